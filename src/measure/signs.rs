//! What the settled wire shows of double turns, skipped grooves, jumps out of turn, loose and stretched wire.

use super::STATIONS_PER_TURN;
use super::coil::Coil;
use super::row::Row;
use super::station::{Signs, Station};
use super::support::Support;

impl Coil {
    /// The signs of the next station.
    pub(crate) fn signs(
        &self,
        station: &Station,
        row: Row,
        support: &Support,
        bucket: (usize, i64),
        strain: f64,
        tension: f64,
    ) -> Signs {
        let last = self.records.last();
        let before = last.map(|last| last.signs).unwrap_or_default();
        let layer_since = match last {
            Some(last) if last.station.layer != station.layer => station.angle,
            _ => before.layer_since,
        };
        let above_since = self.above_since(station, (row, support), &before, layer_since);
        let signs = Signs {
            rise: support.own_row,
            empty_groove: self.empty_groove(station, row, support, bucket),
            early: above_since.and_then(|since| self.early(station.angle, since)),
            late: self.late(station, layer_since),
            strain,
            layer_since,
            above_since,
            untouched: before.untouched + u32::from(self.touches_nothing(station, support)),
            tension_sum: before.tension_sum + tension,
            loose: None,
        };
        Signs {
            loose: self.looseness(self.records.len(), &signs),
            ..signs
        }
    }

    /// Gap to the turn before where two turns or more of the row below lie between the two: a groove between them is empty.
    ///
    /// Neighbouring grooves have one turn of the row below between them, whatever its pitch.
    fn empty_groove(
        &self,
        station: &Station,
        row: Row,
        support: &Support,
        bucket: (usize, i64),
    ) -> Option<f64> {
        // wire that comes back skips none
        let neighbour = station.neighbour.filter(|n| n.axial > 0.0)?;
        let below = support.row?;
        let (here, there) = (
            station.position.y,
            station.position.y - row.sense * neighbour.axial,
        );
        let (low, high) = (here.min(there), here.max(there));
        let bin = |y: f64| (y / self.spec.diameter).floor() as i64;
        let mut between = 0;
        for bin in bin(low)..=bin(high) {
            let mut next = self.buckets.get((bucket.0, bin));
            while let Some(index) = next {
                let lower = &self.records[index];
                next = lower.beneath;
                let y = lower.station.position.y;
                between += u32::from(lower.row.number == below && y > low && y < high);
            }
        }
        (between >= 2).then_some(neighbour.gap)
    }

    /// Whether wire stands higher over what it was laid on than it would at rest; not known where that height is not.
    fn touches_nothing(&self, station: &Station, support: &Support) -> bool {
        let most = self.spec.limits.loose_height * self.spec.diameter;
        // wire that rides on its own row touches that
        station.measured
            && station.height - support.highest > most
            && station.bulge_excess.is_some_and(|excess| excess > most)
    }

    /// How loose the last turn up to the station at `index` is: 1 where too much of it touches nothing, or where its mean
    /// tension has fallen to the least share of what was meant. None before a turn beyond the clamp.
    fn looseness(&self, index: usize, now: &Signs) -> Option<f64> {
        let limits = &self.spec.limits;
        let back = index.checked_sub(STATIONS_PER_TURN)?;
        let is_free = |first: &usize| self.is_free_of_clamp(self.records[*first].station.angle);
        let first = (back..index).find(is_free)?;
        let start = &self.records[first].signs;
        let tension = (now.tension_sum - start.tension_sum) / (index - first) as f64;
        let least = limits.loose_tension * self.spec.tension;
        let by_place = self.looseness_by_place(start, now);
        let by_tension = match least {
            0.0 => 0.0,
            least => least / tension.max(1e-3 * least),
        };
        Some(by_place.max(by_tension))
    }

    /// Share of the turn between two stations that touches nothing, over what may.
    pub(super) fn looseness_by_place(&self, start: &Signs, now: &Signs) -> f64 {
        let untouched = f64::from(now.untouched - start.untouched) / STATIONS_PER_TURN as f64;
        match self.spec.limits.loose_fraction {
            0.0 => f64::from(u8::from(untouched > 0.0)) * 2.0,
            most => untouched / most,
        }
    }
}
