//! The elements of a mesh, prepared for distance queries: facet, edge and corner.

use crate::math::V3;

/// One triangle, ready for queries. Side `k` runs from corner `k` to corner `k + 1`.
#[derive(Clone, Debug)]
pub(crate) struct Facet {
    /// outward unit normal
    pub normal: V3,
    /// the plane is `normal . x = offset`, m
    pub offset: f64,
    /// unit normal of each side in the plane, pointing away from the triangle
    pub side: [V3; 3],
    /// the prism is `side[k] . x <= side_offset[k]`, m
    pub side_offset: [f64; 3],
    /// edge index of each side
    pub edge: [u32; 3],
    /// triangle across each side
    pub across: [u32; 3],
    /// vertex indices
    pub corner: [u32; 3],
    /// width per height of the strip over each side that lies in both prisms: 0 at flat and convex
    /// edges, negative at concave edges that are no seams, where both faces touch
    pub overlap: [f64; 3],
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

    /// [`Facet::beyond`] of all three sides.
    #[inline]
    pub fn beyond_sides(&self, p: V3) -> [f64; 3] {
        [self.beyond(0, p), self.beyond(1, p), self.beyond(2, p)]
    }

    /// Whether `p` projects onto the triangle: eq. 4 of the paper with the side normals pointing
    /// outwards, so that all three products must not be positive.
    #[inline]
    pub fn in_prism(&self, p: V3) -> bool {
        (0..3).all(|k| self.beyond(k, p) <= 0.0)
    }
}

/// An edge shared by two triangles.
#[derive(Clone, Debug)]
pub(crate) struct Edge {
    /// position of the first end, m
    pub start: V3,
    /// from the first end to the second, m
    pub along: V3,
    /// squared length, m^2
    pub length_sq: f64,
    /// vertex indices of the ends
    pub ends: [u32; 2],
    /// the two triangles, lower index first
    pub triangles: [u32; 2],
    /// which side of each triangle this edge is
    pub side_in: [u8; 2],
    /// unit bisector of the two face normals: tells outside from inside at the edge
    pub outward: V3,
}

impl Edge {
    /// Projection of `p` on the edge times the edge's length, m^2: 0 at the first end,
    /// `length_sq` at the second. Every triangle and vertex at the edge decides by this one number.
    #[inline]
    pub fn project(&self, p: V3) -> f64 {
        (p - self.start).dot(&self.along)
    }

    /// Whether `p` projects past the second end (`second`) or before the first.
    #[inline]
    pub fn is_past_end(&self, p: V3, second: bool) -> bool {
        let along = self.project(p);
        if second {
            along >= self.length_sq
        } else {
            along <= 0.0
        }
    }
}

/// A vertex with its surroundings.
#[derive(Clone, Debug)]
pub(crate) struct Corner {
    /// range of `rings`
    pub ring: (u32, u32),
    /// lowest triangle index at the vertex
    pub first_triangle: u32,
    /// unit normal, faces weighted by their angle (Baerentzen and Aanaes 2005): tells outside
    /// from inside at the vertex
    pub outward: V3,
}
