//! Triangles to pixels: which triangle is nearest at each.

use std::ops::Range;

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
        let sides = [(b, c), (c, a), (a, b)];
        for row in span([a[1], b[1], c[1]], self.height) {
            let y = row as f64 + 0.5;
            for column in between(sides, area, y, columns.clone()) {
                let p = [column as f64 + 0.5, y, 0.0];
                let weights = sides.map(|(from, to)| cross(from, to, p) / area);
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

/// Of these columns those that a triangle may cover in the row of centres at `y`, and up to one more at either end.
///
/// A long triangle that lies askew covers few of the pixels between its least and largest coordinates.
fn between(
    sides: [([f64; 3], [f64; 3]); 3],
    area: f64,
    y: f64,
    columns: Range<usize>,
) -> Range<usize> {
    let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
    for (from, to) in sides {
        // what the weight of a pixel grows by from one column to the next
        let slope = (from[1] - to[1]) / area;
        let crossing = from[0] + (to[0] - from[0]) * (y - from[1]) / (to[1] - from[1]);
        // (a side along the row crosses it nowhere, or where rounding says)
        if slope > 0.0 && crossing.is_finite() {
            low = low.max(crossing);
        } else if slope < 0.0 && crossing.is_finite() {
            high = high.min(crossing);
        }
    }
    // casts saturate
    let first = ((low - 1.5).ceil() as usize).max(columns.start);
    let end = ((high + 0.5).floor() as usize).saturating_add(1);
    first..end.min(columns.end)
}

/// Pixels whose centres lie between the least and largest coordinate, within the picture.
fn span(coordinates: [f64; 3], size: usize) -> Range<usize> {
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

    /// Every pixel of the picture is asked, where [`Raster::draw`] asks those of a row that may be covered.
    #[test]
    fn rows_leave_no_pixel_out() {
        let (width, height) = (40, 30);
        let place = |k: u32, seed: f64| (f64::from(k) * seed).fract();
        for k in 0..3000 {
            // on and off the picture, slivers, and corners at pixel centres
            let corner = |x: f64, y: f64| {
                let p = [80.0 * place(k, x) - 20.0, 60.0 * place(k, y) - 15.0, 1.0];
                if k % 3 == 0 {
                    p.map(|c| c.floor() + 0.5)
                } else {
                    p
                }
            };
            let [a, b] = [corner(0.618, 0.271), corner(0.377, 0.733)];
            let mut c = corner(0.149, 0.857);
            if k % 5 == 0 {
                c = [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]) + 0.02, 1.0];
            }
            let mut raster = Raster::new(width, height);
            raster.draw([a, b, c], 0);
            let area = cross(a, b, c);
            for (pixel, drawn) in raster.triangle.iter().enumerate() {
                let (column, row) = (pixel % width, pixel / width);
                let p = [column as f64 + 0.5, row as f64 + 0.5, 0.0];
                let covers = [(b, c), (c, a), (a, b)]
                    .iter()
                    .all(|&(from, to)| cross(from, to, p) / area >= 0.0);
                assert_eq!(*drawn != NONE, covers, "{k}: {a:?} {b:?} {c:?} at {p:?}");
            }
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
