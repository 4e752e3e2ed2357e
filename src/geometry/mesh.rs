//! A closed triangle mesh, checked and prepared for distance queries.
//!
//! Everything a query needs is stored ready to use. There is a [`Facet`] per triangle (its plane and the
//! three planes of its prism), an [`Edge`] per shared edge and a [`Corner`] per vertex. The two
//! triangles of an edge read the *same* edge record, so both decide alike whether a point lies
//! beside the edge or past its end. That is what keeps a touch from being lost or counted twice.

use super::bodies::{bounds, check_bodies, signed_volume};
use super::elements::{Corner, Edge, Facet};
use super::error::{MeshError, Place};
use super::topology::{corners, edges, pieces, rise};
use crate::math::V3;

/// Largest coordinate accepted, m. Chosen far above any machine, far below where squares of
/// areas overflow.
const LARGEST_COORDINATE: f64 = 1e6;
/// A triangle is degenerate when its height is below this share of its longest side: its normal
/// would be rounding noise. Chosen a thousandth of what single-precision files can resolve.
const LEAST_HEIGHT: f64 = 1e-10;
/// A neighbour may rise over a face by this share of the mesh's extent and still count as flat:
/// some ten roundings of a single-precision file.
pub(super) const FLAT: f64 = 1e-6;

/// A closed, outward oriented triangle mesh. Vertices in m, core frame.
///
/// The public fields are for reading (drawing, export); the rest is derived from them in
/// [`TriMesh::new`], so a changed mesh is a new mesh.
#[derive(Clone, Debug)]
pub struct TriMesh {
    /// vertex positions, m
    pub vertices: Vec<V3>,
    /// vertex indices, counterclockwise seen from outside
    pub triangles: Vec<[u32; 3]>,
    pub(crate) facets: Vec<Facet>,
    pub(crate) edges: Vec<Edge>,
    pub(crate) corners: Vec<Corner>,
    /// edges at each corner, `corners[v].ring` indexes it: edge index and whether it ends here
    pub(crate) rings: Vec<(u32, bool)>,
    /// below this distance (m) the direction from the surface to a point is rounding noise
    pub(crate) tiny: f64,
    /// every edge flat or convex, and one connected piece
    pub(crate) convex: bool,
}

impl TriMesh {
    /// Checks and prepares a mesh.
    ///
    /// `vertices` in m; `triangles` counterclockwise seen from outside. Vertices that no
    /// triangle uses are kept and ignored. Self-intersection is looked for by [`Surface::crossing`](super::Surface).
    pub fn new(vertices: Vec<V3>, triangles: Vec<[u32; 3]>) -> Result<Self, MeshError> {
        check_numbers(&vertices, &triangles)?;
        let mut facets = facets(&vertices, &triangles)?;
        let extent = extent(&vertices, &triangles);
        let edges = edges(&vertices, &mut facets)?;
        let (piece, count) = pieces(&facets);
        check_bodies(&vertices, &triangles, &piece, count)?;
        let volume = signed_volume(&vertices, &triangles);
        if volume <= 1e-15 * extent * extent * extent {
            return Err(MeshError::InsideOut { volume });
        }
        let (corners, rings) = corners(&vertices, &facets, &edges);
        let convex = edges
            .iter()
            .all(|edge| rise(edge, &vertices, &facets) <= FLAT * extent)
            && count == 1;
        Ok(Self {
            vertices,
            triangles,
            facets,
            edges,
            corners,
            rings,
            tiny: 1e-12 * extent,
            convex,
        })
    }

    /// Closed meshes as one. They may reach into each other: from outside only the outer surface is seen.
    pub(super) fn together(parts: &[Self]) -> Result<Self, MeshError> {
        let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
        for part in parts {
            let first = vertices.len() as u32;
            vertices.extend(&part.vertices);
            let numbered = part.triangles.iter().map(|t| t.map(|v| v + first));
            triangles.extend(numbered);
        }
        Self::new(vertices, triangles)
    }

    /// Number of triangles.
    pub fn len(&self) -> usize {
        self.triangles.len()
    }

    /// Never true: a mesh without triangles is refused.
    pub fn is_empty(&self) -> bool {
        self.triangles.is_empty()
    }

    /// Outward unit normal of a triangle.
    pub fn normal(&self, triangle: u32) -> V3 {
        self.facets[triangle as usize].normal
    }

    /// Corners of a triangle, m.
    pub(super) fn vertices_of(&self, triangle: u32) -> [V3; 3] {
        self.triangles[triangle as usize].map(|vertex| self.vertices[vertex as usize])
    }

    /// Its bounding box, m: lowest and highest corner.
    pub fn bounds(&self) -> [V3; 2] {
        bounds(&self.vertices, &self.triangles).into()
    }

    /// Enclosed volume, m^3.
    pub fn volume(&self) -> f64 {
        signed_volume(&self.vertices, &self.triangles)
    }

    /// True when the solid is convex, up to rounding of its vertices.
    pub fn is_convex(&self) -> bool {
        self.convex
    }
}

fn check_numbers(vertices: &[V3], triangles: &[[u32; 3]]) -> Result<(), MeshError> {
    // Three half-edges per triangle are numbered too.
    let limit = (u32::MAX / 4) as usize;
    for (what, count) in [("vertices", vertices.len()), ("triangles", triangles.len())] {
        if count > limit {
            return Err(MeshError::TooMany { what, count, limit });
        }
    }
    if triangles.is_empty() {
        return Err(MeshError::Empty);
    }
    for (vertex, v) in vertices.iter().enumerate() {
        // Written so that NaN fails.
        if !v.iter().all(|x| x.abs() <= LARGEST_COORDINATE) {
            let limit = LARGEST_COORDINATE;
            return Err(MeshError::Coordinate {
                vertex,
                x: v.x,
                y: v.y,
                z: v.z,
                limit,
            });
        }
    }
    for (triangle, corner) in triangles.iter().enumerate() {
        for &vertex in corner {
            if vertex as usize >= vertices.len() {
                return Err(MeshError::NoSuchVertex {
                    triangle,
                    vertex,
                    count: vertices.len(),
                });
            }
        }
    }
    Ok(())
}

/// Whether a triangle with these corners is more than a line.
pub(super) fn has_area(p: [V3; 3]) -> bool {
    let sides = [p[1] - p[0], p[2] - p[1], p[0] - p[2]];
    let twice_area = sides[0].cross(&sides[1]).norm();
    let longest = sides.iter().map(|s| s.norm()).fold(0.0, f64::max);
    // Written so that NaN and zero sides fail.
    twice_area > LEAST_HEIGHT * longest * longest && twice_area > 0.0
}

/// Planes of every triangle; edges and neighbours are filled in by [`edges`].
fn facets(vertices: &[V3], triangles: &[[u32; 3]]) -> Result<Vec<Facet>, MeshError> {
    let mut facets = Vec::with_capacity(triangles.len());
    for (triangle, corner) in triangles.iter().enumerate() {
        let p = corner.map(|v| vertices[v as usize]);
        let sides = [p[1] - p[0], p[2] - p[1], p[0] - p[2]];
        let area_vector = sides[0].cross(&sides[1]);
        let twice_area = area_vector.norm();
        let longest = sides.iter().map(|s| s.norm()).fold(0.0, f64::max);
        if !has_area(p) {
            let height = if longest > 0.0 {
                twice_area / longest
            } else {
                0.0
            };
            let middle = |k: usize| 0.5 * (p[k] + p[(k + 1) % 3]);
            let side = (0..3).find(|&k| sides[k].norm() == longest);
            return Err(MeshError::Degenerate {
                at: Place(side.map_or(p[0], middle)),
                triangle,
                height,
                longest,
            });
        }
        let normal = area_vector / twice_area;
        let side = sides.map(|s| s.cross(&normal).normalize());
        facets.push(Facet {
            normal,
            offset: normal.dot(&p[0]),
            side,
            side_offset: [side[0].dot(&p[0]), side[1].dot(&p[1]), side[2].dot(&p[2])],
            edge: [0; 3],
            across: [0; 3],
            corner: *corner,
            overlap: [0.0; 3],
        });
    }
    Ok(facets)
}

/// Largest side of the bounding box of all used vertices, m.
fn extent(vertices: &[V3], triangles: &[[u32; 3]]) -> f64 {
    let (low, high) = bounds(vertices, triangles);
    (high - low).max()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Corners of a unit cube at the origin; bit 0, 1, 2 of the index: x, y, z.
    fn cube_vertices() -> Vec<V3> {
        (0..8)
            .map(|i| V3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)))
            .collect()
    }

    fn cube_triangles() -> Vec<[u32; 3]> {
        let quads: [[u32; 4]; 6] = [
            [0, 4, 6, 2],
            [1, 3, 7, 5],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 2, 3, 1],
            [4, 5, 7, 6],
        ];
        quads
            .iter()
            .flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]])
            .collect()
    }

    fn refuse(vertices: Vec<V3>, triangles: Vec<[u32; 3]>) -> MeshError {
        TriMesh::new(vertices, triangles).expect_err("must be refused")
    }

    #[test]
    fn a_cube_is_accepted_with_its_topology() {
        let mesh = TriMesh::new(cube_vertices(), cube_triangles()).unwrap();
        assert!((mesh.volume() - 1.0).abs() < 1e-15);
        assert!(mesh.is_convex());
        // Euler: V - E + F = 2.
        assert_eq!(8 + mesh.len(), mesh.edges.len() + 2);
        let bends = |e: &&Edge| {
            mesh.normal(e.triangles[0])
                .dot(&mesh.normal(e.triangles[1]))
                < 0.5
        };
        assert_eq!(mesh.edges.iter().filter(bends).count(), 12);
        for (t, facet) in mesh.facets.iter().enumerate() {
            for k in 0..3 {
                let other = &mesh.facets[facet.across[k] as usize];
                let back = (0..3).find(|&j| other.edge[j] == facet.edge[k]).unwrap();
                assert_eq!(other.across[back] as usize, t);
            }
        }
        for (v, corner) in mesh.corners.iter().enumerate() {
            // By symmetry the angle-weighted normal is the diagonal, however faces are split.
            let diagonal = (mesh.vertices[v] - V3::repeat(0.5)).normalize();
            assert!((corner.outward - diagonal).norm() < 1e-12);
        }
    }

    #[test]
    fn holes_are_named() {
        let mut triangles = cube_triangles();
        triangles.pop();
        let error = refuse(cube_vertices(), triangles);
        assert!(
            matches!(
                error,
                MeshError::Open { at, triangle: 0 } if at.0 == V3::new(0.0, 0.5, 1.0)
            ),
            "{error}"
        );
    }

    #[test]
    fn a_turned_triangle_is_named() {
        let mut triangles = cube_triangles();
        triangles[3].swap(0, 1);
        let error = refuse(cube_vertices(), triangles);
        assert!(
            matches!(error, MeshError::Twisted { first, second, .. } if first == 3 || second == 3),
            "{error}"
        );
    }

    #[test]
    fn inside_out_is_refused() {
        let mut triangles = cube_triangles();
        triangles.iter_mut().for_each(|t| t.swap(0, 1));
        let error = refuse(cube_vertices(), triangles);
        assert!(matches!(error, MeshError::InsideOut { volume } if (volume + 1.0).abs() < 1e-12));
    }

    #[test]
    fn bad_numbers_are_refused() {
        assert_eq!(refuse(cube_vertices(), vec![]), MeshError::Empty);

        let mut triangles = cube_triangles();
        triangles[2][1] = 8;
        let error = refuse(cube_vertices(), triangles);
        assert_eq!(
            error,
            MeshError::NoSuchVertex {
                triangle: 2,
                vertex: 8,
                count: 8
            }
        );

        for bad in [f64::NAN, f64::INFINITY, -1e9] {
            let mut vertices = cube_vertices();
            vertices[5].y = bad;
            let error = refuse(vertices, cube_triangles());
            assert!(
                matches!(error, MeshError::Coordinate { vertex: 5, .. }),
                "{error}"
            );
        }
    }

    #[test]
    fn degenerate_triangles_are_refused() {
        let mut triangles = cube_triangles();
        triangles[4] = [0, 1, 1];
        let error = refuse(cube_vertices(), triangles);
        assert!(
            matches!(error, MeshError::Degenerate { triangle: 4, .. }),
            "{error}"
        );

        // Three corners on a line.
        let mut vertices = cube_vertices();
        vertices.push(V3::new(0.5, 0.0, 0.0));
        let mut triangles = cube_triangles();
        triangles[5] = [0, 8, 1];
        let error = refuse(vertices, triangles);
        assert!(
            matches!(error, MeshError::Degenerate { triangle: 5, .. }),
            "{error}"
        );
    }

    #[test]
    fn fins_and_folds_are_refused() {
        // A fin standing on an edge: three triangles there.
        let mut vertices = cube_vertices();
        vertices.push(V3::new(0.5, -1.0, -1.0));
        let mut triangles = cube_triangles();
        triangles.push([0, 1, 8]);
        triangles.push([1, 0, 8]);
        let error = refuse(vertices, triangles);
        assert!(
            matches!(
                error,
                MeshError::NonManifold { at, count: 4, .. } if at.0 == V3::new(0.5, 0.0, 0.0)
            ),
            "{error}"
        );

        // A sheet covered on both sides.
        let error = refuse(cube_vertices(), vec![[0, 1, 2], [0, 2, 1]]);
        assert!(matches!(error, MeshError::Folded { .. }), "{error}");
    }

    #[test]
    fn two_boxes_are_not_convex() {
        let mut vertices = cube_vertices();
        vertices.extend(cube_vertices().iter().map(|v| v + V3::new(3.0, 0.0, 0.0)));
        let mut triangles = cube_triangles();
        triangles.extend(cube_triangles().iter().map(|t| t.map(|v| v + 8)));
        assert!(!TriMesh::new(vertices, triangles).unwrap().is_convex());
    }
}
