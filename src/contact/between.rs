//! Live wire against live wire in the implicit method.
//!
//! Where lift-off comes round before the wire there is at rest, the younger wire's contact points
//! touch the spline of the older wire. Force and reaction go to the nodes of both, the bristle of friction
//! grows with the relative slide and so travels with both. Such a pair couples nodes a whole turn
//! apart, which no band holds: its share of the Hessian between the partners is kept aside, and the
//! linear system is solved by conjugate gradients with the banded part as preconditioner.

use super::law::{ContactLaw, TANGENTIAL_SHARE};
use super::line::prediction_tolerance;
use super::touch::{ALONG_SLIDE, huber, less, onset_law, times, unstored};
use super::{ContactLoss, OWN_WIRE};
use crate::geometry::Curve;
use crate::math::V3;
use crate::math::{polar_angle, wrap_to_pi};
use crate::rod::{Block, add_outer};
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// Pairs are listed when nearer than this beyond touching, in wire diameters ...
const SKIN: f64 = 0.25;
/// ... and this much of the way the step's guess moves the point.
const FOLLOW: f64 = 1.5;
/// How far from one turn back along the wire a partner may lie, rad.
const WINDOW: f64 = 0.6;

/// A point of contact and the older wire near it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Pair {
    point: u32,
    segment: u32,
    held: bool,
    bristle: V3,
    lag: f64,
    /// the same at the last accepted instant
    kept: f64,
    fresh: f64,
    depth: f64,
    /// where the foot was in the last evaluation
    share: f64,
    normal: V3,
}

/// The coupling of two far-apart triples of nodes: `weights a b^T` times a block.
#[derive(Clone, Copy, Debug)]
pub struct Cross {
    /// nodes of the younger wire and their weights
    pub young: Triple,
    /// nodes of the older wire and their weights, negative
    pub old: Triple,
    /// Hessian with respect to the distance vector, N/m
    pub block: Block,
}

/// A listed pair as the linear system sees it.
#[derive(Clone, Copy, Debug)]
struct NearPair {
    pair: u32,
    young: Triple,
    old: Triple,
    /// contact stiffness of what the point stands for, N/m
    stiffness: f64,
    /// gradient at the iterate, N, and Hessian, N/m, by the distance vector
    gradient: V3,
    hessian: Block,
    /// distance to the push, while it has none, m
    room: f64,
    /// gradient and Hessian are those of a place that an update led to
    predicted: bool,
    /// direction of the slide in it; 0: the bristle holds
    slide: V3,
    /// its coupling, if it has one
    cross: Option<u32>,
}

/// Three nodes and their weights.
pub type Triple = ([usize; 3], [f64; 3]);

/// What a pair adds to the step's potential.
#[derive(Clone, Copy, Debug, Default)]
pub struct PairPush {
    /// potential with the friction limit of the iterate before, J
    pub energy_lagged: f64,
    /// potential with the present limit, J
    pub energy: f64,
    /// gradient with respect to the young point, N; its negative acts on the foot
    pub gradient: V3,
    /// friction limit, N
    pub limit: f64,
    /// direction of the slide; 0: the bristle holds
    pub slide: V3,
}

impl Pair {
    /// What a touching pair adds that has slid `way` since the last accepted instant; `limit` gives the friction
    /// limit for a normal force. A slide against `before` is not taken at once, see `Touch::push`.
    fn push(
        &self,
        law: &ContactLaw,
        onset: f64,
        stiffness: f64,
        way: V3,
        before: V3,
        limit: impl Fn(f64) -> f64,
    ) -> (PairPush, Block) {
        let (e, f, s) = onset_law(self.depth, onset);
        let n = self.normal;
        let mut push = PairPush {
            energy_lagged: stiffness * e,
            energy: stiffness * e,
            gradient: n * (-stiffness * f),
            limit: 0.0,
            slide: V3::zeros(),
        };
        let mut block = Block::default();
        let mut along = stiffness * s;
        if law.mu_static > 0.0 {
            push.limit = limit(stiffness * f);
            let b = self.bristle + way;
            let b = b - n * b.dot(&n);
            let k_t = stiffness * TANGENTIAL_SHARE;
            let size = b.norm();
            push.energy_lagged += huber(k_t, self.lag, size);
            push.energy += huber(k_t, push.limit, size);
            let dir = b / size;
            let h = if k_t * size <= push.limit || dir.dot(&before) < 0.0 {
                k_t
            } else {
                push.slide = dir;
                let h = push.limit / size;
                add_outer(&mut block, &(dir * (-ALONG_SLIDE * h)), &dir);
                h
            };
            push.gradient += b * h;
            for (k, row) in block.iter_mut().enumerate() {
                row[k] += h;
            }
            along -= h;
        }
        add_outer(&mut block, &(n * along), &n);
        (push, block)
    }
}

/// Pairs of live wire and what their friction remembers.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Between {
    pairs: Vec<Pair>,
    /// the live wire begins at a seam with frozen wire
    pub(super) goes_on: bool,
    /// those of the step before, while the next ones are listed
    #[serde(skip)]
    old: Vec<Pair>,
    #[serde(skip)]
    angle: Vec<f64>,
    #[serde(skip)]
    arc: Vec<f64>,
    /// points near older wire that make no pair with it, how far both may move before they do, m, and the node
    /// of that wire
    #[serde(skip)]
    room: Vec<(u32, f64, u32)>,
    /// by turns back, where the search along the wire stands
    #[serde(skip)]
    downhill: Vec<usize>,
    /// room for the wire in the core frame
    #[serde(skip)]
    pub scratch: Vec<V3>,
    /// couplings of the last evaluation
    #[serde(skip)]
    pub cross: Vec<Cross>,
    #[serde(skip)]
    near: Vec<NearPair>,
    /// totals of what was lost
    pub loss: ContactLoss,
}

/// Nodes and weights of contact point `point`: `2 i` the spline at node i, `2 j + 1` the middle of
/// edge j.
pub fn point_weights(point: usize) -> Triple {
    let i = point / 2;
    if point.is_multiple_of(2) {
        ([i - 1, i, i + 1], [0.125, 0.75, 0.125])
    } else {
        ([i, i + 1, i + 1], [0.5, 0.5, 0.0])
    }
}

/// The weighted place.
fn place(q: &[V3], (nodes, weights): &Triple) -> V3 {
    q[nodes[0]] * weights[0] + q[nodes[1]] * weights[1] + q[nodes[2]] * weights[2]
}

impl Between {
    /// A node was put into edge `j`.
    pub fn split(&mut self, j: usize) {
        for p in &mut self.pairs {
            // points beyond the new node move up by two, segments by one
            p.point += 2 * u32::from(p.point as usize > 2 * j + 1);
            p.segment += u32::from(p.segment as usize > j);
        }
    }

    /// The first `count` nodes left.
    pub fn remove_front(&mut self, count: usize) {
        self.pairs.retain(|p| p.segment as usize >= count);
        for p in &mut self.pairs {
            p.point -= 2 * count as u32;
            p.segment -= count as u32;
        }
    }

    /// `count` nodes came back at the front.
    pub fn insert_front(&mut self, count: usize) {
        for p in &mut self.pairs {
            p.point += 2 * count as u32;
            p.segment += count as u32;
        }
    }

    /// Node `i` was taken out; its own point becomes the middle of the joined edge.
    pub fn merge(&mut self, i: usize) {
        let i = i as u32;
        self.pairs
            .retain(|p| p.point != 2 * i - 1 && p.point != 2 * i + 1);
        for p in &mut self.pairs {
            p.point -= u32::from(p.point >= 2 * i) + u32::from(p.point > 2 * i);
            p.segment -= u32::from(p.segment >= i);
        }
    }

    /// The live wire as what other wire touches.
    fn curve<'a>(&self, q: &'a [V3]) -> Curve<'a> {
        Curve {
            points: q,
            seams: [self.goes_on, false],
        }
    }

    /// Lists the pairs for a step from `q` that is expected to lead to `guess` (core frame); `rest` are the
    /// edges' unstretched lengths.
    #[inline(never)]
    pub fn list(&mut self, q: &[V3], guess: &[V3], rest: &[f64], diameter: f64) {
        self.angle.clear();
        self.arc.clear();
        self.room.clear();
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
        let curve = self.curve(q);
        let arc = &self.arc;
        std::mem::swap(&mut self.pairs, &mut self.old);
        self.pairs.clear();
        let last_point = 2 * (q.len() - 1);
        // both lists run along the wire
        let mut known = 0;
        self.downhill.clear();
        for point in 1..last_point {
            let i = point / 2;
            if self.angle[i] - TAU < -WINDOW {
                continue;
            }
            let weights = point_weights(point);
            let p = place(q, &weights);
            let way = (place(guess, &weights) - p).norm();
            let own = arc[i] - OWN_WIRE * diameter;
            let end = arc[..i].partition_point(|a| *a <= own);
            if end < 2 {
                continue;
            }
            while known < self.old.len() && self.old[known].point < point as u32 {
                known += 1;
            }
            // every turn back along the wire, and downhill from there
            for turns in 1.. {
                let back = self.angle[i] - turns as f64 * TAU;
                if back < -WINDOW {
                    break;
                }
                if self.downhill.len() < turns {
                    self.downhill.push(0);
                }
                let near = &mut self.downhill[turns - 1];
                while *near + 1 < end - 1 && self.angle[*near] < back {
                    *near += 1;
                }
                while *near > 0 && self.angle[*near - 1] >= back {
                    *near -= 1;
                }
                let foot = curve.foot(p, *near as u32);
                let gap = -foot.depth(diameter);
                let other = foot.segment as usize;
                if arc[other] > own || (self.angle[other] - back).abs() > WINDOW {
                    continue;
                }
                let way = way + (guess[other] - q[other]).norm();
                if gap > SKIN * diameter + FOLLOW * way {
                    self.room.push((point as u32, gap, foot.segment));
                    continue;
                }
                let before = self.old[known..]
                    .iter()
                    .take_while(|o| o.point == point as u32)
                    .find(|o| o.segment.abs_diff(foot.segment) < 6);
                self.pairs.push(Pair {
                    point: point as u32,
                    segment: foot.segment,
                    held: before.is_some_and(|o| o.held),
                    bristle: before.map_or(V3::zeros(), |o| o.bristle),
                    lag: before.map_or(0.0, |o| o.kept),
                    kept: before.map_or(0.0, |o| o.kept),
                    fresh: 0.0,
                    depth: before.map_or(0.0, |o| o.depth),
                    share: foot.share,
                    normal: foot.normal,
                });
            }
        }
    }

    /// First node next to wire that may have moved from `q` to `now` past wire it is not paired with.
    pub fn missed(&self, q: &[V3], now: &[V3]) -> Option<usize> {
        self.room
            .iter()
            .find(|&&(point, room, other)| {
                let (weights, other) = (point_weights(point as usize), other as usize);
                let way = (place(now, &weights) - place(q, &weights)).norm();
                way + (now[other] - q[other]).norm() > room
            })
            .map(|(point, ..)| *point as usize / 2)
    }

    /// Whether every pair is one of a wire of so many live nodes: a point and wire nearer to the clamp.
    pub(super) fn fits(&self, nodes: usize) -> bool {
        let points = 1..2 * (nodes as u32 - 1);
        let mut pairs = self.pairs.iter();
        pairs.all(|p| points.contains(&p.point) && p.segment < p.point / 2)
    }

    /// Number of pairs near each other.
    pub fn len(&self) -> usize {
        self.pairs.len()
    }

    /// Whether no live wire is near live wire.
    pub fn is_empty(&self) -> bool {
        self.pairs.is_empty()
    }

    /// Depth of the deepest touch, m; 0: none.
    pub fn deepest(&self) -> f64 {
        self.pairs.iter().map(|p| p.depth).fold(0.0, f64::max)
    }

    /// Takes the friction limits of the iterate in hand over.
    pub fn renew_lags(&mut self) {
        for p in &mut self.pairs {
            p.lag = p.fresh;
        }
    }

    /// Evaluates all pairs at `q`; `last` is the wire at the last accepted instant, `length` tells what a
    /// point stands for. Hands each touching pair's push to `take`, and keeps the couplings.
    pub fn evaluate(
        &mut self,
        law: &ContactLaw,
        onset: f64,
        (q, last): (&[V3], &[V3]),
        diameter: f64,
        step: f64,
        hold_limits: bool,
        length: impl Fn(usize) -> f64,
        mut take: impl FnMut(&Cross, &PairPush),
    ) {
        self.cross.clear();
        self.near.clear();
        let curve = self.curve(q);
        for pair in &mut self.pairs {
            let young = point_weights(pair.point as usize);
            let p = place(q, &young);
            let foot = curve.foot(p, pair.segment);
            pair.segment = foot.segment;
            (pair.share, pair.normal) = (foot.share, foot.normal);
            pair.depth = foot.depth(diameter);
            let old = curve.weights(foot.segment as usize, foot.share);
            let minus = (old.0, old.1.map(|w| -w));
            let stiffness = law.stiffness * length(pair.point as usize);
            let mut near = NearPair {
                pair: self.near.len() as u32,
                young,
                old: minus,
                stiffness,
                gradient: V3::zeros(),
                hessian: Block::default(),
                room: (-pair.depth).max(0.0),
                predicted: false,
                slide: V3::zeros(),
                cross: None,
            };
            if pair.depth <= 0.0 {
                pair.fresh = 0.0;
                self.near.push(near);
                continue;
            }
            let way = (p - place(last, &young)) - (foot.point - place(last, &old));
            let n = foot.normal;
            let (push, hessian) = pair.push(law, onset, stiffness, way, V3::zeros(), |force| {
                if hold_limits {
                    pair.lag
                } else {
                    law.mu((way - n * way.dot(&n)).norm() / step) * force
                }
            });
            pair.fresh = push.limit;
            near.cross = Some(self.cross.len() as u32);
            (near.gradient, near.hessian) = (push.gradient, hessian);
            near.slide = push.slide;
            self.near.push(near);
            let cross = Cross {
                young,
                old: minus,
                block: hessian,
            };
            take(&cross, &push);
            self.cross.push(cross);
        }
    }

    /// As [`LineContact::foresee`](super::LineContact::foresee), for pairs, with the wire at `there`;
    /// `correct` gets both triples.
    pub fn predict(
        &mut self,
        (law, onset, diameter): (&ContactLaw, f64, f64),
        (q, last, there): (&[V3], &[V3], &[V3]),
        mut correct: impl FnMut(&Triple, &Triple, &Block, &V3),
    ) -> bool {
        let mut any = false;
        let curve = self.curve(there);
        let enough = prediction_tolerance(diameter);
        for near in &mut self.near {
            let relative = |q: &[V3]| place(q, &near.young) + place(q, &near.old);
            let way = relative(there) - relative(q);
            let far = way.norm_squared();
            // (the foot moves along with its wire, whose turning is small beside that)
            let still = far <= enough * enough && !near.predicted;
            if 4.0 * far < near.room * near.room || still {
                continue;
            }
            let now = self.pairs[near.pair as usize];
            let p = place(there, &near.young);
            let foot = curve.foot(p, now.segment);
            let pair = Pair {
                depth: foot.depth(diameter),
                normal: foot.normal,
                ..now
            };
            let (mut gradient, mut hessian) = (V3::zeros(), Block::default());
            if pair.depth > 0.0 {
                let slid = relative(there) - relative(last);
                let push;
                let limit = |_| now.fresh;
                (push, hessian) = pair.push(law, onset, near.stiffness, slid, near.slide, limit);
                gradient = push.gradient;
                near.slide = push.slide;
            }
            let off = gradient - near.gradient - times(&near.hessian, &way);
            if off.amax() <= enough * near.stiffness {
                continue;
            }
            any = true;
            gradient -= times(&hessian, &way);
            let more = less(&hessian, &near.hessian);
            correct(&near.young, &near.old, &more, &(gradient - near.gradient));
            let at = *near.cross.get_or_insert_with(|| {
                self.cross.push(Cross {
                    young: near.young,
                    old: near.old,
                    block: Block::default(),
                });
                self.cross.len() as u32 - 1
            });
            self.cross[at as usize].block = hessian;
            (near.gradient, near.hessian, near.room) = (gradient, hessian, 0.0);
            near.predicted = true;
        }
        any
    }

    /// Takes the wire at `q` over as accepted: bristles move on, slip and blows are booked, see [`super::LineContact::commit`].
    pub fn commit(
        &mut self,
        (law, onset): (&ContactLaw, f64),
        (q, last): (&[V3], &[V3]),
        length: impl Fn(usize) -> f64,
    ) {
        let curve = self.curve(q);
        for pair in &mut self.pairs {
            (pair.lag, pair.kept) = (pair.fresh, pair.fresh);
            if pair.depth <= 0.0 {
                pair.held = false;
                pair.bristle = V3::zeros();
                continue;
            }
            let young = point_weights(pair.point as usize);
            let old = curve.weights(pair.segment as usize, pair.share);
            let way =
                (place(q, &young) - place(last, &young)) - (place(q, &old) - place(last, &old));
            let n = pair.normal;
            let b = pair.bristle + way;
            let b = b - n * b.dot(&n);
            let stiffness = law.stiffness * length(pair.point as usize);
            let k_t = stiffness * TANGENTIAL_SHARE;
            let size = b.norm();
            let deeper = -way.dot(&n);
            let lands = !pair.held && deeper >= pair.depth;
            if lands {
                let (energy, force, _) = onset_law(pair.depth, onset);
                self.loss.damping += stiffness * unstored(force, energy, deeper);
            }
            let share = if lands { 0.5 } else { 1.0 };
            pair.held = true;
            pair.bristle = b;
            if k_t * size > pair.fresh {
                let kept = pair.fresh / k_t;
                pair.bristle = b * (kept / size);
                self.loss.friction += share * pair.fresh * (size - kept);
            }
        }
    }

    /// Energy stored in the touches, J.
    pub fn stored(&self, law: &ContactLaw, onset: f64, length: impl Fn(usize) -> f64) -> f64 {
        self.pairs
            .iter()
            .filter(|p| p.depth > 0.0)
            .map(|p| {
                let k_n = law.stiffness * length(p.point as usize);
                k_n * onset_law(p.depth, onset).0
                    + 0.5 * k_n * TANGENTIAL_SHARE * p.bristle.norm_squared()
            })
            .sum()
    }
}

/// Adds the couplings' product with `x` to `y`, which have `D` unknowns a node, first its coordinates.
pub fn add_cross<const D: usize>(cross: &[Cross], x: &[f64], y: &mut [f64]) {
    for c in cross {
        one_way::<D>(&c.block, &c.old, &c.young, x, y);
        one_way::<D>(&c.block, &c.young, &c.old, x, y);
    }
}

fn one_way<const D: usize>(block: &Block, from: &Triple, to: &Triple, x: &[f64], y: &mut [f64]) {
    let mut s = [0.0; 3];
    for (n, w) in from.0.iter().zip(from.1) {
        for a in 0..3 {
            s[a] += w * x[D * n + a];
        }
    }
    // symmetric block
    let t: [f64; 3] =
        std::array::from_fn(|r| block[r][0] * s[0] + block[r][1] * s[1] + block[r][2] * s[2]);
    for (n, w) in to.0.iter().zip(to.1) {
        for a in 0..3 {
            y[D * n + a] += w * t[a];
        }
    }
}
