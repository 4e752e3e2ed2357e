//! The layer that is being wound, of wire that may not have come to rest yet, and where it begins.

use super::coil::{Coil, STEP_UP};
use std::f64::consts::TAU;

/// Wire that changes its layer farther than this from where it is meant to climb, rad, has ridden up or sunk there and begins no layer.
/// Chosen: a turn. Wire that rides up on its neighbour comes down again within one.
const ASTRAY: f64 = TAU;

impl Coil {
    /// Layer, from 1, of the wire at this winding angle, and the winding angle at which that layer begins, rad, as far as is known by now.
    ///
    /// Where wire has come to rest in that layer, it says so. Until then the plan does, in the middle of the climb, or without a plan the
    /// nozzle, which has turned. A swing of the nozzle past its place is no turn of it.
    pub fn layer_being_laid(&self, angle: f64) -> (u32, f64) {
        let (layer, since, end) = self.records.last().map_or((1, 0.0, 0.0), |last| {
            let station = &last.station;
            (
                station.layer as usize,
                last.signs.layer_since,
                station.angle,
            )
        });
        let (jumps, full) = (&self.spec.jumps, self.spec.full);
        if jumps.is_empty() && full.is_none() {
            let climbed = (layer > 1).then_some(since);
            let begins = self.passes.begins(angle, climbed).max(0.0);
            // (after a turn of the nozzle wire may lie beside the layer for a turn or two before it climbs)
            return (self.layer(), begins);
        }
        let middle = |jump: &[f64; 2]| 0.5 * (jump[0] + jump[1]);
        let planned = |climbs: usize| match climbs {
            0 => 0.0,
            _ => middle(&jumps[climbs - 1]),
        };
        let due = jumps.partition_point(|jump| middle(jump) <= angle);
        let climbs = layer - 1;
        if climbs > due {
            // it has climbed early, for good or for a while, or once the plan was over
            let is_early = end - since > ASTRAY;
            let is_over = full.is_some_and(|full| since > full - STEP_UP);
            return match is_early || is_over {
                true => (climbs as u32 + 1, since),
                false => (due as u32 + 1, planned(due)),
            };
        }
        let [from, to] = jumps.get(climbs).copied().unwrap_or([f64::INFINITY; 2]);
        let is_late = climbs < due && since < from && end > to + STEP_UP;
        let begun = if is_late { climbs } else { due };
        let has_climbed = climbs == begun && (since - planned(begun)).abs() < ASTRAY;
        let begins = if has_climbed { since } else { planned(begun) };
        (begun as u32 + 1, begins)
    }
}
