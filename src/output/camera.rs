//! Where the picture is taken from, and where its light comes from.

use crate::math::V3;

/// A right-handed view frame: `right` and `up` span the picture, `back` points to the viewer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Frame {
    right: V3,
    up: V3,
    back: V3,
}

impl Frame {
    /// Looks along `-back` with `up` upright as far as possible.
    pub(crate) fn looking_from(back: V3, up: V3) -> Self {
        let back = back.normalize();
        let right = up.cross(&back).normalize();
        Self {
            right,
            up: back.cross(&right),
            back,
        }
    }

    /// Coordinates of `p - origin` along right, up and back.
    fn coordinates(&self, p: V3) -> V3 {
        V3::new(p.dot(&self.right), p.dot(&self.up), p.dot(&self.back))
    }
}

/// Perspective camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Camera {
    frame: Frame,
    /// position of the eye, m
    pub(crate) eye: V3,
    /// pixels per unit of tangent
    focal: f64,
    centre: (f64, f64),
}

impl Camera {
    /// Places a camera that looks from `back` at the middle of `points`.
    ///
    /// It stands as near as shows all points in `width` by `height` pixels, with a share `margin`
    /// free on each side. `view_angle` is that of the picture's width, rad.
    pub(crate) fn framing(
        points: &[V3],
        frame: Frame,
        view_angle: f64,
        (width, height): (f64, f64),
        margin: f64,
    ) -> Self {
        let focal = 0.5 * width / libm::tan(0.5 * view_angle);
        let (mut low, mut high) = (V3::repeat(f64::INFINITY), V3::repeat(f64::NEG_INFINITY));
        for &p in points {
            let c = frame.coordinates(p);
            low = low.inf(&c);
            high = high.sup(&c);
        }
        let middle = (low + high) * 0.5;
        let half_width = (0.5 - margin) * width / focal;
        let half_height = (0.5 - margin) * height / focal;
        // Each point must fit beside the line of sight at its own depth.
        let distance =
            points
                .iter()
                .map(|&p| frame.coordinates(p) - middle)
                .fold(0.0, |most, c| {
                    let needed = (c.x.abs() / half_width).max(c.y.abs() / half_height) + c.z;
                    f64::max(most, needed)
                });
        let target = frame.right * middle.x + frame.up * middle.y + frame.back * middle.z;
        let eye = target + frame.back * distance;
        Self {
            frame,
            eye,
            focal,
            centre: (0.5 * width, 0.5 * height),
        }
    }

    /// Pixel coordinates and inverse depth (1/m); `None` behind the eye.
    pub(crate) fn project(&self, p: V3) -> Option<[f64; 3]> {
        let c = self.frame.coordinates(p - self.eye);
        if c.z > -1e-6 {
            return None;
        }
        let near = -1.0 / c.z;
        let (x, y) = (c.x * near * self.focal, c.y * near * self.focal);
        Some([self.centre.0 + x, self.centre.1 - y, near])
    }

    /// Unit direction from the eye through a pixel.
    pub(crate) fn ray(&self, x: f64, y: f64) -> V3 {
        let (x, y) = (
            (x - self.centre.0) / self.focal,
            (self.centre.1 - y) / self.focal,
        );
        (self.frame.right * x + self.frame.up * y - self.frame.back).normalize()
    }

    /// The point that is seen at a pixel with a given inverse depth (1/m).
    pub(crate) fn unproject(&self, x: f64, y: f64, near: f64) -> V3 {
        let depth = 1.0 / near;
        let (x, y) = (
            (x - self.centre.0) / self.focal,
            (self.centre.1 - y) / self.focal,
        );
        self.eye + (self.frame.right * x + self.frame.up * y - self.frame.back) * depth
    }

    /// Pixels per metre across the view at an inverse depth (1/m).
    pub(crate) fn scale(&self, near: f64) -> f64 {
        self.focal * near
    }

    /// Direction given in the view's right, up and back.
    pub(crate) fn direction(&self, right: f64, up: f64, back: f64) -> V3 {
        (self.frame.right * right + self.frame.up * up + self.frame.back * back).normalize()
    }

    /// Upward in the picture.
    pub(crate) fn up(&self) -> V3 {
        self.frame.up
    }
}

/// Parallel light that casts shadows, seen as a camera without perspective.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Light {
    frame: Frame,
    low: V3,
    scale: f64,
    /// texels along each side of the shadow map
    pub(crate) texels: usize,
}

impl Light {
    /// Light from `towards` (a direction to the light) on everything within `points`.
    pub(crate) fn on(points: &[V3], towards: V3, texels: usize) -> Self {
        let frame = Frame::looking_from(towards, V3::new(0.31, 0.8, 0.52));
        let (mut low, mut high) = (V3::repeat(f64::INFINITY), V3::repeat(f64::NEG_INFINITY));
        for &p in points {
            let c = frame.coordinates(p);
            low = low.inf(&c);
            high = high.sup(&c);
        }
        let extent = (high - low).xy().max().max(1e-9);
        Self {
            frame,
            low,
            scale: texels as f64 / extent,
            texels,
        }
    }

    /// Direction to the light.
    pub(crate) fn towards(&self) -> V3 {
        self.frame.back
    }

    /// Length of a texel, m.
    pub(crate) fn texel(&self) -> f64 {
        1.0 / self.scale
    }

    /// Texel coordinates and nearness to the light, m.
    pub(crate) fn project(&self, p: V3) -> [f64; 3] {
        let c = self.frame.coordinates(p) - self.low;
        [c.x * self.scale, c.y * self.scale, c.z]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera(points: &[V3]) -> Camera {
        let frame = Frame::looking_from(V3::new(1.0, 0.5, 0.7), V3::y());
        Camera::framing(points, frame, 0.45, (1200.0, 900.0), 0.05)
    }

    #[test]
    fn everything_framed_is_in_the_picture_and_reaches_its_margin() {
        let corner = |k: u32| {
            let sign = |bit: u32| if k >> bit & 1 == 0 { -1.0 } else { 1.0 };
            V3::new(0.006 * sign(0), 0.01 * sign(1), 0.015 * sign(2))
        };
        let points: Vec<V3> = (0..8).map(corner).collect();
        let camera = camera(&points);
        let seen: Vec<[f64; 3]> = points.iter().map(|&p| camera.project(p).unwrap()).collect();
        let fits = |[x, y, _]: [f64; 3]| (59.9..1140.1).contains(&x) && (44.9..855.1).contains(&y);
        assert!(seen.iter().all(|&p| fits(p)), "{seen:?}");
        let touches = |[x, y, _]: &[f64; 3]| (x - 600.0).abs() > 539.0 || (y - 450.0).abs() > 404.0;
        assert!(seen.iter().any(touches), "{seen:?}");
    }

    #[test]
    fn rays_pass_through_what_is_seen_at_their_pixel() {
        let camera = camera(&[V3::repeat(-0.01), V3::repeat(0.01)]);
        let p = V3::new(0.003, -0.004, 0.002);
        let [x, y, near] = camera.project(p).unwrap();
        assert!((camera.ray(x, y) - (p - camera.eye).normalize()).norm() < 1e-12);
        assert!((camera.unproject(x, y, near) - p).norm() < 1e-15);
        assert_eq!(
            camera.project(camera.eye + camera.direction(0.0, 0.0, 1.0)),
            None
        );
    }
}
