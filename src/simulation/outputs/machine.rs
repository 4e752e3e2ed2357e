//! What a model of the machine needs: where the wire is laid.

use super::layon::LayOn;
use crate::math::Spin;
use crate::signals::Outputs;
use crate::simulation::Winding;
use std::f64::consts::TAU;

/// Outputs for a model of the machine.
pub(super) struct Machine {
    layon: [f64; 2],
    layer: u32,
    turn_in_layer: f64,
    clearance: f64,
    resistance: f64,
    inertia: f64,
}

impl Machine {
    pub(super) fn write(self, o: &mut Outputs) {
        [o.layon_x, o.layon_z] = self.layon;
        o.layer = self.layer as i32;
        o.turn_in_layer = self.turn_in_layer;
        o.flange_clearance = self.clearance;
        o.wire_resistance = self.resistance;
        o.coil_inertia = self.inertia;
    }
}

impl Winding {
    /// What a model of the machine needs of wire that is laid at `layon`.
    pub(super) fn for_the_machine(&self, layon: &LayOn) -> Machine {
        let [low, high] = self.ends;
        let y = layon.point.y;
        let on_core = Spin::new(self.sys.state.spindle.angle).to_core(layon.point);
        let way = self.flange_beside(on_core);
        let (layer, begins) = self.coil.layer_being_laid(layon.angle);
        Machine {
            layon: [layon.point.x, layon.point.z],
            layer,
            turn_in_layer: (layon.angle - begins).max(0.0) / TAU,
            clearance: way.map_or((y - low).min(high - y), f64::abs) - self.scene.wire.radius(),
            resistance: self.resistance_of(layon.arc, layon.added_by_stretch),
            inertia: self.coil_inertia(),
        }
    }

    /// Moment of inertia of the settled wire about the axis, kg m2.
    fn coil_inertia(&self) -> f64 {
        self.scene.wire.mass_per_length() * self.coil.second_moment()
    }

    /// Moment that speeds up the settled wire, over the last communication step, N m.
    pub(in crate::simulation) fn torque_of_inertia(&self) -> f64 {
        self.coil_inertia() * self.run.acceleration
    }
}
