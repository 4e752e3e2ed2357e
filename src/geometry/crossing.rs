//! Whether a closed surface crosses itself: where it does, inside and outside are not told apart.
//!
//! Bodies of one mesh may reach into each other, as a flange does into its barrel. A body may not cross itself. Triangles that lie
//! flat on each other do not count as crossing.

use super::bodies::bounds;
use super::mesh::{FLAT, TriMesh};
use super::surface::Surface;
use super::topology::pieces;
use crate::math::V3;

/// Pairs of boxes that are looked at, at most: chosen so that the search takes no longer than reading the file, below a second. An
/// evenly meshed core of 400,000 triangles takes a third of them. Of long triangles side by side, as in a fan, the boxes lie over
/// each other, and the pairs grow with the square of their number.
const MOST_PAIRS: u64 = 40_000_000;

/// What a search for crossings found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Crossing {
    /// no triangle of a body goes through another one of it
    None,
    /// an edge of one goes through another one here, m
    At(V3),
    /// the boxes of too many triangles overlap to look at them all
    NotSearched,
}

impl Surface {
    /// Looks for a place where a body of the mesh crosses itself by more than single precision leaves uncertain.
    pub(crate) fn crossing(&self) -> Crossing {
        self.crossing_among(MOST_PAIRS)
    }

    fn crossing_among(&self, most: u64) -> Crossing {
        let mesh = self.mesh();
        let (piece, _) = pieces(&mesh.facets);
        let (low, high) = bounds(&mesh.vertices, &mesh.triangles);
        let depth = FLAT * (high - low).max();
        let meet = |s: u32, t: u32| match piece[s as usize] == piece[t as usize] {
            true => mesh.meet(s, t, depth),
            false => None,
        };
        match self.tree().first_pair(most, meet) {
            Ok(Some(place)) => Crossing::At(place),
            Ok(None) => Crossing::None,
            Err(()) => Crossing::NotSearched,
        }
    }
}

impl TriMesh {
    /// A place where an edge of one of two triangles goes through the other by more than `depth`, m; neighbours at an edge do not.
    fn meet(&self, s: u32, t: u32, depth: f64) -> Option<V3> {
        let [a, b] = [s, t].map(|triangle| self.triangles[triangle as usize]);
        let shared = a.iter().filter(|corner| b.contains(corner)).count();
        if shared > 1 {
            return None;
        }
        self.edge_through(a, t, depth)
            .or_else(|| self.edge_through(b, s, depth))
    }

    /// The place where an edge of a triangle with these corners goes through another triangle. Edges that begin in its corner do not.
    fn edge_through(&self, corners: [u32; 3], triangle: u32, depth: f64) -> Option<V3> {
        let other = self.triangles[triangle as usize];
        let [a, b, c] = other.map(|v| self.vertices[v as usize]);
        let normal = self.normal(triangle);
        let sides = [(a, b), (b, c), (c, a)];
        (0..3).find_map(|side| {
            let ends = [corners[side], corners[(side + 1) % 3]];
            if ends.iter().any(|end| other.contains(end)) {
                return None;
            }
            let [p, q] = ends.map(|v| self.vertices[v as usize]);
            let [above, below] = [p, q].map(|end| normal.dot(&(end - a)));
            if above.abs() <= depth || below.abs() <= depth || (above > 0.0) == (below > 0.0) {
                return None;
            }
            let place = p + (q - p) * (above / (above - below));
            // a place right on a side is on one of the two triangles there at least
            let within = |(from, to): &(V3, V3)| {
                let along = to - from;
                normal.dot(&along.cross(&(place - from))) >= -depth * along.norm()
            };
            let longest = sides.iter().map(|(from, to)| (to - from).norm());
            let doubled_area = (b - a).cross(&(c - a)).norm();
            // (the plane of a narrower triangle is rounding)
            let has_a_plane = doubled_area > depth * longest.fold(0.0, f64::max);
            (has_a_plane && sides.iter().all(within)).then_some(place)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::generate::{cylinder, rounded_box};
    use super::*;
    use std::f64::consts::TAU;

    /// A tube of four sides round the closed line through these points of the plane across y, as one body.
    fn ring(points: &[[f64; 2]]) -> Surface {
        let count = points.len();
        let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
        for k in 0..count {
            let [before, here, after] = [count - 1, 0, 1].map(|by| {
                let [x, z] = points[(k + by) % count];
                V3::new(x, 0.0, z)
            });
            let out = V3::y().cross(&(after - before).normalize());
            for (aside, up) in [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)] {
                vertices.push(here + 1e-3 * (aside * out + up * V3::y()));
            }
            for side in 0..4 {
                let at = |k: usize, side: usize| (4 * (k % count) + side % 4) as u32;
                let quad = [
                    at(k, side),
                    at(k, side + 1),
                    at(k + 1, side + 1),
                    at(k + 1, side),
                ];
                triangles.push([quad[0], quad[1], quad[2]]);
                triangles.push([quad[0], quad[2], quad[3]]);
            }
        }
        let turned = |t: &[u32; 3]| [t[0], t[2], t[1]];
        let other = triangles.iter().map(turned).collect();
        let mesh = TriMesh::new(vertices.clone(), triangles);
        Surface::new(mesh.or_else(|_| TriMesh::new(vertices, other)).unwrap())
    }

    #[test]
    fn a_body_that_crosses_itself_is_found_with_its_place() {
        let points = |x: fn(f64) -> f64, z: fn(f64) -> f64| -> Vec<[f64; 2]> {
            let angles = (0..42).map(|k| TAU * f64::from(k) / 42.0);
            angles.map(|a| [8e-3 * x(a), 5e-3 * z(a)]).collect()
        };
        let figure_of_eight = points(libm::sin, |a| libm::sin(2.0 * a));
        let Crossing::At(place) = ring(&figure_of_eight).crossing() else {
            panic!("the two ways cross in the middle");
        };
        // (ways of 2 mm that cross at 103 degrees)
        assert!(place.norm() < 2.5e-3, "{place}");
        let round = points(libm::sin, libm::cos);
        assert_eq!(ring(&round).crossing(), Crossing::None);
        // (what would take too long is not taken for sound)
        assert_eq!(ring(&round).crossing_among(100), Crossing::NotSearched);
    }

    #[test]
    fn the_search_takes_few_pairs_of_an_even_mesh() {
        let points: Vec<[f64; 2]> = (0..500)
            .map(|k| TAU * f64::from(k) / 500.0)
            .map(|a| [60e-3 * libm::sin(a), 60e-3 * libm::cos(a)])
            .collect();
        let ring = ring(&points);
        let most = ring.mesh().len() as u64 * MOST_PAIRS / 400_000;
        assert_eq!(ring.crossing_among(most / 2), Crossing::None);
    }

    #[test]
    fn cores_and_bodies_that_reach_into_each_other_do_not_cross_themselves() {
        let barrel = cylinder(6e-3, 20e-3, 200).unwrap();
        let plate = rounded_box(30e-3, 30e-3, 2e-3, 5e-3, 20).unwrap();
        let both = TriMesh::together(&[barrel.clone(), plate]).unwrap();
        for mesh in [barrel, both] {
            assert_eq!(Surface::new(mesh).crossing(), Crossing::None);
        }
    }
}
