//! Pairs of a contact point and older live wire near it, and how they follow changes of the wire.

use crate::contact::friction::FrictionLimit;
use crate::contact::law::ContactLoss;
use crate::contact::stencil::ContactPoint;
use crate::geometry::Curve;
use crate::math::V3;
use serde::{Deserialize, Serialize};

/// A contact point and the older wire near it; core frame.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Pair {
    /// number of the point, see [`ContactPoint`]
    pub(super) point: u32,
    /// segment of the older wire's spline on which the foot lies
    pub(super) segment: u32,
    /// it touched at the last accepted instant
    pub(super) touched: bool,
    /// stretch of the bristle then, m
    pub(super) bristle: V3,
    /// largest friction force
    pub(super) limit: FrictionLimit,
    /// depth at the last evaluation, m; negative: a gap
    pub(super) depth: f64,
    /// place of the foot on its segment at the last evaluation, 0 to 1
    pub(super) share: f64,
    /// unit normal from the foot to the point
    pub(super) normal: V3,
    /// speed at which it may open, m/s: what its landing gives back
    pub(super) rebound: f64,
}

impl Pair {
    /// The node of its point, or the one before it.
    #[inline]
    pub(super) fn node_before(&self) -> usize {
        ContactPoint::node_before(self.point as usize)
    }
}

/// Contact of live wire with live wire: the pairs with their friction state.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct SelfContact {
    pub(super) pairs: Vec<Pair>,
    /// the live wire begins at a seam with frozen wire
    pub(in crate::contact) has_seam: bool,
    /// totals of what was lost
    pub loss: ContactLoss,
}

impl SelfContact {
    /// Renumbers the pairs after edge `j` was split: those of its middle become those of the new node `j + 1`.
    pub fn split(&mut self, j: usize) {
        let middle = ContactPoint::Edge(j).number();
        for p in &mut self.pairs {
            let point = p.point as usize;
            p.point += u32::from(point >= middle) + u32::from(point > middle);
            p.segment += u32::from(p.segment as usize > j);
        }
    }

    /// Drops the pairs with wire of the first `count` nodes, which froze, and renumbers the others.
    pub fn remove_front(&mut self, count: usize) {
        self.pairs.retain(|p| p.segment as usize >= count);
        for p in &mut self.pairs {
            p.point -= 2 * count as u32;
            p.segment -= count as u32;
        }
    }

    /// Renumbers the pairs after `count` nodes thawed at the front.
    pub fn insert_front(&mut self, count: usize) {
        for p in &mut self.pairs {
            p.point += 2 * count as u32;
            p.segment += count as u32;
        }
    }

    /// Drops the pairs of both edges at node `i`, which was taken out, and renumbers the others; its own point becomes
    /// the middle of the joined edge.
    pub fn merge(&mut self, i: usize) {
        let number = |point: ContactPoint| point.number() as u32;
        let here = number(ContactPoint::Node(i));
        let gone = [ContactPoint::Edge(i - 1), ContactPoint::Edge(i)].map(number);
        self.pairs.retain(|p| !gone.contains(&p.point));
        for p in &mut self.pairs {
            p.point -= u32::from(p.point >= here) + u32::from(p.point > here);
            p.segment -= u32::from(p.segment as usize >= i);
        }
    }

    /// Keeps the speed at which a pair may open, m/s.
    pub(in crate::contact) fn keep_rebound(&mut self, pair: usize, speed: f64) {
        self.pairs[pair].rebound = speed;
    }

    /// The spline of the live wire with nodes at `q`.
    pub(super) fn curve<'a>(&self, q: &'a [V3]) -> Curve<'a> {
        Curve {
            points: q,
            seams: [self.has_seam, false],
        }
    }

    /// Whether every pair lies on a wire of so many live nodes: a point, and wire nearer to the clamp.
    pub(in crate::contact) fn fits(&self, nodes: usize) -> bool {
        let points = 1..2 * (nodes as u32 - 1);
        let mut pairs = self.pairs.iter();
        pairs.all(|p| points.contains(&p.point) && (p.segment as usize) < p.node_before())
    }

    /// Number of pairs listed.
    #[cfg(feature = "lab")]
    pub fn len(&self) -> usize {
        self.pairs.len()
    }

    /// Whether no pair is listed.
    #[cfg(feature = "lab")]
    pub fn is_empty(&self) -> bool {
        self.pairs.is_empty()
    }

    /// The last node that wire up to a node carries: by a touch of its own, or of wire between that is carried too. That node where
    /// none does.
    pub fn carried_by(&self, node: usize) -> usize {
        let mut last = node;
        loop {
            let carried = |pair: &&Pair| pair.depth > 0.0 && pair.segment as usize <= last;
            let points = self.pairs.iter().filter(carried);
            let next = points.map(Pair::node_before).max();
            match next.filter(|next| *next > last) {
                Some(next) => last = next,
                None => return last,
            }
        }
    }

    /// Depth of the deepest touch, m; 0: none.
    pub fn deepest(&self) -> f64 {
        self.pairs.iter().map(|p| p.depth).fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn with_points(points: impl Iterator<Item = u32>) -> SelfContact {
        let pair = |point| Pair {
            point,
            segment: 0,
            touched: true,
            bristle: V3::x() * f64::from(point),
            limit: FrictionLimit::ZERO,
            depth: 0.0,
            share: 0.5,
            normal: V3::y(),
            rebound: 0.0,
        };
        SelfContact {
            pairs: points.map(pair).collect(),
            ..SelfContact::default()
        }
    }

    /// The pairs of a split edge's middle went to the middle of its first half, where the wire had never been.
    #[test]
    fn pairs_stay_where_the_wire_is() {
        let mut pairs = with_points(4..10);
        pairs.split(3);
        let numbers: Vec<u32> = pairs.pairs.iter().map(|p| p.point).collect();
        // the middle of edge 3, number 7, is node 4 now, number 8
        assert_eq!(numbers, [4, 5, 6, 8, 10, 11]);
        pairs.merge(4);
        let back: Vec<u32> = pairs.pairs.iter().map(|p| p.point).collect();
        assert_eq!(back, [4, 5, 6, 7, 8, 9]);
        let kept = pairs
            .pairs
            .iter()
            .all(|p| p.bristle.x == f64::from(p.point));
        assert!(kept, "each with its own bristle");
    }
}
