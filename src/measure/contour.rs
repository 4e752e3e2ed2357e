//! The outer contour of a coil, layer by layer, and how many layers it has.

use super::STATIONS_PER_TURN;
use super::coil::Coil;
use super::station::Station;
use serde::Serialize;
use std::collections::BTreeMap;
use std::f64::consts::PI;

/// Turns over a layer from which on they are layers, whatever the nozzle did. Chosen: the last turn of a full layer has no room and
/// climbs, for up to one and a half turns until it has settled.
const LAYER: f64 = 2.0;

/// Part of a turn from which on wire that follows its nozzle to a next layer is one. Chosen: half. A layer may be a single turn, and a
/// crossover or a place beside a flange takes less.
const BEGUN: f64 = 0.5;

/// Sectors round the core in which heights are compared. Chosen: half of the usual crossover each.
const SECTORS: usize = 12;

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
    /// height that half of the wire exceeds, m
    pub height_median_m: f64,
    /// height of wire in its groove, m: that of half of the first layer, and for each layer after it the least rise over the
    /// first in a twelfth of a turn. Crossovers stand higher, and from layer to layer they take more of a turn
    pub height_groove_m: f64,
    /// highest place, m
    pub height_max_m: f64,
}

impl LayerContour {
    /// That of a layer with these stations in a turn and heights of its outer side there, m; one at least. It rises so much over the
    /// `first` layer in the grooves, m.
    fn of(layer: u32, places: &[(usize, f64)], first: Option<&Self>, rise: f64) -> Self {
        let count = places.len();
        let mut heights: Vec<f64> = places.iter().map(|(_, height)| *height).collect();
        let sum: f64 = heights.iter().sum();
        heights.sort_by(f64::total_cmp);
        let median = median(&heights);
        Self {
            layer,
            turns: count as f64 / STATIONS_PER_TURN as f64,
            height_min_m: heights[0],
            height_mean_m: sum / count as f64,
            height_median_m: median,
            height_groove_m: first.map_or(median, |first| first.height_median_m + rise),
            height_max_m: heights[count - 1],
        }
    }
}

/// The median height of a layer's turns at each degree, m; none where it has no wire.
fn by_degree(places: &[(usize, f64)]) -> Vec<Option<f64>> {
    let mut heights = vec![Vec::new(); STATIONS_PER_TURN];
    for &(station, height) in places {
        heights[station].push(height);
    }
    heights.into_iter().map(median_of).collect()
}

/// The least rise of a layer over another, both as the heights at each degree (m), in a sector: the median of its degrees. Beside a
/// corner heights change fast, so only those at the same degree are compared. Sectors of which half or less is known are left out.
fn least_rise(over: &[Option<f64>], under: &[Option<f64>]) -> Option<f64> {
    let rises: Vec<Option<f64>> = (over.iter().zip(under))
        .map(|(over, under)| Some((*over)? - (*under)?))
        .collect();
    let sectors = rises.chunks(STATIONS_PER_TURN / SECTORS);
    let known = sectors.map(|degrees| degrees.iter().flatten().copied().collect::<Vec<f64>>());
    known
        .filter(|rises| 2 * SECTORS * rises.len() > STATIONS_PER_TURN)
        .filter_map(median_of)
        .reduce(f64::min)
}

/// The middle of values in any order.
fn median_of(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    (!values.is_empty()).then(|| median(&values))
}

/// The middle of values in order, one at least.
fn median(values: &[f64]) -> f64 {
    let count = values.len();
    0.5 * (values[(count - 1) / 2] + values[count / 2])
}

/// The highest layer in which, with those over it, so many turns lie; of each station its layer.
fn highest(layers: impl Iterator<Item = u32>, turns: f64) -> Option<u32> {
    let mut layers: Vec<u32> = layers.collect();
    layers.sort_unstable();
    let least = (turns * STATIONS_PER_TURN as f64) as usize;
    layers
        .len()
        .checked_sub(least)
        .and_then(|k| layers.get(k).copied())
}

impl Coil {
    /// Outer side of each layer that settled wire lies in, from the core outwards.
    pub fn contour(&self) -> Vec<LayerContour> {
        let mut places: BTreeMap<u32, Vec<(usize, f64)>> = BTreeMap::new();
        for (index, station) in self.stations().enumerate() {
            let top = station.height + self.spec.diameter;
            let place = (index % STATIONS_PER_TURN, top);
            places.entry(station.layer).or_default().push(place);
        }
        let mut contour: Vec<LayerContour> = Vec::new();
        let mut first: Option<Vec<Option<f64>>> = None;
        for (layer, places) in places {
            let now = by_degree(&places);
            let rise = least_rise(&now, first.get_or_insert_with(|| now.clone())).unwrap_or(0.0);
            contour.push(LayerContour::of(layer, &places, contour.first(), rise));
        }
        contour
    }

    /// Layers of the settled wire.
    ///
    /// The nozzle makes a pass for each, and at least half a turn lies there. Wire that climbs within its pass is a layer of its own from
    /// two turns on, also where it heaps up turn on turn. So less than two turns lie over the layers of a coil. The last swing of a nozzle
    /// that swings past its places is no pass.
    pub fn layers(&self) -> u32 {
        let end = self.stations().last().map_or(0.0, |station| station.angle);
        let swing = self.last_swing(end);
        let passes = |station: &Station| match swing {
            Some(swing) if station.pass == swing => swing - 1,
            _ => station.pass,
        };
        let by_pass = highest(self.stations().map(|s| s.layer.min(passes(s))), BEGUN);
        let by_wire = highest(self.stations().map(|station| station.layer), LAYER);
        let first = u32::from(self.stations().len() > 0);
        by_wire.max(by_pass).unwrap_or(first)
    }

    /// Turns of settled wire over this layer.
    pub fn turns_over(&self, layer: u32) -> f64 {
        let over = self.stations().filter(|station| station.layer > layer);
        over.count() as f64 / STATIONS_PER_TURN as f64
    }

    /// Least distance of settled wire from a line over the core, m; negative beyond it. `None` without wire.
    ///
    /// The line is `height` (m) over the core at y = 0 and rises towards +y by the angle `taper`, rad.
    pub fn clearance(&self, height: f64, taper: f64) -> Option<f64> {
        let radius = 0.5 * self.spec.diameter;
        self.below(height, taper)
            .map(|centre| centre - radius)
            .reduce(f64::min)
    }

    /// Turns that settled wire would make of what lies beyond such a line, by the share of its section.
    pub fn turns_beyond(&self, height: f64, taper: f64) -> f64 {
        let radius = 0.5 * self.spec.diameter;
        let beyond = self.below(height, taper).map(|centre| {
            // share of a circle that a chord cuts off
            let at = (centre / radius).clamp(-1.0, 1.0);
            (libm::acos(at) - at * (1.0 - at * at).sqrt()) / PI
        });
        beyond.sum::<f64>() / STATIONS_PER_TURN as f64
    }

    /// How far the centreline of settled wire lies below a line over the core, station by station, m.
    fn below(&self, height: f64, taper: f64) -> impl Iterator<Item = f64> {
        let radius = 0.5 * self.spec.diameter;
        let (slope, across) = (libm::tan(taper), libm::cos(taper));
        self.stations()
            .map(move |s| (height + slope * s.position.y - (s.height + radius)) * across)
    }
}
