//! What holds the solver to account: exact answers, benchmarks, random scenes.

pub mod bench;
pub mod statics;
pub mod stress;
pub mod verify;
