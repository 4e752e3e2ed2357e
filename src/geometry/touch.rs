//! Where a sphere touches the mesh: paper eq. 3-7, mended.
//!
//! A touch is a point of the surface that is closer to the sphere's centre than all surface
//! around it. Seen from outside these are
//!
//! * the foot on a face, when the centre lies in the face's prism,
//! * the foot on an edge, when the centre lies beyond that edge of *both* its faces,
//! * a vertex, when the centre lies past it along *every* edge that starts there.
//!
//! They never leave a hole at a convex edge (three prisms alone do), and a convex solid yields
//! exactly one. In a concave corner each wall yields its own, and the corner edge none.
//!
//! A centre that got under the surface is pushed to the one nearest surface point, whatever the
//! feature; the far side of a thin flange does not pull it through. So the largest depth is
//! always `r` less the signed distance, hence continuous.
//!
//! # Flat and nearly flat edges
//!
//! Over the shared edge of two coplanar triangles rounding may put the centre into both prisms or
//! into none. In none: each triangle finds the edge closest, and the edge rule serves. In both,
//! and over concave edges that bend less than 15 degrees (tessellated fillets, noise of
//! files), only the nearer face touches, ties going to the lower index. At a vertex inside a flat
//! face the same can happen to triangles that share no edge. Touches at one point are merged.
//! If every triangle passed the touch on to another, the nearest feature is taken.

use super::elements::Facet;
use super::feature::{Closest, Region};
use super::mesh::TriMesh;
use crate::math::V3;

/// Touches closer than this share of the radius and with like normals are one.
const SAME_POINT: f64 = 1e-9;
/// Cosine between normals that may be one touch.
const SAME_NORMAL: f64 = 0.9;

/// One contact of a sphere with the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touch {
    /// unit vector from the surface to the sphere's centre (from inside: to the surface)
    pub normal: V3,
    /// radius less signed distance, m; positive
    pub depth: f64,
    /// point of the surface, m
    pub point: V3,
}

impl TriMesh {
    /// All contacts of a sphere with centre `p` (core frame, m) and radius `r` (m).
    ///
    /// `candidates`: triangles to look at, each once: at least all within `r` of `p`, as
    /// [`super::Bvh::near`] finds them. `out` is emptied first; it holds at most a handful, in
    /// the order of the candidates. Centres deeper than `r` inside touch nothing.
    pub fn touching(&self, p: V3, r: f64, candidates: &[u32], out: &mut Vec<Touch>) {
        self.touching_among(p, r, candidates.iter().copied(), out);
    }

    /// [`TriMesh::touching`] with every triangle as a candidate.
    pub fn touching_brute(&self, p: V3, r: f64, out: &mut Vec<Touch>) {
        self.touching_among(p, r, 0..self.len() as u32, out);
    }

    fn touching_among(
        &self,
        p: V3,
        r: f64,
        candidates: impl Iterator<Item = u32> + Clone,
        out: &mut Vec<Touch>,
    ) {
        out.clear();
        // Nearest touch with the centre inside, and its signed distance.
        let mut inside: Option<(f64, Touch)> = None;
        let mut least_outside = f64::INFINITY;
        // Some surface may be within r; if it is, there must be a touch.
        let mut within = false;
        for triangle in candidates.clone() {
            let facet = &self.facets[triangle as usize];
            let height = facet.height(p);
            // Written so that NaN touches nothing.
            let close = height.abs() < r;
            if !close {
                continue;
            }
            let beyond = facet.beyond_sides(p);
            let farthest = beyond[0].max(beyond[1]).max(beyond[2]);
            let region = if farthest <= 0.0 {
                Region::Face
            } else if height * height + farthest * farthest >= r * r {
                continue;
            } else {
                self.region_outside(facet, p, beyond)
            };
            within = true;
            let counts = match region {
                Region::Face => !self.outranked(triangle, facet, height, beyond, p),
                Region::Edge { side, .. } => self.is_edge_touch(triangle, facet.edge[side], p),
                Region::Vertex { corner } => {
                    self.is_vertex_touch(triangle, facet.corner[corner], p)
                }
            };
            if !counts {
                continue;
            }
            let closest = self.closest_in(region, facet, p);
            if closest.distance_sq >= r * r {
                continue;
            }
            let (distance, touch) = self.touch(p, r, triangle, &closest);
            if distance >= 0.0 {
                least_outside = least_outside.min(distance);
                out.push(touch);
            } else if inside.is_none_or(|(deepest, _)| distance > deepest) {
                inside = Some((distance, touch));
            }
        }
        if let Some((distance, touch)) = inside
            && -distance < least_outside
        {
            // A wall across a narrow gap goes on touching; the rim it slipped under does not.
            out.retain(|other| (other.point - touch.point).norm() >= SAME_POINT * r);
            out.push(touch);
        }
        if within && out.is_empty() {
            self.push_nearest(p, r, candidates, out);
        }
        self.merge(r, out);
    }

    /// Whether `p`, beside the edge of this triangle, is so for the other as well; only the lower
    /// index counts it.
    #[inline]
    fn is_edge_touch(&self, triangle: u32, edge: u32, p: V3) -> bool {
        let edge = &self.edges[edge as usize];
        let [first, second] = edge.triangles;
        triangle == first && {
            let other = &self.facets[second as usize];
            other.beyond(edge.side_in[1] as usize, p) > 0.0
        }
    }

    /// Whether `p`, past the vertex of this triangle, is so for all others; only the lowest index
    /// counts it.
    #[inline]
    fn is_vertex_touch(&self, triangle: u32, vertex: u32, p: V3) -> bool {
        triangle == self.corners[vertex as usize].first_triangle && self.in_normal_cone(vertex, p)
    }

    /// Whether `p`, at `height` over this face, belongs to a nearer face across a seam.
    #[inline]
    fn outranked(
        &self,
        triangle: u32,
        facet: &Facet,
        height: f64,
        beyond: [f64; 3],
        p: V3,
    ) -> bool {
        if height < 0.0 {
            return false;
        }
        (0..3).any(|side| {
            let overlap = facet.overlap[side];
            if overlap < 0.0 || beyond[side] < -(height * overlap + self.tiny) {
                return false;
            }
            let across = facet.across[side];
            let other = &self.facets[across as usize];
            let rival = other.height(p);
            rival >= 0.0 && (rival, across) < (height, triangle) && other.in_prism(p)
        })
    }

    /// Signed distance and touch at `closest`.
    #[inline]
    fn touch(&self, p: V3, r: f64, triangle: u32, closest: &Closest) -> (f64, Touch) {
        let (distance, normal) = self.signed(p, triangle, closest);
        (
            distance,
            Touch {
                normal,
                depth: r - distance,
                point: closest.point,
            },
        )
    }

    /// The last resort against rounding: the nearest feature of all candidates.
    #[cold]
    fn push_nearest(
        &self,
        p: V3,
        r: f64,
        candidates: impl Iterator<Item = u32>,
        out: &mut Vec<Touch>,
    ) {
        let mut best: Option<(f64, u32)> = None;
        for triangle in candidates {
            let distance_sq = self.closest(triangle, p).distance_sq;
            if distance_sq < r * r && best.is_none_or(|(least, _)| distance_sq < least) {
                best = Some((distance_sq, triangle));
            }
        }
        if let Some((_, triangle)) = best {
            out.push(self.touch(p, r, triangle, &self.closest(triangle, p)).1);
        }
    }

    /// Keeps one of touches that are the same up to rounding.
    fn merge(&self, r: f64, touches: &mut Vec<Touch>) {
        if touches.len() < 2 {
            return;
        }
        if self.convex {
            // There is one in exact arithmetic; more are copies at a vertex or noise of a file.
            let deeper = |a: Touch, b: &Touch| if b.depth > a.depth { *b } else { a };
            touches[0] = touches[1..].iter().fold(touches[0], deeper);
            touches.truncate(1);
            return;
        }
        let mut index = 1;
        while index < touches.len() {
            let touch = touches[index];
            let known = touches[..index].iter().any(|other| {
                (other.point - touch.point).norm() < SAME_POINT * r
                    && other.normal.dot(&touch.normal) > SAME_NORMAL
            });
            if known {
                touches.remove(index);
            } else {
                index += 1;
            }
        }
    }
}
