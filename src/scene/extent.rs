//! The room that a core takes up.

use super::Flange;

/// Room the core takes up.
pub(super) struct Extent {
    /// largest distance from the axis, m
    pub(super) turning_radius: f64,
    /// the same of what wire is wound on, without flanges, m
    pub(super) winding_radius: f64,
    /// ends along the axis, m
    pub(super) y_min: f64,
    pub(super) y_max: f64,
    /// distance of the flanges, m, where the scene says it
    pub(super) window: Option<f64>,
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
            window: flange.map(|f| f.inner_distance),
        }
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
            window: Some(f.inner_distance),
            ..self
        }
    }
}

/// Distance of a flange's outer face from the middle between the two, m.
fn outer_face(flange: Flange) -> f64 {
    0.5 * flange.inner_distance + flange.thickness
}
