//! Directions in the inputs, for derivatives.

use coilwind::signals::Inputs;

/// A change `by` of one input: 0 speed of the spindle, 1 place of the nozzle, 2 set tension.
pub fn along(input: usize, by: f64) -> Inputs {
    let of = |k: usize| if k == input { by } else { 0.0 };
    Inputs {
        spindle_speed: of(0),
        nozzle_position: of(1),
        tension_setpoint: of(2),
        ..Inputs::HELD
    }
}
