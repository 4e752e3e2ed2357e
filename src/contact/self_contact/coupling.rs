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
        one_way::<D>(&c.block, &c.old, &c.young, x, y);
        one_way::<D>(&c.block, &c.young, &c.old, x, y);
    }
}

fn one_way<const D: usize>(
    block: &Block,
    from: &NodeWeights,
    to: &NodeWeights,
    x: &[f64],
    y: &mut [f64],
) {
    let mut s = V3::zeros();
    for (n, w) in from.iter() {
        for a in 0..3 {
            s[a] += w * x[D * n + a];
        }
    }
    // the block is symmetric
    let t = block_times(block, &s);
    for (n, w) in to.iter() {
        for a in 0..3 {
            y[D * n + a] += w * t[a];
        }
    }
}
