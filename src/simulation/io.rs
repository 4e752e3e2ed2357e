//! The wire as a line, and why a run ends early.

use crate::math::{Quat, V3};

/// The wire's centreline in the core frame, clamp first, nozzle last.
#[derive(Clone, Debug, Default)]
pub struct Centreline {
    /// node positions, m
    pub points: Vec<V3>,
    /// material frame of the edge leaving each node (the last repeats), body z along the edge
    pub frames: Vec<Quat>,
    /// unstretched length from the clamp, m
    pub arc: Vec<f64>,
    /// plastic stretch of the edge leaving each node
    pub plastic_stretch: Vec<f64>,
    /// largest plastic strain in the section at each node: the plastic stretch and what the plastic curvature adds at the
    /// surface of the bare wire
    pub plastic_strain: Vec<f64>,
    /// tension of the edge leaving each node, N
    pub tension: Vec<f64>,
    /// the first `frozen` nodes are fixed geometry, the rest is live
    pub frozen: usize,
}

/// The run can't start or can't go on.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub struct SimError {
    /// when, s
    pub time: f64,
    /// where: live node from the clamp, if one is to blame
    pub node: Option<usize>,
    /// why
    pub reason: String,
}

impl SimError {
    /// An error of the set-up, before any time has passed.
    pub fn setup(reason: String) -> Self {
        Self {
            time: 0.0,
            node: None,
            reason,
        }
    }
}

impl std::fmt::Display for SimError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "at t = {:.9} s", self.time)?;
        if let Some(node) = self.node {
            write!(f, ", live node {node}")?;
        }
        write!(f, ": {}", self.reason)
    }
}
