//! Where the wire meets the coil, as a place that moves evenly along the wire.

use super::Winding;
use crate::math::{Spin, V3, polar_angle, scaled, wrap_to_pi};

/// Clearance up to which wire lies on the core, m, for wire of 0.7 mm.
///
/// A span that leaves a flat face at no angle has no last touch: rounding decides where its pressure ends. Chosen: as
/// large as the error that a step may have at the default tolerance. It moves the place on a corner of 2 mm by 0.1 mm.
const LIES: f64 = 2e-6;

/// The place where the wire meets the coil.
#[derive(Clone, Copy, Debug)]
pub(super) struct LayOn {
    /// angle along the wire from the clamp, rad
    pub(super) angle: f64,
    /// of the wire's centreline, in the frame at rest, m
    pub(super) point: V3,
    /// length of wire from there to the nozzle, m
    pub(super) free_length: f64,
    /// unstretched length of wire from the clamp to there, m
    pub(super) arc: f64,
}

impl Winding {
    /// Finds the last wire that touches something or lies on the core, between nodes by its clearance.
    pub(super) fn layon(&self) -> LayOn {
        let spin = Spin::new(self.sys.state.spindle.angle);
        let x = &self.sys.state.rod.x;
        let lies = scaled(LIES, self.scene.wire.diameter);
        let radius = self.scene.wire.radius();
        let clearance = |i: usize| match self.sys.touches(i) {
            true => 0.0,
            false => {
                let height = self.sys.distance_to_core(spin.to_core(self.sys.centre(i)));
                (height - radius).max(0.0)
            }
        };
        let last = x.len() - 1;
        // clearances of the two nodes beyond
        let mut beyond = [f64::INFINITY; 2];
        let mut node = last - 1;
        loop {
            // the clamp lies on the core
            let here = if node == 0 { 0.0 } else { clearance(node) };
            if here <= lies {
                break;
            }
            (node, beyond) = (node - 1, [here, beyond[0]]);
        }
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
            angle: angle + share * self.coil.spec().direction * wrap_to_pi(ahead - polar),
            point: x[node] + share * edge,
            free_length: after + (1.0 - share) * length(node),
        }
    }
}
