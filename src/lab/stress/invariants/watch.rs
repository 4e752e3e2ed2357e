//! Looks at a run at every communication point.

use super::broken::Found;
use super::energy::Energy;
use super::frozen::Frozen;
use super::length::Length;
use super::plastic_work::PlasticWork;
use super::{depth, finite, friction_cone, frozen_tension, tension, wire_in_wire};
use crate::lab::stress::Measures;
use crate::simulation::Simulation;

/// What is remembered from one communication point to the next.
pub(super) struct Watch {
    energy: Energy,
    plastic_work: PlasticWork,
    length: Length,
    frozen: Frozen,
    /// which nodes there were at the last look
    nodes: Vec<u64>,
}

impl Watch {
    pub(super) fn new(sim: &Simulation) -> Self {
        Self {
            energy: Energy::new(sim),
            plastic_work: PlasticWork::new(sim),
            length: Length::new(sim),
            frozen: Frozen::default(),
            nodes: nodes_of(sim),
        }
    }

    pub(super) fn look(&mut self, sim: &Simulation, m: &mut Measures) -> Found {
        finite::look(sim)?;
        self.energy.look(sim, m)?;
        self.length.look(sim)?;
        // nodes put in or taken out move the points that touch and share out tension; the next step brings
        // that in line
        let nodes = nodes_of(sim);
        let same = self.nodes == nodes;
        self.nodes = nodes;
        self.plastic_work.look(sim, same, m)?;
        if same {
            friction_cone::look(sim, m)?;
            tension::look(sim, m)?;
            frozen_tension::look(sim)?;
        }
        depth::look(sim, m)?;
        wire_in_wire::look(sim, m)?;
        self.frozen.look(sim)
    }
}

/// Tells nodes from others: their number may be the same where one came and one went. The unstretched lengths between them
/// are theirs, but for the last, which grows, and the first, which gets what frozen wire gives.
fn nodes_of(sim: &Simulation) -> Vec<u64> {
    let rest = &sim.system().state.rod.rest;
    let lengths = rest[1..rest.len() - 1].iter().map(|l| l.to_bits());
    lengths.chain([sim.centreline().frozen as u64]).collect()
}
