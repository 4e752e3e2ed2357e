//! The system and the methods that move it in time: implicit (`implicit`), explicit (`verlet`, `rk4`).

mod band;
mod books;
mod change;
mod flow;
pub mod implicit;
mod ldl;
mod relax;
pub mod rk4;
mod saved;
mod stability;
mod support;
mod system;
mod twist;
pub mod verlet;

pub use books::Books;
pub use implicit::{Effort, Implicit, Past, Scheme, Seen, Stopped};
pub use ldl::{Banded, Loose};
pub use relax::{Limits, RelaxError, Relaxed, ramp, relax};
pub(crate) use saved::SavedSystem;
pub use stability::{RK4_LIMIT, VERLET_LIMIT, highest_frequency, longest_step};
pub use support::{Spindle, Support, turn_about_y};
pub use system::{Loads, Mass, System};
pub use twist::Twist;
