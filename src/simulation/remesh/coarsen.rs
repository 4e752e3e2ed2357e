//! Coarser spacing of settled wire behind lift-off.
//!
//! Wire needs fine nodes while it bends round a corner. The bows it leaves between corners are
//! smooth and move only a little as a whole. A node is removed where its neighbours carry the same
//! curvature. The error indicator is a displacement over one bending length: the one that results
//! when the node's share of the curvature is spread over its neighbours.

use crate::math::{Spin, V3, scaled};
use crate::rod::turning;
use crate::simulation::Winding;

/// Longest joined edge over the spacing near the core.
const LONGEST: f64 = 4.0;
/// Height of an arc over the joined edge, in wire diameters: contact and frozen wire see a spline that
/// cuts the polygon's corners by this much.
const CUT: f64 = 0.005;
/// The same for wire that touches, in m for wire of 0.7 mm: a hundredth of the depth over which contact sets in.
const CUT_TOUCHING: f64 = 1e-8;
/// Wire this share of the keep length behind lift-off may be coarsened ...
const BEHIND: f64 = 0.6;
/// ... and is fine again when it comes nearer than this.
const AHEAD: f64 = 0.4;

impl Winding {
    /// First node from the clamp that is less than `share` of the keep length behind lift-off.
    fn near_lift_off(&self, share: f64) -> usize {
        let mut left = share * self.run.policy.keep_length;
        let mut i = self.lift_off();
        while i > 0 && left > 0.0 {
            i -= 1;
            left -= self.sys.state.rod.rest[i];
        }
        i
    }

    /// First edge that has to have the spacing its place asks for.
    pub(super) fn first_fine_edge(&self) -> usize {
        self.near_lift_off(AHEAD)
    }

    /// Nodes behind lift-off that can go, ascending, no two of them neighbours.
    pub(super) fn nodes_to_coarsen(&self) -> Vec<usize> {
        let solver = self.scene.solver;
        let end = self.near_lift_off(BEHIND);
        let mut nodes = Vec::new();
        if end < 4 {
            return nodes;
        }
        let rod = &self.sys.state.rod;
        let wire = &self.scene.wire;
        let spin = Spin::new(self.sys.state.spindle.angle);
        let bending = (wire.ei
            / self
                .sys
                .state
                .set_tension
                .max(0.01 * self.scene.tensioner.tension))
        .sqrt();
        let curvature = |i: usize| -> V3 {
            let t = [rod.tangent(i - 1), rod.tangent(i)];
            spin.to_core(turning([&t[0], &t[1]])) / rod.voronoi(i)
        };
        let mut i = 2;
        while i < end - 1 {
            let [a, b] = [rod.rest[i - 1], rod.rest[i]];
            let length = a + b;
            if length <= LONGEST * solver.spacing_near * (1.0 + 1e-9) {
                let [before, here, after] = [curvature(i - 1), curvature(i), curvature(i + 1)];
                let spread = (before * b + after * a) / length;
                let set = |i: usize| rod.bend[i].curvature;
                let off: f64 = (0..2)
                    .map(|k| {
                        let s = (set(i - 1)[k] * b + set(i + 1)[k] * a) / length;
                        (set(i)[k] - s).powi(2)
                    })
                    .sum();
                let off = off.sqrt().max((here - spread).norm());
                // a surface that the wire lies on would push the chord out again, and tighten it
                let cut = if (i - 1..=i + 1).any(|k| self.sys.touches(k)) {
                    scaled(CUT_TOUCHING, wire.diameter)
                } else {
                    CUT * wire.diameter
                };
                if here.norm() * length * length < 8.0 * cut
                    && off * length * bending < solver.tolerance
                {
                    nodes.push(i);
                    i += 1;
                }
            }
            i += 1;
        }
        nodes
    }
}
