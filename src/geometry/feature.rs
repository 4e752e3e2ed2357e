//! Which feature of a triangle (face, edge, vertex) a point is closest to, and the signed
//! distance that follows.
//!
//! The plane of a triangle is divided by its three sides and by the lines through their ends
//! (its Voronoi regions). Seen from space the regions are prisms: over the face, beside an edge,
//! past a vertex. Paper eq. 4 knows only the first, with its sign reversed.

use super::elements::Facet;
use super::mesh::TriMesh;
use crate::math::V3;

/// The Voronoi region of one triangle that a point lies in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Region {
    /// over or under the face
    Face,
    /// beside side `side`; `along` is the projection on its edge, see `Edge::project`
    Edge { side: usize, along: f64 },
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

impl TriMesh {
    /// The region of triangle `facet` that `p` lies in.
    #[inline]
    pub(crate) fn region(&self, facet: &Facet, p: V3) -> Region {
        let beyond = facet.beyond_sides(p);
        if beyond.iter().all(|&b| b <= 0.0) {
            return Region::Face;
        }
        self.region_outside(facet, p, beyond)
    }

    /// The region of a point that lies `beyond` at least one side.
    #[inline]
    pub(crate) fn region_outside(&self, facet: &Facet, p: V3, beyond: [f64; 3]) -> Region {
        for side in 0..3 {
            if beyond[side] > 0.0 {
                let edge = &self.edges[facet.edge[side] as usize];
                let along = edge.project(p);
                if along > 0.0 && along < edge.length_sq {
                    return Region::Edge { side, along };
                }
            }
        }
        self.region_past_ends(facet, p)
    }

    /// The region of a point beside no side.
    fn region_past_ends(&self, facet: &Facet, p: V3) -> Region {
        let edge = |side: usize| &self.edges[facet.edge[side] as usize];
        for corner in 0..3 {
            if [corner, (corner + 2) % 3].into_iter().all(|side| {
                let second = edge(side).ends[1] == facet.corner[corner];
                edge(side).is_past_end(p, second)
            }) {
                return Region::Vertex { corner };
            }
        }
        // The regions cover the plane, so only rounding leads here: take the nearest side.
        let distance_sq = |side: usize| {
            let edge = edge(side);
            let share = (edge.project(p) / edge.length_sq).clamp(0.0, 1.0);
            (p - edge.start - share * edge.along).norm_squared()
        };
        let nearer = |a: usize, b: usize| {
            if distance_sq(b) < distance_sq(a) {
                b
            } else {
                a
            }
        };
        let side = nearer(nearer(0, 1), 2);
        let along = edge(side).project(p);
        if along > 0.0 && along < edge(side).length_sq {
            return Region::Edge { side, along };
        }
        let end = edge(side).ends[usize::from(along > 0.0)];
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
        self.closest_in(self.region(facet, p), facet, p)
    }

    /// The closest point of a triangle to `p`, which lies in its `region`.
    #[inline]
    pub(crate) fn closest_in(&self, region: Region, facet: &Facet, p: V3) -> Closest {
        let (point, outward) = match region {
            Region::Face => {
                let height = facet.height(p);
                let point = p - height * facet.normal;
                let outward = facet.normal;
                return Closest {
                    point,
                    distance_sq: height * height,
                    outward,
                    region,
                };
            }
            Region::Edge { side, along } => {
                let edge = &self.edges[facet.edge[side] as usize];
                (
                    edge.start + (along / edge.length_sq) * edge.along,
                    edge.outward,
                )
            }
            Region::Vertex { corner } => {
                let vertex = facet.corner[corner] as usize;
                (self.vertices[vertex], self.corners[vertex].outward)
            }
        };
        Closest {
            point,
            distance_sq: (p - point).norm_squared(),
            outward,
            region,
        }
    }

    /// Whether `p` is past vertex `vertex` along every edge that starts there.
    pub(crate) fn in_normal_cone(&self, vertex: u32, p: V3) -> bool {
        let (start, end) = self.corners[vertex as usize].ring;
        self.rings[start as usize..end as usize]
            .iter()
            .all(|&(edge, ends_here)| self.edges[edge as usize].is_past_end(p, ends_here))
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
    /// [`super::Bvh::nearest_from`].
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
