//! First derivatives of the outputs, for importers that look ahead.

use super::Simulation;
use crate::signals::Outputs;
use serde::{Deserialize, Serialize};

/// What outputs change evenly from one step of the method to the next.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Instant {
    time: f64,
    tension: f64,
    torque: f64,
    feed_speed: f64,
}

impl Instant {
    pub(super) fn of(sim: &Simulation) -> Self {
        Self {
            time: sim.sys.state.time,
            tension: sim.wire_tension(),
            torque: sim.sys.state.torque_on_core,
            feed_speed: sim.sys.state.feed.map_or(0.0, |f| f.rate),
        }
    }
}

impl Simulation {
    /// Slopes of the outputs at the communication point; `before` are those of the one before.
    pub(super) fn update_rates(&mut self, before: &Outputs, dt: f64) {
        let step = self.sys.state.time - self.run.instant.time;
        let (now, old) = (Instant::of(self), self.run.instant);
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

    /// First derivatives of the outputs with respect to time at the last communication point, per s.
    ///
    /// Core angle and fed length by their speeds. Tension, torque and speed of the wire by their change
    /// over the last step of the method. Where the wire lifts off moves from node to node, so what depends
    /// on it (`free_length`, `layon_*`, `turns_wound`) by its change over the communication step. Everything else
    /// changes only when wire comes to rest, and has 0.
    pub fn output_rates(&self) -> &Outputs {
        &self.run.rates
    }
}
