//! The one door to a run: scene in, inputs in, outputs and events out.
//!
//! A step reads as a list of stages: move, feed, forces ([`crate::integrate`]), then remeshing
//! (insert wire at the nozzle, refine near the core, let settled wire go), then measure.

mod ahead;
mod broken;
mod clamp_place;
mod coarsen;
mod collision;
mod communication;
mod core_model;
mod course;
mod door;
mod doubt;
mod drawn_loop;
mod faults;
mod freezing;
mod frozen_tension;
mod health;
mod io;
mod judgement;
mod layon;
mod machine;
mod master_inputs;
mod motion_profile;
mod nozzle_by_law;
mod nozzle_place;
mod nozzle_way;
mod older_wire;
mod outputs;
mod pool;
mod product;
mod quasi_static;
mod rates;
mod refining;
mod remeshing;
mod run;
mod run_state;
mod saved;
mod sharp_bend;
mod slipping;
mod start;
mod step_derivatives;
mod stepping;
mod straight_wire;
mod summary;
mod talk;
mod tapered;
mod telling;
mod thinned;
#[cfg(feature = "lab")]
mod trail;
#[cfg(feature = "lab")]
mod trail_keeping;
mod traverse;
mod trouble;
mod whole_turn;
mod winding;

pub use crate::geometry::{Surface, TriMesh};
pub use crate::integrate::SolverStatistics;
pub use core_model::core_surface;
#[cfg(feature = "lab")]
pub(crate) use doubt::{DEEPEST, UNEXPLAINED};
pub use freezing::{FreezePolicy, Watch};
pub use io::{Centreline, SimError};
pub use motion_profile::MotionProfile;
pub use product::{Fill, Product};
pub use run::Simulation;
pub use saved::RestoreError;
pub use step_derivatives::Derivative;
pub use summary::{EnergySummary, PenetrationSummary, Summary};
#[cfg(feature = "lab")]
#[doc(hidden)]
pub use trail::StepTrail;
pub use traverse::OTHER_WAY;
pub use winding::Winding;

/// Speed below which wire on a standing core counts as quiet, m/s.
///
/// In a second such wire moves by less than the error that one step may have.
const QUIET: f64 = 1e-6;

/// Time to which communication steps add up before the solver takes a step, s.
///
/// About the solver's shortest step for wire of 0.7 mm. In less time, wire at 5000 rpm moves by 20 nm at most, and
/// rounding errors dominate the solution.
const WORTH_A_STEP: f64 = 1e-9;

/// Steps between looks for edges to refine and values that are not finite.
const REMESH_STEPS: u64 = 32;
