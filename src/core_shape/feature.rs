//! Which feature of a triangle (face, edge, vertex) a point is closest to, and the signed
//! distance that follows.
//!
//! The plane of a triangle is divided by its three sides and by the lines through their ends
//! (its Voronoi regions). Seen from space the regions are prisms: over the face, beside an edge,
//! past a vertex. Paper eq. 4 knows only the first, with its sign reversed.

use super::mesh::{Edge, Facet, TriMesh};
use crate::math::V3;

/// The Voronoi region of one triangle that a point lies in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Region {
    /// over or under the face
    Face,
    /// beside side `side`; `share` of the edge record's length from its start
    Edge { side: usize, share: f64 },
    /// past corner `corner`
    Vertex { corner: usize },
}

/// The closest point of a triangle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Closest {
    /// on the triangle, m
    pub point: V3,
    /// squared distance, m^2
    pub distance_sq: f64,
    /// unit outward direction of the feature
    pub outward: V3,
    /// the feature
    pub region: Region,
}

/// The point of a surface nearest to a query point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// signed distance, m; negative inside the solid
    pub distance: f64,
    /// closest point of the surface, m
    pub point: V3,
    /// unit gradient of the distance at the query point
    pub normal: V3,
}

impl Edge {
    /// Share of the edge at which `p` projects onto it: below 0 before the start, above 1 past
    /// the end. Every triangle and vertex at the edge decides by this one number.
    #[inline]
    pub fn share(&self, p: V3) -> f64 {
        (p - self.start).dot(&self.along) / self.length_sq
    }
}

impl Facet {
    /// Signed distance of `p` from the plane, m.
    #[inline]
    pub fn height(&self, p: V3) -> f64 {
        self.normal.dot(&p) - self.offset
    }

    /// How far `p` lies beyond side `k`, measured in the plane, m; negative within.
    #[inline]
    pub fn beyond(&self, k: usize, p: V3) -> f64 {
        self.side[k].dot(&p) - self.side_offset[k]
    }

    /// Whether `p` projects onto the triangle: eq. 4 with the side normals pointing outwards,
    /// so that all three products must not be positive.
    #[inline]
    pub fn in_prism(&self, p: V3) -> bool {
        (0..3).all(|k| self.beyond(k, p) <= 0.0)
    }
}

impl TriMesh {
    /// The region of triangle `facet` that `p` lies in.
    #[inline]
    pub(crate) fn region(&self, facet: &Facet, p: V3) -> Region {
        let beyond = [facet.beyond(0, p), facet.beyond(1, p), facet.beyond(2, p)];
        if beyond.iter().all(|&b| b <= 0.0) {
            return Region::Face;
        }
        self.region_outside(facet, p, beyond)
    }

    /// The region of a point known to lie beyond a side.
    fn region_outside(&self, facet: &Facet, p: V3, beyond: [f64; 3]) -> Region {
        let share = facet.edge.map(|e| self.edges[e as usize].share(p));
        for side in 0..3 {
            if beyond[side] > 0.0 && share[side] > 0.0 && share[side] < 1.0 {
                return Region::Edge {
                    side,
                    share: share[side],
                };
            }
        }
        for corner in 0..3 {
            if [corner, (corner + 2) % 3].into_iter().all(|side| {
                let edge = &self.edges[facet.edge[side] as usize];
                past_end(share[side], edge.ends[1] == facet.corner[corner])
            }) {
                return Region::Vertex { corner };
            }
        }
        // The regions cover the plane, so only rounding leads here: take the nearest side.
        let clamped = |side: usize| {
            let edge = &self.edges[facet.edge[side] as usize];
            (p - edge.start - share[side].clamp(0.0, 1.0) * edge.along).norm_squared()
        };
        let near = |a: usize, b: usize| if clamped(b) < clamped(a) { b } else { a };
        let side = near(near(0, 1), 2);
        let edge = &self.edges[facet.edge[side] as usize];
        if share[side] > 0.0 && share[side] < 1.0 {
            return Region::Edge {
                side,
                share: share[side],
            };
        }
        let end = edge.ends[usize::from(share[side] >= 1.0)];
        Region::Vertex {
            corner: if facet.corner[side] == end {
                side
            } else {
                (side + 1) % 3
            },
        }
    }

    /// The closest point of triangle `triangle` to `p`.
    #[inline]
    pub(crate) fn closest(&self, triangle: u32, p: V3) -> Closest {
        let facet = &self.facets[triangle as usize];
        let region = self.region(facet, p);
        let (point, outward) = match region {
            Region::Face => (p - facet.height(p) * facet.normal, facet.normal),
            Region::Edge { side, share } => {
                let edge = &self.edges[facet.edge[side] as usize];
                (edge.start + share * edge.along, edge.outward)
            }
            Region::Vertex { corner } => {
                let vertex = facet.corner[corner] as usize;
                (self.vertices[vertex], self.corners[vertex].outward)
            }
        };
        let distance_sq = match region {
            // The height itself: squaring the difference of two points would cost digits.
            Region::Face => facet.height(p) * facet.height(p),
            _ => (p - point).norm_squared(),
        };
        Closest {
            point,
            distance_sq,
            outward,
            region,
        }
    }

    /// Whether `p` is past vertex `vertex` along every edge that starts there.
    pub(crate) fn in_normal_cone(&self, vertex: u32, p: V3) -> bool {
        let (start, end) = self.corners[vertex as usize].ring;
        self.rings[start as usize..end as usize]
            .iter()
            .all(|&(edge, ends_here)| past_end(self.edges[edge as usize].share(p), ends_here))
    }

    /// Signed distance and unit normal of `p` whose closest point is `closest`.
    ///
    /// The feature's outward direction decides the sign; with angle-weighted vertex normals this
    /// is right everywhere (Baerentzen and Aanaes 2005).
    pub(crate) fn signed(&self, p: V3, triangle: u32, closest: &Closest) -> (f64, V3) {
        if closest.region == Region::Face {
            return (self.facets[triangle as usize].height(p), closest.outward);
        }
        let arm = p - closest.point;
        let distance = closest.distance_sq.sqrt();
        let outside = arm.dot(&closest.outward) >= 0.0;
        let signed = if outside { distance } else { -distance };
        let normal = if distance <= self.tiny {
            closest.outward
        } else {
            arm / signed
        };
        (signed, normal)
    }

    /// [`Nearest`] of `p`, given the triangle that is closest.
    pub(crate) fn nearest_on(&self, p: V3, triangle: u32) -> Nearest {
        let closest = self.closest(triangle, p);
        let (distance, normal) = self.signed(p, triangle, &closest);
        Nearest {
            distance,
            point: closest.point,
            normal,
        }
    }

    /// Signed distance, closest point and normal, by asking every triangle: the slow twin of
    /// [`super::Bvh::nearest`].
    pub fn nearest_brute(&self, p: V3) -> Nearest {
        let mut best = (f64::INFINITY, 0);
        for triangle in 0..self.len() as u32 {
            let distance_sq = self.closest(triangle, p).distance_sq;
            if distance_sq < best.0 {
                best = (distance_sq, triangle);
            }
        }
        self.nearest_on(p, best.1)
    }
}

/// Whether a point at `share` of an edge is past its second end (`second`) or before its first.
#[inline]
fn past_end(share: f64, second: bool) -> bool {
    if second { share >= 1.0 } else { share <= 0.0 }
}
