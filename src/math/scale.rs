//! Inner lengths and times, which go with the wire.

/// Diameter of the wire for which inner lengths and times were chosen, m.
const DIAMETER: f64 = 0.7e-3;

/// A length (m) or a time (s) for wire of this `diameter` (m), from `chosen`, the value for wire of 0.7 mm.
///
/// A scene of which all lengths and times are twice as large then has twice the result.
#[inline]
pub fn scaled(chosen: f64, diameter: f64) -> f64 {
    chosen * (diameter / DIAMETER)
}
