//! Blocks of the Hessian between two live wires that touch, which no band holds.

use crate::contact::stencil::NodeWeights;
use crate::math::{Block, V3, block_times};

/// The Hessian between two far-apart places of the wire: `block` times the product of their weights.
#[derive(Clone, Copy, Debug)]
pub struct Coupling {
    /// place of the younger wire
    pub young: NodeWeights,
    /// foot on the older wire, with negative weights
    pub old: NodeWeights,
    /// Hessian with respect to the distance vector, N/m
    pub block: Block,
}

/// Adds the product of the couplings with `x` to `y`; both have `D` unknowns a node, first its coordinates.
pub fn add_couplings<const D: usize>(couplings: &[Coupling], x: &[f64], y: &mut [f64]) {
    for c in couplings {
        // (the block is symmetric)
        for (from, to) in [(&c.old, &c.young), (&c.young, &c.old)] {
            let mut way = V3::zeros();
            from.add_way::<D>(x, &mut way);
            to.add_to::<D>(&block_times(&c.block, &way), y);
        }
    }
}
