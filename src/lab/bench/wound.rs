//! What a winding run is judged by: bulge and gap of one turn, tension extremes of each.

use serde::{Deserialize, Serialize};

/// What a run is judged by.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Wound {
    /// bulge at the stations of turn 2, m; `None` where nothing is measured
    pub bulge: Vec<Option<f64>>,
    /// gap to turn 1 there, m; `None` where nothing is measured or no neighbour is found
    pub gap: Vec<Option<f64>>,
    /// tension extremes of each turn of the spindle
    pub tension: Vec<Extremes>,
}

/// Smallest and largest tension of a turn.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Extremes {
    /// N
    #[serde(rename = "min_N")]
    pub min: f64,
    /// N
    #[serde(rename = "max_N")]
    pub max: f64,
}

impl Extremes {
    /// Of no values.
    pub(super) fn none() -> Self {
        Self {
            min: f64::INFINITY,
            max: f64::NEG_INFINITY,
        }
    }

    /// With these as well.
    pub(super) fn add(&mut self, min: f64, max: f64) {
        self.min = self.min.min(min);
        self.max = self.max.max(max);
    }
}
