//! What goes into a run and what comes out of it: inputs, outputs, events.

use serde::{Deserialize, Serialize};

/// What the machine tells the simulator.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Inputs {
    /// core angular velocity about +y, rad/s
    pub spindle_speed: f64,
    /// nozzle along the core axis, m
    pub nozzle_position: f64,
    /// pull of the tensioner, N
    pub tension_setpoint: f64,
}

impl Inputs {
    /// All of them 0: rates of inputs that are held.
    pub const HELD: Self = Self {
        spindle_speed: 0.0,
        nozzle_position: 0.0,
        tension_setpoint: 0.0,
    };

    /// Where these inputs are after `dt` (s) at these rates, per s.
    pub fn after(&self, rates: &Self, dt: f64) -> Self {
        Self {
            spindle_speed: self.spindle_speed + rates.spindle_speed * dt,
            nozzle_position: self.nozzle_position + rates.nozzle_position * dt,
            tension_setpoint: self.tension_setpoint + rates.tension_setpoint * dt,
        }
    }
}

/// What the simulator tells the machine at a communication point. Units in the variable table.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs)]
pub struct Outputs {
    pub wire_tension: f64,
    pub wire_tension_min: f64,
    pub wire_tension_max: f64,
    pub defect_bulge: bool,
    pub defect_gap: bool,
    pub defect_overlap: bool,
    pub defect_break: bool,
    pub defect_slack: bool,
    pub defect_code: i32,
    pub defect_count: i32,
    pub defect_turn: f64,
    pub defect_angle: f64,
    pub bulge_height: f64,
    pub gap_width: f64,
    pub overlap_depth: f64,
    pub turns_wound: f64,
    pub turns_settled: f64,
    pub layer: i32,
    pub spindle_angle: f64,
    pub spindle_torque: f64,
    pub feed_speed: f64,
    pub fed_length: f64,
    pub free_length: f64,
    pub layon_position: f64,
    pub layon_angle: f64,
    pub coil_width: f64,
    pub mean_pitch: f64,
    pub fill_factor: f64,
    pub wire_strain: f64,
    pub solver_steps: f64,
    pub solver_rejects: f64,
    pub live_nodes: i32,
    pub penetration_max: f64,
    pub energy_residual: f64,
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
    /// tension rose above the wire's strength
    Break,
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
