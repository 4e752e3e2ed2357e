//! Where winding begins, if the scene does not say.

use super::extent::Extent;
use super::problems::Problems;
use crate::settings::{Origin, SceneSettings};

/// The leaf of the first turn's place.
const FIRST: &str = "nozzle.y_start";
/// The leaf of the place of the wire's end.
const CLAMP: &str = "start.clamp_y";

impl SceneSettings {
    /// Whether this leaf has a value that follows from the nozzle's way: nobody gave it, and layers are planned, or for the clamp a
    /// table. In code a leaf is given by another value than its default.
    pub(super) fn follows_from_way(&self, name: &str) -> bool {
        let (value, follows) = match name {
            FIRST => (self.nozzle.y_start, self.winds_layers()),
            CLAMP => (
                self.start.clamp_y,
                self.winds_layers() || self.winds_table(),
            ),
            _ => return false,
        };
        follows && self.origin(name) == Origin::Default && value == 0.0
    }

    /// The settings with the places that follow from the nozzle's way; none where none does.
    ///
    /// Planned layers begin beside the flange that the first one goes away from, and the wire is clamped where the nozzle's way begins.
    pub(super) fn placed(&self, extent: &Extent) -> Option<Self> {
        let mut placed = self.clone();
        let radius = 0.5 * self.wire.outer_diameter();
        if let Some(room) = extent.window
            && self.follows_from_way(FIRST)
        {
            placed.nozzle.y_start = match self.winding.direction.as_str() {
                "-y" => room.faces[1] - radius,
                _ => room.faces[0] + radius,
            };
        }
        if self.follows_from_way(CLAMP) {
            placed.start.clamp_y = match self.winds_table() {
                true => {
                    // (a table that is wrong, or begins where no wire can lie, is told as that)
                    let first = self.law_of_table(&mut Problems::default())?.position(0.0);
                    let ends = [extent.y_min, extent.y_max];
                    let [low, high] = extent.window.map_or(ends, |room| room.faces);
                    first.min(high - radius).max(low + radius)
                }
                false => placed.nozzle.y_start,
            };
        }
        let places = |s: &Self| [s.nozzle.y_start, s.start.clamp_y];
        (places(&placed) != places(self)).then_some(placed)
    }
}
