//! Error of contact forces that the linear system may promise.

use crate::geometry::Shape;
use crate::math::scaled;

/// Error of a contact force that an update may promise, as a depth, m, for wire of 0.7 mm that is drawn round [`BEND`].
/// Chosen.
const PREDICTION_TOLERANCE: f64 = 1e-7;
/// Bending radius of the centreline to which that belongs, m.
const BEND: f64 = 2e-3 + 0.35e-3;

/// Friction limit below which a prediction lets a slide turn at once, as a share of the contact force that it may be off by.
///
/// Wire beside a flange is a picometre deep in it. Its bristles hold nothing, and for each of them to hold once before
/// it slides the other way takes an update for every two or three points. Chosen: a thousandth or a thousand times as much takes as
/// many solves (`tooth`).
pub(super) const NEGLIGIBLE: f64 = 1e-8;

/// Error of a contact force that an update may promise, as a depth, m, for wire of this `radius`, m.
///
/// The force that presses wire on its core goes with its cross-section over the radius that it is bent to, so the
/// tolerance does too. With the same depth for all diameters an update could promise wire of 0.05 mm fifty times the
/// force that there is; then Newton's method alternates and steps shrink to a microsecond.
pub(super) fn prediction_tolerance(core: &Shape, radius: f64) -> f64 {
    let most = scaled(PREDICTION_TOLERANCE, 2.0 * radius);
    let bend = match core {
        Shape::RoundedBox { corner_radius, .. } => corner_radius + radius,
        Shape::Cylinder { radius: core, .. } => core + radius,
        // its edges may be as sharp as any
        Shape::Mesh(_) => radius,
    };
    scaled(most * BEND / bend, 2.0 * radius).min(most)
}
