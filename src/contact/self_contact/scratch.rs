//! What contact of live wire with live wire works with.

use super::by_place::Blocks;
use super::coupling::Coupling;
use super::pairs::Pair;
use crate::contact::friction::FrictionLimit;
use crate::contact::slip_coupling::SlipCoupling;
use crate::contact::stencil::NodeWeights;
use crate::math::{Block, V3};

/// A listed pair and the quadratic model of its potential in the linear system, by the distance vector.
#[derive(Clone, Copy, Debug)]
pub(super) struct NearPair {
    /// index of the pair
    pub(super) pair: u32,
    /// the point
    pub(super) young: NodeWeights,
    /// its foot, with negative weights
    pub(super) old: NodeWeights,
    /// contact stiffness of the wire that the point stands for, N/m
    pub(super) stiffness: f64,
    /// gradient at the iterate, N
    pub(super) gradient: V3,
    /// Hessian, N/m
    pub(super) hessian: Block,
    /// see [`ContactResponse::slip_coupling`](crate::contact::ContactResponse::slip_coupling)
    pub(super) slip_coupling: Block,
    /// distance to touching, while the model has no touch, m
    pub(super) room: f64,
    /// the model is that of a place that an update led to
    pub(super) predicted: bool,
    /// direction of the slide in the model; 0: the bristle holds
    pub(super) slide: V3,
    /// friction limit of the bristle if the model holds it beyond that, N; infinite: it does not
    pub(super) held: f64,
    /// index of its coupling, if it has one
    pub(super) coupling: Option<u32>,
}

/// A contact point next to older wire with which it makes no pair.
#[derive(Clone, Copy, Debug)]
pub(super) struct Unpaired {
    /// number of the point
    pub(super) point: u32,
    /// way that both together may move before they would be a pair, m
    pub(super) room: f64,
    /// node of the older wire
    pub(super) other: u32,
}

/// Where the search for older wire is, so many turns back along the wire.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Reached {
    /// node by its angle
    pub(super) near: usize,
    /// segment with the foot of the point before, if that is there
    pub(super) foot: Option<u32>,
}

/// Work arrays of the pairs. Nothing in here outlives a step.
#[derive(Clone, Debug, Default)]
pub struct PairScratch {
    /// the pairs of the step before, while those of the next are listed
    pub(super) previous: Vec<Pair>,
    /// polar angle of each node from the clamp, rad
    pub(super) angle: Vec<f64>,
    /// unstretched length from the clamp to each node, m
    pub(super) arc: Vec<f64>,
    /// largest of the angles up to each node, as far as the wire was looked at, rad
    pub(super) farthest: Vec<f64>,
    /// the wire by place, where it has loops
    pub(super) blocks: Blocks,
    /// nodes of older wire near the point that is looked at, and segments with which it was paired
    pub(super) found: Vec<u32>,
    pub(super) paired: Vec<u32>,
    /// points next to wire with which they make no pair
    pub(super) unpaired: Vec<Unpaired>,
    /// by turns back along the wire, how far the search has come
    pub(super) reached: Vec<Reached>,
    /// friction limits by which the last solve went, pair by pair
    pub used: Vec<FrictionLimit>,
    /// room for the wire in the core frame
    pub wire: Vec<V3>,
    /// couplings of nodes on touching live wires, by the last evaluation
    pub couplings: Vec<Coupling>,
    /// the pairs as the linear system sees them
    pub(super) near: Vec<NearPair>,
}

impl PairScratch {
    /// Adds the slip couplings of the pairs to `list`.
    pub(crate) fn list_slip_couplings(&self, list: &mut Vec<SlipCoupling>) {
        for near in &self.near {
            if near.slip_coupling != Block::default() {
                list.push(SlipCoupling {
                    point: near.young,
                    foot: Some(near.old),
                    block: near.slip_coupling,
                });
            }
        }
    }

    /// Empties the work arrays.
    pub(crate) fn clear(&mut self) {
        let Self {
            previous,
            angle,
            arc,
            farthest,
            blocks,
            found,
            paired,
            unpaired,
            reached,
            used,
            wire,
            couplings,
            near,
        } = self;
        previous.clear();
        angle.clear();
        arc.clear();
        farthest.clear();
        blocks.clear();
        found.clear();
        paired.clear();
        unpaired.clear();
        reached.clear();
        used.clear();
        wire.clear();
        couplings.clear();
        near.clear();
    }
}
