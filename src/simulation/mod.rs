//! The one door to a run: scene in, inputs in, outputs and events out.
//!
//! A step reads as a list of stages: move, feed, forces ([`crate::integrate`]), then remeshing
//! (insert wire at the nozzle, refine near the core, let settled wire go), then measure.

mod broken;
mod coarsen;
mod core_model;
mod door;
mod faults;
mod freezing;
mod io;
mod judgement;
mod layon;
mod machine;
mod motion_profile;
mod nozzle_by_law;
mod nozzle_place;
mod nozzle_way;
mod outputs;
mod product;
mod quasi_static;
mod rates;
mod remeshing;
mod run_state;
mod saved;
mod start;
mod step_derivatives;
mod stepping;
mod summary;
mod traverse;

pub use crate::geometry::{Surface, TriMesh};
pub use crate::integrate::SolverStatistics;
pub use core_model::core_surface;
pub use freezing::{FreezePolicy, Watch};
pub use io::{Centreline, SimError};
pub use motion_profile::MotionProfile;
pub use product::{Fill, Product};
pub use saved::RestoreError;
pub use summary::{EnergySummary, PenetrationSummary, Summary};

use crate::integrate::Stepper;
use crate::measure::Coil;
use crate::scene::Scene;
use crate::signals::{Event, EventKind, Inputs, Outputs};
use crate::system::System;
use run_state::RunState;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// Speed below which wire on a standing core counts as quiet, m/s.
///
/// In a second such wire moves by less than the error that one step may have.
const QUIET: f64 = 1e-6;

/// Tension below which wire is slack, N: the weight of 3 cm of 0.7 mm wire, half a free span.
const SLACK: f64 = 1e-3;

/// Time to which communication steps add up before the solver takes a step, s.
///
/// It is the solver's own shortest step. In less time, wire at 5000 rpm moves by 20 nm at most, and
/// rounding errors dominate the solution.
const WORTH_A_STEP: f64 = 1e-9;

/// Steps between looks for edges to refine and values that are not finite.
const REMESH_STEPS: u64 = 32;

/// A winding run.
#[derive(Clone, Debug)]
pub struct Simulation {
    scene: Scene,
    motion_profile: MotionProfile,
    sys: System,
    coil: Coil,
    stepper: Stepper,
    run: RunState,
    /// polar angle from each laid node to lift-off, at the last look, rad
    behind: Vec<f64>,
    /// between which wire can be wound along y, m
    ends: [f64; 2],
    /// how much [`RunState::work`] may become; the caller's
    most_work: u64,
    /// ends a step of the run early where it is up; the caller's
    stop: Option<Arc<AtomicBool>>,
}

impl Simulation {
    /// Input values at this moment.
    pub fn inputs(&self) -> Inputs {
        Inputs {
            spindle_speed: self.sys.state.spindle.speed,
            nozzle_position: self.sys.state.support[1].point.y,
            tension_setpoint: self.sys.state.set_tension,
            nozzle_offset_x: self.sys.state.support[1].point.x - self.scene.nozzle.distance,
            nozzle_offset_z: self.sys.state.support[1].point.z,
        }
    }

    /// Bounds the work of the run: beyond `most`, [`Self::advance`] returns an error.
    ///
    /// The work is the number of steps tried since the start, each times its number of nodes.
    /// Rejected steps count too. The bound does not depend on the clock.
    pub fn limit_work(&mut self, most: u64) {
        self.most_work = most;
    }

    /// Lets a step of the run end early, with an error, once `flag` is up, however long the step is. The run then stands at the
    /// last good step of the method.
    pub fn stop_on(&mut self, flag: Arc<AtomicBool>) {
        self.stop = Some(flag);
    }

    /// What [`Self::limit_work`] counts.
    pub fn work(&self) -> u64 {
        self.run.work
    }

    /// Elapsed time, s.
    pub fn time(&self) -> f64 {
        self.run.time
    }

    /// The scene this run was made from.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Outputs at the last communication point.
    pub fn outputs(&self) -> &Outputs {
        &self.run.outputs
    }

    /// Settled wire and its measures.
    pub fn coil(&self) -> &Coil {
        &self.coil
    }

    /// The motion profile of the scene.
    pub fn motion_profile(&self) -> &MotionProfile {
        &self.motion_profile
    }

    /// What happened since the last call.
    pub fn drain_events(&mut self) -> Vec<Event> {
        std::mem::take(&mut self.run.events)
    }

    pub(super) fn report(&mut self, kind: EventKind, text: String) {
        let turn = self.run.outputs.turns_wound;
        self.run.events.push(Event {
            time: self.sys.state.time,
            turn,
            angle: self.sys.state.spindle.angle - self.run.angle0,
            kind,
            text,
        });
    }

    /// Takes over the tunable parameters of another version of the scene.
    pub fn retune(&mut self, scene: &Scene) {
        if self.scene.friction != scene.friction {
            // What holds at rest with one friction may slide with another.
            self.run.quiet = 0.0;
        }
        self.scene.defects = scene.defects;
        self.scene.friction = scene.friction;
        self.coil.set_limits(scene.defects);
        if let Some(law) = self.sys.model.contact.law_mut() {
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
    #[cfg(feature = "lab")]
    #[doc(hidden)]
    pub fn system(&self) -> &System {
        &self.sys
    }

    /// The same, to put loads on it that no scene has (verification only).
    #[cfg(feature = "lab")]
    #[doc(hidden)]
    pub fn system_mut(&mut self) -> &mut System {
        &mut self.sys
    }
}
