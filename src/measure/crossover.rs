//! Crossovers: where wire steps from one place of its row to the next.
//!
//! Beside a crossover there are no grooves, and a turn that crosses a little before or after the one before it leaves room
//! between the two. That room is no gap of the winding, and closes where both lie in their places again.

use super::coil::Coil;
use super::{STATION_STEP, STATIONS_PER_TURN};

/// Share of the planned slope from which on wire crosses. Chosen: half. Wire in its place runs straight, and wire that is drawn
/// through its crossover late does so more steeply than planned.
const STEEP: f64 = 0.5;
/// Stations over which the slope of the wire is taken.
const OVER: usize = 6;

/// The crossover that the scene plans for each turn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossover {
    /// way along y, m
    pub step: f64,
    /// winding angle that it takes, rad
    pub angle: f64,
}

impl Coil {
    /// The last station up to the next one at which wire crosses, when the next one lies at `y`, m.
    pub(crate) fn last_crossing(&self, y: f64) -> Option<usize> {
        let crossover = self.spec.crossover?;
        let index = self.records.len();
        let before = index.checked_sub(OVER).map(|k| &self.records[k]);
        let steep = STEEP * crossover.step / crossover.angle * OVER as f64 * STATION_STEP;
        if before.is_some_and(|before| (y - before.station.position.y).abs() > steep) {
            return Some(index);
        }
        self.records.last().and_then(|last| last.last_crossing)
    }

    /// Whether the next station lies in a crossover of its own turn or the one before, up to half a crossover before it, or up to
    /// a whole one after it: wire that is drawn beyond its place comes back within as much.
    ///
    /// `last_crossing` is that of the next station. How soon its own turn crosses is not known yet; as a rule it does so where the
    /// turn before has.
    pub(crate) fn is_in_crossover(&self, last_crossing: Option<usize>) -> bool {
        let Some(crossover) = self.spec.crossover else {
            return false;
        };
        let index = self.records.len();
        let half = (0.5 * crossover.angle / STATION_STEP).ceil() as usize;
        let near = |last: Option<usize>, at: usize| last.is_some_and(|last| last + 2 * half >= at);
        let turn_before = || {
            let ahead = (index + half).checked_sub(STATIONS_PER_TURN)?;
            let record = &self.records[ahead.min(index.checked_sub(1)?)];
            Some((record.last_crossing, index.checked_sub(STATIONS_PER_TURN)?))
        };
        near(last_crossing, index) || turn_before().is_some_and(|(last, from)| near(last, from))
    }
}
