//! The room that a core takes up.

use super::Flange;
use crate::geometry::{Crossing, Room};

/// Share of a length by which it may be missed: by faces in an STL file, which has single precision, and by sums of pitches.
pub(super) const ROUNDING: f64 = 1e-6;

/// How far the first and the last turn of wire of the diameter `d` may lie apart in a room of this `width`, m; none where the wire
/// has no room. One wire has room between flanges that are its diameter apart.
pub(super) fn between_turns(width: f64, d: f64) -> Option<f64> {
    let apart = width * (1.0 + ROUNDING) - d;
    (apart >= 0.0).then_some(apart)
}

/// Room the core takes up.
pub(super) struct Extent {
    /// largest distance from the axis, m
    pub(super) turning_radius: f64,
    /// the same of what wire is wound on, without flanges, m
    pub(super) winding_radius: f64,
    /// ends along the axis, m
    pub(super) y_min: f64,
    pub(super) y_max: f64,
    /// what lies between flanges, those of the scene or those that a mesh has
    pub(super) window: Option<Room>,
    /// between the flanges of a mesh, the stretches along the axis in which wire can be clamped on +x, m
    pub(super) clamp_places: Vec<[f64; 2]>,
    /// what wire on a mesh meets towards either end, by [`TriMesh::in_the_way`](crate::geometry::TriMesh::in_the_way)
    pub(super) in_the_way: Option<[Vec<f64>; 2]>,
    /// another axis than y about which a mesh has flanges, where it should have some and has none about y
    pub(super) flanged_about: Option<char>,
    /// whether the surface of a mesh crosses itself
    pub(super) crossing: Crossing,
}

impl Extent {
    /// That of a core with this turning radius and half length, m; between flanges it ends at their outer faces.
    pub(super) fn of(turning_radius: f64, half: f64, flange: Option<Flange>) -> Self {
        let half = flange.map_or(half, outer_face);
        Self {
            turning_radius: turning_radius + flange.map_or(0.0, |f| f.height),
            winding_radius: turning_radius,
            y_min: -half,
            y_max: half,
            window: flange.map(|f| between(f, turning_radius)),
            clamp_places: Vec::new(),
            in_the_way: None,
            flanged_about: None,
            crossing: Crossing::None,
        }
    }

    /// Whether this place along the axis, m, lies beside the core.
    pub(super) fn is_beside(&self, y: f64) -> bool {
        y < self.y_min || y > self.y_max
    }

    /// The same with flanges beside it.
    pub(super) fn with(self, flange: Option<Flange>) -> Self {
        let Some(f) = flange else {
            return self;
        };
        let outer = outer_face(f);
        Self {
            turning_radius: self.turning_radius + f.height,
            y_min: self.y_min.min(-outer),
            y_max: self.y_max.max(outer),
            window: Some(between(f, self.winding_radius)),
            ..self
        }
    }
}

/// The room between the scene's flanges on a core of this radius, m.
fn between(flange: Flange, radius: f64) -> Room {
    let half = 0.5 * flange.inner_distance;
    Room {
        faces: [-half, half],
        widest: [-half, half],
        height: flange.height,
        radius,
    }
}

/// Distance of a flange's outer face from the middle between the two, m.
fn outer_face(flange: Flange) -> f64 {
    0.5 * flange.inner_distance + flange.thickness
}
