//! How each part of the system follows a change of the wire.

use super::super::{ContactState, Past};
use super::{Merge, Remesh, Split, Thaw};
use crate::math::{Spin, V3, spin_velocity, turn_about_y};
use crate::rod::{Rod, Scalar};

impl Remesh for Rod {
    fn split(&mut self, split: &Split) {
        let j = split.edge;
        self.x.insert(j + 1, split.place);
        self.v.insert(j + 1, split.velocity);
        self.rest[j] = split.half;
        self.rest.insert(j + 1, split.half);
        self.frame[j] = split.frames[0];
        self.frame.insert(j + 1, split.frames[1]);
        self.spin.insert(j + 1, self.spin[j]);
        self.stretch.insert(j + 1, self.stretch[j]);
        if split.at_nozzle {
            // new wire is straight: what set the node before has stays its own
            let own = self.voronoi(j);
            let scale = (own + 0.5 * split.half) / own;
            self.bend[j].curvature = self.bend[j].curvature.map(|k| k * scale);
            self.twist[j].strain *= scale;
        }
        self.bend.insert(j + 1, split.bend);
        self.twist.insert(j + 1, split.twist);
    }

    fn merge(&mut self, merge: &Merge) {
        let (i, [a, b]) = (merge.node, merge.rest);
        for (end, gain) in [(i - 1, 0.5 * b), (i + 1, 0.5 * a)] {
            if merge.at_nozzle && end == i + 1 {
                // set that has gone into the nozzle is forgotten: what comes out again is straight
                continue;
            }
            let own = self.voronoi(end);
            let mix = |x: f64, y: f64| (x * own + y * gain) / (own + gain);
            let (gone, gone_twist) = (self.bend[i], self.twist[i]);
            let (bend, twist) = (&mut self.bend[end], &mut self.twist[end]);
            for k in 0..2 {
                bend.curvature[k] = mix(bend.curvature[k], gone.curvature[k]);
            }
            bend.rise = mix(bend.rise, gone.rise);
            twist.strain = mix(twist.strain, gone_twist.strain);
            twist.rise = mix(twist.rise, gone_twist.rise);
        }
        let [before, after] = [self.stretch[i - 1], self.stretch[i]];
        self.stretch[i - 1] = Scalar {
            strain: merge.share(before.strain, after.strain),
            rise: merge.share(before.rise, after.rise),
        };
        self.spin[i - 1] = merge.share(self.spin[i - 1], self.spin[i]);
        self.rest[i - 1] = merge.joined;
        self.frame[i - 1] = merge.frame;
        self.x.remove(i);
        self.v.remove(i);
        self.bend.remove(i);
        self.twist.remove(i);
        self.rest.remove(i);
        self.frame.remove(i);
        self.spin.remove(i);
        self.stretch.remove(i);
    }

    fn remove_front(&mut self, count: usize) {
        self.x.drain(..count);
        self.v.drain(..count);
        self.rest.drain(..count);
        self.frame.drain(..count);
        self.spin.drain(..count);
        self.stretch.drain(..count);
        self.bend.drain(..count);
        self.twist.drain(..count);
    }

    /// A node that stayed live while the edge before it was frozen has gone on to yield over half its length. Frozen wire did not.
    fn insert_front(&mut self, thaw: &Thaw) {
        let spin = Spin::new(thaw.core.angle);
        let turn = turn_about_y(thaw.core.angle);
        let nodes = &thaw.nodes;
        let lab = nodes.iter().map(|node| spin.to_lab(node.place));
        let speed = thaw.core.speed;
        self.v
            .splice(0..0, lab.clone().map(|x| spin_velocity(speed, x)));
        self.x.splice(0..0, lab);
        self.rest.splice(0..0, nodes.iter().map(|node| node.rest));
        self.frame
            .splice(0..0, nodes.iter().map(|node| turn * node.frame));
        self.spin.splice(0..0, nodes.iter().map(|node| node.spin));
        self.stretch
            .splice(0..0, nodes.iter().map(|node| node.stretch));
        self.bend.splice(0..0, nodes.iter().map(|node| node.bend));
        self.twist.splice(0..0, nodes.iter().map(|node| node.twist));
        for (i, before) in nodes.iter().enumerate() {
            let (frozen, live) = (before.rest, self.rest[i + 1]);
            let share = frozen / (frozen + live);
            self.bend[i + 1] = self.bend[i + 1].mixed(&before.end_bend, share);
            self.twist[i + 1] = self.twist[i + 1].mixed(&before.end_twist, share);
        }
    }
}

/// Rolls of the edges since the step began.
impl Remesh for Vec<f64> {
    fn split(&mut self, split: &Split) {
        self.insert(split.edge + 1, self[split.edge]);
    }

    fn merge(&mut self, merge: &Merge) {
        self.remove(merge.node);
    }

    fn remove_front(&mut self, count: usize) {
        self.drain(..count);
    }

    fn insert_front(&mut self, thaw: &Thaw) {
        self.splice(0..0, std::iter::repeat_n(0.0, thaw.nodes.len()));
    }
}

impl Remesh for ContactState {
    fn split(&mut self, split: &Split) {
        match self {
            Self::None => {}
            Self::Nodal(nodal) => nodal.split(split.edge, split.half),
            Self::Line(line) => line.split(split.edge),
        }
    }

    fn merge(&mut self, merge: &Merge) {
        match self {
            Self::None => {}
            Self::Nodal(nodal) => nodal.merge(merge.node),
            Self::Line(line) => line.merge(merge.node),
        }
    }

    fn remove_front(&mut self, count: usize) {
        match self {
            Self::None => {}
            Self::Nodal(nodal) => nodal.remove_front(count),
            Self::Line(line) => line.remove_front(count),
        }
    }

    fn insert_front(&mut self, thaw: &Thaw) {
        match self {
            // frozen wire of the nodal method keeps nothing to come back with
            Self::None | Self::Nodal(_) => {}
            Self::Line(line) => {
                line.insert_front(thaw.nodes.iter().map(|node| node.memory.clone()));
            }
        }
    }
}

/// Arrays that are not filled yet stay as they are.
impl Remesh for Past {
    /// Where the edge grew at the nozzle, the same bit of wire was farther along then, or still behind the nozzle.
    fn split(&mut self, split: &Split) {
        let (j, new) = (split.edge, split.place_in_core);
        if self.q[0].len() < j + 2 {
            self.known = 0;
            return;
        }
        // the same bow off the chord at every instant
        let bow = new - (self.q[0][j] + self.q[0][j + 1]) * 0.5;
        self.q[0].insert(j + 1, new);
        for k in 0..2 {
            let q = &mut self.q[k + 1];
            if q.len() > j + 1 {
                let mid = q[j] + (q[j + 1] - q[j]) * (0.5 / split.grown[k]) + bow;
                q.insert(j + 1, mid);
            }
        }
        if self.x.len() > j + 1 {
            self.x
                .insert(j + 1, split.core_before.to_lab(self.q[1][j + 1]));
            // the same change of velocity over the last step as the wire on either side
            let [a, b] = [self.v[j], self.v[j + 1]];
            let change = (split.ends[0] - a + split.ends[1] - b) * 0.5;
            self.v.insert(j + 1, split.velocity - change);
        }
        for a in self.roll.iter_mut().chain([&mut self.spin]) {
            if a.len() > j {
                a.insert(j + 1, a[j]);
            }
        }
    }

    fn merge(&mut self, merge: &Merge) {
        let (i, [a, b]) = (merge.node, merge.rest);
        let share = b / (a + b);
        for q in &mut self.q {
            if q.len() > i {
                q.remove(i);
            }
        }
        if self.x.len() > i {
            self.x.remove(i);
            self.v.remove(i);
        }
        for a in self.roll.iter_mut().chain([&mut self.spin]) {
            if a.len() > i {
                let gone = a.remove(i);
                a[i - 1] += (gone - a[i - 1]) * share;
            }
        }
    }

    fn remove_front(&mut self, count: usize) {
        for q in &mut self.q {
            q.drain(..count.min(q.len()));
        }
        for a in [&mut self.x, &mut self.v] {
            a.drain(..count.min(a.len()));
        }
        for a in self.roll.iter_mut().chain([&mut self.spin]) {
            a.drain(..count.min(a.len()));
        }
    }

    /// The nodes had been at rest in the core; rolls and spins need the frames and are left as they are.
    fn insert_front(&mut self, thaw: &Thaw) {
        let places = || thaw.nodes.iter().map(|node| node.place);
        let nodes = self.q[0].len();
        for (k, kept) in self.q.iter_mut().enumerate() {
            if k == 0 || kept.len() == nodes {
                kept.splice(0..0, places());
            }
        }
        if self.x.len() == nodes {
            let spin = Spin::new(thaw.core_before.angle);
            let back: Vec<V3> = places().map(|q| spin.to_lab(q)).collect();
            let speed = thaw.core_before.speed;
            self.v
                .splice(0..0, back.iter().map(|x| spin_velocity(speed, *x)));
            self.x.splice(0..0, back);
        }
    }
}
