//! A run as bytes, and back.
//!
//! Description and state stay apart: the scene is not in the bytes, whoever restores hands it over.
//! From it the run is started anew and the state laid over. What can be rebuilt from the state to
//! the bit is not in the bytes either (search trees, measures of settled wire).

use super::Simulation;
use super::freezing::{FreezePolicy, Watch};
use super::rates::Instant;
use crate::integrate::{SolverStatistics, Stepper};
use crate::measure::SavedCoil;
use crate::scene::Scene;
use crate::signals::{Event, Outputs};
use crate::system::SavedSystem;
use serde::{Deserialize, Serialize};

/// Changes whenever the bytes of the same state do.
const VERSION: u32 = 4;

/// Bytes that are no state of a run of this scene.
#[derive(Debug, thiserror::Error)]
pub enum RestoreError {
    /// written by another version of this program
    #[error("the state is of version {found}, this program reads version {VERSION}")]
    Version {
        /// version in the bytes
        found: u32,
    },
    /// the bytes end too soon or hold what no state can
    #[error("the state cannot be read: {0}")]
    Unreadable(#[from] postcard::Error),
    /// bytes beyond the end
    #[error("the state ends {left} bytes before the data does")]
    TooLong {
        /// how many
        left: usize,
    },
    /// readable, but no state of a run
    #[error("the state contradicts itself: {0}")]
    Impossible(&'static str),
    /// the scene's mesh file has changed since
    #[error("the core's surface is not the one that the state was saved with")]
    OtherCore,
    /// the scene does not start
    #[error("the scene of the state does not start: {0}")]
    Scene(#[from] super::SimError),
}

/// All that the scene does not give.
#[derive(Debug, Serialize, Deserialize)]
struct Saved {
    /// over vertices and triangles of the core
    core: u32,
    sys: SavedSystem,
    coil: SavedCoil,
    watch: Watch,
    policy: FreezePolicy,
    /// of the implicit method: next step, s, and what it took so far
    implicit: Option<(f64, SolverStatistics)>,
    angle0: f64,
    last_step: f64,
    last_span: f64,
    time: f64,
    steps: u64,
    work: u64,
    outputs: Outputs,
    rates: Outputs,
    instant: Instant,
    time_lost: f64,
    owed: f64,
    events: Vec<Event>,
    rest_depth: f64,
    broken: bool,
    was_slack: bool,
    quiet: f64,
    farthest: f64,
    pass: (f64, f64),
}

impl Simulation {
    /// The state of this run, for [`Simulation::from_bytes`] with the same scene.
    pub fn to_bytes(&self) -> Result<Vec<u8>, RestoreError> {
        // a new field asks here whether it is state
        let Self {
            scene: _,
            sys,
            coil,
            watch,
            policy,
            behind: _,
            motion_profile: _,
            angle0,
            stepper,
            last_step,
            last_span,
            time,
            steps,
            work,
            // the caller's
            most_work: _,
            outputs,
            rates,
            instant,
            time_lost,
            owed,
            events,
            rest_depth,
            broken,
            was_slack,
            quiet,
            farthest,
            pass,
        } = self;
        let saved = Saved {
            core: self.core_checksum(),
            sys: sys.saved(),
            coil: coil.saved(),
            watch: watch.clone(),
            policy: *policy,
            implicit: match stepper {
                Stepper::Implicit(method) => Some((method.next, method.statistics)),
                Stepper::Explicit { .. } => None,
            },
            angle0: *angle0,
            last_step: *last_step,
            last_span: *last_span,
            time: *time,
            steps: *steps,
            work: *work,
            outputs: *outputs,
            rates: *rates,
            instant: *instant,
            time_lost: *time_lost,
            owed: *owed,
            events: events.clone(),
            rest_depth: *rest_depth,
            broken: *broken,
            was_slack: *was_slack,
            quiet: *quiet,
            farthest: *farthest,
            pass: *pass,
        };
        Ok(postcard::to_stdvec(&(VERSION, saved))?)
    }

    /// A run of `scene` that goes on, to the bit, as the one did that `bytes` were made of.
    ///
    /// The bytes need not be trusted: what they hold is checked before it is used. That they are the
    /// ones written (a checksum) is for the caller to see to.
    pub fn from_bytes(scene: &Scene, bytes: &[u8]) -> Result<Self, RestoreError> {
        let (found, rest) = postcard::take_from_bytes::<u32>(bytes)?;
        if found != VERSION {
            return Err(RestoreError::Version { found });
        }
        let (saved, rest) = postcard::take_from_bytes::<Saved>(rest)?;
        if !rest.is_empty() {
            return Err(RestoreError::TooLong { left: rest.len() });
        }
        let mut sim = Self::new(scene)?;
        if saved.core != sim.core_checksum() {
            return Err(RestoreError::OtherCore);
        }
        sim.take_over(saved).map_err(RestoreError::Impossible)?;
        Ok(sim)
    }

    fn take_over(&mut self, saved: Saved) -> Result<(), &'static str> {
        self.sys.restore(saved.sys)?;
        let far = self.sys.far().ok_or("there is no core")?;
        self.coil.restore(saved.coil, far)?;
        if !saved.watch.fits(self.sys.rod.nodes()) {
            return Err("the watch does not go with the nodes");
        }
        match (&mut self.stepper, saved.implicit) {
            (Stepper::Implicit(method), Some((next, statistics))) => {
                method.next = next.clamp(method.shortest, method.longest);
                method.statistics = statistics;
            }
            (Stepper::Explicit { .. }, None) => {}
            _ => return Err("the method is another one"),
        }
        self.watch = saved.watch;
        self.policy = saved.policy;
        self.angle0 = saved.angle0;
        self.last_step = saved.last_step;
        self.last_span = saved.last_span;
        self.time = saved.time;
        self.steps = saved.steps;
        self.work = saved.work;
        self.outputs = saved.outputs;
        self.rates = saved.rates;
        self.instant = saved.instant;
        self.time_lost = saved.time_lost;
        self.owed = saved.owed;
        self.events = saved.events;
        self.rest_depth = saved.rest_depth;
        self.broken = saved.broken;
        self.was_slack = saved.was_slack;
        self.quiet = saved.quiet;
        self.farthest = saved.farthest;
        self.pass = saved.pass;
        Ok(())
    }

    /// Tells cores apart whose scene is the same: the file of a mesh may have changed.
    fn core_checksum(&self) -> u32 {
        let mut sum = crc32fast::Hasher::new();
        if let Some(surface) = self.sys.core_surface() {
            let mesh = surface.mesh();
            for x in mesh.vertices.iter().flatten() {
                sum.update(&x.to_bits().to_le_bytes());
            }
            for k in mesh.triangles.iter().flatten() {
                sum.update(&k.to_le_bytes());
            }
        }
        sum.finalize()
    }
}
