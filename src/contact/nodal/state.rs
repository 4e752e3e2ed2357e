//! What contact at the nodes remembers, and how it follows changes of the wire.

use super::live::{LiveContact, Wire};
use super::model::NodalModel;
use super::node::NodeContact;
use crate::contact::law::ContactLoss;
use serde::{Deserialize, Serialize};

/// State of each live node's contact, and totals of what was dissipated.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct NodalState {
    /// per live node
    pub nodes: Vec<NodeContact>,
    /// totals of what was dissipated
    pub loss: ContactLoss,
    /// live wire against live wire, where it may meet
    pub live: Option<LiveContact>,
    /// the live wire as that contact saw it last
    pub wire: Wire,
}

impl NodalState {
    /// State of a wire with so many nodes, none of them in touch.
    pub fn new(nodes: usize) -> Self {
        Self {
            nodes: vec![NodeContact::new(); nodes],
            loss: ContactLoss::default(),
            live: None,
            wire: Wire::default(),
        }
    }

    /// Follows the split of edge `j`, whose halves are `half` long, m.
    pub fn split(&mut self, j: usize, half: f64) {
        self.nodes.insert(j + 1, NodeContact::new());
        if let Some(live) = &mut self.live {
            live.insert(j + 1);
            // there is none before the first evaluation
            if self.wire.length.len() > j {
                self.wire.length.insert(j + 1, half);
            }
        }
    }

    /// Node `i` was taken out.
    pub fn merge(&mut self, i: usize) {
        self.nodes.remove(i);
    }

    /// The first `count` nodes left.
    pub fn remove_front(&mut self, count: usize) {
        self.nodes.drain(..count);
        if let Some(live) = &mut self.live {
            live.remove_front(count);
            let lengths = &mut self.wire.length;
            lengths.drain(..count.min(lengths.len()));
        }
    }

    /// Makes every node look its surroundings up again; call when frozen wire has changed.
    pub fn forget_surroundings(&mut self) {
        for n in &mut self.nodes {
            n.reach = -1.0;
        }
    }

    /// What is impossible about a saved state of a wire with so many live `nodes` behind `frozen` ones.
    pub(crate) fn check(
        &self,
        model: &NodalModel,
        nodes: usize,
        frozen: usize,
    ) -> Result<(), &'static str> {
        if self.nodes.len() != nodes {
            return Err("contacts do not go with the nodes");
        }
        let faces = model.surface.mesh().triangles.len();
        let segments = frozen.saturating_sub(1);
        for node in &self.nodes {
            let known = node.reach < 0.0
                || node.faces.iter().all(|f| (*f as usize) < faces)
                    && node.segments.iter().all(|s| (*s as usize) < segments);
            if !known {
                return Err("a node's surroundings are beyond core and frozen wire");
            }
        }
        let fits = self.live.as_ref().is_none_or(|live| live.fits(nodes));
        if !fits || ![0, nodes].contains(&self.wire.length.len()) {
            return Err("a pair is beyond the live wire");
        }
        Ok(())
    }

    /// Ends all touches of node `i`; the bristles of those not `kept` lose what they stored.
    pub(super) fn release(&mut self, model: &NodalModel, i: usize, length: f64, kept: &[bool]) {
        let node = &mut self.nodes[i];
        for (anchor, kept) in node.anchors[..node.count].iter().zip(kept) {
            if !kept {
                self.loss.friction += model.law.stored(0.0, anchor.bristle, length);
            }
        }
        node.count = 0;
    }

    /// Energy stored in node `i`'s touches at the last committed evaluation, J.
    pub fn stored(&self, model: &NodalModel, i: usize, length: f64) -> f64 {
        let node = &self.nodes[i];
        node.anchors[..node.count]
            .iter()
            .map(|a| model.law.stored(a.depth, a.bristle, length))
            .sum()
    }
}
