//! The core of a scene as a triangle mesh and as a shape for contact.

use super::SimError;
use crate::geometry::generate::{
    Plates, cylinder, flanged, rounded_box, segments_for_sagitta, with_plates,
};
use crate::geometry::{Flanges, Shape, Surface, TriMesh};
use crate::math::scaled;
use crate::scene::{Core, Scene};
use std::sync::Arc;

/// Facets of a generated core lie at most this far under the true surface, m, for wire of 0.7 mm.
const SAGITTA: f64 = 0.5e-6;

/// Builds the triangle mesh of a scene's core, in the frame of the core, m. Facets are as fine as its wire needs them.
///
/// # Errors
///
/// If the file of a mesh cannot be read, or the mesh is refused; the message names the reason.
pub fn core_surface(scene: &Scene) -> Result<Surface, SimError> {
    let (core, sagitta) = (&scene.core, scaled(SAGITTA, scene.wire.diameter));
    let fail = |e: String| SimError::setup(format!("core: {e}"));
    let quarter = |radius: f64| segments_for_sagitta(radius, sagitta).div_ceil(4).max(2);
    if let Some(flanges) = core_flanges(core) {
        let rim = match core {
            Core::RoundedBox { corner_radius, .. } => *corner_radius,
            Core::Cylinder { radius, .. } => *radius,
            Core::Mesh { .. } => 0.0,
        } + flanges.height;
        let mesh = flanged(&flanges, quarter(rim), quarter(flanges.edge_radius));
        return Ok(Surface::new(mesh.map_err(|e| fail(e.to_string()))?));
    }
    let mesh: TriMesh = match core {
        Core::RoundedBox {
            width_x,
            height_z,
            length_y,
            corner_radius,
            ..
        } => rounded_box(
            *width_x,
            *height_z,
            *length_y,
            *corner_radius,
            quarter(*corner_radius),
        )
        .map_err(|e| fail(e.to_string()))?,
        Core::Cylinder {
            radius, length_y, ..
        } => cylinder(*radius, *length_y, segments_for_sagitta(*radius, sagitta))
            .map_err(|e| fail(e.to_string()))?,
        Core::Mesh { path, unit, flange } => {
            let file = std::fs::File::open(path)
                .map_err(|e| fail(format!("cannot open {}: {e}", path.display())))?;
            let mesh = crate::geometry::stl::read(&mut std::io::BufReader::new(file), *unit)
                .map_err(|e| fail(format!("{}: {e}", path.display())))?;
            match flange {
                Some(f) => {
                    let plates = Plates {
                        half_inner: 0.5 * f.inner_distance,
                        height: f.height,
                        thickness: f.thickness,
                        edge_radius: f.edge_radius,
                    };
                    let [corner, edge] = [f.height, f.edge_radius].map(quarter);
                    with_plates(&mesh, &plates, corner, edge).map_err(|e| fail(e.to_string()))?
                }
                None => mesh,
            }
        }
    };
    Ok(Surface::new(mesh))
}

/// The flanges beside what wire is wound on where that has a formula, core frame; beside a mesh they are part of the surface.
pub(in crate::simulation) fn core_flanges(core: &Core) -> Option<Flanges> {
    let flange = core.flange()?;
    Some(Flanges {
        core: wound_on(core)?,
        half_inner: 0.5 * flange.inner_distance,
        height: flange.height,
        thickness: flange.thickness,
        edge_radius: flange.edge_radius,
    })
}

/// Returns the shape on which the line contact finds the nearest points, without flanges that are none of it.
pub(in crate::simulation) fn core_shape(core: &Core, surface: &Arc<Surface>) -> Shape {
    wound_on(core).unwrap_or_else(|| Shape::Mesh(surface.clone()))
}

/// What wire is wound on, where it has a formula; between flanges it ends at their outer faces.
fn wound_on(core: &Core) -> Option<Shape> {
    let half_length = |length_y: f64| match core.flange() {
        Some(flange) => 0.5 * flange.inner_distance + flange.thickness,
        None => 0.5 * length_y,
    };
    match core {
        Core::RoundedBox {
            width_x,
            height_z,
            length_y,
            corner_radius,
            ..
        } => Some(Shape::RoundedBox {
            half_x: 0.5 * width_x,
            half_z: 0.5 * height_z,
            half_y: half_length(*length_y),
            corner_radius: *corner_radius,
        }),
        Core::Cylinder {
            radius, length_y, ..
        } => Some(Shape::Cylinder {
            radius: *radius,
            half_y: half_length(*length_y),
        }),
        Core::Mesh { .. } => None,
    }
}
