//! Two flanges beside what wire is wound on: plates whose rim stands the same height above it all round.
//!
//! Each plate is convex, so its distance is C1 outside. Wire in the corner between core and flange touches both,
//! and each of the two distances stays smooth there; that of the union has a ridge.

use super::shape::{Nearness, Outline, Shape, beyond_both};
use crate::math::V3;

/// A pair of flanges, the same on both sides of y = 0. Core frame, lengths in m.
#[derive(Clone, Debug)]
pub struct Flanges {
    /// what they stand above
    pub core: Shape,
    /// half the distance between their inner faces, m
    pub half_inner: f64,
    /// how far the rim stands above the core, m
    pub height: f64,
    /// along y, m
    pub thickness: f64,
    /// radius of the edges of the rim, m, at most half the thickness and the height
    pub edge_radius: f64,
}

impl Flanges {
    /// Way along y from the middle `p` of wire of this `radius` to the inner face beside it, all in m, negative towards -y; none where all
    /// of the wire lies above the rim.
    pub fn beside(&self, p: V3, radius: f64) -> Option<f64> {
        let below = self.core.outline(p).distance - radius < self.height;
        below.then(|| (self.half_inner - p.y.abs()).copysign(p.y))
    }

    /// Exact signed distance of `p` (m) from the flange nearer to it, and its gradient.
    ///
    /// Inside a plate, where the gradient jumps on the medial axis, one of the two sides is returned.
    #[inline]
    pub fn nearness(&self, p: V3) -> Nearness {
        let outline = self.core.outline(p);
        let middle = self.half_inner + 0.5 * self.thickness;
        let from_middle = p.y.abs() - middle;
        // beyond the rim and beyond a face, each counted from where the edge begins to be round
        let rim = outline.distance - self.height + self.edge_radius;
        let face = from_middle.abs() - 0.5 * self.thickness + self.edge_radius;
        let (reach, across, along) = beyond_both(rim, face);
        let Outline { x, z, .. } = outline;
        let along = along.copysign(p.y * from_middle);
        Nearness {
            distance: reach - self.edge_radius,
            normal: V3::new(across * x, along, across * z),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::generate;
    use super::super::surface::Surface;
    use super::*;
    use proptest::prelude::*;

    const BOX: Shape = Shape::RoundedBox {
        half_x: 6e-3,
        half_z: 15e-3,
        half_y: 7e-3,
        corner_radius: 2e-3,
    };
    const ROUND: Shape = Shape::Cylinder {
        radius: 8e-3,
        half_y: 7e-3,
    };

    fn flanges(core: Shape, edge_radius: f64) -> Flanges {
        Flanges {
            core,
            half_inner: 5e-3,
            height: 4e-3,
            thickness: 2e-3,
            edge_radius,
        }
    }

    fn somewhere() -> impl Strategy<Value = V3> {
        (-25e-3..25e-3f64, -10e-3..10e-3f64, -25e-3..25e-3f64)
            .prop_map(|(x, y, z)| V3::new(x, y, z))
    }

    proptest! {
        #[test]
        fn normal_is_the_gradient_of_the_distance(p in somewhere()) {
            let h = 1e-8;
            for flanges in [flanges(BOX, 0.5e-3), flanges(BOX, 0.0), flanges(ROUND, 1e-3)] {
                let at = flanges.nearness(p);
                // inside there are ridges, and between the plates the nearer one changes
                prop_assume!(at.distance > 1e-6 && p.y.abs() > 1e-6);
                prop_assert!((at.normal.norm() - 1.0).abs() < 1e-12);
                for axis in 0..3 {
                    let mut step = V3::zeros();
                    step[axis] = h;
                    let ahead = flanges.nearness(p + step).distance;
                    let slope = (ahead - flanges.nearness(p - step).distance) / (2.0 * h);
                    prop_assert!((slope - at.normal[axis]).abs() < 1e-4, "{p:?} {slope} {at:?}");
                }
            }
        }

        #[test]
        fn distance_is_that_of_the_mesh(p in somewhere()) {
            for (core, most) in [(BOX, 2e-6), (ROUND, 5e-6)] {
                let flanges = flanges(core.clone(), 0.5e-3);
                let surface = Surface::new(generate::flanged(&flanges, 48, 24).unwrap());
                let union = core.nearness(p).distance.min(flanges.nearness(p).distance);
                // outside, where the distance of a union is the least of theirs
                prop_assume!(union > 1e-5);
                let mesh = surface.nearest(p).distance;
                prop_assert!((mesh - union).abs() < most, "{p:?} {mesh} {union}");
            }
        }
    }

    /// Plates beside a mesh are those of the box or cylinder that it is a mesh of.
    #[test]
    fn plates_beside_a_mesh_are_flanges() {
        let far = |mesh: &str| -> Surface {
            let core = match mesh {
                "box" => generate::rounded_box(12e-3, 30e-3, 20e-3, 2e-3, 48),
                _ => generate::cylinder(8e-3, 20e-3, 192),
            };
            let plates = generate::Plates {
                half_inner: 5e-3,
                height: 4e-3,
                thickness: 2e-3,
                edge_radius: 0.5e-3,
            };
            let joined = generate::with_plates(&core.unwrap(), &plates, 48, 24);
            Surface::new(joined.unwrap())
        };
        for (core, mesh, most) in [(BOX, "box", 2e-6), (ROUND, "cylinder", 5e-6)] {
            let (flanges, surface) = (flanges(core.clone(), 0.5e-3), far(mesh));
            let mut seen = 0;
            for k in 0..2000 {
                let k = f64::from(k);
                let within = |seed: f64, half: f64| half * (2.0 * (k * seed).fract() - 1.0);
                let p = V3::new(
                    within(0.618, 20e-3),
                    within(0.2713, 9e-3),
                    within(0.3819, 22e-3),
                );
                // (the mesh goes on beyond the plates)
                let core = core.outline(p).distance;
                let union = core.min(flanges.nearness(p).distance);
                if union < 1e-5 {
                    continue;
                }
                seen += 1;
                let off = (surface.nearest(p).distance - union).abs();
                assert!(off < most, "{p:?} {off}");
            }
            assert!(seen > 500, "{seen}");
        }
    }

    #[test]
    fn the_inner_face_stands_where_it_is_said() {
        let flanges = flanges(BOX, 0.3e-3);
        let near = flanges.nearness(V3::new(7e-3, 4.65e-3, 0.0));
        assert!((near.distance - 0.35e-3).abs() < 1e-15);
        assert_eq!(near.normal, V3::new(0.0, -1.0, 0.0));
        let near = flanges.nearness(V3::new(7e-3, -4.65e-3, 0.0));
        assert_eq!(near.normal, V3::new(0.0, 1.0, 0.0));
        let above = flanges.nearness(V3::new(11e-3, 6e-3, 0.0));
        assert!((above.distance - 1e-3).abs() < 1e-15, "{above:?}");
        assert_eq!(above.normal, V3::new(1.0, 0.0, 0.0));
    }
}
