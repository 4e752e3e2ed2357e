//! What is measured at one polar angle of one turn.

use crate::math::V3;
use serde::Serialize;

/// Half the polar angle over which the neighbour one turn back is looked for, rad
/// (default scene, `gap_m`).
pub(crate) const NEIGHBOUR_WINDOW: f64 = 0.5;

/// The wire one turn back, seen from a station.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Neighbour {
    /// distance of the centrelines minus the diameter, m
    pub gap: f64,
    /// axial part of that distance, positive in the direction of the traverse, m
    pub axial: f64,
}

/// The wire at one polar angle, interpolated between nodes; core frame.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Station {
    /// winding angle from the clamp, rad; grows by 2 pi per turn whatever the direction
    pub angle: f64,
    /// centreline, m
    pub position: V3,
    /// unstretched length from the clamp, m
    pub arc: f64,
    /// time at which the wire came to rest here, s
    pub time: f64,
    /// distance of the centreline from the core minus the radius, m
    pub height: f64,
    /// how far the wire could drop before it lay on what it was laid over: wire of earlier rows below it, or the climb to
    /// its own row, else the core, m
    pub bulge: f64,
    /// `bulge` minus the quasi-static height at this angle, which is 0 over wire, m; `None` without a profile
    pub bulge_excess: Option<f64>,
    /// wire one turn back, where it is of the same pass
    pub neighbour: Option<Neighbour>,
    /// diameter minus axial distance where the wire stands on its neighbour, a diameter where it has changed
    /// places with it, else 0, m
    pub overlap_depth: f64,
    /// room along y between the wire and the flange beside it, with or without wire in it, m; `None` where all of the wire lies above
    /// the rims, without flanges, or far from those of a mesh
    pub flange_gap: Option<f64>,
    /// one more than the layer of the wire below, 1 without any
    pub layer: u32,
    /// pass of the traverse, from 1; grows when the traverse turns back
    pub pass: u32,
    /// true in a planned crossover, its own or that of the turn before, and beside it: its gap is no gap of the winding
    pub crosses: bool,
    /// true where the wire stands on a wire of the layer below instead of in a groove, beside no crossover; false where no
    /// crossovers are planned
    pub out_of_groove: bool,
    /// false where the clamp still shapes this wire or its neighbour, and in the step to the next layer
    pub measured: bool,
}

/// Signs at a station, beside gap, bulge and overlap.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Signs {
    /// rise over the wire of its own row that it stands on, m; none where it stands on none
    pub(crate) rise: Option<f64>,
    /// gap to the turn before, m, where a groove of the row below lies empty between them
    pub(crate) empty_groove: Option<f64>,
    /// turns by which the wire climbed before it was meant to, known from where it was meant to
    pub(crate) early: Option<f64>,
    /// turns for which the wire has not climbed though it was meant to
    pub(crate) late: Option<f64>,
    /// plastic stretch
    pub(crate) strain: f64,
    /// how loose the last turn is, 1 at the limit
    pub(crate) loose: Option<f64>,
    /// winding angle since which it lies in its layer, rad
    pub(crate) layer_since: f64,
    /// winding angle since which it lies above the layer planned there, rad
    pub(crate) above_since: Option<f64>,
    /// stations so far where the wire touches nothing
    pub(crate) untouched: u32,
    /// sum of the tensions so far, N
    pub(crate) tension_sum: f64,
}

impl Station {
    /// Distance from the core axis, m.
    pub fn radius(&self) -> f64 {
        (self.position.x * self.position.x + self.position.z * self.position.z).sqrt()
    }
}
