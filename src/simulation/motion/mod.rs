//! How spindle, nozzle and tension move: what inputs or the scene's law mean for them.

mod course;
mod master_inputs;
mod nozzle_by_law;
mod nozzle_place;

pub(super) use course::{Course, Given, Likeness};
pub(super) use master_inputs::{MasterInputs, as_meant, check_finite, with_brake};
pub(super) use nozzle_place::{beside_clamp, nozzle_of};
