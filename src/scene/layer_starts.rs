//! Where layers begin between flanges, and the room that their turns leave there.

use super::extent::{Extent, between_turns};
use super::nozzle_plan::{Layer, Layers};
use super::problems::Problems;
use crate::measure::LayerStart;
use crate::settings::SceneSettings;

/// Largest difference, diameters, of the distance between flanges round the core where places beside them are known. Chosen: a
/// third of the room that counts as an empty place.
const UNEVEN: f64 = 0.25;

impl SceneSettings {
    /// Room beside the last turn of the first planned layer, to its flange, m, where the first turn of the next has its place over it and
    /// falls in, and the turns that fit in a layer.
    pub(super) fn place_left(&self, d: f64, extent: &Extent) -> Option<(f64, f64)> {
        if !self.winds_layers() {
            return None;
        }
        let layers = self.layers(d, extent, &mut Problems::default())?;
        let [low, high] = extent.window.as_ref()?.faces;
        let [first, next] = *layers.layers.first_chunk()?;
        let ahead = if first.sense > 0.0 { high } else { low };
        let room = (ahead - first.last).abs() - 0.5 * d;
        let hangs_over = (next.first - first.last) * first.sense > 0.0;
        let fit = (between_turns(high - low, d)? / self.winding.pitch.max(d)).floor() + 1.0;
        (hangs_over && room >= d && fit > f64::from(first.turns)).then_some((room, fit))
    }
}

impl Layers {
    /// Those of wire of diameter `d`, m; none where the distance of the flanges changes round the core.
    ///
    /// A nozzle that goes by a table starts each layer where it likes, but for one that is full: that begins at its flange, or half a
    /// place from it where it has a turn less.
    pub(super) fn starts(&self, d: f64, extent: &Extent, by_table: bool) -> Vec<LayerStart> {
        let Some(room) = &extent.window else {
            return Vec::new();
        };
        let [low, high] = room.faces;
        let uneven = (room.widest[1] - room.widest[0]) - (high - low) > UNEVEN * d;
        let most = self.layers[0].turns;
        let is_full = high - low < f64::from(most + 1) * d;
        if uneven || by_table && !is_full {
            return Vec::new();
        }
        let start = |layer: &Layer| {
            let face = if layer.sense > 0.0 { low } else { high };
            LayerStart {
                faces: room.faces,
                rim: room.height,
                room: match (by_table, layer.turns < most) {
                    (true, false) => 0.0,
                    (true, true) => 0.5 * self.pitch,
                    (false, _) => (layer.first - face).abs() - 0.5 * d,
                },
            }
        };
        self.layers.iter().map(start).collect()
    }
}
