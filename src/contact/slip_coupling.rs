//! What friction limits that follow the normal force add to the linear system.

use super::stencil::NodeWeights;
use crate::math::{Block, V3, block_times};

/// The slip coupling of a contact point or of a pair of live wires.
///
/// Friction of wire that slides is the coefficient times the normal force. Pressed deeper, it is held back by more, but its
/// slide presses it no deeper: the derivative has no transpose beside it, and no potential holds it.
#[derive(Clone, Copy, Debug)]
pub struct SlipCoupling {
    /// the place of the point
    pub point: NodeWeights,
    /// the foot on the other wire of a pair, with negative weights
    pub foot: Option<NodeWeights>,
    /// derivative of the gradient by the place, or by the distance vector of a pair, N/m
    pub block: Block,
}

impl SlipCoupling {
    /// Adds the product with `x` to `y`; both have `D` unknowns a node, first its coordinates.
    pub fn add_product<const D: usize>(&self, x: &[f64], y: &mut [f64]) {
        let gradient = block_times(&self.block, &self.way::<D>(x));
        for at in std::iter::once(&self.point).chain(&self.foot) {
            at.add_to::<D>(&gradient, y);
        }
    }

    /// The product with `x` from either side.
    pub fn square<const D: usize>(&self, x: &[f64]) -> f64 {
        let way = self.way::<D>(x);
        way.dot(&block_times(&self.block, &way))
    }

    /// Way of the place, or of the distance vector of a pair, in `x`.
    fn way<const D: usize>(&self, x: &[f64]) -> V3 {
        let mut sum = V3::zeros();
        for at in std::iter::once(&self.point).chain(&self.foot) {
            at.add_way::<D>(x, &mut sum);
        }
        sum
    }
}
