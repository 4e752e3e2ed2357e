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

/// A length or force for a message: six digits are enough to act on.
pub(crate) fn si(x: f64) -> String {
    let rounded = format!("{x:.5e}").parse().unwrap_or(x);
    crate::variables::Value::Real(rounded).to_string()
}
