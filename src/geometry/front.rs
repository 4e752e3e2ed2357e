//! Where wire lies that is pressed against a core from +x.

use super::surface::Surface;
use crate::math::V3;

/// Depth in a face that is none, as a share of the core's radius: a nanometre of 10 mm.
const TOUCHES: f64 = 1e-7;

/// Depth in a face, as a share of the wire's radius, up to which clamped wire lies on it. Chosen: as exact as a room with slanted flanges.
const ON_FACE: f64 = 0.05;

/// Steps until the wire touches; on flat faces it is one.
const MOST_STEPS: usize = 50;

/// Share of the wire's radius that comes to rest over a gap or groove, and not on the rim of a flange that the wire touches.
const THIN: f64 = 0.9;

/// Steps of a walk along x.
const MOST_WAYS: usize = 500;

impl Surface {
    /// Depth in a face that is none, m.
    fn touches(&self) -> f64 {
        TOUCHES * self.radius_max()
    }

    /// Half width of the core on +x at `y` for wire of `radius`, m: what its centreline has from the axis there, less its radius. None
    /// where the core has nothing that would hold it.
    ///
    /// On an inclined face that is more than the face has itself. Over a gap or groove that the wire is too thick for it lies on the
    /// edges.
    pub(crate) fn half_width(&self, y: f64, radius: f64) -> Option<f64> {
        let lies = self.face_on_x(y, 0.0).map(|face| {
            let pressed = V3::new(face + radius, y, 0.0);
            self.moved_out(pressed, radius).map_or(face, |x| x - radius)
        });
        let touches = |half_width: &f64| self.depth(*half_width, y, radius) <= ON_FACE * radius;
        let on_edges = || Some(self.face_on_x(y, THIN * radius)? - THIN * radius);
        lies.filter(touches).or_else(on_edges).or(lies)
    }

    /// How deep wire lies in the core that has this half width there, m.
    fn depth(&self, half_width: f64, y: f64, radius: f64) -> f64 {
        radius - self.nearest(V3::new(half_width + radius, y, 0.0)).distance
    }

    /// Whether wire that is clamped at `y` (m) lies on the core, and in nothing.
    pub(crate) fn holds_clamped(&self, y: f64, radius: f64) -> bool {
        let found = self.half_width(y, radius);
        found.is_some_and(|half_width| self.depth(half_width, y, radius) <= ON_FACE * radius)
    }

    /// Whether wire clamped at `y` (m) would lie on something with a hollow below it, as on a flange that leans over the core.
    pub(crate) fn overhangs(&self, y: f64, radius: f64) -> bool {
        let Some(outside) = self.face_on_x(y, 0.0) else {
            return false;
        };
        let mut x = 0.0;
        for _ in 0..MOST_WAYS {
            let depth = -self.nearest(V3::new(x, y, 0.0)).distance;
            if depth < self.touches() {
                // (an axis in a hollow of the core says nothing)
                return x > 0.0 && outside > x + radius;
            }
            x += depth;
        }
        false
    }

    /// Where a sphere of this `radius` that comes along the +x axis at `y` stops, m.
    fn face_on_x(&self, y: f64, radius: f64) -> Option<f64> {
        // walk in from outside, never farther than the surface is away
        let mut x = self.radius_max() * 1.01 + radius;
        for _ in 0..MOST_WAYS {
            let d = self.nearest(V3::new(x, y, 0.0)).distance - radius;
            if d < self.touches() {
                return Some(x);
            }
            x -= d;
            if x < 0.0 {
                break;
            }
        }
        None
    }

    /// The place along x at which a sphere of `radius` (m) that is pressed into a face at `place` (m) only touches it, m. None where
    /// it presses into nothing, or into what moves along x do not lead away from, such as a flange.
    fn moved_out(&self, place: V3, radius: f64) -> Option<f64> {
        let farthest = self.radius_max() + radius;
        let mut at = place;
        for step in 0..MOST_STEPS {
            let near = self.nearest(at);
            let depth = radius - near.distance;
            if step > 0 && depth.abs() <= self.touches() {
                return Some(at.x);
            }
            if step == 0 && depth <= self.touches() || near.normal.x <= 0.0 {
                return None;
            }
            at.x += depth / near.normal.x;
            if at.x > farthest {
                return None;
            }
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::TriMesh;
    use crate::geometry::generate::{grooved_pulley, rounded_box, sewn};
    use crate::math::Spin;
    use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

    const RADIUS: f64 = 0.4e-3;

    /// A box of 12 x 20 x 30 mm with sharp edges, changed point by point.
    fn changed(change: impl Fn(V3) -> V3) -> Surface {
        let mesh = rounded_box(12e-3, 20e-3, 30e-3, 0.0, 1).expect("a box");
        let vertices = mesh.vertices.iter().map(|p| change(*p)).collect();
        Surface::new(TriMesh::new(vertices, mesh.triangles).expect("closed"))
    }

    /// How deep wire that is clamped at `y` is in the core, m.
    fn depth(surface: &Surface, y: f64) -> f64 {
        let x = surface.half_width(y, RADIUS).expect("a face") + RADIUS;
        RADIUS - surface.nearest(V3::new(x, y, 0.0)).distance
    }

    /// It was half a diameter off along x, and so pressed in by the share 1 - cos of the inclination.
    #[test]
    fn wire_clamped_to_an_inclined_face_touches_it() {
        for degrees in [3.0, 20.0, 55.0, 72.0, -35.0] {
            let spin = Spin::new(f64::to_radians(degrees));
            let turned = changed(|p| spin.to_lab(p));
            let tapered = changed(|p| V3::new(p.x * (1.0 + 10.0 * p.y), p.y, p.z));
            for surface in [turned, tapered] {
                let depth = depth(&surface, -2e-3);
                assert!(depth.abs() <= surface.touches(), "{degrees} deg: {depth} m");
                assert_ne!(
                    surface.half_width(-2e-3, RADIUS),
                    surface.face_on_x(-2e-3, 0.0)
                );
            }
        }
    }

    #[test]
    fn wire_clamped_in_a_groove_touches_both_walls() {
        let pulley = grooved_pulley(8e-3, FRAC_PI_2, 2e-3, 36).expect("a pulley");
        let surface = Surface::new(pulley);
        for y in [0.0, 0.1e-3] {
            let depth = depth(&surface, y);
            assert!(depth.abs() <= surface.touches(), "{depth} m");
        }
    }

    #[test]
    fn wire_clamped_to_a_face_square_to_x_stays_where_it_was() {
        let edge_ahead = changed(|p| Spin::new(FRAC_PI_4).to_lab(V3::new(p.x, p.y, 0.6 * p.z)));
        for surface in [changed(|p| p), edge_ahead] {
            assert_eq!(
                surface.half_width(-2e-3, RADIUS),
                surface.face_on_x(-2e-3, 0.0)
            );
        }
    }

    /// Plates of 1 mm with gaps of 10 um, as of a laminated core.
    fn plates() -> Surface {
        let plate = rounded_box(12e-3, 1e-3, 30e-3, 0.0, 1).expect("a plate");
        let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
        for k in 0..10_u32 {
            let (first, up) = (vertices.len() as u32, V3::y() * (f64::from(k) * 1.01e-3));
            vertices.extend(plate.vertices.iter().map(|p| p + up));
            let of_plate = plate.triangles.iter();
            triangles.extend(of_plate.map(|t| t.map(|vertex| vertex + first)));
        }
        Surface::new(TriMesh::new(vertices, triangles).expect("closed"))
    }

    /// In front of a gap of a laminated core the wire could not be clamped, and no other place was named.
    #[test]
    fn wire_clamped_over_a_gap_between_plates_touches_both() {
        let surface = plates();
        let middle_of_gap = 0.505e-3 + 3.0 * 1.01e-3;
        let over_gap = surface
            .half_width(middle_of_gap, RADIUS)
            .expect("two edges");
        assert!((over_gap - 6e-3).abs() < 0.1e-6, "{over_gap}");
        assert!(depth(&surface, middle_of_gap) <= ON_FACE * RADIUS);
        let over_plate = surface.half_width(3.03e-3, RADIUS).expect("a plate");
        assert!(
            (over_plate - 6e-3).abs() < surface.touches(),
            "{over_plate}"
        );
    }

    /// Wire over a groove that it does not fit into was clamped on the bottom, deep in both walls.
    #[test]
    fn wire_clamped_over_a_narrow_groove_lies_on_its_edges() {
        let half = 0.2e-3;
        let rings = [
            (-2e-3, 9e-3),
            (-half, 9e-3),
            (-half, 8e-3),
            (half, 8e-3),
            (half, 9e-3),
            (2e-3, 9e-3),
        ];
        let round = |(y, radius): (f64, f64)| {
            let at = |k: u32| {
                Spin::new(-FRAC_PI_4 / 45.0 * f64::from(k)).to_lab(V3::new(0.0, y, radius))
            };
            (0..360).map(at).collect()
        };
        let drum = sewn(&rings.map(round)).expect("a drum");
        let surface = Surface::new(drum);
        let on_edges = 9e-3 + (RADIUS * RADIUS - half * half).sqrt() - RADIUS;
        let found = surface.half_width(0.0, RADIUS).expect("two edges");
        assert!(
            (found - on_edges).abs() < 0.05 * RADIUS,
            "{found} {on_edges}"
        );
        assert!(surface.holds_clamped(0.0, RADIUS));
    }
}
