//! The system and the explicit steps that move it in time.

pub mod rk4;
mod stability;
mod system;
pub mod verlet;

pub use stability::{RK4_LIMIT, VERLET_LIMIT, highest_frequency};
pub use system::{Books, Loads, Spindle, Support, System, turn_about_y};
