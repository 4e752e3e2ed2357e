//! Wire that has come to rest on the coil: passes, turns and defects, told as they come and go.

mod frozen_tension;
mod telling;
mod traverse;

pub use traverse::OTHER_WAY;
