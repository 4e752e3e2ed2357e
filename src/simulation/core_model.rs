//! The core of a scene as a triangle mesh and as a shape for contact.

use super::SimError;
use crate::geometry::generate::{cylinder, rounded_box, segments_for_sagitta};
use crate::geometry::{Shape, Surface, TriMesh};
use crate::scene::Core;
use std::sync::Arc;

/// Facets of a generated core lie at most this far under the true surface, m.
const SAGITTA: f64 = 0.5e-6;

/// Builds the triangle mesh of a scene's core, in the frame of the core, m.
///
/// # Errors
///
/// If the file of a mesh cannot be read, or the mesh is refused; the message names the reason.
pub fn core_surface(core: &Core) -> Result<Surface, SimError> {
    let fail = |e: String| SimError::setup(format!("core: {e}"));
    let mesh: TriMesh = match core {
        Core::RoundedBox {
            width_x,
            height_z,
            length_y,
            corner_radius,
        } => {
            let segments = segments_for_sagitta(*corner_radius, SAGITTA)
                .div_ceil(4)
                .max(2);
            rounded_box(*width_x, *height_z, *length_y, *corner_radius, segments)
                .map_err(|e| fail(e.to_string()))?
        }
        Core::Cylinder { radius, length_y } => {
            cylinder(*radius, *length_y, segments_for_sagitta(*radius, SAGITTA))
                .map_err(|e| fail(e.to_string()))?
        }
        Core::Mesh { path, unit } => {
            let file = std::fs::File::open(path)
                .map_err(|e| fail(format!("cannot open {}: {e}", path.display())))?;
            crate::geometry::stl::read(&mut std::io::BufReader::new(file), *unit)
                .map_err(|e| fail(format!("{}: {e}", path.display())))?
        }
    };
    Ok(Surface::new(mesh))
}

/// Returns the shape on which the line contact finds the nearest points.
pub(super) fn core_shape(core: &Core, surface: &Arc<Surface>) -> Shape {
    match core {
        Core::RoundedBox {
            width_x,
            height_z,
            length_y,
            corner_radius,
        } => Shape::RoundedBox {
            half_x: 0.5 * width_x,
            half_z: 0.5 * height_z,
            half_y: 0.5 * length_y,
            corner_radius: *corner_radius,
        },
        Core::Cylinder { radius, length_y } => Shape::Cylinder {
            radius: *radius,
            half_y: 0.5 * length_y,
        },
        Core::Mesh { .. } => Shape::Mesh(surface.clone()),
    }
}
