//! The outer contour of a coil, layer by layer, and how many layers it has.

use super::STATIONS_PER_TURN;
use super::coil::Coil;
use serde::Serialize;
use std::collections::BTreeMap;

/// Turns in a layer from which on it is one, whatever the nozzle did. Chosen: the last turn of a full layer has no room and
/// climbs, for up to one and a half turns until it has settled.
const LAYER: f64 = 2.0;

/// Outer side of a layer over the core: the far side of its wire.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct LayerContour {
    /// layer, from 1
    pub layer: u32,
    /// turns in it, counted by where wire lies
    pub turns: f64,
    /// lowest place, m
    pub height_min_m: f64,
    /// mean along the wire, m
    pub height_mean_m: f64,
    /// height that half of the wire exceeds, m: that of wire in its groove, since crossovers take less than half a turn
    pub height_median_m: f64,
    /// highest place, m
    pub height_max_m: f64,
}

impl LayerContour {
    /// That of a layer with these heights of its outer side, m, one a station and one at least.
    fn of(layer: u32, mut heights: Vec<f64>) -> Self {
        let count = heights.len();
        let sum: f64 = heights.iter().sum();
        heights.sort_by(f64::total_cmp);
        Self {
            layer,
            turns: count as f64 / STATIONS_PER_TURN as f64,
            height_min_m: heights[0],
            height_mean_m: sum / count as f64,
            height_median_m: 0.5 * (heights[(count - 1) / 2] + heights[count / 2]),
            height_max_m: heights[count - 1],
        }
    }
}

impl Coil {
    /// Outer side of each layer that settled wire lies in, from the core outwards.
    pub fn contour(&self) -> Vec<LayerContour> {
        let mut heights: BTreeMap<u32, Vec<f64>> = BTreeMap::new();
        for station in self.stations() {
            let top = station.height + self.spec.diameter;
            heights.entry(station.layer).or_default().push(top);
        }
        let of = |(layer, heights)| LayerContour::of(layer, heights);
        heights.into_iter().map(of).collect()
    }

    /// Layers of the settled wire.
    ///
    /// The nozzle makes a pass for each, so wire that climbs within its pass is none of its own; from two turns on it is.
    pub fn layers(&self) -> u32 {
        let by_pass = self.stations().map(|s| s.layer.min(s.pass)).max();
        let contour = self.contour();
        let by_wire = contour.iter().filter(|layer| layer.turns >= LAYER);
        by_wire
            .map(|layer| layer.layer)
            .chain(by_pass)
            .max()
            .unwrap_or(0)
    }

    /// Least distance of settled wire from a line over the core, m; negative beyond it. `None` without wire.
    ///
    /// The line is `height` (m) over the core at y = 0 and rises towards +y by the angle `taper`, rad.
    pub fn clearance(&self, height: f64, taper: f64) -> Option<f64> {
        let radius = 0.5 * self.spec.diameter;
        let (slope, across) = (libm::tan(taper), libm::cos(taper));
        self.stations()
            .map(|s| {
                let centre = s.height + radius;
                (height + slope * s.position.y - centre) * across - radius
            })
            .reduce(f64::min)
    }
}
