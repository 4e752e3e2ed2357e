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
//! and over concave edges that bend less than [`SEAM_BEND`] (tessellated fillets, noise of
//! files), only the nearer face touches, ties going to the lower index. At a vertex inside a flat
//! face the same can happen to triangles that share no edge: touches at one point are merged,
//! and if every triangle passed the touch on to another, the nearest feature is taken.

use super::feature::{Closest, Region};
use super::mesh::{Facet, TriMesh};
use crate::math::V3;

/// A concave edge bending less than this is part of one smooth face, rad.
///
/// Chosen (15 degrees): the second touch of a concave edge sets in at depth zero as long as the
/// first is shallower than `r (1 - cos bend)`, 3.4 % of r here, a depth contact keeps below. For
/// a smaller bend it would set in with a jump, as if the stiffness doubled.
const SEAM_BEND: f64 = 15.0 / 180.0 * std::f64::consts::PI;
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
        // Some surface is within r, so there must be a touch.
        let mut within = false;
        for triangle in candidates.clone() {
            let facet = &self.facets[triangle as usize];
            let height = facet.height(p);
            // Written so that NaN touches nothing.
            let close = height.abs() < r;
            if !close {
                continue;
            }
            let closest = self.closest(triangle, p);
            if closest.distance_sq >= r * r {
                continue;
            }
            within = true;
            if !self.counts(triangle, facet, p, height, &closest) {
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

    /// Whether this triangle is the one that counts the touch at `closest`.
    #[inline]
    fn counts(&self, triangle: u32, facet: &Facet, p: V3, height: f64, closest: &Closest) -> bool {
        match closest.region {
            Region::Face => !self.outranked(triangle, facet, p, height),
            Region::Edge { side, .. } => {
                let edge = &self.edges[facet.edge[side] as usize];
                let [first, second] = edge.triangles;
                if triangle != first {
                    return false;
                }
                let other = &self.facets[second as usize];
                other.beyond(edge.side_in[1] as usize, p) > 0.0
            }
            Region::Vertex { corner } => {
                let vertex = facet.corner[corner];
                triangle == self.corners[vertex as usize].first_triangle
                    && self.in_normal_cone(vertex, p)
            }
        }
    }

    /// Whether `p`, at `height` over this face, belongs to a nearer face across a seam.
    #[inline]
    fn outranked(&self, triangle: u32, facet: &Facet, p: V3, height: f64) -> bool {
        if height < 0.0 {
            return false;
        }
        (0..3).any(|side| {
            let edge = &self.edges[facet.edge[side] as usize];
            let strip = height * edge.overlap + self.tiny;
            if edge.bend < -SEAM_BEND || facet.beyond(side, p) < -strip {
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
