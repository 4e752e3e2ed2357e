//! Explicit steps, and how long one may be.

pub mod rk4;
mod stability;
pub mod verlet;

pub use stability::{RK4_LIMIT, VERLET_LIMIT, highest_frequency, longest_step};
