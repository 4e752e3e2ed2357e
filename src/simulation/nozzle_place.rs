//! Where the nozzle stands in a run that is driven by inputs, and that it stays clear of the core.

use super::{SimError, Winding};
use crate::math::V3;
use crate::scene::{Scene, si};
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

    /// Refuses inputs that send the nozzle into the circle that the core sweeps, as long as there is wire to wind.
    pub(super) fn check_nozzle(&self, end: &Inputs) -> Result<(), SimError> {
        if self.run.over {
            return Ok(());
        }
        let nozzle = nozzle_of(&self.scene, end);
        let sweeps = self
            .sys
            .model
            .core
            .as_ref()
            .map_or(0.0, |core| core.radius_max());
        let least = sweeps + self.scene.wire.radius();
        if libm::hypot(nozzle.x, nozzle.z) > least {
            return Ok(());
        }
        Err(SimError {
            time: self.run.time,
            node: None,
            reason: format!(
                "nozzle_offset_x = {} m and nozzle_offset_z = {} m put the nozzle into the circle of radius {} m that the core sweeps; allowed: more than that from the axis",
                si(end.nozzle_offset_x),
                si(end.nozzle_offset_z),
                si(least)
            ),
        })
    }
}
