//! The set of the wire at the node before the nozzle, whose length changes as wire comes and goes.

use super::System;
use crate::rod::Joint;

impl System {
    /// The edge at the nozzle has grown by `grown`: it is straight wire that came or went, so the set
    /// at the node before stays, spread over the node's new length.
    pub(crate) fn keep_set_at_nozzle(&mut self, grown: f64) {
        let rod = &mut self.state.rod;
        let i = rod.nodes() - 2;
        let own = rod.voronoi(i);
        let scale = (own - 0.5 * grown) / own;
        rod.bend[i].curvature = rod.bend[i].curvature.map(|k| k * scale);
        rod.twist[i].strain *= scale;
    }

    /// Elastic energy per length of bending and twist at the node before the nozzle, J/m.
    pub(crate) fn bent_at_nozzle(&self) -> f64 {
        let rod = &self.state.rod;
        let i = rod.nodes() - 2;
        let joint = Joint::between(&rod.frame[i - 1], &rod.frame[i]);
        let own = rod.voronoi(i);
        let bent: f64 = (0..2)
            .map(|k| {
                0.5 * self.model.laws.bend.modulus
                    * (joint.bend[k] / own - rod.bend[i].curvature[k]).powi(2)
            })
            .sum();
        if self.model.twist.is_carried() {
            let twist = joint.twist / own - rod.twist[i].strain;
            return bent + 0.5 * self.model.laws.twist.modulus * twist * twist;
        }
        bent
    }
}
