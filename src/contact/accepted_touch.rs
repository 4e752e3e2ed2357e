//! A touch as the impulses of landings see it.

use super::stencil::{ContactPoint, NodeWeights};
use crate::math::V3;

/// Depth from which wire still comes from outside, as a share of the onset: wire that is laid in touch is outside but for rounding.
pub(super) const OUTSIDE: f64 = 1e-3;

/// A touch at the accepted end of a step; core frame.
#[derive(Clone, Copy, Debug)]
pub struct AcceptedTouch {
    /// the contact point
    pub point: ContactPoint,
    /// nodes of the live wire that it touches, with negative weights
    pub old: Option<NodeWeights>,
    /// unit normal towards the point
    pub normal: V3,
    /// force on the point, N
    pub force: V3,
    /// friction that the solve took too much, because its limit was that of an earlier iterate, N
    pub surplus: V3,
    /// it began within the step
    pub began: bool,
    /// the wire came to it from outside within the step
    pub lands: bool,
    /// speed at which it may open, m/s: what its landing gives back
    pub rebound: f64,
    /// where it is kept
    pub owner: TouchOwner,
}

/// Which touch it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TouchOwner {
    /// of a contact point with the core (0) or a passage of frozen wire
    Point {
        /// number of the point
        point: usize,
        /// number of the touch
        slot: usize,
    },
    /// of a pair of live wire
    Pair(usize),
}

/// Force on the point of the bristle of a touch, N, and the surplus of the solve. The touch was solved with the friction limit
/// `used`, N, and holds `limit`. The bristle has the stretch `b` (m) and the stiffness `k` (N/m).
pub(super) fn friction_of(b: &V3, k: f64, limit: f64, used: f64) -> (V3, V3) {
    let pull = k * b.norm();
    if pull <= limit.min(used) {
        return (-b * k, V3::zeros());
    }
    let along = b * (k / pull);
    let kept = pull.min(limit);
    (-along * kept, along * (pull.min(used) - kept))
}
