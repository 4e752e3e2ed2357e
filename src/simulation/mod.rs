//! The one door to a run: scene in, inputs in, outputs and events out.
//!
//! [`Winding`] is a run as data, and [`Simulation`] is the handle that drives it. A step reads as a list of stages: move, feed,
//! forces ([`crate::integrate`]), then remeshing (insert wire at the nozzle, refine near the core, let settled wire go), then
//! measure.

mod communication;
mod faults;
mod motion;
mod outputs;
mod quasi_static;
mod remesh;
mod saved;
mod settled;
mod start;
mod step_derivatives;
mod stepping;
mod verdict;
mod winding;

pub use crate::geometry::{Surface, TriMesh};
pub use crate::integrate::SolverStatistics;
pub use communication::Simulation;
pub use outputs::Centreline;
pub use saved::RestoreError;
pub use settled::OTHER_WAY;
pub use step_derivatives::Derivative;
pub use verdict::{EnergySummary, Fill, PenetrationSummary, Product, Summary};
#[cfg(feature = "lab")]
#[doc(hidden)]
pub use winding::StepTrail;
#[cfg(feature = "lab")]
pub(crate) use winding::{DEEPEST, UNEXPLAINED};
pub use winding::{FreezePolicy, MotionProfile, SimError, Watch, Winding, core_surface};
