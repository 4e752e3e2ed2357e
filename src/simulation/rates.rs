//! First derivatives of the outputs by time, for importers that look ahead.

use super::Simulation;
use crate::signals::Outputs;

/// Wire laid in a step over wire fed in it, from which on a stretch of wire has landed. A round core lays what is fed;
/// chosen: half as much again.
const LANDED: f64 = 1.5;

impl Simulation {
    /// Slopes of the outputs at the communication point; `before` are those of the one before, `dt` (s) ago.
    pub(super) fn update_rates(&mut self, before: &Outputs, dt: f64) {
        let o = self.run.outputs;
        self.run.rates = Outputs {
            spindle_angle: self.sys.state.spindle.speed,
            ..Outputs::default()
        };
        if self.run.over || self.is_quiescent() {
            return;
        }
        self.run.rates.fed_length = o.feed_speed;
        // More wire laid than was fed: a stretch landed at once, which says nothing about the next step.
        let laid = (o.wire_length - before.wire_length).abs();
        if laid <= LANDED * (o.fed_length - before.fed_length).abs() {
            self.run.rates.free_length = (o.free_length - before.free_length) / dt;
        }
    }

    /// Returns the first time derivatives of the outputs at the last communication point, per s.
    ///
    /// - `spindle_angle` and `fed_length`: the speeds themselves.
    /// - `free_length`: the change over the communication step; 0 where a stretch of wire landed in it.
    /// - `layon_*`, `turns_wound`: 0. Wire swings about a corner and lands on the next, so that these go in jumps.
    /// - `wire_tension`, `spindle_torque`, `feed_speed`: 0. The free span rings at a period of a millisecond, so that
    ///   a slope of now misses the next communication point by more than the value held.
    /// - All others: 0, because they change only when wire comes to rest.
    pub fn output_rates(&self) -> &Outputs {
        &self.run.rates
    }
}
