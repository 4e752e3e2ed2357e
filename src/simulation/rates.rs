//! First derivatives of the outputs, for importers that look ahead.

use super::Simulation;
use super::run_state::Instant;
use crate::signals::Outputs;

impl Simulation {
    /// Returns the outputs that [`Instant`] holds, at the time of the wire.
    pub(super) fn instant(&self) -> Instant {
        Instant {
            time: self.sys.state.time,
            tension: self.wire_tension(),
            torque: self.sys.state.torque_on_core,
            feed_speed: self.sys.state.feed.map_or(0.0, |f| f.rate),
        }
    }

    /// Slopes of the outputs at the communication point; `before` are those of the one before.
    pub(super) fn update_rates(&mut self, before: &Outputs, dt: f64) {
        let step = self.sys.state.time - self.run.instant.time;
        let (now, old) = (self.instant(), self.run.instant);
        let o = self.run.outputs;
        self.run.rates = Outputs {
            spindle_angle: self.sys.state.spindle.speed,
            ..Outputs::default()
        };
        if self.run.broken || self.is_quiescent() || step <= 0.0 {
            return;
        }
        self.run.rates.wire_tension = (now.tension - old.tension) / step;
        self.run.rates.spindle_torque = (now.torque - old.torque) / step;
        self.run.rates.feed_speed = (now.feed_speed - old.feed_speed) / step;
        self.run.rates.fed_length = o.feed_speed;
        self.run.rates.turns_wound = (o.turns_wound - before.turns_wound) / dt;
        self.run.rates.free_length = (o.free_length - before.free_length) / dt;
        self.run.rates.layon_position = (o.layon_position - before.layon_position) / dt;
        self.run.rates.layon_angle = (o.layon_angle - before.layon_angle) / dt;
    }

    /// Returns the first time derivatives of the outputs at the last communication point, per s.
    ///
    /// - `spindle_angle` and `fed_length`: the speeds themselves.
    /// - `wire_tension`, `spindle_torque`, `feed_speed`: the change over the last step of the method.
    /// - `free_length`, `layon_*`, `turns_wound`: the change over the communication step, because
    ///   lift-off moves from node to node.
    /// - All others: 0, because they change only when wire comes to rest.
    pub fn output_rates(&self) -> &Outputs {
        &self.run.rates
    }
}
