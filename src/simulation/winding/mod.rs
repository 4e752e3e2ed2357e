//! A run as data: scene, wire, coil, method, and what a run remembers of them.
//!
//! The rooms beside this one say what happens to a [`Winding`].

mod core_model;
mod doubt;
mod freezing;
mod motion_profile;
mod nozzle_way;
mod older_wire;
mod run_state;
mod sim_error;
#[cfg(feature = "lab")]
mod trail;

pub use core_model::core_surface;
pub(super) use core_model::{core_flanges, core_shape};
pub(super) use doubt::{Cause, Doubt, Throughput};
pub(crate) use doubt::{DEEPEST, UNEXPLAINED};
pub use freezing::{FreezePolicy, Watch};
pub use motion_profile::MotionProfile;
pub(super) use motion_profile::ROUNDING;
pub(super) use nozzle_way::{Found, Traverse};
pub(super) use older_wire::OlderWire;
pub(super) use run_state::{RunState, SlackSince, Slip, WORTH_A_STEP};
pub use sim_error::SimError;
#[cfg(feature = "lab")]
pub use trail::StepTrail;

use crate::geometry::Surface;
use crate::integrate::{SolverStatistics, Stepper};
use crate::measure::Coil;
use crate::scene::Scene;
use crate::signals::{Event, EventKind, Inputs, Outputs};
use crate::system::System;
use std::f64::consts::TAU;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// The winding itself, at the end of a step of the method. [`Simulation`](super::Simulation) lends it to readers.
#[derive(Clone, Debug)]
pub struct Winding {
    pub(super) scene: Scene,
    pub(super) motion_profile: MotionProfile,
    pub(super) sys: System,
    /// copies share it until one of them changes it
    pub(super) coil: Arc<Coil>,
    pub(super) stepper: Stepper,
    pub(super) run: RunState,
    /// polar angle from each laid node to lift-off, at the last look, rad
    pub(super) behind: Vec<f64>,
    /// work space of a look
    pub(super) older_wire: OlderWire,
    /// between which wire can be wound along y, m
    pub(super) ends: [f64; 2],
    /// how much [`RunState::work`] may become; the caller's
    pub(super) most_work: u64,
    /// ends a step of the run early where it is up; the caller's
    pub(super) stop: Option<Arc<AtomicBool>>,
    /// what steps did, where somebody asked
    #[cfg(feature = "lab")]
    pub(super) trail: Option<Vec<StepTrail>>,
}

impl Winding {
    /// Input values at the winding's time; all that holds the tensioner back is in `tension_setpoint`.
    pub(super) fn inputs(&self) -> Inputs {
        Inputs {
            spindle_speed: self.sys.state.spindle.speed,
            nozzle_position: self.sys.state.support[1].point.y,
            tension_setpoint: self.sys.state.set_tension,
            nozzle_offset_x: self.sys.state.support[1].point.x - self.scene.nozzle.distance,
            nozzle_offset_z: self.sys.state.support[1].point.z,
            brake_torque: 0.0,
            tensioner_damping: self.sys.state.feed.map_or(0.0, |feed| feed.damping),
        }
    }

    /// What [`crate::simulation::Simulation::limit_work`] counts.
    pub fn work(&self) -> u64 {
        self.run.work
    }

    /// Time of the winding, s.
    pub fn time(&self) -> f64 {
        self.run.time
    }

    /// The scene this run was made from.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Outputs at the winding's time.
    pub fn outputs(&self) -> &Outputs {
        &self.run.outputs
    }

    /// Settled wire and its measures.
    pub fn coil(&self) -> &Coil {
        &self.coil
    }

    pub(super) fn coil_mut(&mut self) -> &mut Coil {
        Arc::make_mut(&mut self.coil)
    }

    /// The motion profile of the scene.
    pub fn motion_profile(&self) -> &MotionProfile {
        &self.motion_profile
    }

    /// The core as a triangle mesh, in its own frame, m.
    ///
    /// # Errors
    ///
    /// As for [`core_surface`].
    pub(crate) fn core(&self) -> Result<Arc<Surface>, SimError> {
        match &self.sys.model.core {
            Some(surface) => Ok(Arc::clone(surface)),
            None => core_surface(&self.scene).map(Arc::new),
        }
    }

    pub(super) fn report(&mut self, kind: EventKind, text: String) {
        // (those of the communication point before may be turns old)
        let turn = match self.run.over {
            true => self.run.outputs.turns_wound,
            false => self.layon().angle.max(0.0) / TAU,
        };
        self.run.events.push(Event {
            time: self.sys.state.time,
            turn,
            angle: self.sys.state.spindle.angle - self.run.angle0,
            kind,
            text,
        });
    }

    /// Takes over the tunable parameters of another version of the scene.
    pub(super) fn retune(&mut self, scene: &Scene) {
        if self.scene.friction != scene.friction {
            // What holds at rest with one friction may slide with another.
            self.run.quiet = 0.0;
        }
        self.scene.friction = scene.friction;
        if self.scene.defects != scene.defects {
            self.scene.defects = scene.defects;
            self.coil_mut().set_limits(scene.defects);
            self.count_defects();
            let mut outputs = self.run.outputs;
            self.lower_flags(&mut outputs);
            self.run.outputs = outputs;
            self.tell_of_limits();
        }
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

    /// Becomes a copy of another winding of the same scene. Work space stays, which is most of what a copy from nothing costs.
    pub(super) fn become_copy_of(&mut self, other: &Self) {
        let Self {
            scene: _,
            motion_profile: _,
            sys,
            coil,
            stepper,
            run,
            behind,
            older_wire: _,
            ends: _,
            most_work,
            stop,
            #[cfg(feature = "lab")]
            trail,
        } = other;
        self.sys.take_over_from(sys);
        self.coil.clone_from(coil);
        self.stepper.take_over_from(stepper);
        self.run.clone_from(run);
        self.behind.clone_from(behind);
        self.most_work = *most_work;
        self.stop.clone_from(stop);
        #[cfg(feature = "lab")]
        self.trail.clone_from(trail);
    }
}
