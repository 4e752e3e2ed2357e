//! The system and the explicit steps that move it in time.

mod books;
mod change;
pub mod rk4;
mod stability;
mod support;
mod system;
pub mod verlet;

pub use books::Books;
pub use stability::{RK4_LIMIT, VERLET_LIMIT, highest_frequency};
pub use support::{Spindle, Support, turn_about_y};
pub use system::{Loads, System};
