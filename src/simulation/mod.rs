//! The one door to a run: scene in, inputs in, outputs and events out.
//!
//! A step reads as a list of stages: move, feed, forces ([`crate::integrate`]), then remeshing
//! (insert wire at the nozzle, refine near the core, let settled wire go), then measure.

mod ahead;
mod broken;
mod coarsen;
mod communication;
mod core_model;
mod course;
mod door;
mod faults;
mod freezing;
mod io;
mod judgement;
mod layon;
mod motion_profile;
mod nozzle_way;
mod outputs;
mod pool;
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
mod winding;

pub use crate::geometry::{Surface, TriMesh};
pub use crate::integrate::SolverStatistics;
pub use core_model::core_surface;
pub use freezing::{FreezePolicy, Watch};
pub use io::{Centreline, SimError};
pub use motion_profile::MotionProfile;
pub use product::Product;
pub use saved::RestoreError;
pub use summary::{EnergySummary, PenetrationSummary, Summary};
pub use winding::Winding;

use crate::scene::Scene;
use crate::signals::{Event, Inputs, Outputs};
#[cfg(feature = "lab")]
use crate::system::System;
use ahead::Ahead;
use communication::Communication;
use pool::Pool;
use std::ops::Deref;
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

/// A winding run, from one communication point to the next. A copy shares what neither has changed since.
#[derive(Clone, Debug)]
pub struct Simulation {
    now: Arc<Winding>,
    ahead: Option<Ahead>,
    talk: Communication,
    pool: Pool,
    looks_ahead: bool,
}

/// A run is read as its winding is; what a communication point has of its own, time, inputs and outputs, comes first.
impl Deref for Simulation {
    type Target = Winding;

    fn deref(&self) -> &Winding {
        &self.now
    }
}

impl From<Winding> for Simulation {
    fn from(mut winding: Winding) -> Self {
        let mut talk = Communication::default();
        talk.events.append(&mut winding.run.events);
        Self {
            now: Arc::new(winding),
            ahead: None,
            talk,
            pool: Pool::default(),
            looks_ahead: false,
        }
    }
}

impl Simulation {
    /// Wire clamped to the core and straight to the nozzle at the set tension, everything at rest.
    ///
    /// # Errors
    ///
    /// If the scene has no valid start.
    pub fn new(scene: &Scene) -> Result<Self, SimError> {
        Winding::new(scene).map(Self::from)
    }

    /// The same with these inputs at the start.
    ///
    /// # Errors
    ///
    /// As for [`Self::new`].
    pub fn starting_with(scene: &Scene, inputs: Inputs) -> Result<Self, SimError> {
        Winding::starting_with(scene, inputs).map(Self::from)
    }

    /// Starts over with other inputs; only before the first step.
    ///
    /// # Errors
    ///
    /// As for [`Self::new`].
    pub fn set_start(&mut self, inputs: Inputs) -> Result<(), SimError> {
        let run = Self::starting_with(self.scene(), inputs)?;
        *self = Self {
            looks_ahead: self.looks_ahead,
            ..run
        };
        Ok(())
    }

    /// Lets steps of the implicit method reach beyond the communication point, as long as inputs go on as they did. Then a fine
    /// communication step costs little, and the coil may be a step of the method behind; see [`Self::settle`].
    pub fn look_ahead(&mut self, on: bool) {
        self.looks_ahead = on;
    }

    /// Bounds the work of the run: beyond `most`, [`Self::advance`] returns an error.
    ///
    /// The work is the number of steps tried since the start, each times its number of nodes.
    /// Rejected steps count too. The bound does not depend on the clock.
    pub fn limit_work(&mut self, most: u64) {
        Arc::make_mut(&mut self.now).most_work = most;
    }

    /// Lets a step of the run end early, with an error, once `flag` is up, however long the step is. The run then stands at the
    /// last good step of the method.
    pub fn stop_on(&mut self, flag: Arc<AtomicBool>) {
        Arc::make_mut(&mut self.now).stop = Some(flag);
    }

    /// Time of the communication point, s.
    pub fn time(&self) -> f64 {
        let served = self.talk.served.as_ref();
        served.map_or(self.now.run.time, |served| served.time)
    }

    /// Input values at the communication point.
    pub fn inputs(&self) -> Inputs {
        let served = self.talk.served.as_ref();
        served.map_or_else(|| self.now.inputs(), |served| served.inputs)
    }

    /// Outputs at the communication point.
    pub fn outputs(&self) -> &Outputs {
        let served = self.talk.served.as_ref();
        served.map_or(&self.now.run.outputs, |served| &served.outputs)
    }

    /// Wire, coil and method at the end of the last step that does not reach beyond the communication point.
    pub fn winding(&self) -> &Winding {
        &self.now
    }

    /// What happened since the last call.
    pub fn drain_events(&mut self) -> Vec<Event> {
        std::mem::take(&mut self.talk.events)
    }

    /// Takes over the tunable parameters of another version of the scene.
    ///
    /// # Errors
    ///
    /// If the method gives up on the way to the communication point, from which on they hold.
    pub fn retune(&mut self, scene: &Scene) -> Result<(), SimError> {
        self.settle()?;
        Arc::make_mut(&mut self.now).retune(scene);
        self.pool = Pool::default();
        Ok(())
    }

    /// The mechanical system, to put loads on it that no scene has (verification only).
    #[cfg(feature = "lab")]
    #[doc(hidden)]
    pub fn system_mut(&mut self) -> &mut System {
        &mut Arc::make_mut(&mut self.now).sys
    }
}
