//! The methods that move a system in time: implicit (production), explicit (the paper's).

mod explicit;
pub mod implicit;
mod stepper;

pub use explicit::{Explicit, ExplicitMethod, highest_frequency, longest_step, shift_velocities};
#[cfg(feature = "lab")]
pub use explicit::{RK4_LIMIT, VERLET_LIMIT};
pub use implicit::{Implicit, NOZZLE_TURN, PATIENCE, Scheme, SolverStatistics, StepError};
pub use stepper::Stepper;
