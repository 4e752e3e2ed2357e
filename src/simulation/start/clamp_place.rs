//! Where the wire is clamped: on the face of the core on +x.

use crate::geometry::Surface;
use crate::scene::{Core, Scene};
use crate::simulation::SimError;

/// Half width of the core on +x where the wire is clamped, m, by [`Surface::half_width`].
///
/// # Errors
///
/// If a mesh has no surface there.
pub(super) fn half_width(scene: &Scene, surface: &Surface) -> Result<f64, SimError> {
    match &scene.core {
        Core::RoundedBox { width_x, .. } => Ok(0.5 * width_x),
        Core::Cylinder { radius, .. } => Ok(*radius),
        Core::Mesh { path, .. } => {
            let y = scene.start.clamp_y;
            surface.half_width(y, scene.wire.radius()).ok_or_else(|| {
                SimError::setup(format!(
                    "core: {} has no surface on +x at y = {y} m to clamp the wire to; change start.clamp_y or move the mesh",
                    path.display(),
                ))
            })
        }
    }
}
