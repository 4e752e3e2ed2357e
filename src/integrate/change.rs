//! Changes of the wire between steps: halving an edge, letting settled wire go.

use super::support::{Support, turn_about_y};
use super::system::System;
use crate::math::{Spin, V3, spin_velocity};
use crate::rod::align;

impl System {
    /// Splits edge `j` in two halves at the same stretch.
    ///
    /// The new node lies on the cubic through both ends, so that the curvature stays smooth, and
    /// moves with their mean velocity, which keeps the momentum. Last edge: on the chord, since
    /// the wire leaves the nozzle straight.
    pub fn split(&mut self, j: usize) {
        let last = self.rod.edges() - 1;
        let (a, b) = (self.rod.x[j], self.rod.x[j + 1]);
        let chord = b - a;
        let at_nozzle = j == last && self.feed.is_some();
        let kinetic = if at_nozzle { self.kinetic() } else { 0.0 };
        let mid = if j == last || j == 0 {
            (a + b) * 0.5
        } else {
            // on an arc an edge has the direction at its middle: at a node between edges of different
            // length the shorter one counts more
            let before = a - self.rod.x[j - 1];
            let after = self.rod.x[j + 2] - b;
            let l = [before.norm(), chord.norm(), after.norm()];
            let ta = (before * (l[1] / l[0]) + chord * (l[0] / l[1])).normalize();
            let tb = (chord * (l[2] / l[1]) + after * (l[1] / l[2])).normalize();
            (a + b) * 0.5 + (ta - tb) * (l[1] / 8.0)
        };
        let v = if at_nozzle {
            // at the nozzle the material moves in along the wire at the feed rate
            let stretch = chord.norm() / self.rod.rest[j];
            let rate = self.feed.as_ref().map_or(0.0, |(_, f)| f.rate);
            let inlet = self.rod.v[j + 1] - chord.normalize() * (rate * stretch);
            (self.rod.v[j] + inlet) * 0.5
        } else {
            (self.rod.v[j] + self.rod.v[j + 1]) * 0.5
        };
        let rod = &mut self.rod;
        let half = 0.5 * rod.rest[j];
        rod.x.insert(j + 1, mid);
        rod.v.insert(j + 1, v);
        rod.rest[j] = half;
        rod.rest.insert(j + 1, half);
        let frame = rod.frame[j];
        rod.frame[j] = align(&frame, &((mid - a) / (mid - a).norm()), 0.0);
        rod.frame
            .insert(j + 1, align(&frame, &((b - mid) / (b - mid).norm()), 0.0));
        rod.spin.insert(j + 1, rod.spin[j]);
        rod.stretch.insert(j + 1, rod.stretch[j]);
        let mut bend = rod.bend[j + 1];
        let mut twist = rod.twist[j + 1];
        for k in 0..2 {
            bend.curvature[k] = 0.5 * (rod.bend[j].curvature[k] + rod.bend[j + 1].curvature[k]);
        }
        bend.rise = 0.5 * (rod.bend[j].rise + rod.bend[j + 1].rise);
        twist.strain = 0.5 * (rod.twist[j].strain + rod.twist[j + 1].strain);
        twist.rise = 0.5 * (rod.twist[j].rise + rod.twist[j + 1].rise);
        rod.bend.insert(j + 1, bend);
        rod.twist.insert(j + 1, twist);
        if let Some(c) = &mut self.contacts {
            c.nodes.insert(j + 1, crate::contact::NodeContact::new());
        }
        if let Some(l) = &mut self.live {
            l.insert(j + 1);
            self.wire.length.insert(j + 1, half);
        }
        if let Some(l) = &mut self.line {
            l.split(j);
        }
        self.split_past(j, mid, v);
        self.roll.insert(j + 1, self.roll[j]);
        if at_nozzle {
            // the half edge at the nozzle was not in the books before
            self.books.inflow += self.kinetic() - kinetic;
        }
    }

    /// The same for the instants before, if the method keeps any.
    fn split_past(&mut self, j: usize, mid: V3, v: V3) {
        let rest = 2.0 * self.rod.rest[j];
        let grown = match &self.feed {
            Some((_, f)) if j + 2 == self.rod.nodes() - 1 => self
                .past
                .fed
                .map(|fed| ((rest - (f.fed - fed)) / rest).max(0.05)),
            _ => [1.0; 2],
        };
        let back = self.spindle.before(self.past.h[0]);
        let now = Spin::new(self.spindle.angle).to_core(mid);
        self.past.split(j, now, grown, Spin::new(back.angle));
        if let (Some(a), Some(b)) = (self.past.v.get(j).copied(), self.past.v.get(j + 2)) {
            // the same change of velocity over the last step as the wire on either side
            let change = (self.rod.v[j] - a + self.rod.v[j + 2] - b) * 0.5;
            self.past.v[j + 1] = v - change;
        }
    }

    /// Takes the first `count` nodes out of the computation; the node after them becomes the clamp.
    ///
    /// The wire just behind the new clamp keeps its direction such that the curvature and moment
    /// there stay what they are.
    pub fn freeze_front(&mut self, count: usize) {
        let spin = Spin::new(self.spindle.angle);
        let back = turn_about_y(-self.spindle.angle);
        let stored = self.stored();
        let mut handed = 0.0;
        for i in 1..=count {
            let v = spin_velocity(self.spindle.speed, self.rod.x[i]);
            handed += 0.5 * self.rod.mass(&self.section, i) * v.norm_squared();
        }
        let joint = crate::rod::Joint::between(&self.rod.frame[count - 1], &self.rod.frame[count]);
        let share = self.rod.rest[count] / (self.rod.rest[count - 1] + self.rod.rest[count]);
        let rel = crate::rod::relative(
            [joint.bend[0] * share, joint.bend[1] * share],
            joint.twist * share,
        );
        let frame = self.rod.frame[count] * rel.conjugate();
        self.support[0] = Support {
            hold: [true; 3],
            point: spin.to_core(self.rod.x[count]),
            velocity: V3::zeros(),
            frame: Some(back * frame),
            turning: true,
        };
        self.arc0 += self.rod.rest[..count].iter().sum::<f64>();
        let rod = &mut self.rod;
        rod.x.drain(..count);
        rod.v.drain(..count);
        rod.rest.drain(..count);
        rod.frame.drain(..count);
        rod.spin.drain(..count);
        rod.stretch.drain(..count);
        rod.bend.drain(..count);
        rod.twist.drain(..count);
        self.roll.drain(..count);
        if let Some(c) = &mut self.contacts {
            c.nodes.drain(..count);
        }
        if let Some(l) = &mut self.live {
            l.remove_front(count);
            self.wire.length.drain(..count.min(self.wire.length.len()));
        }
        if let Some(l) = &mut self.line {
            l.remove_front(count);
        }
        self.past.remove_front(count);
        self.place_supports();
        self.books.frozen_kinetic += handed;
        self.books.frozen_stored += stored - self.stored();
    }
}
