//! Accepted instants before the present one, as the implicit method's formulas need them.

use crate::math::{Spin, V3, spin_velocity};
use serde::{Deserialize, Serialize};

/// What a step of the wire needs to know of the time before it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Past {
    /// accepted instants on record before the present one, at most two
    pub known: usize,
    /// lab positions and velocities one instant back
    pub x: Vec<V3>,
    /// see `x`
    pub v: Vec<V3>,
    /// core-frame positions now, one back and two back
    pub q: [Vec<V3>; 3],
    /// twist of each edge's frame against parallel transport in the last step and in the one before, rad
    pub roll: [Vec<f64>; 2],
    /// spin of each edge one instant back, rad/s
    pub spin: Vec<f64>,
    /// wire passed by one and two instants back, m
    pub fed: [f64; 2],
    /// tensioner's way, m, and speed, m/s, one instant back
    pub paid: f64,
    /// see `paid`
    pub paid_rate: f64,
    /// lengths of the last two steps, s
    pub h: [f64; 2],
}

impl Past {
    /// Forgets everything before the present instant: the next step starts afresh.
    pub fn forget(&mut self) {
        self.known = 0;
    }

    /// A node was put into the middle of edge `j`; `new` is its core-frame place now, `spin` the core's
    /// pose one instant back.
    ///
    /// Where the edge grew at the nozzle, `grown` tells its length over the present one at the two
    /// instants before: the same bit of wire was farther along then, or still behind the nozzle.
    pub(crate) fn split(&mut self, j: usize, new: V3, grown: [f64; 2], spin: Spin) {
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
                let mid = q[j] + (q[j + 1] - q[j]) * (0.5 / grown[k]) + bow;
                q.insert(j + 1, mid);
            }
        }
        if self.x.len() > j + 1 {
            self.x.insert(j + 1, spin.to_lab(self.q[1][j + 1]));
            self.v.insert(j + 1, V3::zeros());
        }
        for a in self.roll.iter_mut().chain([&mut self.spin]) {
            if a.len() > j {
                a.insert(j + 1, a[j]);
            }
        }
    }

    /// Node `i` was taken out; `share` is that of the edge after it in the joined edge.
    pub(crate) fn merge(&mut self, i: usize, share: f64) {
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

    /// Nodes came back at the front that had been at rest in the core at `q`; `spin` is the core's pose and
    /// `speed` its speed one instant back.
    pub(crate) fn insert_front(&mut self, q: &[V3], spin: Spin, speed: f64) {
        let nodes = self.q[0].len();
        for (k, kept) in self.q.iter_mut().enumerate() {
            if k == 0 || kept.len() == nodes {
                kept.splice(0..0, q.iter().copied());
            }
        }
        if self.x.len() == nodes {
            let back: Vec<V3> = q.iter().map(|q| spin.to_lab(*q)).collect();
            self.v
                .splice(0..0, back.iter().map(|x| spin_velocity(speed, *x)));
            self.x.splice(0..0, back);
        }
    }

    /// The first `count` nodes left.
    pub(crate) fn remove_front(&mut self, count: usize) {
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
}
