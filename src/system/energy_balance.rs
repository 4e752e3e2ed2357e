//! Where energy comes from and where it goes.

use serde::{Deserialize, Serialize};

/// Where energy came from and went, J, since the start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct EnergyBalance {
    /// work of the spindle on the wire
    pub spindle: f64,
    /// work of the feed on the wire (negative: the wire pulls against the tensioner)
    pub nozzle: f64,
    /// motion energy of wire that came in
    pub inflow: f64,
    /// plastic work: bending, twist, stretch
    pub plastic: [f64; 3],
    /// slip against friction
    pub friction: f64,
    /// contact dashpots
    pub damping: f64,
    /// losses of the time steps
    pub numerical: f64,
    /// losses where the mesh changes: splits and joins, frozen and thawed wire, wire that comes out
    pub remeshing: f64,
    /// elastic energy locked into frozen wire
    pub frozen_stored: f64,
    /// motion energy handed to the core with frozen wire
    pub frozen_kinetic: f64,
    /// stored and motion energy at the start
    pub initial: f64,
}
