//! Where winding begins, if a scene that plans layers between flanges does not say.

use super::extent::Extent;
use crate::settings::{Origin, SceneSettings};

/// The leaf of the first turn's place.
const FIRST: &str = "nozzle.y_start";
/// The leaf of the place of the wire's end.
const CLAMP: &str = "start.clamp_y";

impl SceneSettings {
    /// Whether this leaf has a value that follows from others: layers are planned, and nobody gave it. In code a leaf is given
    /// by another value than its default.
    pub(super) fn follows_from_layers(&self, name: &str) -> bool {
        let value = match name {
            FIRST => self.nozzle.y_start,
            CLAMP => self.start.clamp_y,
            _ => return false,
        };
        self.winds_layers() && self.origin(name) == Origin::Default && value == 0.0
    }

    /// The settings with the places that follow from the flanges; none where there are no flanges, or none does.
    ///
    /// The first turn lies beside the flange that the first layer goes away from, and the wire is clamped where the first turn lies.
    pub(super) fn placed(&self, extent: &Extent) -> Option<Self> {
        let [low, high] = extent.window?.faces;
        let [first, clamp] = [FIRST, CLAMP].map(|name| self.follows_from_layers(name));
        if !first && !clamp {
            return None;
        }
        let mut placed = self.clone();
        if first {
            let radius = 0.5 * self.wire.outer_diameter();
            placed.nozzle.y_start = match self.winding.direction.as_str() {
                "-y" => high - radius,
                _ => low + radius,
            };
        }
        if clamp {
            placed.start.clamp_y = placed.nozzle.y_start;
        }
        Some(placed)
    }
}
