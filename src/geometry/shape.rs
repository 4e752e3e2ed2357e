//! The core as smooth contact sees it: signed distance and its gradient.
//!
//! An implicit step wants a distance that is C1, or Newton rattles between the facets of a mesh.
//! Outside any solid the distance is C1 wherever the closest point is unique, so for convex cores
//! everywhere outside. The two shapes a scene can name have it in closed form, without the
//! chords of [`super::generate`]. A polyhedron's is C1 outside as well, only with the corner
//! arcs made of facets and edges. The wire's centreline stays its radius away from the surface,
//! where that holds; inside, the distance has a ridge on the medial axis and one side is taken.

use super::surface::{Surface, box_distance};
use crate::math::V3;
use std::sync::Arc;

/// A solid core in its own frame, centred on the origin, axis y. Lengths in m.
#[derive(Clone, Debug)]
pub enum Shape {
    /// Rounded rectangle in x-z, extruded along y between flat ends.
    RoundedBox {
        /// half the width along x, m
        half_x: f64,
        /// half the height along z, m
        half_z: f64,
        /// half the length along y, m
        half_y: f64,
        /// radius of the four edges parallel to y, m; 0 (sharp) to the smaller of `half_x`,
        /// `half_z`
        corner_radius: f64,
    },
    /// Circular cylinder about y between flat ends.
    Cylinder {
        /// radius, m
        radius: f64,
        /// half the length along y, m
        half_y: f64,
    },
    /// A triangle mesh, wherever it stands.
    Mesh(Arc<Surface>),
}

/// How far a point is from the core, and which way is out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearness {
    /// signed distance from the surface, m; negative inside
    pub distance: f64,
    /// unit gradient of the distance
    pub normal: V3,
}

/// Signed distance from the outline in x-z with its unit gradient, before extrusion.
#[derive(Clone, Copy)]
pub(super) struct Outline {
    /// m; negative inside
    pub(super) distance: f64,
    /// unit gradient
    pub(super) x: f64,
    pub(super) z: f64,
}

impl Shape {
    /// Exact signed distance of `p` (core frame, m) and its gradient.
    ///
    /// On the medial axis, where the gradient jumps, one of the two sides is returned; on a sharp
    /// edge one of its faces.
    #[inline]
    pub fn nearness(&self, p: V3) -> Nearness {
        match self {
            &Self::RoundedBox {
                half_x,
                half_z,
                half_y,
                corner_radius,
            } => extrude(
                rounded_rectangle(half_x, half_z, corner_radius, p),
                half_y,
                p,
            ),
            &Self::Cylinder { radius, half_y } => extrude(circle(radius, p), half_y, p),
            Self::Mesh(surface) => {
                let nearest = surface.nearest(p);
                Nearness {
                    distance: nearest.distance,
                    normal: nearest.normal,
                }
            }
        }
    }

    /// Whether the signed distance of `p` (core frame, m) is below `reach`, m.
    #[inline]
    pub fn is_within(&self, p: V3, reach: f64) -> bool {
        match self {
            Self::Mesh(surface) => surface.is_within(p, reach),
            Self::RoundedBox { .. } | Self::Cylinder { .. } => self.nearness(p).distance < reach,
        }
    }

    /// [`Self::nearness`] and, on a mesh, the triangle that is nearest; the search begins at the triangle `guess`.
    #[inline]
    pub(crate) fn nearness_from(&self, p: V3, guess: u32) -> (Nearness, u32) {
        match self {
            Self::Mesh(surface) => {
                let (nearest, triangle) = surface.nearest_from(p, guess);
                let near = Nearness {
                    distance: nearest.distance,
                    normal: nearest.normal,
                };
                (near, triangle)
            }
            Self::RoundedBox { .. } | Self::Cylinder { .. } => (self.nearness(p), guess),
        }
    }

    /// The surface, where it is concave: wire may touch several of its walls at a time.
    #[inline]
    pub(crate) fn with_walls(&self) -> Option<&Surface> {
        match self {
            Self::Mesh(surface) if !surface.is_convex() => Some(surface),
            _ => None,
        }
    }

    /// Signed distance of `p` (core frame, m) from the outline of the core in x-z. A mesh counts as the rectangle that it
    /// fits in.
    #[inline]
    pub(super) fn outline(&self, p: V3) -> Outline {
        match self {
            &Self::RoundedBox {
                half_x,
                half_z,
                corner_radius,
                ..
            } => rounded_rectangle(half_x, half_z, corner_radius, p),
            &Self::Cylinder { radius, .. } => circle(radius, p),
            Self::Mesh(surface) => {
                let (low, high) = surface.bounds();
                let (half_x, half_z) = (high.x.max(-low.x), high.z.max(-low.z));
                rounded_rectangle(half_x, half_z, 0.0, p)
            }
        }
    }

    /// A lower bound of the signed distance of `p`, m: that of the bounding box. Negative inside
    /// the box.
    #[inline]
    pub fn lower_bound(&self, p: V3) -> f64 {
        // The solid is a part of its box, so its signed distance is nowhere smaller.
        let beyond = match self {
            &Self::RoundedBox {
                half_x,
                half_z,
                half_y,
                ..
            } => p.abs() - V3::new(half_x, half_y, half_z),
            &Self::Cylinder { radius, half_y } => p.abs() - V3::new(radius, half_y, radius),
            Self::Mesh(surface) => return surface.lower_bound(p),
        };
        box_distance(beyond)
    }
}

/// The rectangle shrunk by the corner radius, grown again as a disc would roll round it.
#[inline]
fn rounded_rectangle(half_x: f64, half_z: f64, corner_radius: f64, p: V3) -> Outline {
    let x = p.x.abs() - (half_x - corner_radius);
    let z = p.z.abs() - (half_z - corner_radius);
    let (reach, x, z) = if x > 0.0 && z > 0.0 {
        let reach = (x * x + z * z).sqrt();
        // Squares vanish at the centre of a rectangle that is all corner, a circle.
        if reach > 0.0 {
            (reach, x / reach, z / reach)
        } else {
            (0.0, 1.0, 0.0)
        }
    } else if x > z {
        (x, 1.0, 0.0)
    } else {
        (z, 0.0, 1.0)
    };
    Outline {
        distance: reach - corner_radius,
        x: x.copysign(p.x),
        z: z.copysign(p.z),
    }
}

#[inline]
fn circle(radius: f64, p: V3) -> Outline {
    let reach = (p.x * p.x + p.z * p.z).sqrt();
    let (x, z) = if reach > 0.0 {
        (p.x / reach, p.z / reach)
    } else {
        (1.0, 0.0)
    };
    Outline {
        distance: reach - radius,
        x,
        z,
    }
}

/// Distance, m, from what is bounded by two surfaces at right angles that are `a` and `b` (m) away, and how much of each is in its
/// gradient: beyond both, both count, else the larger.
#[inline]
pub(super) fn beyond_both(a: f64, b: f64) -> (f64, f64, f64) {
    if a > 0.0 && b > 0.0 {
        let distance = (a * a + b * b).sqrt();
        (distance, a / distance, b / distance)
    } else if a > b {
        (a, 1.0, 0.0)
    } else {
        (b, 0.0, 1.0)
    }
}

/// Distance from the prism over an outline.
#[inline]
fn extrude(outline: Outline, half_y: f64, p: V3) -> Nearness {
    let (distance, across, along) = beyond_both(outline.distance, p.y.abs() - half_y);
    Nearness {
        distance,
        normal: V3::new(
            across * outline.x,
            f64::copysign(along, p.y),
            across * outline.z,
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Flanges, generate};
    use proptest::prelude::*;

    const BOX: Shape = Shape::RoundedBox {
        half_x: 6e-3,
        half_z: 15e-3,
        half_y: 20e-3,
        corner_radius: 2e-3,
    };
    const SHARP: Shape = Shape::RoundedBox {
        half_x: 6e-3,
        half_z: 15e-3,
        half_y: 20e-3,
        corner_radius: 0.0,
    };
    const STADIUM: Shape = Shape::RoundedBox {
        half_x: 6e-3,
        half_z: 15e-3,
        half_y: 20e-3,
        corner_radius: 6e-3,
    };
    const ROUND: Shape = Shape::Cylinder {
        radius: 10e-3,
        half_y: 20e-3,
    };
    const CHORDS: usize = 64;

    fn mesh_of(shape: &Shape) -> Shape {
        let mesh = match *shape {
            Shape::RoundedBox {
                half_x,
                half_z,
                half_y,
                corner_radius,
            } => generate::rounded_box(
                2.0 * half_x,
                2.0 * half_z,
                2.0 * half_y,
                corner_radius,
                CHORDS,
            ),
            Shape::Cylinder { radius, half_y } => {
                generate::cylinder(radius, 2.0 * half_y, 4 * CHORDS)
            }
            Shape::Mesh(_) => unreachable!("only the shapes with a formula are meshed"),
        };
        Shape::Mesh(Arc::new(Surface::new(mesh.unwrap())))
    }

    fn sagitta(shape: &Shape) -> f64 {
        let radius = match *shape {
            Shape::RoundedBox { corner_radius, .. } => corner_radius,
            Shape::Cylinder { radius, .. } => radius,
            Shape::Mesh(_) => 0.0,
        };
        generate::sagitta(radius, 4 * CHORDS)
    }

    /// Central differences of the distance with step `h`.
    fn slope(shape: &Shape, p: V3, h: f64) -> V3 {
        V3::from_fn(|axis, _| {
            let mut step = V3::zeros();
            step[axis] = h;
            (shape.nearness(p + step).distance - shape.nearness(p - step).distance) / (2.0 * h)
        })
    }

    fn somewhere() -> impl Strategy<Value = V3> {
        (-25e-3..25e-3f64, -30e-3..30e-3f64, -25e-3..25e-3f64)
            .prop_map(|(x, y, z)| V3::new(x, y, z))
    }

    proptest! {
        #[test]
        fn normal_is_the_gradient(p in somewhere()) {
            let h = 1e-8;
            for shape in [BOX, SHARP, STADIUM, ROUND, mesh_of(&BOX)] {
                let at = shape.nearness(p);
                prop_assert!((at.normal.norm() - 1.0).abs() < 1e-12);
                // The second derivative is at most 1/distance and may jump. Inside, a ridge within
                // a step shows in the normals, and nothing is asked there.
                let step = at.normal * 2.0 * h;
                let ridge = at.distance < 0.0 && [V3::x(), V3::y(), V3::z()].iter().any(|axis| {
                    let other = |s: f64| shape.nearness(p + axis * (s * h)).normal;
                    (other(1.0) - other(-1.0)).norm() > 1e-3
                });
                if at.distance.abs() > 1e-5 && !ridge {
                    let tolerance = 4.0 * h / at.distance.abs() + 1e-7;
                    let error = (slope(&shape, p, h) - at.normal).norm();
                    prop_assert!(error < tolerance, "{shape:?} {p} {error}");
                }
                if at.distance > 0.0 {
                    let farther = shape.nearness(p + step).distance;
                    prop_assert!((farther - at.distance - 2.0 * h).abs() < 1e-14);
                }
            }
        }

        #[test]
        fn outside_the_normal_turns_no_faster_than_the_distance_allows(
            p in somewhere(),
            way in (-1.0..1.0f64, -1.0..1.0f64, -1.0..1.0f64),
        ) {
            // C1: over a step h the normal turns by at most h/distance, also across regions.
            let step = V3::new(way.0, way.1, way.2) * 1e-4;
            for shape in [BOX, SHARP, STADIUM, ROUND, mesh_of(&BOX)] {
                let (a, b) = (shape.nearness(p), shape.nearness(p + step));
                let nearer = a.distance.min(b.distance);
                if nearer > 0.0 {
                    prop_assert!((a.normal - b.normal).norm() <= step.norm() / nearer + 1e-9);
                }
            }
        }

        #[test]
        fn agrees_with_a_fine_mesh(p in somewhere()) {
            for shape in [BOX, SHARP, STADIUM, ROUND] {
                let (exact, mesh) = (shape.nearness(p), mesh_of(&shape).nearness(p));
                // The mesh lies within the solid, by the sagitta at most.
                let under = mesh.distance - exact.distance;
                prop_assert!(under > -1e-15 && under <= sagitta(&shape) + 1e-15, "{under}");
                if exact.distance > 0.2e-3 {
                    // half a chord, seen from the corner's axis
                    let turn = 0.25 * std::f64::consts::PI / CHORDS as f64;
                    prop_assert!((exact.normal - mesh.normal).norm() < 1.01 * turn + 1e-9);
                }
            }
        }

        #[test]
        fn within_reach_means_a_distance_below_it(p in somewhere(), reach in -5e-3..25e-3f64) {
            let bobbin = Flanges { core: BOX, half_inner: 5e-3, height: 4e-3, thickness: 2e-3, edge_radius: 0.5e-3 };
            let bobbin = generate::flanged(&bobbin, 8, 4).unwrap();
            for shape in [BOX, ROUND, mesh_of(&BOX), Shape::Mesh(Arc::new(Surface::new(bobbin)))] {
                let distance = shape.nearness(p).distance;
                if (distance - reach).abs() > 1e-12 {
                    prop_assert_eq!(shape.is_within(p, reach), distance < reach);
                }
            }
        }

        #[test]
        fn bound_is_below_the_distance(p in somewhere()) {
            for shape in [BOX, SHARP, STADIUM, ROUND, mesh_of(&BOX)] {
                let (bound, distance) = (shape.lower_bound(p), shape.nearness(p).distance);
                prop_assert!(bound <= distance + 1e-15);
                prop_assert!(bound < 0.0 || distance >= 0.0);
            }
            // A sharp box is its own bounding box.
            prop_assert!((SHARP.lower_bound(p) - SHARP.nearness(p).distance).abs() < 1e-15);
        }
    }

    #[test]
    fn corner_arc_is_round() {
        for quarter in 0..4 {
            let (sx, sz) = (
                [1.0, -1.0, -1.0, 1.0][quarter],
                [1.0, 1.0, -1.0, -1.0][quarter],
            );
            for i in 0..=20 {
                let angle = 0.5 * std::f64::consts::PI * f64::from(i) / 20.0;
                let out = V3::new(sx * libm::cos(angle), 0.0, sz * libm::sin(angle));
                let centre = V3::new(sx * 4e-3, 3e-3, sz * 13e-3);
                for distance in [-1.5e-3, -1e-9, 0.0, 1e-9, 0.35e-3, 5e-3] {
                    let at = BOX.nearness(centre + out * (2e-3 + distance));
                    assert!((at.distance - distance).abs() < 1e-17 + 1e-15 * distance.abs());
                    assert!((at.normal - out).norm() < 1e-12, "{at:?} {out}");
                }
            }
        }
    }

    #[test]
    fn on_the_surface() {
        for (p, normal) in [
            (V3::new(6e-3, 0.0, 1e-3), V3::x()),
            (V3::new(-6e-3, 1e-3, -13e-3), -V3::x()),
            (V3::new(4e-3, 0.0, -15e-3), -V3::z()),
            (V3::new(1e-3, 20e-3, 14e-3), V3::y()),
            (V3::new(1e-3, -20e-3, 0.0), -V3::y()),
        ] {
            for shape in [BOX, SHARP] {
                let at = shape.nearness(p);
                assert!(at.distance.abs() < 1e-17, "{at:?}");
                assert_eq!(at.normal, normal);
            }
        }
        let at = ROUND.nearness(V3::new(6e-3, 0.0, -8e-3));
        assert!(at.distance.abs() < 1e-17);
        assert!((at.normal - V3::new(0.6, 0.0, -0.8)).norm() < 1e-15);
    }

    #[test]
    fn sharp_edges_and_corners() {
        let corner = V3::new(6e-3, 20e-3, 15e-3);
        let at = SHARP.nearness(corner);
        assert_eq!(at.distance, 0.0);
        assert!((at.normal.norm() - 1.0).abs() < 1e-15);
        let out = V3::new(2.0, 3.0, 6.0) / 7.0;
        for distance in [1e-12, 1e-6, 1e-3, 1.0] {
            let at = SHARP.nearness(corner + out * distance);
            assert!((at.distance - distance).abs() < 1e-17 + 1e-15 * distance);
            assert!((at.normal - out).norm() < 1e-17 / distance + 1e-12);
        }
    }

    #[test]
    fn far_points_and_the_middle() {
        for shape in [BOX, SHARP, STADIUM, ROUND, mesh_of(&BOX)] {
            let p = V3::new(300.0, -400.0, 1200.0);
            let at = shape.nearness(p);
            assert!((at.distance - 1300.0).abs() < 0.03);
            assert!((at.normal - p / 1300.0).norm() < 1e-4);
            assert!((at.distance - shape.lower_bound(p)).abs() < 0.01);
            let middle = shape.nearness(V3::zeros());
            assert!(middle.distance < -5e-3 && (middle.normal.norm() - 1.0).abs() < 1e-12);
        }
        // a box that is all corner, at the last bit from its axis
        let all_corner = Shape::RoundedBox {
            half_x: 5e-3,
            half_z: 5e-3,
            half_y: 20e-3,
            corner_radius: 5e-3,
        };
        for tiny in [0.0, 1e-300, 1e-200, 1e-18] {
            let at = all_corner.nearness(V3::new(tiny, 0.0, -tiny));
            assert!((at.distance + 5e-3).abs() < 1e-15 && (at.normal.norm() - 1.0).abs() < 1e-12);
        }
    }
}
