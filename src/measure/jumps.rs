//! Wire that climbs to the next layer before or after the turn that the scene plans.

use super::coil::{Coil, Record, STEP_UP};
use super::row::Row;
use super::station::{Signs, Station};
use super::support::{NEXT_LAYER, Support};
use std::f64::consts::TAU;

/// Wire that lies above its planned layer for longer than this, rad, has climbed early, whatever it does later. Chosen: a turn. Wire
/// that rides up on its neighbour comes down again within one.
const STAYS: f64 = TAU;
/// The same for wire above the last layer, rad: it has no layer to go to, and the coil ends before wire that climbs in the last turn
/// has lain there for long. Chosen: half a turn, as for a double turn.
const STAYS_ABOVE_LAST: f64 = 0.5 * TAU;

impl Coil {
    /// The layer planned for wire at this winding angle, from 1; a climb is planned until a quarter of a turn after it may begin.
    fn planned_layer(&self, angle: f64) -> usize {
        let jumps = &self.spec.jumps;
        1 + jumps.partition_point(|[from, _]| from + STEP_UP <= angle)
    }

    /// Whether wire of this layer may climb at this winding angle, rad: the scene plans a layer over it, or it is not known what it plans.
    pub(super) fn may_climb(&self, layer: u32, angle: f64) -> bool {
        let is_last = layer as usize > self.spec.jumps.len();
        !is_last || self.spec.full.is_none_or(|full| angle > full)
    }

    /// Winding angle since which wire of the next station has lain above the layer planned there, rad. Wire that came to stand on its own
    /// row has climbed to no layer, for as long as it stays up in that row.
    pub(super) fn above_since(
        &self,
        station: &Station,
        (row, support): (Row, &Support),
        before: &Signs,
        layer_since: f64,
    ) -> Option<f64> {
        let planned = self.planned_layer(station.angle);
        if station.layer as usize <= planned {
            return None;
        }
        let same_plan = |last: &&Record| self.planned_layer(last.station.angle) == planned;
        let last = self.records.last();
        if let (Some(since), Some(_)) = (before.above_since, last.filter(same_plan)) {
            return Some(since);
        }
        let stands = support
            .own_row
            .is_some_and(|rise| rise >= NEXT_LAYER * self.spec.diameter);
        let stood = last.filter(same_plan).is_some_and(|last| {
            last.row.number == row.number && last.station.layer as usize > planned
        });
        (!stands && !stood).then_some(layer_since)
    }

    /// Turns by which wire that has lain above its layer since then, rad, climbed before it was meant to.
    ///
    /// Whether a climb was a jump and no wire that rides up shows where the jump was meant to be: wire still lies above. So it does where
    /// it stays there for long, or for half as long above the last layer.
    pub(super) fn early(&self, angle: f64, since: f64) -> Option<f64> {
        let jump = self.spec.jumps.get(self.planned_layer(angle) - 1);
        let meant = jump.map(|[from, _]| *from).or(self.spec.full)?;
        let stays = if jump.is_some() {
            STAYS
        } else {
            STAYS_ABOVE_LAST
        };
        let is_due = angle >= meant - STEP_UP || angle - since > stays;
        (is_due && angle < meant + STEP_UP).then_some((meant - since) / TAU)
    }

    /// Turns for which wire of the next station has not climbed though it was meant to.
    pub(super) fn late(&self, station: &Station, layer_since: f64) -> Option<f64> {
        let (angle, jumps) = (station.angle, &self.spec.jumps);
        // the jump that wire is at or past
        let due = jumps.partition_point(|[from, _]| from - STEP_UP <= angle);
        let [_, to] = jumps[due.checked_sub(1)?];
        // the layer before that jump has its number, from 1
        let is_late = station.layer as usize <= due && layer_since < to && angle > to;
        is_late.then_some((angle - to) / TAU)
    }
}
