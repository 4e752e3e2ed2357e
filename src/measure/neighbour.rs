//! The wire one turn back, beside a station.

use super::coil::Coil;
use super::row::Row;
use super::station::{NEIGHBOUR_WINDOW, Neighbour};
use crate::math::{V3, closest_point_segment};
use std::f64::consts::TAU;

impl Coil {
    /// Nearest centreline point of the same row one turn back, and where its search began.
    ///
    /// There is none where the wire one turn back belongs to another row, even where the beginning of this one is near.
    pub(super) fn neighbour(&self, angle: f64, p: V3, row: Row) -> (Option<Neighbour>, usize) {
        let target = angle - TAU;
        // The window only moves on; what is behind it need not be looked at again.
        let mut first = self.records.last().map_or(0, |record| record.window);
        if target < -1e-9 {
            return (None, first);
        }
        while first + 1 < self.nodes.len()
            && self.nodes[first + 1].reach < target - NEIGHBOUR_WINDOW
        {
            first += 1;
        }
        if target < row.from {
            return (None, first);
        }
        let mut nearest: Option<(f64, V3)> = None;
        for node in first + 1..self.nodes.len() {
            let pair = [&self.nodes[node - 1], &self.nodes[node]];
            if pair[0].reach > target + NEIGHBOUR_WINDOW {
                break;
            }
            if pair[1].angle < row.from {
                continue;
            }
            let q = closest_point_segment(p, pair[0].settled.position, pair[1].settled.position);
            let distance2 = (p - q).norm_squared();
            if nearest.is_none_or(|(least, _)| distance2 < least) {
                nearest = Some((distance2, q));
            }
        }
        let neighbour = nearest.map(|(distance2, q)| Neighbour {
            gap: distance2.sqrt() - self.spec.diameter,
            axial: row.sense * (p.y - q.y),
        });
        (neighbour, first)
    }
}
