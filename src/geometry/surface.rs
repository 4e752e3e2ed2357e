//! A mesh together with its search tree: the core as contact and measures see it.

use super::bodies;
use super::bvh::Bvh;
use super::distance_grid::DistanceGrid;
use super::feature::Nearest;
use super::level::LevelNearest;
use super::mesh::TriMesh;
use super::touch::Touch;
use super::wall::WallFoot;
use crate::math::V3;
use std::sync::OnceLock;

/// Feet nearer to each other than this share of the radius that is searched are one, such as those on two triangles at one vertex.
const SAME_FOOT: f64 = 1e-9;

/// A closed surface ready for queries. Core frame, lengths in m.
#[derive(Clone, Debug)]
pub struct Surface {
    mesh: TriMesh,
    bvh: Bvh,
    /// made when something is first asked of the surface
    grid: OnceLock<DistanceGrid>,
    bounds: (V3, V3),
    radius_max: f64,
}

impl Surface {
    /// Builds the search tree of a mesh.
    pub fn new(mesh: TriMesh) -> Self {
        let bvh = Bvh::new(&mesh);
        let bounds = bodies::bounds(&mesh.vertices, &mesh.triangles);
        let radius_sq = |v: &u32| {
            let p = mesh.vertices[*v as usize];
            p.x * p.x + p.z * p.z
        };
        let radius_max = mesh
            .triangles
            .iter()
            .flatten()
            .map(radius_sq)
            .fold(0.0, f64::max)
            .sqrt();
        Self {
            mesh,
            bvh,
            grid: OnceLock::new(),
            bounds,
            radius_max,
        }
    }

    /// The mesh.
    pub fn mesh(&self) -> &TriMesh {
        &self.mesh
    }

    /// Its search tree.
    pub(super) fn tree(&self) -> &Bvh {
        &self.bvh
    }

    /// Bounds of its distance.
    pub(super) fn grid(&self) -> &DistanceGrid {
        self.grid
            .get_or_init(|| DistanceGrid::new(&self.mesh, &self.bvh, self.bounds))
    }

    /// Lowest and highest corner of the bounding box, m.
    pub fn bounds(&self) -> (V3, V3) {
        self.bounds
    }

    /// Largest distance of the surface from the y axis, m.
    pub fn radius_max(&self) -> f64 {
        self.radius_max
    }

    /// Whether the solid is convex: then a sphere touches it once at most.
    pub fn is_convex(&self) -> bool {
        self.mesh.is_convex()
    }

    /// Triangles within `radius` (m) of `p` (core frame, m), by [`Bvh::near`].
    pub fn near(&self, p: V3, radius: f64, out: &mut Vec<u32>) {
        self.bvh.near(&self.mesh, p, radius, out);
    }

    /// Contacts of a sphere of centre `p` and radius `r`, m, by [`TriMesh::touching`].
    pub fn touching(&self, p: V3, r: f64, candidates: &[u32], out: &mut Vec<Touch>) {
        self.mesh.touching(p, r, candidates, out);
    }

    /// Signed distance, closest point and normal of a point `p`, core frame, m.
    pub fn nearest(&self, p: V3) -> Nearest {
        self.nearest_from(p, u32::MAX).0
    }

    /// A lower bound of the signed distance of `p` (core frame, m), m: that of the bounding box outside it, that of a grid inside.
    pub(crate) fn lower_bound(&self, p: V3) -> f64 {
        let (low, high) = self.bounds;
        let of_box = box_distance((low - p).sup(&(p - high)));
        match of_box > 0.0 {
            true => of_box,
            false => self.grid().bounds(p).least,
        }
    }

    /// Whether the signed distance of `p` (core frame, m) is below `reach`, m.
    pub(crate) fn is_within(&self, p: V3, reach: f64) -> bool {
        if self.lower_bound(p) >= reach {
            return false;
        }
        // any triangle will do; deep inside, where none is near, the sign decides
        self.grid().bounds(p).most < reach
            || self.bvh.reaches(&self.mesh, p, reach)
            || self.nearest(p).distance < reach
    }

    /// [`Self::nearest`] and its triangle, looked for from a triangle that may be it, or from that of the grid where there is none of
    /// that number.
    pub(crate) fn nearest_from(&self, p: V3, guess: u32) -> (Nearest, u32) {
        let guess = match (guess as usize) < self.mesh.len() {
            true => guess,
            false => self.grid().bounds(p).triangle,
        };
        self.bvh.nearest_from(&self.mesh, p, guess)
    }

    /// Foot of `p` (core frame, m) on the wall of a triangle, by [`TriMesh::wall_foot`]; none for a number that is no triangle's.
    pub(crate) fn wall_foot(&self, p: V3, triangle: u32) -> Option<WallFoot> {
        let known = (triangle as usize) < self.mesh.len();
        known.then(|| self.mesh.wall_foot(p, triangle)).flatten()
    }

    /// Feet of `p` (core frame, m) on all walls within `radius` (m), the nearest first. Both lists are emptied first; `found` is
    /// room for the search.
    ///
    /// Walls that a point outside sees from behind, as through a thin flange, do not count. From inside the nearest alone does.
    pub(crate) fn walls(&self, p: V3, radius: f64, found: &mut Vec<u32>, feet: &mut Vec<WallFoot>) {
        self.near(p, radius, found);
        feet.clear();
        for &triangle in &*found {
            let Some(foot) = self.mesh.wall_foot(p, triangle) else {
                continue;
            };
            let known = |other: &WallFoot| {
                other.triangle == foot.triangle
                    || (other.point - foot.point).norm() < SAME_FOOT * radius
            };
            if !feet.iter().any(known) {
                feet.push(foot);
            }
        }
        feet.sort_by(|a, b| {
            let order = a.distance.abs().total_cmp(&b.distance.abs());
            order.then(a.triangle.cmp(&b.triangle))
        });
        if feet.first().is_some_and(|nearest| nearest.distance < 0.0) {
            feet.truncate(1);
        } else {
            feet.retain(|foot| foot.distance >= 0.0);
        }
    }

    /// The section at the level of `p` (core frame, m) that is nearest, and its triangle.
    pub(crate) fn nearest_at_level(&self, p: V3) -> Option<(LevelNearest, u32)> {
        self.bvh.nearest_at_level(&self.mesh, p)
    }
}

/// Signed distance from a box, m, by how far a point is beyond its faces, m; negative inside.
#[inline]
pub(super) fn box_distance(beyond: V3) -> f64 {
    let deepest = beyond.x.max(beyond.y).max(beyond.z);
    if deepest > 0.0 {
        beyond.sup(&V3::zeros()).norm()
    } else {
        deepest
    }
}
