//! How high wire stands at rest over what it is laid on.

use super::STATIONS_PER_TURN;
use super::coil::Coil;
use super::support::{LaidOn, Support};

/// Stations over which tensions of two rows are compared: half a turn, in which each face of a core comes round, or its twin.
const COMPARED: usize = STATIONS_PER_TURN / 2;

impl Coil {
    /// Height over the core, m, at which wire with this `tension`, N, is at rest at the next station. Its own row may hold it higher.
    /// `over_core` is that of a loop drawn tight round the core there, m, under the tension that was meant.
    ///
    /// A loop drawn round a loop lies close on it, since that stands off the core as the loop would alone. Wound wire below stands lower than
    /// a loop would, and does not carry the one over it. A looser loop stands higher: heights go with the root of the tension. Wire may be
    /// that loose until its tension makes it a loose turn.
    fn at_rest(&self, over_core: f64, support: &Support, tension: f64) -> f64 {
        let Some(LaidOn { level, station }) = support.laid_on else {
            return over_core;
        };
        let below = &self.records[station];
        let level = level + (below.at_rest - below.station.height).max(0.0);
        let least = self.spec.limits.loose_tension * self.spec.tension;
        let present = self.mean_tension(self.records.len(), tension).max(least);
        if present <= 0.0 {
            return level;
        }
        let own = self.records[station].signs.tension_sum - self.tension_before(station);
        let looser = libm::sqrt(self.mean_tension(station, own) / present) - 1.0;
        level + over_core * looser.max(0.0)
    }

    /// The same at the winding angle `angle` (rad) and `y` (m); none where that of the core is not known.
    pub(super) fn level_at_rest(
        &self,
        (angle, y): (f64, f64),
        support: &Support,
        tension: f64,
    ) -> Option<f64> {
        let profile = self.spec.profile.as_ref()?;
        let over_core = profile.at(self.polar_at(angle), y);
        Some(self.at_rest(over_core, support, tension))
    }

    /// Mean tension of the last turn at rest, N; none before there is one beyond the clamp.
    pub fn tension_of_last_turn(&self) -> Option<f64> {
        let end = self.records.len();
        let first = end.checked_sub(STATIONS_PER_TURN)?;
        let is_free = self.is_free_of_clamp(self.records[first].station.angle);
        let sum = self.tension_before(end) - self.tension_before(first);
        is_free.then_some(sum / STATIONS_PER_TURN as f64)
    }

    /// Mean tension of the stations up to that at `index`, whose own this `tension` is, N.
    fn mean_tension(&self, index: usize, tension: f64) -> f64 {
        let first = index.saturating_sub(COMPARED);
        let sum = self.tension_before(index) - self.tension_before(first);
        (sum + tension) / (index - first + 1) as f64
    }

    /// Sum of the tensions of all stations before that at `index`, N.
    fn tension_before(&self, index: usize) -> f64 {
        let before = index.checked_sub(1).map(|before| &self.records[before]);
        before.map_or(0.0, |before| before.signs.tension_sum)
    }
}
