//! Directions in the inputs, for derivatives.

use coilwind::signals::Inputs;

/// Names of the inputs, in the order of [`along`].
#[allow(dead_code, reason = "tests name inputs by their numbers")]
pub const INPUTS: [&str; 7] = [
    "spindle_speed",
    "nozzle_position",
    "tension_setpoint",
    "nozzle_offset_x",
    "nozzle_offset_z",
    "brake_torque",
    "tensioner_damping",
];

/// A change `by` of one input, by its place in [`INPUTS`].
pub fn along(input: usize, by: f64) -> Inputs {
    let of = |k: usize| if k == input { by } else { 0.0 };
    Inputs {
        spindle_speed: of(0),
        nozzle_position: of(1),
        tension_setpoint: of(2),
        nozzle_offset_x: of(3),
        nozzle_offset_z: of(4),
        brake_torque: of(5),
        tensioner_damping: of(6),
    }
}
