//! A straight round rod with rounded rims, such as the body of a nozzle.

use super::shape::Nearness;
use crate::math::V3;

/// Steps of [`RoundedRod::meets`] at most. A plane before a round of radius `r` is found to be nearer than `gap` after about
/// `r / (2 gap)` steps: 1000 for the share below.
const MOST_STEPS: usize = 1024;

/// Distance up to which bodies meet, as a share of the rod's radius: 1.5 um of a nozzle 6 mm thick. Points of bodies that overlap come
/// nearer step by step and never quite to each other.
const MEETS: f64 = 5e-4;

/// A rod whose axis runs from the origin along +x, lengths in m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoundedRod {
    /// of the rod
    pub radius: f64,
    /// from face to face; infinite for a rod without end
    pub length: f64,
    /// of the rim of both faces, at most the radius and half the length
    pub edge_radius: f64,
}

impl RoundedRod {
    /// The point nearest to `p` of the rod without its round of `edge_radius`, and the unit vector away from the axis.
    fn kernel(&self, p: V3) -> (V3, V3) {
        let from_axis = libm::hypot(p.y, p.z);
        let out = match from_axis > 0.0 {
            true => V3::new(0.0, p.y / from_axis, p.z / from_axis),
            false => V3::z(),
        };
        let e = self.edge_radius;
        let x = p.x.max(e).min(self.length - e);
        let aside = from_axis.min(self.radius - e);
        (V3::new(x, 0.0, 0.0) + aside * out, out)
    }

    /// Exact signed distance of `p` (m) from the surface, negative inside. It grows by no more than the way.
    pub fn distance(&self, p: V3) -> f64 {
        let e = self.edge_radius;
        let side = self.radius - e - libm::hypot(p.y, p.z);
        let faces = (p.x - e).min(self.length - e - p.x);
        // (rounding sets the kernel's nearest point beside a point within the kernel)
        match side.min(faces) {
            within if within >= 0.0 => -within - e,
            _ => (p - self.kernel(p).0).norm() - e,
        }
    }

    /// The point of the rod nearest to `p`, m; `p` itself inside.
    fn nearest(&self, p: V3) -> V3 {
        let (kernel, _) = self.kernel(p);
        let beyond = (p - kernel).norm();
        match beyond > self.edge_radius {
            true => kernel + (p - kernel) * (self.edge_radius / beyond),
            false => p,
        }
    }

    /// A point, m, that the rod shares with a solid, which says how near it is to a point, looked for from `start`.
    ///
    /// Alternating projections lead to the nearest points of two convex bodies (Cheney and Goldstein 1959). Of a solid that is
    /// not convex they find a near place that depends on the start.
    pub fn meets(&self, start: V3, solid: impl Fn(V3) -> Nearness) -> Option<V3> {
        let mut p = self.nearest(start);
        for _ in 0..MOST_STEPS {
            let near = solid(p);
            if near.distance <= MEETS * self.radius {
                return Some(p);
            }
            let next = self.nearest(p - near.normal * near.distance);
            if next == p {
                return None;
            }
            p = next;
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::super::shape::Shape;
    use super::*;
    use proptest::prelude::*;

    const RODS: [RoundedRod; 4] = [
        RoundedRod {
            radius: 2e-3,
            length: 9e-3,
            edge_radius: 0.0,
        },
        RoundedRod {
            radius: 2e-3,
            length: 9e-3,
            edge_radius: 0.5e-3,
        },
        RoundedRod {
            radius: 2e-3,
            length: 9e-3,
            edge_radius: 2e-3,
        },
        RoundedRod {
            radius: 2e-3,
            length: f64::INFINITY,
            edge_radius: 0.3e-3,
        },
    ];

    fn somewhere() -> impl Strategy<Value = V3> {
        (-6e-3..15e-3f64, -6e-3..6e-3f64, -6e-3..6e-3f64).prop_map(|(x, y, z)| V3::new(x, y, z))
    }

    proptest! {
        #[test]
        fn distance_is_that_of_the_nearest_point(p in somewhere()) {
            for rod in RODS {
                let (distance, nearest) = (rod.distance(p), rod.nearest(p));
                prop_assert!(rod.distance(nearest) < 1e-15);
                prop_assert!(((p - nearest).norm() - distance.max(0.0)).abs() < 1e-15, "{rod:?} {p:?}");
            }
        }

        #[test]
        fn distance_grows_by_no_more_than_the_way(a in somewhere(), b in somewhere()) {
            for rod in RODS {
                let way = (a - b).norm();
                prop_assert!((rod.distance(a) - rod.distance(b)).abs() <= way + 1e-15);
            }
        }
    }

    #[test]
    fn distance_from_faces_side_and_rim() {
        let [sharp, round, capsule, endless] = RODS;
        for rod in RODS {
            assert!((rod.distance(V3::new(-1e-3, 0.0, 0.0)) - 1e-3).abs() < 1e-15);
            assert!((rod.distance(V3::new(4e-3, 3e-3, 0.0)) - 1e-3).abs() < 1e-15);
        }
        let rim = V3::new(0.0, 0.0, 2e-3);
        assert_eq!(sharp.distance(rim), 0.0);
        let open = |edge: f64| edge * (2.0_f64.sqrt() - 1.0);
        assert!((round.distance(rim) - open(0.5e-3)).abs() < 1e-15);
        assert!((capsule.distance(rim) - open(2e-3)).abs() < 1e-15);
        assert!((sharp.distance(V3::new(11e-3, 0.0, 0.0)) - 2e-3).abs() < 1e-15);
        assert!(endless.distance(V3::new(1.0, 0.0, 0.0)) < 0.0);
    }

    /// A box beside the rod, and corner first, each a little too far and a little too near.
    #[test]
    fn a_rod_meets_a_box_where_it_reaches_it() {
        let solid = Shape::RoundedBox {
            half_x: 6e-3,
            half_z: 4e-3,
            half_y: 5e-3,
            corner_radius: 1e-3,
        };
        let turned = std::f64::consts::FRAC_1_SQRT_2;
        // to the frame of a box that stands on its edge
        let to_edge = |p: V3| V3::new(turned * (p.x - p.z), p.y, turned * (p.x + p.z));
        let from_edge = |n: V3| V3::new(turned * (n.x + n.z), n.y, turned * (n.z - n.x));
        let corner = turned * (5e-3 + 3e-3) + 1e-3;
        for rod in RODS {
            for (gap, meets) in [(2e-6, false), (-2e-6, true)] {
                let aside = V3::new(0.0, 0.0, 4e-3 + rod.radius + gap);
                let start = |exit: V3| V3::new(0.0, exit.y, 0.0) - exit;
                let found = rod.meets(start(aside), |p| solid.nearness(p + aside));
                assert_eq!(found.is_some(), meets, "{rod:?} beside, {gap}");
                let ahead = V3::new(corner + gap, 1e-3, -turned * 2e-3);
                let found = rod.meets(start(ahead), |p| {
                    let near = solid.nearness(to_edge(p + ahead));
                    Nearness {
                        normal: from_edge(near.normal),
                        ..near
                    }
                });
                assert_eq!(found.is_some(), meets, "{rod:?} ahead, {gap}");
            }
        }
    }
}
