//! Contact of live wire with live wire in the explicit methods.
//!
//! Wire that has not come to rest before the next turn lands on it is touched while it moves. The younger
//! wire's nodes touch the older wire's segments, as they touch the segments of frozen wire; the force
//! goes to the node, its reaction to both ends of the segment. Pairs are listed with a skin and listed again once
//! some node has moved by half of it. The bristle of friction grows with the relative slide, so it
//! travels with both partners.

use crate::contact::law::{ContactLaw, ContactLoss};
use crate::contact::own_wire::own_wire;
use crate::math::V3;
use serde::{Deserialize, Serialize};

/// Distance beyond touching within which pairs are listed, in wire diameters. Chosen.
const SKIN: f64 = 0.5;

/// A node and an older segment near it, and the friction between them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Pair {
    node: u32,
    segment: u32,
    /// stretch of the bristle, core frame, m
    bristle: V3,
    /// depth at the last committed evaluation, m
    depth: f64,
}

/// Motion and lengths of the live wire in the core frame, one entry per live node.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Wire {
    /// positions, m
    pub position: Vec<V3>,
    /// velocities relative to the core, m/s
    pub velocity: Vec<V3>,
    /// wire length each node stands for, m
    pub length: Vec<f64>,
    /// unstretched length from the first live node, m
    pub arc: Vec<f64>,
}

/// What the forces of the pairs depend on besides the wire.
#[derive(Clone, Copy, Debug)]
pub struct LiveConditions<'a> {
    /// the law
    pub law: &'a ContactLaw,
    /// wire diameter, m
    pub diameter: f64,
    /// mass of the wire, kg/m
    pub per_length: f64,
    /// length of the step that this evaluation ends, s
    pub commit: Option<f64>,
}

/// Pairs of live wire with their friction state.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct LiveContact {
    pairs: Vec<Pair>,
    /// places of the nodes when the pairs were listed, m; empty: they have to be listed
    seen: Vec<V3>,
    /// deepest penetration at the last committed evaluation, m
    pub deepest: f64,
    /// friction and damping losses so far, J
    pub loss: ContactLoss,
}

impl LiveContact {
    /// Renumbers the pairs after a node was inserted before index `at`.
    pub fn insert(&mut self, at: usize) {
        self.seen.clear();
        for p in &mut self.pairs {
            p.node += u32::from(p.node as usize >= at);
            p.segment += u32::from(p.segment as usize >= at);
        }
    }

    /// Renumbers the pairs after the first `count` nodes left.
    pub fn remove_front(&mut self, count: usize) {
        self.seen.clear();
        let n = count as u32;
        self.pairs.retain(|p| p.segment >= n);
        for p in &mut self.pairs {
            p.node -= n;
            p.segment -= n;
        }
    }

    /// Whether every pair lies on a wire of so many nodes: a node, and a segment nearer to the clamp.
    pub(crate) fn fits(&self, nodes: usize) -> bool {
        let mut pairs = self.pairs.iter();
        pairs.all(|p| (p.node as usize) < nodes && p.segment < p.node)
    }

    /// Lists node and segments of older wire that may touch before a node has moved by half the skin.
    fn list_pairs(&mut self, wire: &Wire, diameter: f64) {
        let reach = diameter * (1.0 + SKIN);
        let old = std::mem::take(&mut self.pairs);
        let mut carry = old.iter().peekable();
        let x = &wire.position;
        for i in 0..x.len() {
            let own = own_wire(wire.arc[i], diameter);
            for j in 0..i {
                if wire.arc[j + 1] > own {
                    break;
                }
                let half = wire.arc[j + 1] - wire.arc[j];
                let far = reach + half;
                if (x[i] - x[j]).norm_squared() > far * far {
                    continue;
                }
                let (node, segment) = (i as u32, j as u32);
                while carry
                    .peek()
                    .is_some_and(|p| (p.node, p.segment) < (node, segment))
                {
                    carry.next();
                }
                let known = carry
                    .peek()
                    .filter(|p| (p.node, p.segment) == (node, segment));
                self.pairs.push(Pair {
                    node,
                    segment,
                    bristle: known.map_or(V3::zeros(), |p| p.bristle),
                    depth: known.map_or(0.0, |p| p.depth),
                });
            }
        }
        self.seen.clone_from(x);
    }

    /// Computes the `force` on each node of the wire, core frame, N. With a `commit` bristles move on and losses grow.
    pub fn evaluate(&mut self, wire: &Wire, around: &LiveConditions, force: &mut Vec<V3>) {
        let (diameter, commit) = (around.diameter, around.commit);
        let limit = 0.5 * SKIN * diameter;
        let moved = self.seen.len() != wire.position.len()
            || self
                .seen
                .iter()
                .zip(&wire.position)
                .any(|(a, b)| (a - b).norm_squared() > limit * limit);
        if moved {
            self.list_pairs(wire, diameter);
        }
        force.clear();
        force.resize(wire.position.len(), V3::zeros());
        if commit.is_some() {
            self.deepest = 0.0;
        }
        let mut k = 0;
        while k < self.pairs.len() {
            // one touch for each run of neighbouring segments of a node: the nearest
            let mut end = k + 1;
            while end < self.pairs.len()
                && self.pairs[end].node == self.pairs[k].node
                && self.pairs[end].segment - self.pairs[end - 1].segment <= 4
            {
                end += 1;
            }
            self.touch(k..end, wire, around, force);
            k = end;
        }
    }

    /// Adds the touch of a run of pairs, neighbouring segments near one node: the nearest segment touches.
    fn touch(
        &mut self,
        run: std::ops::Range<usize>,
        wire: &Wire,
        around: &LiveConditions,
        force: &mut [V3],
    ) {
        let LiveConditions {
            law,
            diameter,
            per_length,
            commit,
        } = *around;
        let from = run.start;
        let i = self.pairs[from].node as usize;
        let p = wire.position[i];
        let (mut best, mut nearest) = (diameter * diameter, None);
        for pair in &self.pairs[run] {
            let j = pair.segment as usize;
            let (a, b) = (wire.position[j], wire.position[j + 1]);
            let d = b - a;
            let s = ((p - a).dot(&d) / d.norm_squared()).clamp(0.0, 1.0);
            let off = p - a - d * s;
            if off.norm_squared() < best {
                best = off.norm_squared();
                nearest = Some((j, s, off));
            }
        }
        // the bristle of the whole run is kept on its first pair
        let bristle = self.pairs[from].bristle;
        let Some((j, s, off)) = nearest else {
            if commit.is_some() && self.pairs[from].depth > 0.0 {
                self.loss.friction += law.stored(0.0, bristle, wire.length[i]);
                self.pairs[from].bristle = V3::zeros();
                self.pairs[from].depth = 0.0;
            }
            return;
        };
        let distance = best.sqrt();
        let normal = off / distance;
        let velocity = wire.velocity[i] - wire.velocity[j] * (1.0 - s) - wire.velocity[j + 1] * s;
        let slide = velocity - normal * velocity.dot(&normal);
        let grown = bristle + slide * commit.unwrap_or(0.0);
        let length = wire.length[i];
        let f = law.force(
            normal,
            diameter - distance,
            velocity,
            grown,
            length,
            per_length * length,
        );
        force[i] += f.force;
        force[j] -= f.force * (1.0 - s);
        force[j + 1] -= f.force * s;
        if let Some(dt) = commit {
            self.pairs[from].bristle = f.bristle;
            self.pairs[from].depth = diameter - distance;
            self.deepest = self.deepest.max(diameter - distance);
            self.loss.friction += f.friction.dot(&f.slip).abs();
            self.loss.damping += f.damping * dt;
        }
    }

    /// Energy stored in the touches at the last committed evaluation, J.
    pub fn stored(&self, law: &ContactLaw, length: &[f64]) -> f64 {
        self.pairs
            .iter()
            .filter(|p| p.depth > 0.0)
            .map(|p| law.stored(p.depth, p.bristle, length[p.node as usize]))
            .sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const D: f64 = 0.7e-3;

    fn law(mu: f64) -> ContactLaw {
        ContactLaw {
            stiffness: 1e10,
            damping_ratio: 0.2,
            mu_static: mu,
            mu_kinetic: mu,
            slip_speed: 0.01,
        }
    }

    /// Two strands of 20 nodes side by side, the younger shifted by `shift` against the older; the
    /// wire goes from one to the other through two nodes far away.
    fn strands(shift: V3) -> Wire {
        let line = |k: i32| V3::new(0.5e-3 * f64::from(k), 0.0, 0.0);
        let mut points: Vec<V3> = (0..20).map(line).collect();
        points.extend([V3::new(0.02, 0.0, 0.05), V3::new(-0.01, 0.0, 0.05)]);
        points.extend((0..20).map(|k| line(k) + shift));
        let mut w = Wire::default();
        let mut arc = 0.0;
        for (k, p) in points.iter().enumerate() {
            arc += if k > 0 {
                (p - points[k - 1]).norm()
            } else {
                0.0
            };
            w.position.push(*p);
            w.velocity.push(V3::zeros());
            w.length.push(0.5e-3);
            w.arc.push(arc);
        }
        w
    }

    fn around(law: &ContactLaw, step: f64) -> LiveConditions<'_> {
        LiveConditions {
            law,
            diameter: D,
            per_length: 3.4e-3,
            commit: Some(step),
        }
    }

    /// First node of the younger strand.
    const YOUNG: usize = 22;

    proptest! {
        #[test]
        fn listed_pairs_find_what_all_pairs_find(x in -2e-4..2e-4f64, y in 0.95..1.2f64, z in -0.3..0.3f64) {
            let w = strands(V3::new(x, y * D, z * D));
            let mut live = LiveContact::default();
            let mut force = Vec::new();
            live.evaluate(&w, &around(&law(0.0), 1e-7), &mut force);
            // brute: nearest point of the old strand and what leaves it, for each young node
            let mut total = 0.0;
            for i in YOUNG..42 {
                let p = w.position[i];
                let best = (0..21).map(|j| {
                    let (a, b) = (w.position[j], w.position[j + 1]);
                    let s = ((p - a).dot(&(b - a)) / (b - a).norm_squared()).clamp(0.0, 1.0);
                    (p - a - (b - a) * s).norm()
                }).fold(f64::INFINITY, f64::min);
                total += 1e10 * 0.5e-3 * (D - best).max(0.0);
            }
            let got: f64 = (YOUNG..42).map(|i| force[i].norm()).sum();
            prop_assert!((got - total).abs() < 1e-9 * (1.0 + total), "{} {}", got, total);
            let net: V3 = force.iter().sum();
            prop_assert!(net.norm() < 1e-9 * (1.0 + total), "action and reaction");
        }
    }

    #[test]
    fn friction_holds_up_to_the_cone_and_then_slips() {
        let mut w = strands(V3::new(0.0, D - 1e-6, 0.0));
        let mut live = LiveContact::default();
        for v in w.velocity.iter_mut().skip(YOUNG) {
            *v = V3::new(0.1, 0.0, 0.0);
        }
        let l = law(0.2);
        let mut force = Vec::new();
        live.evaluate(&w, &around(&l, 1e-9), &mut force);
        let early = force[30].x.abs() / force[30].y.abs();
        for _ in 0..400 {
            for i in YOUNG..42 {
                let v = w.velocity[i];
                w.position[i] += v * 1e-7;
            }
            live.evaluate(&w, &around(&l, 1e-7), &mut force);
        }
        let late = -force[30].x / force[30].y;
        assert!(early < 0.2 && (late - 0.2).abs() < 1e-6, "{early} {late}");
        assert!(live.loss.friction > 0.0 && live.deepest > 0.9e-6);
    }
}
