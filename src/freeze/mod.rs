//! Wire at rest leaves the computation and becomes fixed geometry on the core.

mod policy;
mod tube;

pub use policy::{FreezePolicy, Watch};
pub use tube::{FrozenNode, SIDES, Tube};
