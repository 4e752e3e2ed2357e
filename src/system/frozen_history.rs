//! Frozen wire, as it is kept to let it move again.

use crate::contact::ContactRecord;
use crate::math::{PersistentVec, Quat, V3};
use crate::rod::{Bend, Scalar};
use serde::{Deserialize, Serialize};

/// A frozen node with the edge after it: all it takes to let them move again where they lie.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FrozenNodeRecord {
    /// place, core frame, m
    pub(super) place: V3,
    /// frame of the edge, core frame
    pub(super) frame: Quat,
    /// frame that a clamp at this node has, core frame
    pub(super) clamp: Quat,
    /// unstretched length of the edge when it froze, m
    pub(super) rest: f64,
    pub(super) spin: f64,
    pub(super) stretch: Scalar,
    pub(super) bend: Bend,
    pub(super) twist: Scalar,
    /// plastic bending of the edge's second half, which froze with the edge while the node at its end stayed live
    pub(super) end_bend: Bend,
    /// plastic twist there
    pub(super) end_twist: Scalar,
    pub(super) memory: ContactRecord,
}

impl FrozenNodeRecord {
    /// Bends the edge's second half by `angle` (rad) more, for good.
    pub(super) fn fold_end(&mut self, angle: [f64; 2]) {
        for (curvature, angle) in self.end_bend.curvature.iter_mut().zip(angle) {
            *curvature += angle / (0.5 * self.rest);
        }
    }

    /// Whether it can come back to life; bytes from elsewhere may say anything.
    pub(crate) fn is_sound(&self) -> bool {
        self.memory.is_sound()
    }
}

/// Frozen wire; a chunk is about half a turn of fine wire.
pub type FrozenHistory = PersistentVec<FrozenNodeRecord, 64>;
