//! A core: a regular prism with rounded edges, one side on +x, its sides flat or hollow.

use super::stl_text::StlText;
use std::f64::consts::{PI, TAU};

/// Chords of one rounded edge per right angle.
const CHORDS: f64 = 8.0;

/// A regular prism about y.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Prism {
    /// flat sides, 3 or more
    pub sides: u32,
    /// radius of its edges along y, m
    pub corner_radius: f64,
    /// width of a flat between two edges, m
    pub flat: f64,
    /// along y, m
    pub length: f64,
    /// how far the middle of each side lies inside its edges, m; 0: flat and convex
    pub dent: f64,
}

impl Prism {
    /// Distance of an edge's axis from y, m.
    fn edge_axis(&self) -> f64 {
        0.5 * self.flat / libm::sin(PI / f64::from(self.sides))
    }

    /// Largest distance from the axis, m.
    pub fn turning_radius(&self) -> f64 {
        self.edge_axis() + self.corner_radius
    }

    /// Way round it, m.
    pub fn perimeter(&self) -> f64 {
        f64::from(self.sides) * self.flat + TAU * self.corner_radius
    }

    /// Points of the section, from +x towards +z, m.
    fn section(&self) -> Vec<[f64; 2]> {
        let turn = TAU / f64::from(self.sides);
        let chords = (CHORDS * turn / (0.5 * PI)).ceil() as u32;
        let mut points = Vec::new();
        for side in 0..self.sides {
            let to_edge = turn * (f64::from(side) + 0.5);
            for k in 0..=chords {
                let angle = to_edge + turn * (f64::from(k) / f64::from(chords) - 0.5);
                points.push([
                    self.edge_axis() * libm::cos(to_edge) + self.corner_radius * libm::cos(angle),
                    self.edge_axis() * libm::sin(to_edge) + self.corner_radius * libm::sin(angle),
                ]);
            }
            if self.dent > 0.0 {
                let to_side = turn * f64::from(side + 1);
                let out = self.edge_axis() * libm::cos(0.5 * turn) + self.corner_radius - self.dent;
                points.push([out * libm::cos(to_side), out * libm::sin(to_side)]);
            }
        }
        points
    }

    /// An ASCII STL file in mm.
    pub fn stl(&self) -> String {
        let section = self.section();
        let half = 0.5 * self.length;
        let mut text = StlText::new("prism");
        let mut facet = |corners| text.facet(corners);
        for (k, &[x, z]) in section.iter().enumerate() {
            let [u, w] = section[(k + 1) % section.len()];
            facet([[x, -half, z], [x, half, z], [u, half, w]]);
            facet([[x, -half, z], [u, half, w], [u, -half, w]]);
            facet([[0.0, half, 0.0], [u, half, w], [x, half, z]]);
            facet([[0.0, -half, 0.0], [x, -half, z], [u, -half, w]]);
        }
        text.finish()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::stl;

    #[test]
    fn its_file_is_a_closed_convex_mesh_of_its_size() {
        for sides in [3, 4, 5, 6, 8] {
            let prism = Prism {
                sides,
                corner_radius: 1.3e-3,
                flat: 7e-3,
                length: 20e-3,
                dent: 0.0,
            };
            let bytes = prism.stl().into_bytes();
            let mesh = stl::read(&mut std::io::Cursor::new(bytes), 1e-3).unwrap();
            assert!(mesh.is_convex());
            // polygon of the edges' axes, its sides thickened, a circle at the edges
            let n = f64::from(sides);
            let polygon = 0.25 * n * prism.flat.powi(2) / libm::tan(PI / n);
            let r = prism.corner_radius;
            let area = polygon + n * prism.flat * r + PI * r * r;
            let off = mesh.volume() / (area * prism.length) - 1.0;
            assert!(off < 0.0 && off > -2e-3, "{sides} sides: {off}");

            let hollow = Prism {
                dent: 1e-3,
                ..prism
            };
            let bytes = hollow.stl().into_bytes();
            let dented = stl::read(&mut std::io::Cursor::new(bytes), 1e-3).unwrap();
            assert!(!dented.is_convex());
            // a triangle less at each side
            let less = 0.5 * n * prism.flat * hollow.dent * prism.length;
            let off = (mesh.volume() - dented.volume()) / less - 1.0;
            assert!(off.abs() < 1e-3, "{sides} sides: {off}");
        }
    }
}
