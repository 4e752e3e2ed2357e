//! The system and the explicit steps that move it in time.

mod band;
mod books;
mod change;
mod flow;
mod relax;
pub mod rk4;
mod stability;
mod support;
mod system;
pub mod verlet;

pub use books::Books;
pub use relax::{Limits, RelaxError, Relaxed, ramp, relax};
pub use stability::{RK4_LIMIT, VERLET_LIMIT, highest_frequency, longest_step};
pub use support::{Spindle, Support, turn_about_y};
pub use system::{Loads, System};
