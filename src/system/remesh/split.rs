//! Halving an edge.

use super::super::System;
use crate::math::{Quat, Spin, V3, align};
use crate::rod::{Bend, Joint, Scalar};

/// An edge that is split in two halves of the same stretch.
#[derive(Clone, Copy, Debug)]
pub(in crate::system) struct Split {
    /// the edge; its second half and the new node get the next number
    pub edge: usize,
    /// place of the new node, lab frame, m
    pub place: V3,
    /// the same in the core frame
    pub place_in_core: V3,
    /// its velocity, m/s
    pub velocity: V3,
    /// velocities of the edge's ends, m/s
    pub ends: [V3; 2],
    /// unstretched length of either half, m
    pub half: f64,
    /// frames of the halves
    pub frames: [Quat; 2],
    /// plastic bending of the new node
    pub bend: Bend,
    /// plastic twist of the new node
    pub twist: Scalar,
    /// the edge ends at the nozzle: its second half is new wire, which has no set
    pub at_nozzle: bool,
    /// length of the edge one and two instants back, over the present one
    pub grown: [f64; 2],
    /// the core's pose one instant back
    pub core_before: Spin,
}

impl System {
    /// Splits edge `j` in two halves at the same stretch.
    ///
    /// The new node lies as far from both ends, where the bends there and its own have the least energy, and moves with
    /// their mean velocity, which keeps the momentum. At the nozzle nothing bends the wire, so only two bends count there. First
    /// edge: on the chord, since frozen wire holds it.
    ///
    /// The halves are longer than the chord was, and as much longer unstretched: wire that only looks straight because its
    /// edges are long does not yield by being looked at more closely. The difference counts as fed.
    pub fn split(&mut self, j: usize) {
        let at_nozzle = j + 1 == self.state.rod.edges() && self.state.feed.is_some();
        let kinetic = if at_nozzle { self.kinetic() } else { 0.0 };
        let rest = self.state.rod.rest[j];
        let split = self.plan_split(j, at_nozzle);
        for part in self.parts() {
            part.split(&split);
        }
        self.carry_points(j, j + 2);
        if at_nozzle {
            // the half edge at the nozzle was not in the energy balance before
            self.state.balance.inflow += self.kinetic() - kinetic;
        }
        self.count_as_fed(2.0 * split.half - rest);
    }

    fn plan_split(&self, j: usize, at_nozzle: bool) -> Split {
        let rod = &self.state.rod;
        let last = rod.edges() - 1;
        let (a, b) = (rod.x[j], rod.x[j + 1]);
        let chord = b - a;
        let mid = if j == 0 {
            (a + b) * 0.5
        } else {
            let l = chord.norm();
            let along = chord / l;
            // direction of the wire at an end against the chord's, over the wire's length that bends there
            let own = |r: f64| 0.5 * r + 0.25 * rod.rest[j];
            let before = (a - rod.x[j - 1]).normalize() - along;
            let (mut turn, mut stiff) = (before / own(rod.rest[j - 1]), 1.0 / own(rod.rest[j - 1]));
            if j < last {
                turn += ((b - rod.x[j + 2]).normalize() + along) / own(rod.rest[j + 1]);
                stiff += 1.0 / own(rod.rest[j + 1]);
            }
            let aside = turn * (0.5 * l / (stiff + 8.0 / rod.rest[j]));
            (a + b) * 0.5 + aside - along * aside.dot(&along)
        };
        let velocity = if at_nozzle {
            // at the nozzle the material moves in along the wire at the feed rate
            let stretch = chord.norm() / rod.rest[j];
            let rate = self.state.feed.as_ref().map_or(0.0, |f| f.rate);
            let inlet = rod.v[j + 1] - chord.normalize() * (rate * stretch);
            (rod.v[j] + inlet) * 0.5
        } else {
            (rod.v[j] + rod.v[j + 1]) * 0.5
        };
        let quarter_turn = if j == last {
            // wire leaves the nozzle untwisted
            0.0
        } else {
            0.25 * rod.rest[j] * self.twist_along(j)
        };
        let half = rod.rest[j] * ((mid - a).norm() / chord.norm());
        let frame = rod.frame[j];
        let mut bend = rod.bend[j + 1];
        let mut twist = rod.twist[j + 1];
        for k in 0..2 {
            bend.curvature[k] = 0.5 * (rod.bend[j].curvature[k] + rod.bend[j + 1].curvature[k]);
        }
        bend.rise = 0.5 * (rod.bend[j].rise + rod.bend[j + 1].rise);
        twist.strain = 0.5 * (rod.twist[j].strain + rod.twist[j + 1].strain);
        twist.rise = 0.5 * (rod.twist[j].rise + rod.twist[j + 1].rise);
        if at_nozzle {
            (bend, twist) = (Bend::default(), Scalar::default());
        }
        Split {
            edge: j,
            place: mid,
            place_in_core: Spin::new(self.state.spindle.angle).to_core(mid),
            velocity,
            ends: [rod.v[j], rod.v[j + 1]],
            half,
            frames: [
                align(&frame, &((mid - a) / (mid - a).norm()), -quarter_turn),
                align(&frame, &((b - mid) / (b - mid).norm()), quarter_turn),
            ],
            bend,
            twist,
            at_nozzle,
            grown: self.growth_of_edge(j),
            core_before: Spin::new(self.state.spindle.before(self.state.past.h[0]).angle),
        }
    }

    /// Twist per length along edge `j`, the mean of its two joints, 1/m.
    ///
    /// Only in steps of the implicit method edges roll by what is asked of them and twist spreads over the halves of an edge.
    fn twist_along(&self, j: usize) -> f64 {
        if !self.model.is_for_implicit_steps() || !self.model.twist.is_carried() {
            return 0.0;
        }
        let rod = &self.state.rod;
        let at = |i: usize| {
            let before = if i == 0 {
                self.clamp_frame(0)
            } else {
                Some(rod.frame[i - 1])
            };
            before.map(|p| Joint::between(&p, &rod.frame[i]).twist / rod.voronoi(i))
        };
        let next = at(j + 1).unwrap_or(0.0);
        0.5 * (at(j).unwrap_or(next) + next)
    }

    /// Length of edge `j` one and two instants back, over the present one; only the edge at the nozzle grows.
    fn growth_of_edge(&self, j: usize) -> [f64; 2] {
        let rest = self.state.rod.rest[j];
        match &self.state.feed {
            Some(f) if j + 1 == self.state.rod.edges() => self
                .state
                .past
                .fed
                .map(|fed| ((rest - (f.fed - fed)) / rest).max(0.05)),
            _ => [1.0; 2],
        }
    }
}
