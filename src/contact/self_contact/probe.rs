//! What holds each pair of live wire by friction, for a judge that computes the force itself.

use super::pairs::SelfContact;
use crate::math::V3;

/// A pair whose bristle holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeldPair {
    /// number of its contact point
    pub point: usize,
    /// segment of the older live wire on which the foot lies
    pub segment: usize,
    /// stretch of the bristle, core frame, m
    pub bristle: V3,
}

impl SelfContact {
    /// The pairs that friction holds.
    pub fn held(&self) -> impl Iterator<Item = HeldPair> {
        let touching = self.pairs.iter().filter(|p| p.touched && p.depth > 0.0);
        touching.map(|p| HeldPair {
            point: p.point as usize,
            segment: p.segment as usize,
            bristle: p.bristle,
        })
    }
}
