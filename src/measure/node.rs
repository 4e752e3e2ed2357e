//! Settled nodes, and what is known of the wire up to each.

use crate::math::V3;
use serde::{Deserialize, Serialize};

/// A node of wire that has come to rest.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SettledNode {
    /// centreline in the core frame, m
    pub position: V3,
    /// unstretched length from the clamp, m
    pub arc: f64,
    /// signed distance of the centreline from the flank of the core (not from a flange), minus the radius, m
    pub height: f64,
    /// way along y from the centreline to the face of the flange beside it, m, negative towards -y; none far from flanges
    pub flange: Option<f64>,
    /// plastic stretch
    pub plastic_strain: f64,
    /// tension of the wire after it, N
    pub tension: f64,
    /// time at which it came to rest, s
    pub time: f64,
}

/// A node with all that is known after it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Node {
    pub(crate) settled: SettledNode,
    pub(crate) polar: f64,
    /// winding angle from the clamp, rad
    pub(crate) angle: f64,
    /// largest winding angle up to here, rad
    pub(crate) reach: f64,
    pub(crate) y_min: f64,
    pub(crate) y_max: f64,
    pub(crate) height_max: f64,
    /// square of the distance from the axis, summed over the wire up to here, m3
    pub(crate) second_moment: f64,
    /// what plastic stretch adds to the wire's resistance up to here, see
    /// [`Coil::added_by_stretch`](super::Coil::added_by_stretch), m
    pub(super) added_by_stretch: f64,
    pub(super) stations_before: usize,
}

impl Node {
    /// [`Coil::added_by_stretch`](super::Coil::added_by_stretch) of a place behind this node and not behind the next, m.
    pub(super) fn added_by_stretch_to(&self, arc: f64) -> f64 {
        let SettledNode {
            arc: from,
            plastic_strain,
            ..
        } = self.settled;
        self.added_by_stretch + added_by_stretch(arc - from, plastic_strain)
    }
}

/// Length of unstretched wire, m, that would add as much to the resistance of so much unstretched wire, m, as its plastic
/// stretch does.
///
/// Plastic flow keeps the volume: wire that is longer by `1 + e` has a section smaller by as much, and `(1 + e)^2` times the
/// resistance.
pub fn added_by_stretch(length: f64, plastic_strain: f64) -> f64 {
    length * plastic_strain * (2.0 + plastic_strain)
}
