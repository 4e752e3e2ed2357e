//! Contact points of the production method: where they lie on the wire, and the nodes that they move with.

use crate::linalg::Banded;
use crate::math::{Block, V3, scaled_block};
use crate::rod::Rod;
use std::ops::RangeInclusive;

/// A contact point of the wire: one at each inner node and one at the middle of each edge.
///
/// Both lie on the quadratic B-spline of the nodes, so that a coarse polygon neither cuts a corner nor catches
/// on a kink. The end nodes have no point of their own.
///
/// Points are numbered along the wire: node `i` has number `2 i`, edge `j` has `2 j + 1`. When edge `j` is split, the
/// state of point `2 j + 1` goes to the new node's point `2 j + 2`, where the wire has been all along. Both halves get
/// a new state. When a node is taken out, the state of its point goes to the middle of the joined edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ContactPoint {
    /// at an inner node `i`: `p = x[i-1] / 8 + 3 x[i] / 4 + x[i+1] / 8`
    Node(usize),
    /// at the middle of edge `j`: `p = x[j] / 2 + x[j+1] / 2`
    Edge(usize),
}

impl ContactPoint {
    /// The point of this number.
    #[inline]
    pub fn of_number(number: usize) -> Self {
        if number.is_multiple_of(2) {
            Self::Node(number / 2)
        } else {
            Self::Edge(number / 2)
        }
    }

    /// The number of the point, see [`ContactPoint`].
    #[inline]
    pub fn number(self) -> usize {
        match self {
            Self::Node(i) => 2 * i,
            Self::Edge(j) => 2 * j + 1,
        }
    }

    /// The node of a point of this number, or the one before it.
    #[inline]
    pub fn node_before(number: usize) -> usize {
        number / 2
    }

    /// Numbers of the points at a node and at the middles of its edges.
    #[inline]
    pub fn around(node: usize) -> RangeInclusive<usize> {
        (2 * node).saturating_sub(1)..=2 * node + 1
    }

    /// All points of a wire of so many edges, clamp first.
    pub fn all(edges: usize) -> impl Iterator<Item = Self> {
        (1..2 * edges).map(Self::of_number)
    }

    /// Place of the point, m, on a wire with nodes at `q`.
    #[inline(always)]
    pub fn place(self, q: &[V3]) -> V3 {
        match self {
            Self::Node(i) => (q[i - 1] + q[i + 1]) * 0.125 + q[i] * 0.75,
            Self::Edge(j) => (q[j] + q[j + 1]) * 0.5,
        }
    }

    /// Nodes that the point moves with, and their weights.
    #[inline(always)]
    pub fn weights(self) -> NodeWeights {
        match self {
            Self::Node(i) => NodeWeights {
                nodes: [i - 1, i, i + 1],
                weights: [0.125, 0.75, 0.125],
            },
            Self::Edge(j) => NodeWeights {
                nodes: [j, j + 1, j + 1],
                weights: [0.5, 0.5, 0.0],
            },
        }
    }

    /// Unstretched length of wire that the point stands for, m: half of what its node or edge stands for.
    #[inline]
    pub fn length(self, rod: &Rod) -> f64 {
        self.length_with(&rod.rest, |i| rod.voronoi(i))
    }

    /// [`Self::length`] for edges of the unstretched lengths `rest` and nodes that stand for `of_node`, m.
    #[inline(always)]
    pub fn length_with(self, rest: &[f64], of_node: impl Fn(usize) -> f64) -> f64 {
        match self {
            Self::Node(i) => 0.5 * of_node(i),
            Self::Edge(j) => 0.5 * rest[j],
        }
    }

    /// Unstretched length from the clamp, m, on a wire whose first node is at `start` and whose edges have the unstretched
    /// lengths `rest`. They are summed up at each call: few points are asked, and few of them more than once.
    pub fn arc(self, start: f64, rest: &[f64]) -> f64 {
        let to_node = |i: usize| rest[..i].iter().fold(start, |arc, rest| arc + rest);
        match self {
            Self::Node(i) => to_node(i),
            Self::Edge(j) => to_node(j) + 0.5 * rest[j],
        }
    }
}

/// A place on the wire as a weighted mean of up to three neighbouring nodes; unused ones have weight 0.
///
/// The weights of a foot on the partner's wire are negative where the mean of both is a distance vector.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NodeWeights {
    /// the nodes, ascending; one with weight 0 repeats the node before it
    pub nodes: [usize; 3],
    /// their weights
    pub weights: [f64; 3],
}

impl NodeWeights {
    /// Nodes and weights.
    #[inline]
    pub fn iter(&self) -> impl Iterator<Item = (usize, f64)> {
        self.nodes.into_iter().zip(self.weights)
    }

    /// The same nodes with the opposite weights.
    #[inline]
    pub fn negative(&self) -> Self {
        Self {
            nodes: self.nodes,
            weights: self.weights.map(|w| -w),
        }
    }

    /// The weighted sum of what the nodes have in `q`, for a [`ContactPoint`] its place but for rounding.
    #[inline]
    pub fn sum(&self, q: &[V3]) -> V3 {
        let [a, b, c] = self.nodes;
        q[a] * self.weights[0] + q[b] * self.weights[1] + q[c] * self.weights[2]
    }

    /// Adds to `sum` the way of the place in `x`, which has `D` numbers a node, first its way.
    #[inline]
    pub(crate) fn add_way<const D: usize>(&self, x: &[f64], sum: &mut V3) {
        for (n, w) in self.iter() {
            *sum += V3::new(x[D * n], x[D * n + 1], x[D * n + 2]) * w;
        }
    }

    /// Adds the force or gradient `f` on the place to `y`, which has `D` numbers a node.
    #[inline]
    pub(crate) fn add_to<const D: usize>(&self, f: &V3, y: &mut [f64]) {
        for (n, w) in self.iter() {
            for a in 0..3 {
                y[D * n + a] += w * f[a];
            }
        }
    }

    /// Adds the force or gradient `f` on the place to the nodes' `out`.
    #[inline(always)]
    pub fn spread(&self, f: &V3, out: &mut [V3]) {
        for (i, w) in self.iter() {
            if w != 0.0 {
                out[i] += f * w;
            }
        }
    }

    /// Adds the Hessian `block` with respect to the place to the nodes' `matrix`.
    #[inline(always)]
    pub fn spread_block<const D: usize>(&self, block: &Block, matrix: &mut Banded<D>) {
        for a in 0..3 {
            let (i, wa) = (self.nodes[a], self.weights[a]);
            if wa == 0.0 {
                continue;
            }
            matrix.add_diagonal(i, &scaled_block(block, wa * wa));
            for b in a + 1..3 {
                let wb = self.weights[b];
                if wb != 0.0 {
                    matrix.add(i, self.nodes[b] - i, &scaled_block(block, wa * wb));
                }
            }
        }
    }
}

impl From<([usize; 3], [f64; 3])> for NodeWeights {
    fn from((nodes, weights): ([usize; 3], [f64; 3])) -> Self {
        Self { nodes, weights }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::block_times;

    /// A point's number leads back to it, and its place is the weighted mean of its nodes.
    #[test]
    fn numbers_weights_and_places_agree() {
        let node = |i: i32| V3::new(1e-3 * f64::from(i), 2e-4 * f64::from(i * i), 1e-3);
        let q: Vec<V3> = (0..6).map(node).collect();
        let rod = Rod::through(&q, None);
        let all: Vec<ContactPoint> = ContactPoint::all(5).collect();
        assert_eq!(all.first(), Some(&ContactPoint::Edge(0)));
        assert_eq!(all.last(), Some(&ContactPoint::Edge(4)));
        for (k, point) in all.iter().enumerate() {
            assert_eq!(point.number(), k + 1);
            let weights = point.weights();
            assert!((weights.iter().map(|(_, w)| w).sum::<f64>() - 1.0).abs() < 1e-15);
            assert!((weights.sum(&q) - point.place(&q)).norm() < 1e-18);
            let mut force = vec![V3::zeros(); 6];
            weights.spread(&V3::x(), &mut force);
            weights.negative().spread(&V3::x(), &mut force);
            assert!(force.iter().all(|f| f.norm() == 0.0));
        }
        // the points stand for all of the wire but half of what the end nodes stand for
        let whole: f64 = all.iter().map(|point| point.length(&rod)).sum();
        let ends = 0.5 * (rod.voronoi(0) + rod.voronoi(5));
        assert!((whole + ends - rod.rest.iter().sum::<f64>()).abs() < 1e-15);
    }

    /// The force that a way of the nodes calls forth through the matrix is that of the way of the place.
    #[test]
    fn a_spread_block_acts_on_the_place() {
        let block: Block = [[2.0, 0.3, 0.1], [0.3, 1.5, -0.2], [0.1, -0.2, 1.0]];
        let ways: Vec<V3> = (0..6)
            .map(|i| V3::new(0.1 * f64::from(i), 1.0 - 0.3 * f64::from(i * i), 0.7))
            .collect();
        for point in ContactPoint::all(5) {
            let weights = point.weights();
            let mut matrix = Banded::<3>::new();
            matrix.reset(6);
            weights.spread_block(&block, &mut matrix);
            let flat: Vec<f64> = ways.iter().flatten().copied().collect();
            let mut got = vec![0.0; 18];
            matrix.multiply(&flat, &mut got);
            let mut want = vec![V3::zeros(); 6];
            weights.spread(&block_times(&block, &weights.sum(&ways)), &mut want);
            for (got, want) in got.iter().zip(want.iter().flatten()) {
                assert!((got - want).abs() < 1e-13, "{point:?}: {got} {want}");
            }
        }
    }
}
