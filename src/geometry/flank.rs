//! Height of a point over the flank of a core: over what wire is wound on, and not over a flange beside it.

use super::surface::Surface;
use crate::math::V3;

/// Share of a facet's unit normal along y from which on it is a flange and no flank: steeper than 45 degrees.
pub(crate) const FLANGE_FACE: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// How far beyond a face the next is looked for, as a share of the core's length: some thousand times the rounding of places.
const HAIR: f64 = 1e-12;

impl Surface {
    /// Signed distance of `p` (core frame, m) from the flank of the core, m: from the tangent plane of what lies nearest
    /// at the same place along y. Over a flange that leans outwards it is the distance from the flank at its foot.
    ///
    /// Wire beside a flange is as high over the core as wire far from it. Where there is only a flange, as in
    /// the edge of one, and beyond the ends of the core it is the distance to the nearest surface.
    pub fn height_over_flank(&self, p: V3) -> f64 {
        self.over_flank(p)
            .unwrap_or_else(|| self.nearest(p).distance)
    }

    /// The same; `None` where there is no flank.
    fn over_flank(&self, p: V3) -> Option<f64> {
        let mut place = p;
        let mut inwards = 0.0;
        loop {
            let (nearest, triangle) = self.nearest_at_level(place)?;
            let normal = self.mesh().normal(triangle);
            if normal.y.abs() <= FLANGE_FACE {
                // A conical flank leans: its distance is less than that in the plane of the section.
                let lean = (1.0 - normal.y * normal.y).sqrt();
                return Some(
                    (nearest.distance_sq.sqrt() * lean).copysign(nearest.away.dot(&normal)),
                );
            }
            if inwards * normal.y < 0.0 {
                // between two flanges there is no flank
                return None;
            }
            inwards = normal.y.signum();
            place.y = self.beyond(triangle, inwards);
        }
    }

    /// The place along y just beyond a triangle, m, towards +y or -y.
    fn beyond(&self, triangle: u32, sense: f64) -> f64 {
        let (low, high) = self.bounds();
        let corners = self.mesh().vertices_of(triangle);
        let farthest = corners.map(|corner| sense * corner.y);
        sense * (farthest.into_iter().fold(f64::MIN, f64::max) + HAIR * (high.y - low.y))
    }
}

impl Surface {
    /// Way along y from `p` (core frame, m) to the flange that is what lies nearest to it, m, negative towards -y; none where
    /// that is no flange.
    pub fn flange_beside(&self, p: V3) -> Option<f64> {
        let nearest = self.nearest(p);
        (nearest.normal.y.abs() > FLANGE_FACE).then(|| -nearest.distance / nearest.normal.y)
    }
}

#[cfg(test)]
mod tests {
    use super::super::mesh::TriMesh;
    use super::*;
    use std::f64::consts::TAU;

    /// Revolves an outline of (y, r), mm, that begins and ends on the axis.
    fn revolved(outline: &[[f64; 2]], sides: u32) -> Surface {
        let mut vertices = Vec::new();
        let mut triangles = Vec::new();
        let inner = &outline[1..outline.len() - 1];
        for &[y, r] in inner {
            for side in 0..sides {
                let a = TAU * f64::from(side) / f64::from(sides);
                vertices.push(V3::new(r * a.cos(), y, r * a.sin()) * 1e-3);
            }
        }
        let (first, last) = (vertices.len() as u32, vertices.len() as u32 + 1);
        vertices.push(V3::new(0.0, outline[0][0], 0.0) * 1e-3);
        vertices.push(V3::new(0.0, outline[outline.len() - 1][0], 0.0) * 1e-3);
        let rows = inner.len() as u32;
        for s in 0..sides {
            let n = (s + 1) % sides;
            triangles.push([first, s, n]);
            for row in 0..rows - 1 {
                let at = |side: u32, row: u32| row * sides + side;
                triangles.push([at(s, row), at(s, row + 1), at(n, row)]);
                triangles.push([at(n, row), at(s, row + 1), at(n, row + 1)]);
            }
            let top = (rows - 1) * sides;
            triangles.push([last, top + n, top + s]);
        }
        Surface::new(TriMesh::new(vertices, triangles).expect("a closed surface"))
    }

    /// Barrel of radius 8 mm between flanges of 12 mm at y = -5 and 5 mm.
    fn bobbin() -> Surface {
        let wall = [
            [-7.0, 0.0],
            [-7.0, 12.0],
            [-5.0, 12.0],
            [-5.0, 8.0],
            [5.0, 8.0],
            [5.0, 12.0],
            [7.0, 12.0],
            [7.0, 0.0],
        ];
        revolved(&wall, 360)
    }

    #[test]
    fn wire_beside_a_flange_is_as_high_as_far_from_it() {
        let core = bobbin();
        for rise in [0.35e-3, 1.5e-3, 3.5e-3] {
            for y in [-4.65e-3, 0.0, 2.1e-3, 4.65e-3] {
                let p = V3::new(8e-3 + rise, y, 1e-5);
                let height = core.height_over_flank(p);
                assert!((height - rise).abs() < 2e-6, "{rise} {y}: {height}");
            }
        }
        let flange = core.nearest(V3::new(11e-3, 4.65e-3, 1e-5)).distance;
        assert!((flange - 0.35e-3).abs() < 1e-6, "the flange is nearer");
    }

    /// Wire on a flange that leans was no higher than wire on the core, and turns that it had climbed on lay beside it.
    #[test]
    fn wire_over_a_leaning_flange_is_as_high_over_the_core() {
        // 8 to 9 to 11 mm: facets of 63 and 76 degrees
        let wall = [
            [-7.0, 0.0],
            [-7.0, 11.0],
            [-6.0, 11.0],
            [-5.5, 9.0],
            [-5.0, 8.0],
            [5.0, 8.0],
            [5.5, 9.0],
            [6.0, 11.0],
            [7.0, 11.0],
            [7.0, 0.0],
        ];
        let core = revolved(&wall, 360);
        for (y, rise) in [(5.1e-3, 0.5e-3), (-5.3e-3, 1.2e-3), (5.8e-3, 2.7e-3)] {
            let p = V3::new(8e-3 + rise, y, 1e-5);
            let height = core.height_over_flank(p);
            assert!((height - rise).abs() < 2e-6, "{y} {rise}: {height}");
        }
        // in a notch between two steep faces there is no flank
        let notch = [
            [-5.0, 0.0],
            [-5.0, 8.0],
            [-1.0, 8.0],
            [0.0, 5.0],
            [1.0, 8.0],
            [5.0, 8.0],
            [5.0, 0.0],
        ];
        let core = revolved(&notch, 360);
        let p = V3::new(7e-3, 0.2e-3, 1e-5);
        let (height, nearest) = (core.height_over_flank(p), core.nearest(p).distance);
        assert!((height - nearest).abs() < 1e-9, "{height} {nearest}");
    }

    #[test]
    fn a_conical_flank_is_as_far_as_its_surface() {
        // 8 to 6 mm over 10 mm.
        let wall = [[-5.0, 0.0], [-5.0, 8.0], [5.0, 6.0], [5.0, 0.0]];
        let core = revolved(&wall, 360);
        let p = V3::new(7.9e-3, 0.0, 1e-5);
        let (height, nearest) = (core.height_over_flank(p), core.nearest(p).distance);
        assert!((height - nearest).abs() < 1e-6, "{height} {nearest}");
    }

    #[test]
    fn the_search_finds_what_asking_every_triangle_finds() {
        let core = bobbin();
        for k in 0..500 {
            let k = f64::from(k);
            let (r, a) = (15e-3 * (k * 0.618).fract(), k * 0.377);
            let p = V3::new(r * a.cos(), 16e-3 * (k * 0.271).fract() - 8e-3, r * a.sin());
            let brute = core.mesh().nearest_at_level_brute(p);
            assert_eq!(core.nearest_at_level(p), brute, "{p:?}");
        }
    }
}
