//! Joining two edges.

use super::super::System;
use crate::math::{Quat, align};
use crate::rod::Joint;

/// An inner node that is taken out, and the edge that its two become.
#[derive(Clone, Copy, Debug)]
pub(in crate::system) struct Merge {
    /// the node
    pub node: usize,
    /// unstretched lengths of the edges before and after it, m
    pub rest: [f64; 2],
    /// unstretched length of the joined edge, m
    pub joined: f64,
    /// frame of the joined edge
    pub frame: Quat,
    /// the joined edge ends at the nozzle: set that has gone in is forgotten
    pub at_nozzle: bool,
}

impl Merge {
    /// Mean of a value before and after the node, weighed by the lengths of the edges.
    pub fn share(&self, before: f64, after: f64) -> f64 {
        let [a, b] = self.rest;
        (before * a + after * b) / (a + b)
    }
}

impl System {
    /// Takes inner node `i` out and joins its edges; plastic state is shared out by length.
    ///
    /// The joined edge is as stretched as the two were on average, and one at the nozzle pulls as the edge there did: the line behind it
    /// knows nothing of the edge before. The chord is shorter than the edges were. The difference counts as wire that went back
    /// through the nozzle.
    pub fn merge(&mut self, i: usize) {
        let nodes = self.state.rod.nodes();
        debug_assert!(i > 0 && i + 1 < nodes, "an inner node");
        let at_nozzle = i + 2 == nodes && self.state.feed.is_some();
        let kinetic = if at_nozzle { self.kinetic() } else { 0.0 };
        let merge = self.plan_merge(i, at_nozzle);
        for part in self.parts() {
            part.merge(&merge);
        }
        self.carry_points(i - 1, i);
        if at_nozzle {
            self.state.balance.inflow += self.kinetic() - kinetic;
        }
        let [a, b] = merge.rest;
        self.count_as_fed(merge.joined - a - b);
    }

    fn plan_merge(&self, i: usize, at_nozzle: bool) -> Merge {
        let rod = &self.state.rod;
        let [a, b] = [rod.rest[i - 1], rod.rest[i]];
        let length = (rod.x[i] - rod.x[i - 1]).norm() + (rod.x[i + 1] - rod.x[i]).norm();
        let chord = rod.x[i + 1] - rod.x[i - 1];
        let mut merge = Merge {
            node: i,
            rest: [a, b],
            joined: (a + b) * chord.norm() / length,
            frame: rod.frame[i - 1],
            at_nozzle,
        };
        if at_nozzle && let Some(pull) = self.state.load.tension.last() {
            let plastic = merge.share(rod.stretch[i - 1].strain, rod.stretch[i].strain);
            let modulus = self.model.laws.stretch.modulus;
            merge.joined = chord.norm() / (1.0 + plastic + pull / modulus);
        }
        // the joined edge's middle is this far from that of its first part
        let roll = if self.model.twist.is_carried() {
            merge.share(0.0, Joint::between(&rod.frame[i - 1], &rod.frame[i]).twist)
        } else {
            0.0
        };
        merge.frame = align(&rod.frame[i - 1], &chord.normalize(), roll);
        merge
    }
}

#[cfg(test)]
mod tests {
    use super::System;
    use crate::feed::{Feed, FeedSpec};
    use crate::math::V3;
    use crate::rod::{Rod, Section};

    /// Wire that was pushed into the nozzle made the joined edge push, though the line was slack.
    #[test]
    fn a_joined_edge_at_the_nozzle_pulls_as_the_edge_there_did() {
        let points =
            [0.0, 1.0, 2.0, 2.4].map(|x| V3::new(1e-3 * x, 0.0, 5e-6 * (x - 2.0).max(0.0)));
        for [before, at_nozzle] in [[-2e-6, 0.0], [3e-6, 5e-6]] {
            let mut rod = Rod::through(&points, None);
            rod.stretch[1].strain = 1e-3;
            rod.rest[1] /= 1.0 + 1e-3 + before;
            rod.rest[2] /= 1.0 + at_nozzle;
            let mut sys = System::new(Section::table1_elastic(), rod);
            let spec = FeedSpec::DIRECT;
            sys.set_feed(spec, Feed::at_rest(&spec, 0.0));
            sys.refresh();
            let pull = sys.state.load.tension[2];
            assert!((pull / sys.model.laws.stretch.modulus - at_nozzle).abs() < 1e-12);
            sys.merge(2);
            sys.refresh();
            let joined = sys.state.load.tension[1];
            assert!((joined - pull).abs() < 1e-6, "{joined} N, {pull} N before");
        }
    }
}
