//! How the triangles of a mesh hang together: edges, vertices, pieces.

use super::elements::{Corner, Edge, Facet};
use super::error::{MeshError, Place};
use crate::math::V3;

/// Two neighbours whose unit normals sum to less than this lie back to back.
const LEAST_FOLD: f64 = 1e-9;

/// A concave edge bending less than this is a seam in one smooth face, rad.
///
/// Chosen (15 degrees): the second touch of a concave edge sets in at depth zero as long as the
/// first is shallower than `r (1 - cos bend)`, 3.4 % of r here, a depth contact keeps below. For
/// a smaller bend it would set in with a jump, as if the stiffness doubled.
const SEAM_BEND: f64 = 15.0 / 180.0 * std::f64::consts::PI;

/// One directed side of a triangle; sorting brings the sides of an edge together.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct HalfEdge {
    low: u32,
    high: u32,
    triangle: u32,
    side: u8,
    /// runs from `low` to `high`
    forward: bool,
}

/// Pairs the sides, checks that the surface is closed and consistently oriented, and links the
/// facets to their edges and neighbours.
pub(super) fn edges(vertices: &[V3], facets: &mut [Facet]) -> Result<Vec<Edge>, MeshError> {
    let mut half_edges = Vec::with_capacity(3 * facets.len());
    for (triangle, facet) in facets.iter().enumerate() {
        for side in 0..3 {
            let (from, to) = (facet.corner[side], facet.corner[(side + 1) % 3]);
            half_edges.push(HalfEdge {
                low: from.min(to),
                high: from.max(to),
                triangle: triangle as u32,
                side: side as u8,
                forward: from < to,
            });
        }
    }
    half_edges.sort_unstable();

    let mut edges = Vec::with_capacity(half_edges.len() / 2);
    for group in half_edges.chunk_by(|a, b| a.low == b.low && a.high == b.high) {
        let (from, to, triangle) = (group[0].low, group[0].high, group[0].triangle);
        let (start, end) = (vertices[from as usize], vertices[to as usize]);
        let at = Place(0.5 * (start + end));
        let &[first, second] = group else {
            return Err(match group.len() {
                1 => MeshError::Open { at, triangle },
                count => MeshError::NonManifold {
                    at,
                    count,
                    triangle,
                },
            });
        };
        if first.forward == second.forward {
            let (first, second) = (first.triangle, second.triangle);
            return Err(MeshError::Twisted { at, first, second });
        }
        let n = [first, second].map(|h| facets[h.triangle as usize].normal);
        let sum = n[0] + n[1];
        if sum.norm() < LEAST_FOLD {
            let (first, second) = (first.triangle, second.triangle);
            return Err(MeshError::Folded { at, first, second });
        }
        let along = end - start;
        // Along the edge as the first triangle runs, a convex edge turns its normal forwards.
        let run = if first.forward { along } else { -along };
        let turn = n[0].cross(&n[1]).dot(&run.normalize());
        let bend = libm::atan2(turn, n[0].dot(&n[1]));
        let overlap = if bend >= 0.0 {
            0.0
        } else if bend > -SEAM_BEND {
            libm::tan(-bend)
        } else {
            -1.0
        };
        let index = edges.len() as u32;
        for (own, other) in [(first, second), (second, first)] {
            let facet = &mut facets[own.triangle as usize];
            facet.edge[own.side as usize] = index;
            facet.across[own.side as usize] = other.triangle;
            facet.overlap[own.side as usize] = overlap;
        }
        edges.push(Edge {
            start,
            along,
            length_sq: along.norm_squared(),
            ends: [from, to],
            triangles: [first.triangle, second.triangle],
            side_in: [first.side, second.side],
            outward: sum.normalize(),
        });
    }
    Ok(edges)
}

/// Rings of edges and angle-weighted normals of all vertices.
pub(super) fn corners(
    vertices: &[V3],
    facets: &[Facet],
    edges: &[Edge],
) -> (Vec<Corner>, Vec<(u32, bool)>) {
    let blank = Corner {
        ring: (0, 0),
        first_triangle: u32::MAX,
        outward: V3::zeros(),
    };
    let mut corners = vec![blank; vertices.len()];
    for (triangle, facet) in facets.iter().enumerate() {
        for k in 0..3 {
            let [at, next, last] = [k, (k + 1) % 3, (k + 2) % 3].map(|i| facet.corner[i]);
            let u = vertices[next as usize] - vertices[at as usize];
            let v = vertices[last as usize] - vertices[at as usize];
            let angle = libm::atan2(u.cross(&v).norm(), u.dot(&v));
            let corner = &mut corners[at as usize];
            corner.outward += angle * facet.normal;
            corner.first_triangle = corner.first_triangle.min(triangle as u32);
        }
    }
    for corner in corners.iter_mut().filter(|c| c.first_triangle != u32::MAX) {
        let norm = corner.outward.norm();
        corner.outward = if norm > LEAST_FOLD {
            corner.outward / norm
        } else {
            facets[corner.first_triangle as usize].normal
        };
    }

    let mut spokes: Vec<(u32, u32, bool)> = Vec::with_capacity(2 * edges.len());
    for (index, edge) in edges.iter().enumerate() {
        spokes.push((edge.ends[0], index as u32, false));
        spokes.push((edge.ends[1], index as u32, true));
    }
    spokes.sort_unstable();
    let mut start = 0;
    for group in spokes.chunk_by(|a, b| a.0 == b.0) {
        let end = start + group.len() as u32;
        corners[group[0].0 as usize].ring = (start, end);
        start = end;
    }
    (
        corners,
        spokes
            .into_iter()
            .map(|(_, edge, ends_here)| (edge, ends_here))
            .collect(),
    )
}

/// How far the two triangles of an edge rise over each other's plane, m: positive at a concave
/// edge. The lesser of both, because a sliver's plane carries noise far beyond the sliver.
pub(super) fn rise(edge: &Edge, vertices: &[V3], facets: &[Facet]) -> f64 {
    let over = |own: usize, other: usize| {
        let plane = &facets[edge.triangles[own] as usize];
        let corner = (edge.side_in[other] as usize + 2) % 3;
        let far = facets[edge.triangles[other] as usize].corner[corner];
        plane.height(vertices[far as usize])
    };
    over(0, 1).min(over(1, 0))
}

/// The number of the piece that each triangle belongs to, from 0, and how many pieces there are: what hangs together by edges.
pub(super) fn pieces(facets: &[Facet]) -> (Vec<u32>, u32) {
    let mut piece = vec![u32::MAX; facets.len()];
    let mut count = 0;
    let mut todo = Vec::new();
    for first in 0..facets.len() as u32 {
        if piece[first as usize] != u32::MAX {
            continue;
        }
        piece[first as usize] = count;
        todo.push(first);
        while let Some(triangle) = todo.pop() {
            for next in facets[triangle as usize].across {
                if piece[next as usize] == u32::MAX {
                    piece[next as usize] = count;
                    todo.push(next);
                }
            }
        }
        count += 1;
    }
    (piece, count)
}
