//! A place left empty beside the flange where a layer begins: its first turn has no neighbour to show that.

use super::STATIONS_PER_TURN;
use super::coil::{Coil, Record};
use super::planned_start::LayerStart;
use super::row::Row;
use super::runs::stations_for;
use super::station::Station;
use super::support::PLACE;

/// Part of a first turn beside which a place has to be empty. Chosen: half a turn. Wire that travels evenly has as much room for the
/// last quarter of its first turn.
const LASTS: f64 = 0.5;

impl Coil {
    /// Stations on end beside which a place is empty up to this one, of this row, and the room there beyond the plan, m, as it was once that counted.
    pub(super) fn left_empty(&self, station: &Station, row: Row) -> (u32, f64) {
        let radius = 0.5 * self.spec.diameter;
        let start = self.spec.layer_starts.get(station.layer as usize - 1);
        let in_its_layer = |start: &&LayerStart| {
            row.number == station.layer && station.height + radius < start.rim
        };
        let start = start.filter(in_its_layer);
        // (a table may begin at either flange)
        let more = start.map(|start| {
            let face = start.faces[usize::from(row.sense < 0.0)];
            (station.position.y - face) * row.sense - radius - start.room
        });
        let begins = station.measured && station.neighbour.is_none() && !station.crosses;
        match more {
            Some(more) if begins && more >= PLACE * self.spec.diameter => {
                let last = self.records.last().map_or((0, 0.0), |last| last.left_empty);
                // (there is less where wire comes to lie in its place, and more where it crosses to the next one)
                (
                    last.0 + 1,
                    if self.is_empty_for(last.0) {
                        last.1
                    } else {
                        more
                    },
                )
            }
            _ => (0, 0.0),
        }
    }

    /// Gap to the turn before, m, or, beside the flange where a layer begins, room of a place that has been empty for so long that half
    /// a turn is full once a gap there counts.
    pub(super) fn gap_at(&self, record: &Record) -> Option<f64> {
        let (count, room) = record.left_empty;
        let neighbour = record.station.neighbour.map(|neighbour| neighbour.gap);
        neighbour.or_else(|| self.is_empty_for(count).then_some(room))
    }

    /// Whether a place that has been empty for so many stations is a gap, once that lasts.
    fn is_empty_for(&self, count: u32) -> bool {
        let lasts = (LASTS * STATIONS_PER_TURN as f64) as u32;
        count + stations_for(self.spec.limits.gap_fraction) > lasts
    }
}
