//! Which pairs of live wire a step has to look at.

use super::by_place::Blocks;
use super::pairs::{Pair, SelfContact};
use super::scratch::{PairScratch, Reached, Unpaired};
use crate::contact::friction::FrictionLimit;
use crate::contact::own_wire::{SAME_PASSAGE, own_wire};
use crate::contact::stencil::ContactPoint;
use crate::geometry::Curve;
use crate::math::{V3, polar_angle, wrap_to_pi};
use std::f64::consts::TAU;
use std::ops::RangeInclusive;

/// Pairs are listed when nearer than this beyond touching, in wire diameters ... Chosen, like the next two.
const SKIN: f64 = 0.25;
/// ... and this many times the way by which the step's guess moves them.
const FOLLOW: f64 = 1.5;
/// How far from whole turns back along the wire a partner may lie, rad, beside half of what its segment takes up.
const WINDOW: f64 = 0.6;

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
        let folded = scratch.is_folded(q, diameter);
        let PairScratch {
            previous,
            angle,
            arc,
            blocks,
            found,
            paired,
            unpaired,
            reached,
            ..
        } = scratch;
        unpaired.clear();
        reached.clear();
        let curve = self.curve(q);
        std::mem::swap(&mut self.pairs, previous);
        self.pairs.clear();
        let mut search = Search {
            q,
            guess,
            curve,
            angle,
            arc,
            diameter,
            previous,
            known: 0,
            paired,
            unpaired,
            pairs: &mut self.pairs,
        };
        let mut fastest = 0;
        if folded {
            blocks.build(q);
            let way_of = |node| search.way_of(node);
            fastest = (0..q.len()).fold(0, |a, b| if way_of(b) > way_of(a) { b } else { a });
        }
        for contact_point in ContactPoint::all(q.len() - 1) {
            let at = search.angle_at(contact_point);
            if !folded && at - TAU < -search.window(0) {
                continue;
            }
            let Some(seeker) = search.begin(contact_point) else {
                continue;
            };
            if folded {
                search.look_by_place(&seeker, fastest, blocks, found);
            } else {
                search.look_by_angle(&seeker, at, reached);
            }
        }
    }
}

/// A point of the wire that looks for older wire.
struct Seeker {
    number: u32,
    /// core frame, m
    place: V3,
    /// by which the guess moves it, m
    way: f64,
    /// arc up to which wire is older than its own passage, m
    own: f64,
    /// number of nodes of that wire
    end: usize,
}

/// The wire of a step, and the pairs found so far. Both lists of pairs run along the wire.
struct Search<'a> {
    q: &'a [V3],
    guess: &'a [V3],
    curve: Curve<'a>,
    angle: &'a [f64],
    arc: &'a [f64],
    diameter: f64,
    previous: &'a [Pair],
    /// how many of `previous` belong to points that were passed
    known: usize,
    /// segments with which the present point was paired
    paired: &'a mut Vec<u32>,
    unpaired: &'a mut Vec<Unpaired>,
    pairs: &'a mut Vec<Pair>,
}

impl Search<'_> {
    fn way_of(&self, node: usize) -> f64 {
        (self.guess[node] - self.q[node]).norm()
    }

    /// How far from a whole turn back this segment may be a partner, rad: on a core a few edges wide it takes up much of a turn.
    fn window(&self, segment: usize) -> f64 {
        let around = [
            segment.saturating_sub(1),
            (segment + 1).min(self.q.len() - 1),
        ];
        let [before, after] = around.map(|node| self.angle[node]);
        WINDOW + 0.5 * (after - before).abs()
    }

    fn angle_at(&self, contact_point: ContactPoint) -> f64 {
        match contact_point {
            ContactPoint::Node(i) => self.angle[i],
            ContactPoint::Edge(i) => 0.5 * (self.angle[i] + self.angle[i + 1]),
        }
    }

    /// Goes on to this point; `None` where no wire is older than its own passage.
    fn begin(&mut self, contact_point: ContactPoint) -> Option<Seeker> {
        let number = contact_point.number() as u32;
        let i = ContactPoint::node_before(contact_point.number());
        let weights = contact_point.weights();
        let place = weights.sum(self.q);
        let way = (weights.sum(self.guess) - place).norm();
        let own = own_wire(self.arc[i], self.diameter);
        let end = self.arc[..i].partition_point(|a| *a <= own);
        if end < 2 {
            return None;
        }
        while self.known < self.previous.len() && self.previous[self.known].point < number {
            self.known += 1;
        }
        self.paired.clear();
        Some(Seeker {
            number,
            place,
            way,
            own,
            end,
        })
    }

    /// Pairs the point with the passage of the wire that node `near` belongs to, if it lies about `back` along the wire (rad).
    /// Segment of the point's foot there.
    fn look(&mut self, seeker: &Seeker, near: u32, back: Option<f64>) -> Option<u32> {
        let foot = self.curve.foot(seeker.place, near);
        let gap = -foot.depth(self.diameter);
        let other = foot.segment as usize;
        let elsewhere =
            back.is_some_and(|back| (self.angle[other] - back).abs() > self.window(other));
        if self.arc[other] > seeker.own || elsewhere {
            return None;
        }
        let nodes = shaping(other, self.q.len());
        let way = seeker.way + farthest_way(nodes, |node| self.way_of(node));
        if gap > SKIN * self.diameter + FOLLOW * way {
            self.unpaired.push(Unpaired {
                point: seeker.number,
                room: gap,
                other: foot.segment,
            });
            return Some(foot.segment);
        }
        let is_same = |segment: u32| segment.abs_diff(foot.segment) < SAME_PASSAGE;
        if self.paired.iter().any(|segment| is_same(*segment)) {
            return Some(foot.segment);
        }
        self.paired.push(foot.segment);
        let before = self.previous[self.known..]
            .iter()
            .take_while(|o| o.point == seeker.number)
            .find(|o| is_same(o.segment));
        let limit = before.map_or(0.0, |o| o.limit.accepted);
        self.pairs.push(Pair {
            point: seeker.number,
            segment: foot.segment,
            touched: before.is_some_and(|o| o.touched),
            bristle: before.map_or(V3::zeros(), |o| o.bristle),
            limit: FrictionLimit {
                lagged: limit,
                accepted: limit,
                ..FrictionLimit::ZERO
            },
            depth: before.map_or(0.0, |o| o.depth),
            share: foot.share,
            normal: foot.normal,
            rebound: before.map_or(0.0, |o| o.rebound),
        });
        Some(foot.segment)
    }

    /// Looks at all older wire near the point; node `fastest` goes farthest of all.
    fn look_by_place(
        &mut self,
        seeker: &Seeker,
        fastest: usize,
        blocks: &Blocks,
        found: &mut Vec<u32>,
    ) {
        let room = SKIN * self.diameter + FOLLOW * (seeker.way + self.way_of(fastest));
        let reach = self.diameter + room;
        blocks.passages(self.q, seeker.place, seeker.end, reach, found);
        for near in &*found {
            self.look(seeker, *near, None);
        }
        // what is farther off was not looked at
        self.unpaired.push(Unpaired {
            point: seeker.number,
            room,
            other: fastest as u32,
        });
    }

    /// Looks from every whole turn back along the wire, from the angle `at` of the point, to the closest point.
    fn look_by_angle(&mut self, seeker: &Seeker, at: f64, reached: &mut Vec<Reached>) {
        for turns in 1.. {
            let back = at - turns as f64 * TAU;
            if back < -self.window(0) {
                break;
            }
            if reached.len() < turns {
                reached.push(Reached::default());
            }
            let Reached { near, foot } = &mut reached[turns - 1];
            // on a long flat the angle hardly changes: the foot of the point before is nearer than a node by its angle
            if foot.is_none() {
                while *near + 1 < seeker.end - 1 && self.angle[*near] < back {
                    *near += 1;
                }
                while *near > 0 && self.angle[*near - 1] >= back {
                    *near -= 1;
                }
            }
            *foot = self.look(seeker, foot.unwrap_or(*near as u32), Some(back));
        }
    }
}

/// The nodes that shape a segment of a wire of so many.
fn shaping(segment: usize, nodes: usize) -> RangeInclusive<usize> {
    segment.saturating_sub(1)..=(segment + 1).min(nodes - 1)
}

/// The longest way of a node: no place that these nodes shape goes farther.
fn farthest_way(nodes: RangeInclusive<usize>, way_of: impl Fn(usize) -> f64) -> f64 {
    nodes.map(way_of).fold(0.0, f64::max)
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

    /// Whether wire may come near older live wire elsewhere than at whole turns back along it.
    ///
    /// It may where it is neither farther round the core nor farther out than older wire by what two wires side by side take up. On a long
    /// flat, wire goes round the axis slowly; there it is near older wire only if a node of that is near. Its own neighbourhood does not
    /// count. `measure_wire` has been called.
    fn is_folded(&mut self, q: &[V3], diameter: f64) -> bool {
        let Self {
            angle,
            arc,
            farthest,
            ..
        } = self;
        let apart = (1.0 + SKIN) * diameter;
        let mut outermost = 0.0f64;
        farthest.clear();
        q.iter().enumerate().any(|(i, p)| {
            let own = own_wire(arc[i], diameter);
            while arc[farthest.len()] <= own {
                let j = farthest.len();
                farthest.push(angle[j].max(farthest.last().copied().unwrap_or(f64::NEG_INFINITY)));
                outermost = outermost.max(libm::hypot(q[j].x, q[j].z));
            }
            let out = libm::hypot(p.x, p.z);
            let ahead = |older: f64| (angle[i] - older) * out;
            let Some(&before) = farthest.last() else {
                return false;
            };
            if ahead(before) >= apart || out - outermost >= apart {
                return false;
            }
            let older = (0..farthest.len()).rev();
            let beside = older.take_while(|&j| ahead(farthest[j]) < apart);
            let reach = |j: usize| apart + (q[j + 1] - q[j]).norm();
            ahead(before) <= 0.0 || beside.into_iter().any(|j| (q[j] - p).norm() < reach(j))
        })
    }

    /// The first node next to wire that may have moved, from `q` to `now`, past wire with which it is not paired.
    pub fn missed(&self, q: &[V3], now: &[V3]) -> Option<usize> {
        self.unpaired
            .iter()
            .find(|near| {
                let weights = ContactPoint::of_number(near.point as usize).weights();
                let way = (weights.sum(now) - weights.sum(q)).norm();
                let other = shaping(near.other as usize, q.len());
                way + farthest_way(other, |node| (now[node] - q[node]).norm()) > near.room
            })
            .map(|near| ContactPoint::node_before(near.point as usize))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DIAMETER: f64 = 1.0;

    /// Numbers of points and segments that are paired in a wire through these places.
    fn pairs(q: &[V3]) -> Vec<(u32, u32)> {
        let rest: Vec<f64> = q.windows(2).map(|e| (e[1] - e[0]).norm()).collect();
        let mut live = SelfContact::default();
        live.list(&mut PairScratch::default(), (q, q), &rest, DIAMETER);
        live.pairs.iter().map(|p| (p.point, p.segment)).collect()
    }

    /// Wire that goes once round a core of radius 20 and on for a third of a radian, smoothly or in loops.
    fn turn(loops: f64) -> Vec<V3> {
        let at = |k: i32| {
            let s = f64::from(k) * 0.02;
            let angle = s + loops * (2.5 * s).sin();
            let out = 20.0 + 4.0 * loops * (2.5 * s).cos();
            V3::new(out * angle.cos(), 0.15 * s, out * angle.sin())
        };
        (0..345).map(at).collect()
    }

    /// The way of the older wire was that of one node: its neighbour could wave into the point unseen.
    #[test]
    fn older_wire_that_waves_beside_its_nearest_node_is_missed() {
        let q: Vec<V3> = turn(0.0)
            .iter()
            .map(|q| q.component_mul(&V3::new(1.0, 9.0, 1.0)))
            .collect();
        let rest: Vec<f64> = q.windows(2).map(|e| (e[1] - e[0]).norm()).collect();
        let (mut live, mut scratch) = (SelfContact::default(), PairScratch::default());
        live.list(&mut scratch, (&q, &q), &rest, DIAMETER);
        let near = *scratch
            .unpaired
            .last()
            .expect("wire a turn back, too far off to be a pair");
        assert_eq!(scratch.missed(&q, &q), None);
        // the last point has the farthest partner: no other looks at the node beyond
        let mut now = q.clone();
        now[near.other as usize + 1].y += near.room + 0.1;
        assert!(scratch.missed(&q, &now).is_some());
    }

    #[test]
    fn wire_without_loops_meets_itself_a_turn_back() {
        let found = pairs(&turn(0.0));
        assert!(!found.is_empty());
        for (point, segment) in found {
            let back = f64::from(point) * 0.01 - f64::from(segment) * 0.02;
            assert!((back - TAU).abs() < 0.05, "{point} {segment}");
        }
    }

    /// A segment took up more of a turn than partners were looked for in: wire touched that had no partner.
    #[test]
    fn wire_on_a_core_of_few_edges_meets_itself_a_turn_back() {
        // five edges a turn, and a half more
        let at = |k: i32| {
            let angle = f64::from(k) * TAU / 5.5;
            V3::new(20.0 * angle.cos(), 0.18 * f64::from(k), 20.0 * angle.sin())
        };
        let q: Vec<V3> = (0..13).map(at).collect();
        let rest: Vec<f64> = q.windows(2).map(|e| (e[1] - e[0]).norm()).collect();
        let mut scratch = PairScratch::default();
        scratch.measure_wire(&q, &rest);
        assert!(!scratch.is_folded(&q, DIAMETER));
        let curve = crate::geometry::Curve {
            points: &q,
            seams: [false; 2],
        };
        let found = pairs(&q);
        let mut near = 0;
        for point in ContactPoint::all(q.len() - 1) {
            let p = point.weights().sum(&q);
            let own = point.number() as u32 / 2;
            for segment in 1..own.saturating_sub(3) {
                let foot = curve.foot(p, segment);
                if foot.segment == segment && foot.distance < 1.2 * DIAMETER {
                    let is_paired = |pair: &(u32, u32)| *pair == (point.number() as u32, segment);
                    assert!(
                        found.iter().any(is_paired),
                        "{point:?} {segment}: {found:?}"
                    );
                    near += 1;
                }
            }
        }
        assert!(near > 8, "{near} places where wire is near wire");
    }

    /// Wire on a long flat goes round the axis slowly: it counted as folded, and was sought by place.
    #[test]
    fn wire_on_a_long_flat_is_not_folded() {
        // round a slot of 50 by 4, then over itself
        let (straight, bend) = (46.0, 2.0 * std::f64::consts::PI);
        let at = |k: i32| {
            let s = (f64::from(k) * 0.5 + 0.25 * straight) % (2.0 * (straight + bend));
            let (side, s) = if s < straight + bend {
                (1.0, s)
            } else {
                (-1.0, s - straight - bend)
            };
            let (x, z) = if s < straight {
                (2.0, s - 0.5 * straight)
            } else {
                let turn = (s - straight) / 2.0;
                (2.0 * turn.cos(), 0.5 * straight + 2.0 * turn.sin())
            };
            V3::new(side * x, 0.004 * f64::from(k), side * z)
        };
        let q: Vec<V3> = (0..330).map(at).collect();
        let rest: Vec<f64> = q.windows(2).map(|e| (e[1] - e[0]).norm()).collect();
        let mut scratch = PairScratch::default();
        scratch.measure_wire(&q, &rest);
        assert!(!scratch.is_folded(&q, DIAMETER));
        assert!(scratch.is_folded(&q, 3.0 * DIAMETER), "wider than the slot");
        let q = turn(0.6);
        scratch.measure_wire(&q, &rest);
        assert!(scratch.is_folded(&q, DIAMETER));
    }

    /// Live wire was sought a turn back only: loops under little tension went through each other.
    #[test]
    fn wire_with_loops_meets_itself_anywhere() {
        let q = turn(0.6);
        let found = pairs(&q);
        let nodes = || (0..q.len() as u32).filter(|n| *n > 0);
        let mut near = 0;
        for (i, j) in nodes().flat_map(|i| (1..i.saturating_sub(30)).map(move |j| (i, j))) {
            if (q[i as usize] - q[j as usize]).norm() < 1.1 * DIAMETER {
                let is_paired = |(point, segment): &(u32, u32)| {
                    (*point / 2).abs_diff(i) < 3 && segment.abs_diff(j) < 6
                };
                assert!(found.iter().any(is_paired), "nodes {i} and {j}");
                near += 1;
            }
        }
        assert!(near > 20, "{near} places where wire is near wire");
    }
}
