//! The methods that move a system in time: implicit (production), explicit (the paper's).

mod explicit;
pub mod implicit;

pub use explicit::{RK4_LIMIT, VERLET_LIMIT, highest_frequency, longest_step, rk4, verlet};
pub use implicit::{Implicit, OutputSensitivity, Scheme, SolverStatistics, StepError};
