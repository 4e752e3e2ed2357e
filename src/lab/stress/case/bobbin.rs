//! A concave core: a barrel between two flanges with rounded rims, revolved about y.

use super::stl_text::StlText;
use std::f64::consts::{PI, TAU};

/// Flat sides of the barrel. Chosen: its chords lie 2e-3 of the radius inside.
const SIDES: usize = 48;
/// Chords of the half circle round a rim.
const CHORDS: usize = 4;

/// A bobbin about y.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bobbin {
    /// radius between the flanges, m
    pub barrel: f64,
    /// radius of the flanges, m
    pub flange: f64,
    /// distance of the flanges, m
    pub width: f64,
    /// of either flange, twice the radius of its rim, m
    pub thickness: f64,
}

impl Bobbin {
    /// Largest distance from the axis, m.
    pub fn turning_radius(&self) -> f64 {
        self.flange
    }

    /// Along y, m.
    pub fn length(&self) -> f64 {
        self.width + 2.0 * self.thickness
    }

    /// Places along y and radii of the outline, from one end of the axis to the other, m.
    fn outline(&self) -> Vec<[f64; 2]> {
        let (inner, rim) = (0.5 * self.width, 0.5 * self.thickness);
        let round = |middle: f64| {
            (0..=CHORDS).map(move |k| {
                let angle = PI * k as f64 / CHORDS as f64;
                let out = self.flange - rim + rim * libm::sin(angle);
                [middle - rim * libm::cos(angle), out]
            })
        };
        let end = inner + self.thickness;
        let mut points = vec![[-end, 0.0]];
        points.extend(round(-inner - rim));
        points.extend([[-inner, self.barrel], [inner, self.barrel]]);
        points.extend(round(inner + rim));
        points.push([end, 0.0]);
        points
    }

    /// An ASCII STL file in mm.
    pub fn stl(&self) -> String {
        let outline = self.outline();
        let point = |[y, r]: [f64; 2], side: usize| {
            let angle = TAU * (side % SIDES) as f64 / SIDES as f64;
            [r * libm::cos(angle), y, r * libm::sin(angle)]
        };
        let mut text = StlText::new("bobbin");
        for side in 0..SIDES {
            for pair in outline.windows(2) {
                let [a, b] = [point(pair[0], side), point(pair[1], side)];
                let [c, d] = [point(pair[1], side + 1), point(pair[0], side + 1)];
                // (the ends of the outline lie on the axis)
                if pair[1][1] > 0.0 {
                    text.facet([a, b, c]);
                }
                if pair[0][1] > 0.0 {
                    text.facet([a, c, d]);
                }
            }
        }
        text.finish()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::stl;

    #[test]
    fn its_file_is_a_closed_concave_mesh_of_its_size() {
        let bobbin = Bobbin {
            barrel: 6e-3,
            flange: 9e-3,
            width: 8e-3,
            thickness: 1.5e-3,
        };
        let bytes = bobbin.stl().into_bytes();
        let mesh = stl::read(&mut std::io::Cursor::new(bytes), 1e-3).unwrap();
        assert!(!mesh.is_convex());
        let (r, rim) = (bobbin.flange, 0.5 * bobbin.thickness);
        let barrel = PI * bobbin.barrel.powi(2) * bobbin.width;
        // disc, and half a ring round it by Pappus
        let disc = PI * (r - rim).powi(2) * bobbin.thickness;
        let half = 0.5 * PI * rim * rim * TAU * (r - rim + 4.0 * rim / (3.0 * PI));
        let off = mesh.volume() / (barrel + 2.0 * (disc + half)) - 1.0;
        assert!(off < 0.0 && off > -2e-2, "{off}");
    }
}
