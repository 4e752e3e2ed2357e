//! Walls of a concave surface: what wire in a corner touches at once, each with a distance of its own.
//!
//! The distance from a concave solid has a ridge over every concave edge, and wire in a corner or a groove lies on that
//! ridge. Newton's method sees one side of it or the other and is thrown back and forth. So the surface is followed wall
//! by wall: from a triangle downhill, never across a concave edge that is no seam. The foot ends where the distance is
//! least on that wall, and moves smoothly with the point; a foot on the border of its wall comes off it smoothly too.
//!
//! A surface without such edges has one wall, with the distance of [`super::Bvh::nearest_from`].

use super::elements::Facet;
use super::feature::{Closest, Region};
use super::mesh::TriMesh;
use crate::math::V3;

/// The foot of a point on a wall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WallFoot {
    /// signed distance from the wall, m
    pub distance: f64,
    /// unit gradient of the distance
    pub normal: V3,
    /// the triangle that the foot is on, the first of several
    pub triangle: u32,
    /// the foot, m
    pub point: V3,
}

impl TriMesh {
    /// Foot of `p` (core frame, m) on the wall that triangle `start` belongs to; none where the wall is seen from behind.
    pub(crate) fn wall_foot(&self, p: V3, start: u32) -> Option<WallFoot> {
        let mut triangle = start;
        let mut closest = self.closest(triangle, p);
        while let Some((next, found)) = self.downhill(triangle, &closest, p) {
            (triangle, closest) = (next, found);
        }
        let facet = &self.facets[triangle as usize];
        let (distance, normal) = if self.on_border(triangle, facet, closest.region) {
            let arm = p - closest.point;
            let distance = closest.distance_sq.sqrt();
            if distance <= self.tiny || arm.dot(&facet.normal) < 0.0 {
                return None;
            }
            (distance, arm / distance)
        } else {
            self.signed(p, triangle, &closest)
        };
        Some(WallFoot {
            distance,
            normal,
            triangle,
            point: closest.point,
        })
    }

    /// The neighbour on the same wall that is nearer to `p`, with its closest point; ties go to the lower index.
    fn downhill(&self, triangle: u32, closest: &Closest, p: V3) -> Option<(u32, Closest)> {
        let facet = &self.facets[triangle as usize];
        let here = (closest.distance_sq, triangle);
        let nearer = |next: u32| {
            let found = self.closest(next, p);
            ((found.distance_sq, next) < here).then_some((next, found))
        };
        match closest.region {
            Region::Face => {
                let height = facet.height(p);
                (0..3).find_map(|side| {
                    // Over a seam the point is in both prisms, and the nearer face counts.
                    let overlap = facet.overlap[side];
                    let over_seam = overlap > 0.0
                        && height >= 0.0
                        && facet.beyond(side, p) >= -(height * overlap + self.tiny);
                    over_seam.then(|| nearer(facet.across[side])).flatten()
                })
            }
            Region::Edge { side, .. } => {
                let same_wall = facet.overlap[side] >= 0.0;
                same_wall.then(|| nearer(facet.across[side])).flatten()
            }
            Region::Vertex { corner } => {
                let mut best = None;
                self.for_each_round(triangle, corner, |next| {
                    if let Some((_, found)) = nearer(next) {
                        let better = match &best {
                            Some((other, least)) => {
                                let least: &Closest = least;
                                (found.distance_sq, next) < (least.distance_sq, *other)
                            }
                            None => true,
                        };
                        if better {
                            best = Some((next, found));
                        }
                    }
                });
                best
            }
        }
    }

    /// Calls `visit` for the other triangles of the wall round a corner of `triangle`; returns whether they close a ring.
    fn for_each_round(&self, triangle: u32, corner: usize, mut visit: impl FnMut(u32)) -> bool {
        let vertex = self.facets[triangle as usize].corner[corner];
        // across the side that leaves the corner, then the other way across the one that comes to it
        for leaving in [true, false] {
            let mut at = triangle;
            loop {
                let facet = &self.facets[at as usize];
                let here = (0..3).find(|&k| facet.corner[k] == vertex);
                let Some(here) = here else { break };
                let side = if leaving { here } else { (here + 2) % 3 };
                if facet.overlap[side] < 0.0 {
                    break;
                }
                at = facet.across[side];
                if at == triangle {
                    return true;
                }
                visit(at);
            }
        }
        false
    }

    /// Whether a feature is a border of the wall.
    fn on_border(&self, triangle: u32, facet: &Facet, region: Region) -> bool {
        match region {
            Region::Face => false,
            Region::Edge { side, .. } => facet.overlap[side] < 0.0,
            Region::Vertex { corner } => !self.for_each_round(triangle, corner, |_| ()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::generate;
    use super::super::surface::Surface;
    use super::*;
    use std::f64::consts::{FRAC_PI_2, TAU};

    const SIDES: usize = 256;
    const BOTTOM: f64 = 10e-3;
    const R: f64 = 0.35e-3;

    fn pulley(angle: f64) -> Surface {
        let mesh = generate::grooved_pulley(BOTTOM, angle, 2e-3, SIDES).expect("a pulley");
        assert!(!mesh.is_convex());
        Surface::new(mesh)
    }

    /// A point over the bottom of the groove, over the middle of a facet.
    fn over(rise: f64, y: f64, side: f64) -> V3 {
        let a = TAU * (side + 0.5) / SIDES as f64;
        let radius = BOTTOM * libm::cos(0.5 * TAU / SIDES as f64) + rise;
        V3::new(radius * libm::cos(a), y, radius * libm::sin(a))
    }

    fn walls(surface: &Surface, p: V3) -> Vec<WallFoot> {
        let (mut found, mut feet) = (Vec::new(), Vec::new());
        surface.walls(p, 2.0 * R, &mut found, &mut feet);
        feet
    }

    #[test]
    fn a_groove_has_two_walls() {
        for angle in [0.5 * FRAC_PI_2, FRAC_PI_2, 1.5 * FRAC_PI_2] {
            let surface = pulley(angle);
            let (sin, cos) = (libm::sin(0.5 * angle), libm::cos(0.5 * angle));
            for y in [-0.05e-3, 0.0, 0.08e-3] {
                let rise = R / sin;
                let feet = walls(&surface, over(rise, y, 7.0));
                assert_eq!(feet.len(), 2, "{angle} {y}: {feet:?}");
                for foot in feet {
                    // the wall on +y leans towards -y
                    let side = -foot.normal.y.signum();
                    let distance = rise * sin - side * y * cos;
                    assert!((foot.distance - distance).abs() < 1e-7, "{foot:?}");
                    assert!((foot.normal.y + side * cos).abs() < 1e-3, "{foot:?}");
                }
            }
        }
    }

    #[test]
    fn the_distance_of_a_wall_has_its_normal_for_a_gradient() {
        let surface = pulley(FRAC_PI_2);
        let mesh = surface.mesh();
        let h = 1e-9;
        let mut last = [f64::NAN; 2];
        for k in 0..4000 {
            // across the bottom and along it, through many facets
            let t = f64::from(k) / 4000.0;
            let y = 0.6e-3 * (2.0 * t - 1.0);
            let p = over(0.5e-3 + 0.4e-3 * (y / 0.6e-3).abs(), y, 3.0 + 5.0 * t);
            for (wall, of) in [(-1.0, 0), (1.0, 1)] {
                // the wall is told by a triangle of it
                let start = (0..mesh.len() as u32)
                    .find(|&t| (mesh.normal(t).y + wall * 0.7).abs() < 0.05)
                    .expect("a wall");
                let Some(foot) = mesh.wall_foot(p, start) else {
                    panic!("no foot at {p}");
                };
                let slope = V3::from_fn(|axis, _| {
                    let mut step = V3::zeros();
                    step[axis] = h;
                    let at = |p| mesh.wall_foot(p, start).expect("a foot").distance;
                    (at(p + step) - at(p - step)) / (2.0 * h)
                });
                assert!((slope - foot.normal).norm() < 1e-4, "{t}: {foot:?}");
                let jump = (foot.distance - last[of]).abs();
                assert!(k == 0 || jump < 2e-6, "{t}: {jump}");
                last[of] = foot.distance;
            }
        }
    }

    #[test]
    fn the_nearest_wall_is_the_nearest_surface() {
        for surface in [pulley(FRAC_PI_2), pulley(0.8)] {
            for k in 0..500 {
                let k = f64::from(k);
                let p = over(
                    1.5e-3 * (k * 0.618).fract() + 0.05e-3,
                    2e-3 * ((k * 0.271).fract() - 0.5),
                    SIDES as f64 * (k * 0.377).fract(),
                );
                let nearest = surface.nearest(p);
                if nearest.distance <= 0.0 || nearest.distance > 2.0 * R {
                    continue;
                }
                let feet = walls(&surface, p);
                assert!((feet[0].distance - nearest.distance).abs() < 1e-15);
                assert!((feet[0].normal - nearest.normal).norm() < 1e-9);
                assert!(feet.windows(2).all(|w| w[0].distance <= w[1].distance));
            }
        }
    }

    #[test]
    fn a_wall_is_not_seen_through_a_thin_flange() {
        // The crest of a narrow groove ends in an edge; past the end of the pulley the wall is behind it.
        let surface = pulley(0.8);
        let end = 2e-3 * libm::tan(0.4);
        let feet = walls(&surface, over(1.8e-3, end + 0.1e-3, 3.0));
        assert_eq!(feet.len(), 1, "{feet:?}");
        assert!((feet[0].distance - 0.1e-3).abs() < 1e-9);
        assert!((feet[0].normal - V3::y()).norm() < 1e-9);
    }

    #[test]
    fn a_convex_surface_has_one_wall() {
        let mesh = generate::rounded_box(12e-3, 30e-3, 40e-3, 2e-3, 16).expect("a box");
        let surface = Surface::new(mesh);
        for k in 0..200 {
            let k = f64::from(k);
            let a = k * 0.377;
            let way = V3::new(libm::cos(a), 1.6 * (k * 0.271).fract() - 0.8, libm::sin(a));
            let inner = V3::new(6e-3 * way.x, 20e-3 * way.y, 15e-3 * way.z);
            let foot = surface.nearest(inner * 1.4);
            let p = foot.point + foot.normal * 0.4e-3;
            let feet = walls(&surface, p);
            assert_eq!(feet.len(), 1);
            assert!((feet[0].distance - 0.4e-3).abs() < 1e-12);
        }
    }
}
