//! The one door to a run: scene in, inputs in, outputs and events out.
//!
//! A step reads as a list of stages: move, feed, forces ([`crate::integrate`]), then keeping
//! house (insert wire at the nozzle, refine near the core, let settled wire go), then measure.

mod broken;
mod coarsen;
mod door;
mod freezing;
mod io;
mod motion_profile;
mod outputs;
mod quasi_static;
mod rates;
mod remeshing;
mod saved;
mod sensitivity;
mod start;
mod stepping;
mod summary;

pub use freezing::{FreezePolicy, Watch};
pub use io::{Centreline, SimError};
pub use motion_profile::MotionProfile;
pub use saved::RestoreError;
pub use start::core_surface;
pub use summary::{EnergySummary, PenetrationSummary, Summary};

use crate::integrate::{SolverStatistics, Stepper};
use crate::measure::Coil;
use crate::scene::Scene;
use crate::signals::{Event, EventKind, Inputs, Outputs};
use crate::system::System;
use rates::Instant;

/// Wire slower than this, m/s, on a standing core counts as quiet: in a second it would move by less than
/// the error that one step may have.
const QUIET: f64 = 1e-6;

/// Tension below which wire is slack, N: chosen as the weight of 3 cm of 0.7 mm wire, half a free span.
const SLACK: f64 = 1e-3;

/// Communication steps are solved for once they add up to this, s, the solver's own shortest step: in less,
/// wire at 5000 rpm moves by 20 nm at most and what is solved for drowns in rounding.
const WORTH_A_STEP: f64 = 1e-9;

/// Steps between looks for edges to refine and values that are not finite.
const REMESH_STEPS: u64 = 32;

/// A winding run.
#[derive(Clone, Debug)]
pub struct Simulation {
    scene: Scene,
    sys: System,
    coil: Coil,
    watch: Watch,
    policy: FreezePolicy,
    /// polar angle from each laid node to lift-off, at the last look, rad
    behind: Vec<f64>,
    motion_profile: MotionProfile,
    /// core angle at the start, rad
    angle0: f64,
    stepper: Stepper,
    last_step: f64,
    /// length of the last communication step, s; 0: none yet
    last_span: f64,
    time: f64,
    steps: u64,
    outputs: Outputs,
    /// per s, see [`Simulation::output_rates`]
    rates: Outputs,
    /// before the last step of the method
    instant: Instant,
    /// what adding up steps has lost of `time`, s
    time_lost: f64,
    /// time passed that the wire has not, see [`WORTH_A_STEP`], s
    owed: f64,
    events: Vec<Event>,
    /// deepest penetration of wire when it came to rest, m
    rest_depth: f64,
    broken: bool,
    was_slack: bool,
    /// how long core, nozzle, tensioner and wire have been still, s
    quiet: f64,
    /// farthest that the spindle has been from where it started, rad
    farthest: f64,
    /// farthest nozzle position of this pass, m, and its direction along y
    pass: (f64, f64),
    /// steps tried so far, each counted as often as it had nodes, and how much of that may be
    work: u64,
    most_work: u64,
}

impl Simulation {
    /// Input values at this moment.
    pub fn inputs(&self) -> Inputs {
        Inputs {
            spindle_speed: self.sys.spindle.speed,
            nozzle_position: self.sys.support[1].point.y,
            tension_setpoint: self.sys.set_tension,
        }
    }

    /// Lets the run end with an error once so many steps have been tried since the start, taken or not, each counted
    /// as often as it had nodes: a bound on the work that does not depend on the clock.
    pub fn limit_work(&mut self, most: u64) {
        self.most_work = most;
    }

    /// What [`Self::limit_work`] counts.
    pub fn work(&self) -> u64 {
        self.work
    }

    /// Elapsed time, s.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// The scene this run was made from.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Outputs at the last communication point.
    pub fn outputs(&self) -> &Outputs {
        &self.outputs
    }

    /// Settled wire and its measures.
    pub fn coil(&self) -> &Coil {
        &self.coil
    }

    /// The programme of the scene.
    pub fn motion_profile(&self) -> &MotionProfile {
        &self.motion_profile
    }

    /// What happened since the last call.
    pub fn drain_events(&mut self) -> Vec<Event> {
        std::mem::take(&mut self.events)
    }

    pub(super) fn report(&mut self, kind: EventKind, text: String) {
        let turn = self.outputs.turns_wound;
        self.events.push(Event {
            time: self.sys.time,
            turn,
            angle: self.sys.spindle.angle - self.angle0,
            kind,
            text,
        });
    }

    /// Takes over the tunable parameters of another version of the scene.
    pub fn retune(&mut self, scene: &Scene) {
        if self.scene.friction != scene.friction {
            // What holds at rest with one friction may slide with another.
            self.quiet = 0.0;
        }
        self.scene.defects = scene.defects;
        self.scene.friction = scene.friction;
        self.coil.set_limits(scene.defects);
        if let Some(law) = self.sys.contact.law_mut() {
            law.mu_static = scene.friction.static_;
            law.mu_kinetic = scene.friction.kinetic;
            law.slip_speed = scene.friction.slip_speed;
        }
    }

    /// What the implicit method took so far; nothing for an explicit one.
    pub fn statistics(&self) -> SolverStatistics {
        self.stepper.statistics()
    }

    /// The mechanical system, for verification and tests.
    pub fn system(&self) -> &System {
        &self.sys
    }

    /// The same, to put loads on it that no scene has (verification only).
    pub fn system_mut(&mut self) -> &mut System {
        &mut self.sys
    }
}
