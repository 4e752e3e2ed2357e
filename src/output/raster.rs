//! Triangles to pixels: which triangle is nearest at each.

/// No triangle.
pub(crate) const NONE: u32 = u32::MAX;

/// For every pixel the nearest triangle and how near it is.
///
/// Nearness is any quantity that is linear over the picture and grows towards the viewer: inverse
/// depth in perspective, height in a parallel projection.
pub(crate) struct Raster {
    pub(crate) width: usize,
    pub(crate) height: usize,
    /// nearness per pixel, row by row from the top
    pub(crate) near: Vec<f32>,
    /// triangle per pixel, or [`NONE`]
    pub(crate) triangle: Vec<u32>,
}

impl Raster {
    pub(crate) fn new(width: usize, height: usize) -> Self {
        let pixels = width * height;
        Self {
            width,
            height,
            near: vec![f32::NEG_INFINITY; pixels],
            triangle: vec![NONE; pixels],
        }
    }

    /// Draws a triangle given by pixel coordinates (pixel centres at halves) and nearness. Both
    /// sides are drawn.
    pub(crate) fn draw(&mut self, [a, b, c]: [[f64; 3]; 3], id: u32) {
        let area = cross(a, b, c);
        if area == 0.0 || !area.is_finite() {
            return;
        }
        let columns = span([a[0], b[0], c[0]], self.width);
        for row in span([a[1], b[1], c[1]], self.height) {
            for column in columns.clone() {
                let p = [column as f64 + 0.5, row as f64 + 0.5, 0.0];
                let weights = [
                    cross(b, c, p) / area,
                    cross(c, a, p) / area,
                    cross(a, b, p) / area,
                ];
                // Edges belong to both neighbours: a pixel more is unseen, a hole is not.
                if weights.iter().any(|&weight| weight < 0.0) {
                    continue;
                }
                let near = (weights[0] * a[2] + weights[1] * b[2] + weights[2] * c[2]) as f32;
                let pixel = row * self.width + column;
                if near > self.near[pixel] {
                    self.near[pixel] = near;
                    self.triangle[pixel] = id;
                }
            }
        }
    }
}

/// Twice the area of a triangle in the picture.
fn cross(a: [f64; 3], b: [f64; 3], c: [f64; 3]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// Pixels whose centres lie between the least and largest coordinate, within the picture.
fn span(coordinates: [f64; 3], size: usize) -> std::ops::Range<usize> {
    let low = coordinates.iter().copied().fold(f64::INFINITY, f64::min);
    let high = coordinates
        .iter()
        .copied()
        .fold(f64::NEG_INFINITY, f64::max);
    // Casts saturate at 0.
    let first = (low - 0.5).ceil() as usize;
    let end = ((high - 0.5).floor() + 1.0) as usize;
    first..end.min(size)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn covered(raster: &Raster, id: u32) -> usize {
        raster
            .triangle
            .iter()
            .filter(|&&triangle| triangle == id)
            .count()
    }

    #[test]
    fn two_triangles_cover_their_square_without_holes() {
        let mut raster = Raster::new(20, 20);
        let [a, b, c, d] = [[2.0, 3.0], [12.0, 3.0], [12.0, 11.0], [2.0, 11.0]];
        let at = |p: [f64; 2]| [p[0], p[1], 1.0];
        raster.draw([at(a), at(b), at(c)], 0);
        raster.draw([at(c), at(a), at(d)], 1);
        assert_eq!(covered(&raster, 0) + covered(&raster, 1), 80);
    }

    #[test]
    fn the_nearer_triangle_is_seen_whatever_the_order() {
        let big = |near| {
            [
                [-50.0, -50.0, near],
                [150.0, -50.0, near],
                [-50.0, 150.0, near],
            ]
        };
        for order in [[0, 1], [1, 0]] {
            let mut raster = Raster::new(8, 8);
            for id in order {
                raster.draw(big(1.0 + f64::from(id)), id);
            }
            assert_eq!(covered(&raster, 1), 64);
        }
    }

    #[test]
    fn what_lies_outside_draws_nothing() {
        let mut raster = Raster::new(8, 8);
        raster.draw([[-9.0, -9.0, 1.0], [-2.0, -9.0, 1.0], [-2.0, -2.0, 1.0]], 0);
        raster.draw([[20.0, 1.0, 1.0], [30.0, 1.0, 1.0], [20.0, 5.0, 1.0]], 1);
        raster.draw([[f64::NAN, 1.0, 1.0], [3.0, 1.0, 1.0], [2.0, 5.0, 1.0]], 2);
        assert!(raster.triangle.iter().all(|&triangle| triangle == NONE));
    }
}
