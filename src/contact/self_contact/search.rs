//! Which pairs of live wire a step has to look at.

use super::pairs::{Pair, SelfContact};
use super::scratch::{PairScratch, Unpaired};
use crate::contact::friction::FrictionLimit;
use crate::contact::own_wire::own_wire;
use crate::contact::stencil::ContactPoint;
use crate::math::{V3, polar_angle, wrap_to_pi};
use std::f64::consts::TAU;

/// Pairs are listed when nearer than this beyond touching, in wire diameters ... Chosen, like the next two.
const SKIN: f64 = 0.25;
/// ... and this many times the way by which the step's guess moves them.
const FOLLOW: f64 = 1.5;
/// How far from whole turns back along the wire a partner may lie, rad.
const WINDOW: f64 = 0.6;
/// Pairs of one point whose segments are nearer along the wire than this are one pair at successive steps.
const SAME_PASSAGE: u32 = 6;

impl SelfContact {
    /// Lists the pairs for a step from `q` that is expected to lead to `guess`, places of the nodes in the core frame, m.
    /// `rest` are the unstretched lengths of the edges, m.
    #[inline(never)]
    pub fn list(
        &mut self,
        scratch: &mut PairScratch,
        (q, guess): (&[V3], &[V3]),
        rest: &[f64],
        diameter: f64,
    ) {
        scratch.measure_wire(q, rest);
        let PairScratch {
            previous,
            angle,
            arc,
            unpaired,
            reached,
            ..
        } = scratch;
        unpaired.clear();
        let curve = self.curve(q);
        std::mem::swap(&mut self.pairs, previous);
        self.pairs.clear();
        // both lists of pairs run along the wire
        let mut known = 0;
        reached.clear();
        for contact_point in ContactPoint::all(q.len() - 1) {
            let point = contact_point.number() as u32;
            let i = point as usize / 2;
            if angle[i] - TAU < -WINDOW {
                continue;
            }
            let weights = contact_point.weights();
            let p = weights.sum(q);
            let way = (weights.sum(guess) - p).norm();
            let own = own_wire(arc[i], diameter);
            let end = arc[..i].partition_point(|a| *a <= own);
            if end < 2 {
                continue;
            }
            while known < previous.len() && previous[known].point < point {
                known += 1;
            }
            // from every whole turn back along the wire to the closest point
            for turns in 1.. {
                let back = angle[i] - turns as f64 * TAU;
                if back < -WINDOW {
                    break;
                }
                if reached.len() < turns {
                    reached.push(0);
                }
                let near = &mut reached[turns - 1];
                while *near + 1 < end - 1 && angle[*near] < back {
                    *near += 1;
                }
                while *near > 0 && angle[*near - 1] >= back {
                    *near -= 1;
                }
                let foot = curve.foot(p, *near as u32);
                let gap = -foot.depth(diameter);
                let other = foot.segment as usize;
                if arc[other] > own || (angle[other] - back).abs() > WINDOW {
                    continue;
                }
                let way = way + (guess[other] - q[other]).norm();
                if gap > SKIN * diameter + FOLLOW * way {
                    unpaired.push(Unpaired {
                        point,
                        room: gap,
                        other: foot.segment,
                    });
                    continue;
                }
                let before = previous[known..]
                    .iter()
                    .take_while(|o| o.point == point)
                    .find(|o| o.segment.abs_diff(foot.segment) < SAME_PASSAGE);
                let limit = before.map_or(0.0, |o| o.limit.accepted);
                self.pairs.push(Pair {
                    point,
                    segment: foot.segment,
                    touched: before.is_some_and(|o| o.touched),
                    bristle: before.map_or(V3::zeros(), |o| o.bristle),
                    limit: FrictionLimit {
                        lagged: limit,
                        accepted: limit,
                        current: 0.0,
                    },
                    depth: before.map_or(0.0, |o| o.depth),
                    share: foot.share,
                    normal: foot.normal,
                    rebound: before.map_or(0.0, |o| o.rebound),
                });
            }
        }
    }
}

impl PairScratch {
    /// Polar angles from the clamp, positive along the wire, and unstretched lengths of the nodes.
    fn measure_wire(&mut self, q: &[V3], rest: &[f64]) {
        self.angle.clear();
        self.arc.clear();
        let mut last = (0.0, polar_angle(q[0]));
        let mut arc = 0.0;
        for (i, p) in q.iter().enumerate() {
            let polar = polar_angle(*p);
            last = (last.0 + wrap_to_pi(polar - last.1), polar);
            self.angle.push(last.0);
            self.arc.push(arc);
            arc += rest.get(i).copied().unwrap_or(0.0);
        }
        // wire runs round the core either way
        if last.0 < 0.0 {
            self.angle.iter_mut().for_each(|a| *a = -*a);
        }
    }

    /// The first node next to wire that may have moved, from `q` to `now`, past wire with which it is not paired.
    pub fn missed(&self, q: &[V3], now: &[V3]) -> Option<usize> {
        self.unpaired
            .iter()
            .find(|near| {
                let weights = ContactPoint::of_number(near.point as usize).weights();
                let other = near.other as usize;
                let way = (weights.sum(now) - weights.sum(q)).norm();
                way + (now[other] - q[other]).norm() > near.room
            })
            .map(|near| near.point as usize / 2)
    }
}
