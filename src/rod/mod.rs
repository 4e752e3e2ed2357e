//! The wire as a discrete rod: section law, stretch, bend and twist.
//!
//! Mass points joined by straight, bending and torsional springs (the paper's section II).
//! Node 0 is the oldest wire (the clamp), the last node the youngest (the nozzle); edge `j` runs
//! from node `j` to node `j + 1`; joint `i` is the bend and twist at node `i`.

pub mod batch;
mod bending;
mod forces;
mod joint;
mod plasticity;
mod section;
mod state;
mod twist;
mod twisting;
mod yield_branch;

pub use crate::math::{Block, add_outer};
pub use batch::{BendingJoints, Forces, TwistingJoints};
pub use bending::{Bent, Stretched, Symmetric, add_square, bent, stretched, turning};
pub use forces::{ForceParts, Laws, Load, internal_forces, stored_energy};
pub use joint::Joint;
pub use plasticity::{Bend, Law, Scalar, respond_bend, respond_scalar};
pub use section::Section;
pub use state::Rod;
pub use twist::Twist;
pub use twisting::{Rolled, Turned, twisted};
pub use yield_branch::{YieldBranch, YieldBranches};
