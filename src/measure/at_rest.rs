//! How high wire stands at rest over what it is laid on.

use super::STATIONS_PER_TURN;
use super::coil::Coil;
use super::profile::Profile;
use super::support::Support;

/// Stations over which tensions of two rows are compared: half a turn, in which each face of a core comes round, or its twin.
const COMPARED: usize = STATIONS_PER_TURN / 2;

impl Coil {
    /// Height at rest of wire with this `tension`, N, at the next station, over its `support`, m. `over_core` is that of
    /// a loop drawn tight round the core there, m, under the tension that was meant.
    ///
    /// A loop drawn round wire lies close on it, since that stands off the core as the loop would alone. A looser one stands
    /// higher: heights go with the root of the tension. Wire may be that loose until its tension makes it a loose turn.
    fn at_rest(&self, over_core: f64, support: &Support, tension: f64) -> f64 {
        if !support.is_wire {
            return over_core;
        }
        let least = self.spec.limits.loose_tension * self.spec.tension;
        let present = self.mean_tension(self.records.len(), tension).max(least);
        let Some(below) = support.below.filter(|_| present > 0.0) else {
            return 0.0;
        };
        let own = self.records[below].signs.tension_sum - self.tension_before(below);
        let looser = libm::sqrt(self.mean_tension(below, own) / present) - 1.0;
        over_core * looser.max(0.0)
    }

    /// By how much a `bulge`, m, is more than the height at rest of such wire; none where that of the core is not known.
    pub(super) fn over_rest(
        &self,
        bulge: f64,
        (angle, y): (f64, f64),
        support: &Support,
        tension: f64,
    ) -> Option<f64> {
        let over_core = |profile: &Profile| profile.at(self.polar_at(angle), y);
        let profile = self.spec.profile.as_ref()?;
        Some(bulge - self.at_rest(over_core(profile), support, tension))
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
