//! The handle of a run, and its communication steps: the method's own steps need not end where they do.

mod ahead;
mod door;
mod points;
mod pool;
mod run;
mod talk;

pub(super) use ahead::Ahead;
pub(super) use pool::Pool;
pub use run::Simulation;
pub(super) use talk::Talk;
