//! The error of a value that the rest of the scene makes impossible.

use super::SceneError;
use crate::settings::SceneSettings;

impl SceneSettings {
    /// An error about a leaf, with its origin and value filled in.
    pub(super) fn impossible(
        &self,
        key: &str,
        reason: impl Into<Box<str>>,
        allowed: impl Into<Box<str>>,
    ) -> SceneError {
        SceneError::Impossible {
            origin: self.told_origin(key),
            key: key.into(),
            value: self.shown(key).into(),
            reason: reason.into(),
            allowed: allowed.into(),
        }
    }
}

/// A bound from below for a message: six digits, rounded up, so that what is told is allowed.
pub(super) fn si_up(x: f64) -> String {
    si(rounded_away(x, 1.0))
}

/// The same of a bound from above.
pub(super) fn si_down(x: f64) -> String {
    si(rounded_away(x, -1.0))
}

/// The nearest number of six digits on that side of `x`, or `x`.
fn rounded_away(x: f64, side: f64) -> f64 {
    let digits: f64 = format!("{x:.5e}").parse().unwrap_or(x);
    if side * (digits - x) >= 0.0 {
        return digits;
    }
    let unit = 10f64.powi(libm::log10(digits.abs()).floor() as i32 - 5);
    digits + side * unit
}

/// A length or force for a message: six digits are enough to act on.
pub(crate) fn si(x: f64) -> String {
    let rounded = format!("{x:.5e}").parse().unwrap_or(x);
    crate::variables::Value::Real(rounded).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A bound was told rounded to the nearest, and what it allowed was refused.
    #[test]
    fn a_bound_that_is_told_is_allowed() {
        for x in [
            2.12819666e-4,
            1.313296e-2,
            0.123456,
            9.999995,
            7.0,
            1e-5 / 3.0,
        ] {
            let [up, down]: [f64; 2] = [si_up(x), si_down(x)].map(|told| told.parse().unwrap());
            assert!(up >= x && up <= x * (1.0 + 1.1e-5), "{x}: {up}");
            assert!(down <= x && down >= x * (1.0 - 1.1e-5), "{x}: {down}");
        }
    }
}
