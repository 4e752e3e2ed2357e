//! Where the nozzle stands in a run that is driven by inputs.

use super::Winding;
use crate::math::V3;
use crate::scene::Scene;
use crate::signals::Inputs;

/// Place of the nozzle by its inputs, in the frame at rest, m.
pub(super) fn nozzle_of(scene: &Scene, inputs: &Inputs) -> V3 {
    V3::new(
        scene.nozzle.distance + inputs.nozzle_offset_x,
        inputs.nozzle_position,
        inputs.nozzle_offset_z,
    )
}

impl Winding {
    /// Where the nozzle has to be at the end of a step whose inputs end as `end`, m: along the core axis as its law says,
    /// where it follows one.
    pub(super) fn nozzle_at_end(&self, end: &Inputs) -> V3 {
        let mut place = nozzle_of(&self.scene, end);
        if self.run.nozzle_by_law {
            place.y = self.nozzle_by_law();
        }
        place
    }

    /// Distance of the nozzle from the core axis, m.
    pub(super) fn nozzle_distance(&self) -> f64 {
        let nozzle = self.sys.state.support[1].point;
        libm::hypot(nozzle.x, nozzle.z)
    }
}
