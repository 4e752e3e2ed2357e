//! First derivatives of the outputs by time, for importers that look ahead.

use super::{Simulation, Winding};
use crate::signals::Outputs;

/// Wire laid in a step over wire fed in it, from which on a stretch of wire has landed. A round core lays what is fed;
/// chosen: half as much again.
const LANDED: f64 = 1.5;

/// Slopes of the outputs `after` a communication step of `dt`, s, at whose end the spindle turns at `speed`, rad/s; `before` are
/// those of its start.
pub(super) fn rates_of(
    winding: &Winding,
    [before, after]: [&Outputs; 2],
    dt: f64,
    speed: f64,
) -> Outputs {
    let mut rates = Outputs {
        spindle_angle: speed,
        ..Outputs::default()
    };
    if winding.run.over || winding.is_quiescent() {
        return rates;
    }
    rates.fed_length = after.feed_speed;
    // More wire laid than was fed: a stretch landed at once, which says nothing about the next step.
    let laid = (after.wire_length - before.wire_length).abs();
    if laid <= LANDED * (after.fed_length - before.fed_length).abs() {
        rates.free_length = (after.free_length - before.free_length) / dt;
    }
    rates
}

impl Simulation {
    /// Returns the first time derivatives of the outputs at the last communication point, per s.
    ///
    /// - `spindle_angle` and `fed_length`: the speeds themselves.
    /// - `free_length`: the change over the communication step; 0 where a stretch of wire landed in it.
    /// - `layon_*`, `turns_wound`: 0. Wire swings about a corner and lands on the next, so that these go in jumps.
    /// - `wire_tension`, `spindle_torque`, `feed_speed`: 0. The free span rings at a period of a millisecond, so that
    ///   a slope of now misses the next communication point by more than the value held.
    /// - All others: 0, because they change only when wire comes to rest.
    pub fn output_rates(&self) -> &Outputs {
        self.talk
            .served
            .as_ref()
            .map_or(&self.now.run.rates, |served| &served.rates)
    }
}
