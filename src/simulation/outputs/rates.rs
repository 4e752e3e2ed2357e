//! First derivatives of the outputs by time, for importers that look ahead.

use crate::signals::Outputs;
use crate::simulation::Winding;

/// Wire laid in a step over wire fed in it, from which on a stretch of wire has landed. A round core lays what is fed;
/// chosen: half as much again.
const LANDED: f64 = 1.5;

/// Slopes of the outputs `after` a communication step of `dt`, s, at whose end the spindle turns at `speed`, rad/s; `before` are
/// those of its start.
pub(in crate::simulation) fn rates_of(
    winding: &Winding,
    [before, after]: [&Outputs; 2],
    dt: f64,
    speed: f64,
) -> Outputs {
    let nozzle_y = (after.nozzle_y - before.nozzle_y) / dt;
    if winding.run.over || winding.is_quiescent() {
        return Outputs {
            spindle_angle: speed,
            nozzle_y,
            ..Outputs::default()
        };
    }
    let mut rates = Outputs {
        nozzle_y,
        ..speeds_of(after, speed)
    };
    // More wire laid than was fed: a stretch landed at once, which says nothing about the next step.
    let laid = (after.wire_length - before.wire_length).abs();
    if laid <= LANDED * (after.fed_length - before.fed_length).abs() {
        rates.free_length = (after.free_length - before.free_length) / dt;
    }
    rates
}

/// Slopes that an instant tells by itself, of its outputs and the spindle's speed, rad/s: those of what has a speed.
pub(in crate::simulation) fn speeds_of(outputs: &Outputs, spindle: f64) -> Outputs {
    Outputs {
        spindle_angle: spindle,
        fed_length: outputs.feed_speed,
        tensioner_position: outputs.tensioner_speed,
        ..Outputs::default()
    }
}
