//! Where the wire is clamped: on the face of the core on +x.

use super::SimError;
use crate::geometry::Surface;
use crate::math::V3;
use crate::scene::{Core, Scene};

/// Depth of the clamped wire in a face of a mesh that is none, m.
const TOUCHES: f64 = 1e-9;

/// Steps until the wire touches; on flat faces it is one.
const MOST_STEPS: usize = 50;

/// Half width of the core on +x where the wire is clamped, m: what its centreline has from the axis there, less its radius.
///
/// On an inclined face of a mesh that is more than the face has itself.
///
/// # Errors
///
/// If a mesh has no surface there.
pub(super) fn half_width(scene: &Scene, surface: &Surface) -> Result<f64, SimError> {
    match &scene.core {
        Core::RoundedBox { width_x, .. } => Ok(0.5 * width_x),
        Core::Cylinder { radius, .. } => Ok(*radius),
        Core::Mesh { path, .. } => {
            let (y, radius) = (scene.start.clamp_y, scene.wire.radius());
            let face = face_on_x(surface, y).ok_or_else(|| {
                SimError::setup(format!(
                    "core: {} has no surface on +x at y = {y} m to clamp the wire to; change start.clamp_y or move the mesh",
                    path.display(),
                ))
            })?;
            let pressed = face + radius;
            Ok(touching(surface, V3::new(pressed, y, 0.0), radius).map_or(face, |x| x - radius))
        }
    }
}

/// Where the +x axis at `y` (m) leaves the core, m.
fn face_on_x(surface: &Surface, y: f64) -> Option<f64> {
    // walk in from outside, never farther than the surface is away
    let mut x = surface.radius_max() * 1.01;
    for _ in 0..500 {
        let d = surface.nearest(V3::new(x, y, 0.0)).distance;
        if d < 1e-9 {
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
fn touching(surface: &Surface, place: V3, radius: f64) -> Option<f64> {
    let farthest = surface.radius_max() + radius;
    let mut at = place;
    for step in 0..MOST_STEPS {
        let near = surface.nearest(at);
        let depth = radius - near.distance;
        if step > 0 && depth.abs() <= TOUCHES {
            return Some(at.x);
        }
        if step == 0 && depth <= TOUCHES || near.normal.x <= 0.0 {
            return None;
        }
        at.x += depth / near.normal.x;
        if at.x > farthest {
            return None;
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::TriMesh;
    use crate::geometry::generate::{grooved_pulley, rounded_box};
    use crate::math::Spin;
    use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

    const RADIUS: f64 = 0.4e-3;

    /// A box of 12 x 20 x 30 mm with sharp edges, changed point by point.
    fn changed(change: impl Fn(V3) -> V3) -> Surface {
        let mesh = rounded_box(12e-3, 20e-3, 30e-3, 0.0, 1).expect("a box");
        let vertices = mesh.vertices.iter().map(|p| change(*p)).collect();
        Surface::new(TriMesh::new(vertices, mesh.triangles).expect("closed"))
    }

    /// How deep wire that is clamped at `y` is in the core, m, and where along x it was moved to.
    fn depth(surface: &Surface, y: f64) -> (f64, Option<f64>) {
        let pressed = V3::new(face_on_x(surface, y).expect("a face") + RADIUS, y, 0.0);
        let found = touching(surface, pressed, RADIUS);
        let x = found.unwrap_or(pressed.x);
        (RADIUS - surface.nearest(V3::new(x, y, 0.0)).distance, found)
    }

    /// It was half a diameter off along x, and so pressed in by the share 1 - cos of the inclination.
    #[test]
    fn wire_clamped_to_an_inclined_face_touches_it() {
        for degrees in [3.0, 20.0, 55.0, 72.0, -35.0] {
            let spin = Spin::new(f64::to_radians(degrees));
            let turned = changed(|p| spin.to_lab(p));
            let tapered = changed(|p| V3::new(p.x * (1.0 + 10.0 * p.y), p.y, p.z));
            for surface in [turned, tapered] {
                let (depth, found) = depth(&surface, -2e-3);
                assert!(depth.abs() <= TOUCHES, "{degrees} deg: {depth} m");
                assert!(found.is_some());
            }
        }
    }

    #[test]
    fn wire_clamped_in_a_groove_touches_both_walls() {
        let pulley = grooved_pulley(8e-3, FRAC_PI_2, 2e-3, 36).expect("a pulley");
        let surface = Surface::new(pulley);
        for y in [0.0, 0.1e-3] {
            let depth = depth(&surface, y).0;
            assert!(depth.abs() <= TOUCHES, "{depth} m");
        }
    }

    #[test]
    fn wire_clamped_to_a_face_square_to_x_stays_where_it_was() {
        assert_eq!(depth(&changed(|p| p), -2e-3).1, None);
        let edge_ahead = changed(|p| Spin::new(FRAC_PI_4).to_lab(V3::new(p.x, p.y, 0.6 * p.z)));
        assert_eq!(depth(&edge_ahead, -2e-3).1, None);
    }
}
