//! Search for the triangles near a point by a hierarchy of boxes.
//!
//! The `bvh` crate builds the tree (surface-area heuristic); the walk is ours because its
//! iterators report boxes, and a fixed-depth stack would panic on adversarial files. The crate's
//! vector types stay inside this file.

use super::feature::Nearest;
use super::level::LevelNearest;
use super::mesh::TriMesh;
use crate::math::V3;
use bvh::aabb::{Aabb, Bounded};
use bvh::bounding_hierarchy::BHShape;
use bvh::bvh::BvhNode;
use nalgebra::Point3;

type Node = BvhNode<f64, 3>;
type Box3 = Aabb<f64, 3>;

/// Boxes of a node's two halves and the numbers of their nodes; none of a leaf.
fn children(node: &BvhNode<f64, 3>) -> impl Iterator<Item = (&Box3, usize)> {
    let halves = match node {
        BvhNode::Leaf { .. } => None,
        BvhNode::Node {
            child_l_index,
            child_l_aabb,
            child_r_index,
            child_r_aabb,
            ..
        } => Some([
            (child_l_aabb, *child_l_index),
            (child_r_aabb, *child_r_index),
        ]),
    };
    halves.into_iter().flatten()
}

/// Boxes are taken this much (relative) larger than they are, so that rounding never hides a
/// triangle that the exact test would keep.
const SLACK: f64 = 1e-9;

/// A box hierarchy over the triangles of one mesh; every query is handed that same mesh.
#[derive(Clone, Debug)]
pub struct Bvh {
    nodes: Vec<Node>,
}

/// A triangle's box, as the builder wants it.
struct Leaf {
    bounds: Box3,
    node: usize,
}

impl Bounded<f64, 3> for Leaf {
    fn aabb(&self) -> Box3 {
        self.bounds
    }
}

impl BHShape<f64, 3> for Leaf {
    fn set_bh_node_index(&mut self, node: usize) {
        self.node = node;
    }

    fn bh_node_index(&self) -> usize {
        self.node
    }
}

impl Bvh {
    /// Builds the hierarchy.
    pub fn new(mesh: &TriMesh) -> Self {
        let leaf = |corner: &[u32; 3]| {
            let p = corner.map(|v| mesh.vertices[v as usize]);
            let low = p[0].inf(&p[1]).inf(&p[2]);
            let high = p[0].sup(&p[1]).sup(&p[2]);
            Leaf {
                bounds: Aabb::with_bounds(Point3::from(low), Point3::from(high)),
                node: 0,
            }
        };
        let mut leaves: Vec<Leaf> = mesh.triangles.iter().map(leaf).collect();
        Self {
            nodes: bvh::bvh::Bvh::build(&mut leaves).nodes,
        }
    }

    /// Triangles whose distance from `p` is at most `radius` (m), in ascending order.
    ///
    /// `out` is emptied first and reused: no allocation once it has grown.
    pub fn near(&self, mesh: &TriMesh, p: V3, radius: f64, out: &mut Vec<u32>) {
        out.clear();
        if radius >= 0.0 {
            let query = Near {
                nodes: &self.nodes,
                mesh,
                p,
                limit: radius * radius,
            };
            query.walk(0, out);
            out.sort_unstable();
        }
    }

    /// Whether a triangle is nearer to `p` than `radius`, m.
    pub(crate) fn reaches(&self, mesh: &TriMesh, p: V3, radius: f64) -> bool {
        radius > 0.0 && reaching_walk(&self.nodes, mesh, p, 0, radius * radius)
    }

    /// Signed distance, closest point and normal of a point `p`, core frame, m, and the triangle of that point. A guess of the triangle,
    /// if there is one of that number, spares most of the search and changes nothing about what is found.
    pub fn nearest_from(&self, mesh: &TriMesh, p: V3, guess: u32) -> (Nearest, u32) {
        let mut best = match (guess as usize) < mesh.len() {
            true => (mesh.closest(guess, p).distance_sq, guess),
            false => (f64::INFINITY, 0),
        };
        nearest_walk(&self.nodes, mesh, p, 0, &mut best);
        (mesh.nearest_on(p, best.1), best.1)
    }

    /// What `look` finds first at two triangles whose boxes overlap; an error where more than `most` pairs of boxes would have to
    /// be looked at.
    pub(super) fn first_pair<T>(
        &self,
        most: u64,
        look: impl FnMut(u32, u32) -> Option<T>,
    ) -> Result<Option<T>, ()> {
        let mut pairs = Pairs {
            nodes: &self.nodes,
            look,
            left: most,
        };
        pairs.within(0)
    }

    /// The triangle whose section at the level of `p` (core frame, m) is nearest, the first of several; none above and
    /// below the mesh.
    pub(crate) fn nearest_at_level(&self, mesh: &TriMesh, p: V3) -> Option<(LevelNearest, u32)> {
        let mut best = None;
        level_walk(&self.nodes, mesh, p, 0, &mut best);
        best
    }
}

impl TriMesh {
    /// Triangles within `radius` of `p` by asking every one: the slow twin of [`Bvh::near`].
    pub fn near_brute(&self, p: V3, radius: f64, out: &mut Vec<u32>) {
        out.clear();
        let limit = radius * radius;
        out.extend((0..self.len() as u32).filter(|&t| self.closest(t, p).distance_sq <= limit));
    }
}

/// A search among the pairs of triangles whose boxes overlap.
struct Pairs<'a, F> {
    nodes: &'a [Node],
    look: F,
    /// pairs of boxes that may still be looked at
    left: u64,
}

impl<T, F: FnMut(u32, u32) -> Option<T>> Pairs<'_, F> {
    /// Among the triangles below a node.
    fn within(&mut self, node: usize) -> Result<Option<T>, ()> {
        let nodes = self.nodes;
        let halves: Vec<_> = children(&nodes[node]).collect();
        let [one, other] = halves[..] else {
            return Ok(None);
        };
        if let Some(found) = self.between(one, other)? {
            return Ok(Some(found));
        }
        if let Some(found) = self.within(one.1)? {
            return Ok(Some(found));
        }
        self.within(other.1)
    }

    /// Between the triangles below one node and those below another.
    fn between(&mut self, a: (&Box3, usize), b: (&Box3, usize)) -> Result<Option<T>, ()> {
        self.left = self.left.checked_sub(1).ok_or(())?;
        if !overlap(a.0, b.0) {
            return Ok(None);
        }
        let nodes = self.nodes;
        let (node, rest) = match (&nodes[a.1], &nodes[b.1]) {
            (Node::Leaf { shape_index: s, .. }, Node::Leaf { shape_index: t, .. }) => {
                return Ok((self.look)(*s as u32, *t as u32));
            }
            (Node::Leaf { .. }, inner) => (inner, a),
            (inner, Node::Leaf { .. }) => (inner, b),
            // the larger one, so that the halves are of a size with the other
            (one, other) => match size(a.0) > size(b.0) {
                true => (one, b),
                false => (other, a),
            },
        };
        for half in children(node) {
            let found = self.between(half, rest)?;
            if found.is_some() {
                return Ok(found);
            }
        }
        Ok(None)
    }
}

fn overlap(a: &Box3, b: &Box3) -> bool {
    (0..3).all(|k| a.min[k] <= b.max[k] && b.min[k] <= a.max[k])
}

/// Length of a box along all axes together, m.
fn size(bounds: &Box3) -> f64 {
    (bounds.max - bounds.min).sum()
}

struct Near<'a> {
    nodes: &'a [Node],
    mesh: &'a TriMesh,
    p: V3,
    /// squared radius, m^2
    limit: f64,
}

impl Near<'_> {
    /// Depth is bounded: each level of the tree at least takes a sixth off a box or halves a set.
    fn walk(&self, node: usize, out: &mut Vec<u32>) {
        match &self.nodes[node] {
            Node::Leaf { shape_index, .. } => {
                let triangle = *shape_index as u32;
                if self.mesh.closest(triangle, self.p).distance_sq <= self.limit {
                    out.push(triangle);
                }
            }
            inner => {
                for (bounds, child) in children(inner) {
                    if box_distance_sq(bounds, self.p) <= self.limit {
                        self.walk(child, out);
                    }
                }
            }
        }
    }
}

/// The halves of a node by the squared `distance` of their boxes, m^2, the nearer first.
#[inline(always)]
fn nearer_first(node: &Node, distance: impl Fn(&Box3) -> f64) -> Option<[(f64, usize); 2]> {
    let Node::Node {
        child_l_index,
        child_l_aabb,
        child_r_index,
        child_r_aabb,
        ..
    } = node
    else {
        return None;
    };
    let left = (distance(child_l_aabb), *child_l_index);
    let right = (distance(child_r_aabb), *child_r_index);
    Some(if right.0 < left.0 {
        [right, left]
    } else {
        [left, right]
    })
}

/// Whether a triangle below `node` is nearer to `p` than the root of `limit`, m^2.
fn reaching_walk(nodes: &[Node], mesh: &TriMesh, p: V3, node: usize, limit: f64) -> bool {
    match &nodes[node] {
        Node::Leaf { shape_index, .. } => mesh.closest(*shape_index as u32, p).distance_sq < limit,
        inner => nearer_first(inner, |bounds| box_distance_sq(bounds, p))
            .into_iter()
            .flatten()
            .any(|(distance_sq, child)| {
                distance_sq < limit && reaching_walk(nodes, mesh, p, child, limit)
            }),
    }
}

/// Branch and bound, nearer child first; `best` is squared distance and triangle.
fn nearest_walk(nodes: &[Node], mesh: &TriMesh, p: V3, node: usize, best: &mut (f64, u32)) {
    match &nodes[node] {
        Node::Leaf { shape_index, .. } => {
            let triangle = *shape_index as u32;
            let distance_sq = mesh.closest(triangle, p).distance_sq;
            if (distance_sq, triangle) < *best {
                *best = (distance_sq, triangle);
            }
        }
        inner => {
            for (distance_sq, child) in nearer_first(inner, |bounds| box_distance_sq(bounds, p))
                .into_iter()
                .flatten()
            {
                if distance_sq <= best.0 {
                    nearest_walk(nodes, mesh, p, child, best);
                }
            }
        }
    }
}

/// Branch and bound as in [`nearest_walk`], among what crosses the level of `p`.
fn level_walk(
    nodes: &[Node],
    mesh: &TriMesh,
    p: V3,
    node: usize,
    best: &mut Option<(LevelNearest, u32)>,
) {
    match &nodes[node] {
        Node::Leaf { shape_index, .. } => {
            let triangle = *shape_index as u32;
            let nearer = |found: &LevelNearest| match best {
                Some((least, first)) => (found.distance_sq, triangle) < (least.distance_sq, *first),
                None => true,
            };
            if let Some(found) = mesh.closest_at_level(triangle, p).filter(nearer) {
                *best = Some((found, triangle));
            }
        }
        inner => {
            let distance = |bounds: &Box3| match bounds.min.y <= p.y && p.y <= bounds.max.y {
                true => box_distance_sq(bounds, p),
                false => f64::INFINITY,
            };
            for (distance_sq, child) in nearer_first(inner, distance).into_iter().flatten() {
                let least = best.map_or(f64::MAX, |(found, _)| found.distance_sq);
                if distance_sq <= least {
                    level_walk(nodes, mesh, p, child, best);
                }
            }
        }
    }
}

/// Squared distance of `p` from a box, slightly understated, m^2.
#[inline]
fn box_distance_sq(bounds: &Box3, p: V3) -> f64 {
    let (low, high) = (bounds.min.coords, bounds.max.coords);
    let outside = (low - p).sup(&(p - high)).sup(&V3::zeros());
    let rounding = 1e-14 * low.abs().sup(&high.abs()).max();
    // (n - e)^2 is at least n^2 (1 - s) - e^2 / s
    outside.norm_squared() * (1.0 - 2.0 * SLACK) - rounding * rounding / SLACK
}
