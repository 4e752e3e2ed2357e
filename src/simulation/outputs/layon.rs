//! Where the wire meets the coil, as a place that moves evenly along the wire. A flange that it passes on its way is not the coil.

use crate::math::{Spin, V3, polar_angle, scaled, wrap_to_pi};
use crate::measure::added_by_stretch;
use crate::simulation::Winding;

/// Clearance up to which wire lies on the core, m, for wire of 0.7 mm.
///
/// A span that leaves a flat face at no angle has no last touch: rounding decides where its pressure ends. Chosen: as
/// large as the error that a step may have at the default tolerance. It moves the place on a corner of 2 mm by 0.1 mm.
const LIES: f64 = 2e-6;

/// The place where the wire meets the coil.
#[derive(Clone, Copy, Debug)]
pub(in crate::simulation) struct LayOn {
    /// angle along the wire from the clamp, rad
    pub(in crate::simulation) angle: f64,
    /// of the wire's centreline, in the frame at rest, m
    pub(super) point: V3,
    /// length of wire from there to the nozzle, m
    pub(super) free_length: f64,
    /// unstretched length of wire from the clamp to there, m
    pub(super) arc: f64,
    /// what plastic stretch adds to the resistance of that wire, m of unstretched wire
    pub(super) added_by_stretch: f64,
}

impl Winding {
    /// Finds the last wire that touches something, live wire on the coil too, or lies on the core, between nodes by its clearance.
    pub(in crate::simulation) fn layon(&self) -> LayOn {
        let spin = Spin::new(self.sys.state.spindle.angle);
        let x = &self.sys.state.rod.x;
        let lies = scaled(LIES, self.scene.wire.diameter);
        let radius = self.scene.wire.radius();
        let beside_flange = self.sys.may_meet_flange();
        let height = |i: usize| {
            let place = spin.to_core(self.sys.centre(i));
            let distance = match beside_flange {
                true => self.distance_to_wound(place),
                false => self.sys.distance_to_core(place),
            };
            distance - radius
        };
        let last = x.len() - 1;
        // a node and its height: wire so far off reaches the core no sooner than after that way
        let (mut seen, mut off) = (last - 1, 0.0);
        let mut lies_at = |i: usize| {
            if self.sys.touches_wound(i) {
                return true;
            }
            let way = (self.sys.centre(i) - self.sys.centre(seen)).norm();
            if off - way > 2.0 * lies {
                return false;
            }
            (seen, off) = (i, height(i));
            off <= lies
        };
        // the clamp lies on the core
        let mut node = last - 1;
        while node > 0 && !lies_at(node) {
            node -= 1;
        }
        let node = self.sys.carried_by(node);
        let clearance = |i: usize| {
            if i >= last {
                f64::INFINITY
            } else if self.sys.touches_wound(i) {
                0.0
            } else {
                height(i).max(0.0)
            }
        };
        // clearances of the two nodes beyond
        let beyond = [clearance(node + 1), clearance(node + 2)];
        // wire that bends away lifts off with the square of the way, so that roots lie on a line
        let length = |j: usize| (x[j + 1] - x[j]).norm();
        let [near, far, lies] = [beyond[0], beyond[1], lies].map(f64::sqrt);
        let back = if far > near && far.is_finite() {
            (near - lies) * length(node + 1) / (far - near)
        } else {
            length(node)
        };
        let share = (1.0 - back / length(node)).clamp(0.0, 1.0);
        let (angle, polar) = self.wound_to(node);
        let ahead = polar_angle(spin.to_core(x[node + 1]));
        let edge = x[node + 1] - x[node];
        let after: f64 = (node + 1..last).map(length).sum();
        let rest = &self.sys.state.rod.rest;
        let laid: f64 = rest[..node].iter().sum();
        LayOn {
            arc: self.sys.state.arc0 + laid + share * rest[node],
            added_by_stretch: self.added_by_stretch(node, share),
            angle: angle + share * self.coil.spec().direction * wrap_to_pi(ahead - polar),
            point: x[node] + share * edge,
            free_length: after + (1.0 - share) * length(node),
        }
    }

    /// What plastic stretch adds to the resistance of the wire from the clamp to so far behind a live node, a share of its edge:
    /// m of unstretched wire.
    fn added_by_stretch(&self, node: usize, share: f64) -> f64 {
        let rod = &self.sys.state.rod;
        let of = |edge: usize| added_by_stretch(rod.rest[edge], rod.stretch[edge].strain);
        let live: f64 = (0..node).map(of).sum();
        self.coil.added_by_stretch(self.sys.state.arc0) + live + share * of(node)
    }
}
