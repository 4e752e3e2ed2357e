//! The wire as a discrete rod: section law, stretch, bend and twist.
//!
//! Mass points joined by straight, bending and torsional springs (the paper's section II).
//! Node 0 is the oldest wire (the clamp), the last node the youngest (the nozzle). Edge `j` runs
//! from node `j` to node `j + 1`, joint `i` is the bend and twist at node `i`.

pub mod batch;
mod bending;
mod exit_bend;
mod flow_curve;
mod forces;
mod joint;
mod material;
mod pieces;
mod plasticity;
mod section;
mod state;
mod twist;
mod twisting;
mod yield_branch;

pub use crate::math::{Block, add_outer};
pub use batch::{BendingJoints, Forces, TwistingJoints};
#[cfg(any(test, feature = "lab"))]
pub use bending::bent;
#[cfg(feature = "lab")]
pub use bending::{Bent, Symmetric, add_square};
pub use bending::{SetCurvature, Stretched, stretched, turning};
pub use exit_bend::ExitBend;
pub use flow_curve::{Bilinear, FlowCurve, FlowCurveError, InPieces, MOST_STRAIN, RoundLaws};
pub use forces::{ForceParts, Laws, Load, internal_forces, stored_energy};
pub use joint::{Joint, mid_frame_vector};
pub use material::Material;
pub use pieces::Pieces;
pub use plasticity::{Bend, Law, Scalar};
#[cfg(feature = "lab")]
pub use plasticity::{respond_bend, respond_scalar};
pub use section::{ENAMEL_DENSITY, Hardening, Section};
pub use state::Rod;
pub use twist::Twist;
#[cfg(any(test, feature = "lab"))]
pub use twisting::twisted;
#[cfg(feature = "lab")]
pub use twisting::{Rolled, Turned};
pub use yield_branch::{YieldBranch, YieldBranches};
