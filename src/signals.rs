//! What goes into a run and what comes out of it: inputs, outputs, events.

use serde::{Deserialize, Serialize};

/// What the machine tells the simulator: its inputs at one moment.
///
/// The core turns about +y of the frame of the laboratory; the nozzle of the scene stands on +x.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Inputs {
    /// core angular velocity about +y, rad/s
    pub spindle_speed: f64,
    /// nozzle along the core axis, m
    pub nozzle_position: f64,
    /// pull of the tensioner, N
    pub tension_setpoint: f64,
    /// nozzle beyond its distance in the scene, along x, m
    pub nozzle_offset_x: f64,
    /// nozzle beside the plane of the scene's nozzle and the core axis, along z, m
    pub nozzle_offset_z: f64,
    /// torque that holds the tensioner's wheel back, N m; over the wheel's radius it adds to `tension_setpoint`
    pub brake_torque: f64,
    /// damper on the tensioner beside that of the scene, N s/m
    pub tensioner_damping: f64,
}

impl Inputs {
    /// All of them 0: rates of inputs that are held.
    pub const HELD: Self = Self {
        spindle_speed: 0.0,
        nozzle_position: 0.0,
        tension_setpoint: 0.0,
        nozzle_offset_x: 0.0,
        nozzle_offset_z: 0.0,
        brake_torque: 0.0,
        tensioner_damping: 0.0,
    };

    /// Rate of an input of which is told that it stands still, where a rate of 0 says nothing: the least number above it.
    pub const STILL: f64 = f64::MIN_POSITIVE;

    /// Where these inputs are after `dt` (s) at these rates, per s.
    pub fn after(&self, rates: &Self, dt: f64) -> Self {
        let led = |value: f64, rate: f64| match rate == Self::STILL {
            true => value,
            false => value + rate * dt,
        };
        Self {
            spindle_speed: led(self.spindle_speed, rates.spindle_speed),
            nozzle_position: led(self.nozzle_position, rates.nozzle_position),
            tension_setpoint: led(self.tension_setpoint, rates.tension_setpoint),
            nozzle_offset_x: led(self.nozzle_offset_x, rates.nozzle_offset_x),
            nozzle_offset_z: led(self.nozzle_offset_z, rates.nozzle_offset_z),
            brake_torque: led(self.brake_torque, rates.brake_torque),
            tensioner_damping: led(self.tensioner_damping, rates.tensioner_damping),
        }
    }
}

/// What the simulator tells the machine at a communication point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Outputs {
    /// tension in the free span at the nozzle exit, N; 0 at the end of the step in which winding ends, and from then on
    pub wire_tension: f64,
    /// smallest wire_tension since the last communication point, N
    pub wire_tension_min: f64,
    /// largest wire_tension since the last communication point, N
    pub wire_tension_max: f64,
    /// wire stands off a face of the core by more than allowed
    pub defect_bulge: bool,
    /// neighbouring turns lie apart by more than allowed
    pub defect_gap: bool,
    /// a turn has climbed on its neighbour or changed places with it
    pub defect_overlap: bool,
    /// tension above the strength of the wire
    pub defect_break: bool,
    /// tension fell to zero
    pub defect_slack: bool,
    /// bit mask of [`DefectKind::code`](crate::measure::DefectKind::code)
    pub defect_code: i32,
    /// defects of coil and wire, of every kind
    pub defect_count: i32,
    /// turn of the last defect
    pub defect_turn: f64,
    /// polar angle of the last defect within its turn, rad
    pub defect_angle: f64,
    /// largest bulge of the last 360 settled stations, m
    pub bulge_height: f64,
    /// widest gap to the neighbouring turn, last settled turn, m
    pub gap_width: f64,
    /// deepest overlap with the neighbouring turn, last settled turn, m
    pub overlap_depth: f64,
    /// turns laid, counted from the clamp
    pub turns_wound: f64,
    /// turns come to rest; falls on reversal
    pub turns_settled: f64,
    /// layer of the last settled wire, from 1; rises once wire of the new layer has settled
    pub layer: i32,
    /// core angle from the start position, rad
    pub spindle_angle: f64,
    /// moment of the wire on the core about +y, N m; negative when it resists positive speed
    pub spindle_torque: f64,
    /// speed of the wire leaving the nozzle, m/s; 0 at the end of the step in which winding ends, and from then on
    pub feed_speed: f64,
    /// wire that has left the nozzle since the start, m
    pub fed_length: f64,
    /// wire between lift-off and nozzle, m
    pub free_length: f64,
    /// where the wire meets the coil, along y, m
    pub layon_position: f64,
    /// where the wire meets the coil, polar angle in the core frame, rad
    pub layon_angle: f64,
    /// extent of the settled wire along y, m
    pub coil_width: f64,
    /// mean axial advance per turn of the settled wire, m
    pub mean_pitch: f64,
    /// wire section over the winding section it takes up, settled wire
    pub fill_factor: f64,
    /// largest plastic stretch of the last settled turn
    pub wire_strain: f64,
    /// bulges of the settled wire
    pub defect_count_bulge: i32,
    /// gaps of the settled wire
    pub defect_count_gap: i32,
    /// overlaps of the settled wire
    pub defect_count_overlap: i32,
    /// breaks so far
    pub defect_count_break: i32,
    /// how often the wire went slack so far
    pub defect_count_slack: i32,
    /// kind of the last defect, as in `defect_code`; 0: none so far
    pub defect_kind: i32,
    /// time of the last defect since the start of the run, s
    pub defect_time: f64,
    /// size of the last defect where it was found, m; 0 for slack, break, collision and runaway
    pub defect_size: f64,
    /// wire let go by the tensioner since the start, m
    pub tensioner_position: f64,
    /// speed of the wire at the tensioner, m/s
    pub tensioner_speed: f64,
    /// angle at the nozzle between the free span and the plane across the core's axis, rad; positive: the wire goes to
    /// larger y than the nozzle's
    pub nozzle_angle: f64,
    /// wire from the clamp to where it meets the coil, unstretched, m
    pub wire_length: f64,
    /// nozzle along the core axis, m
    pub nozzle_y: f64,
    /// where the wire's centreline meets the coil, along x of the frame at rest, m
    pub layon_x: f64,
    /// where the wire's centreline meets the coil, along z of the frame at rest, m
    pub layon_z: f64,
    /// turns of the layer that is being laid
    pub turn_in_layer: f64,
    /// from the surface of the wire where it meets the coil to the nearer flange or end of the core, along y, m
    pub flange_clearance: f64,
    /// resistance of the wire from the clamp to where it meets the coil, at 20 degC, ohm
    pub wire_resistance: f64,
    /// moment of inertia of the settled wire about the core axis, kg m2
    pub coil_inertia: f64,
    /// `spindle_torque` less what speeds the settled wire up, N m
    pub spindle_torque_total: f64,
    /// unstretched wire from the clamp to where it broke, m; 0 for whole wire
    pub break_position: f64,
    /// double turns of the settled wire
    pub defect_count_double_turn: i32,
    /// skipped grooves of the settled wire
    pub defect_count_skipped_groove: i32,
    /// early layer jumps of the settled wire
    pub defect_count_early_jump: i32,
    /// late layer jumps of the settled wire
    pub defect_count_late_jump: i32,
    /// loose turns of the settled wire
    pub defect_count_loose_turn: i32,
    /// overstretched turns of the settled wire
    pub defect_count_overstretch: i32,
    /// collisions of coil and nozzle so far
    pub defect_count_collision: i32,
    /// how often wire shot out of the nozzle so far
    pub defect_count_runaway: i32,
    /// time steps taken
    pub solver_steps: f64,
    /// time steps rejected
    pub solver_rejects: f64,
    /// nodes still computed
    pub live_nodes: i32,
    /// deepest penetration in contact since the last communication point, m
    pub penetration_max: f64,
    /// error of the energy balance since the start, J
    pub energy_residual: f64,
}

/// Groups of Real outputs by how they follow the inputs of a communication step.
macro_rules! group {
    ($(#[$about:meta])* $names:ident, $get:ident, $with:ident: $($field:ident),* $(,)?) => {
        impl Outputs {
            $(#[$about])*
            pub const $names: &'static [&'static str] = &[$(stringify!($field)),*];

            /// Values of the group, in its order and in the units of the outputs.
            pub(crate) fn $get(&self) -> [f64; Self::$names.len()] {
                [$(self.$field),*]
            }

            /// These outputs with other values of the group.
            pub(crate) fn $with(self, [$($field),*]: [f64; Self::$names.len()]) -> Self {
                Self { $($field,)* ..self }
            }
        }
    };
}

group! {
    /// Names of the outputs that follow the inputs smoothly, wherever no wire lands and none comes to rest in the step.
    SMOOTH, smooth, with_smooth:
    wire_tension, wire_tension_min, wire_tension_max, turns_wound, spindle_angle, spindle_torque,
    feed_speed, fed_length, free_length, layon_position, layon_angle, tensioner_position,
    tensioner_speed, nozzle_angle, nozzle_y, layon_x, layon_z, spindle_torque_total, wire_length,
    wire_resistance, flange_clearance, turn_in_layer,
}

group! {
    /// Names of the measures of settled wire: they follow the inputs where wire comes to rest in the step.
    SETTLED, settled, with_settled:
    turns_settled, bulge_height, gap_width, overlap_depth, coil_width, mean_pitch, fill_factor,
    wire_strain, coil_inertia,
}

impl Outputs {
    /// Takes a tension, N, into the extremes.
    pub(crate) fn meet_tension(&mut self, tension: f64) {
        self.wire_tension_min = self.wire_tension_min.min(tension);
        self.wire_tension_max = self.wire_tension_max.max(tension);
    }

    /// Takes a depth of contact, m, into the extreme.
    pub(crate) fn meet_depth(&mut self, depth: f64) {
        self.penetration_max = self.penetration_max.max(depth);
    }
}

/// What kind of thing happened.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum EventKind {
    /// a turn is complete and at rest
    Turn,
    /// a defect was found
    Defect,
    /// tension fell to zero
    Slack,
    /// the wire parted
    Break,
    /// the coil has grown into the nozzle
    Collision,
    /// the wire shoots out of the nozzle
    Runaway,
    /// the coil is judged otherwise than perhaps meant
    Judgement,
    /// what a reader of the verdict should know
    Note,
    /// the solver had to go back and take shorter steps
    Solver,
}

/// Something worth telling.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Event {
    /// when, s
    pub time: f64,
    /// turns wound by then
    pub turn: f64,
    /// core angle from the start, rad
    pub angle: f64,
    /// what kind
    pub kind: EventKind,
    /// in words
    pub text: String,
}

impl std::fmt::Display for Event {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(
            f,
            "t = {:.6} s, turn {:.3}, core at {:.1} deg: {}",
            self.time,
            self.turn,
            self.angle.to_degrees(),
            self.text
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A spindle told to stand, at a rate of 0, turned at the least number there is, and its standstill was solved for.
    #[test]
    fn what_is_told_to_stand_stands() {
        let rates = Inputs {
            spindle_speed: Inputs::STILL,
            nozzle_position: 1.0,
            ..Inputs::HELD
        };
        let led = Inputs::HELD.after(&rates, 1e-3);
        assert_eq!((led.spindle_speed, led.nozzle_position), (0.0, 1e-3));
    }
}
