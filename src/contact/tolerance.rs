//! Error of contact forces that the linear system may promise.

/// Error of a contact force that an update may promise, as a depth, m, for wire of 0.7 mm. Chosen.
const PREDICTION_TOLERANCE: f64 = 1e-7;
/// Diameter to which that belongs, m.
const DIAMETER: f64 = 0.7e-3;

/// Error of a contact force that an update may promise, as a depth, m, for wire of this `diameter`, m.
///
/// The force that presses wire on its core scales with its cross-section, so the tolerance does too, up to 0.7 mm. With
/// the same depth for all diameters an update could promise wire of 0.05 mm fifty times the force that there is; then
/// Newton's method alternates and steps shrink to a microsecond.
pub(super) fn prediction_tolerance(diameter: f64) -> f64 {
    let size = diameter / DIAMETER;
    PREDICTION_TOLERANCE * (size * size).min(1.0)
}
