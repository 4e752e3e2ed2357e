//! The production method: implicit, second order, error-controlled.
//!
//! A step reads: place supports and spindle, guess, turn the plastic curvature along, minimise the
//! incremental potential, estimate the error, commit. Everything before the commit happens in
//! scratch arrays, so a rejected step leaves no trace.

mod assembly;
mod beyond_band;
mod carried;
mod circle;
mod commit;
mod conjugate;
mod dispatch;
mod error;
mod first_edge;
mod impact;
mod impulse;
mod landings;
mod largest;
mod lengths;
mod minimal_residual;
mod newton;
mod nozzle_edge;
mod places;
mod places_and_rolls;
mod potential;
mod predictor;
#[cfg(feature = "lab")]
mod probe;
#[cfg(feature = "lab")]
mod ramp;
mod rolls;
mod scheme;
mod slope;
mod statics;
mod step;
mod step_control;
mod stirred;
mod tensioner;
mod unknowns;
mod update;
mod work;

pub use error::StepError;
pub use scheme::Scheme;
pub use step_control::{NOZZLE_TURN, PATIENCE};

use places::Places;
use places_and_rolls::PlacesAndRolls;
use serde::{Deserialize, Serialize};
use std::mem::take;
use work::Work;

/// Newton's update at which a solve is done, over the tolerance.
const CLOSE: f64 = 0.01;

/// Settings and step length of the production method.
#[derive(Clone, Debug)]
pub struct Implicit {
    /// estimated local error that a step may have, m (root mean square over the wire)
    pub tolerance: f64,
    /// bounds of the step, s
    pub shortest: f64,
    /// see `shortest`
    pub longest: f64,
    /// proposed next step, s
    pub next: f64,
    /// length that the error of the last step asks for, within no bounds, s
    pub(crate) wanted: f64,
    /// take this step and no other (convergence studies), s
    pub fixed: Option<f64>,
    /// which scheme
    pub scheme: Scheme,
    /// every node keeps its place along the core's z (verification only): without twist, a plane wire under
    /// a dead couple has nothing to hold it there
    pub flat: bool,
    /// what it took so far
    pub statistics: SolverStatistics,
    work: Work<3, Places>,
    /// the same where twist is carried
    twisted: Work<4, PlacesAndRolls>,
}

impl SolverStatistics {
    /// Steps tried, taken or not.
    pub fn tried(&self) -> u64 {
        self.steps + self.rejects + self.newton_failures
    }

    /// Takes over what was counted since the last time.
    fn take_from<const D: usize, U>(&mut self, work: &mut Work<D, U>) {
        self.evaluations += take(&mut work.evaluations);
        self.solves += take(&mut work.solves);
        self.line_search_halvings += take(&mut work.line_search_halvings);
        self.cg_iterations += take(&mut work.conjugate.cg_iterations);
    }
}

/// Counts since the start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct SolverStatistics {
    /// accepted steps
    pub steps: u64,
    /// steps thrown away for their error
    pub rejects: u64,
    /// steps thrown away because Newton's method stalled
    pub newton_failures: u64,
    /// accepted steps of the shortest length whose error is above the tolerance
    pub forced: u64,
    /// factorisations
    pub solves: u64,
    /// evaluations of potential, gradient and Hessian
    pub evaluations: u64,
    /// halvings of a Newton step
    pub line_search_halvings: u64,
    /// rounds of conjugate gradients
    pub cg_iterations: u64,
}

impl Implicit {
    /// `tolerance` in m; steps between `shortest` and `longest`, s.
    pub fn new(scheme: Scheme, tolerance: f64, shortest: f64, longest: f64) -> Self {
        Self {
            tolerance,
            shortest,
            longest,
            next: (1e-5f64).clamp(shortest, longest),
            wanted: shortest,
            fixed: None,
            scheme,
            flat: false,
            statistics: SolverStatistics::default(),
            work: Work::default(),
            twisted: Work::default(),
        }
    }
}
