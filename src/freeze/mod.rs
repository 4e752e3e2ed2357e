//! Wire at rest leaves the computation and becomes fixed geometry on the core.
//!
//! * [`Tube`]: as cylinder meshes, for the explicit steps
//! * [`SplineTube`]: as a tube with a continuous normal, for smooth contact

mod grid;
mod policy;
mod spline;
mod tube;

pub use policy::{FreezePolicy, Watch};
pub use spline::{Curve, Foot, SplineTube};
pub use tube::{FrozenNode, SIDES, Tube};
