//! Communication steps: what a master reads, however it steps, and runs that are saved and go on.

#[path = "../common/along.rs"]
mod along;
mod between_steps;
#[path = "../common/mod.rs"]
mod common;
mod lengths;
mod long_steps;
mod one_door;
mod saved;
mod step_derivatives;
mod steps_beyond;
#[path = "../common/stl.rs"]
mod stl;
mod within_a_step;
