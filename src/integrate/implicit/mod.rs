//! The production method: implicit, second order, error-controlled.
//!
//! A step reads: place supports and spindle, guess, turn the plastic curvature along, minimise the
//! incremental potential, estimate the error, commit. Everything before the commit happens in
//! scratch arrays, so a rejected step leaves no trace.

mod assembly;
mod commit;
mod conjugate;
mod model;
mod newton;
mod predictor;
mod roll;
mod scheme;
mod sensitivity;
mod statics;
mod step;
mod step_control;
mod tensioner;

pub use scheme::Scheme;
pub use sensitivity::OutputSensitivity;

use crate::linalg::Banded;
use crate::math::V3;
use crate::rod::YieldBranches;
use roll::{Rolls, WITH_ROLL};
use serde::{Deserialize, Serialize};

/// Newton's update at which a solve is done, over the tolerance.
const CLOSE: f64 = 0.1;

/// Runs `$body` with the work arrays that go with how the system carries twist, under the name `$work`.
///
/// Code with three and with four unknowns a node is compiled apart; this is the one place that chooses.
macro_rules! with_work {
    ($method:ident, $sys:ident, $work:ident => $body:expr) => {
        if $sys.model.twist == crate::rod::Twist::Off {
            let mut arrays = std::mem::take(&mut $method.work);
            let $work = &mut arrays;
            let out = $body;
            $method.work = arrays;
            out
        } else {
            let mut arrays = std::mem::take(&mut $method.twisted);
            let $work = &mut arrays;
            let out = $body;
            $method.twisted = arrays;
            out
        }
    };
}
use with_work;

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
    /// take this step and no other (convergence studies), s
    pub fixed: Option<f64>,
    /// which scheme
    pub scheme: Scheme,
    /// static solves keep every node where it is along the core's z: without twist, a plane wire under
    /// a dead couple has nothing to hold it there
    pub flat: bool,
    /// what it took so far
    pub statistics: SolverStatistics,
    work: Work<3>,
    /// the same where twist is carried
    twisted: Work<WITH_ROLL>,
}

impl SolverStatistics {
    /// Steps tried, taken or not.
    pub fn tried(&self) -> u64 {
        self.steps + self.rejects + self.newton_failures
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
    /// factorisations
    pub solves: u64,
    /// evaluations of potential, gradient and Hessian
    pub evaluations: u64,
    /// halvings of a Newton step
    pub line_search_halvings: u64,
    /// rounds of conjugate gradients
    pub cg_iterations: u64,
}

/// Scratch arrays of a step with `D` unknowns a node, core frame.
#[derive(Debug, Default)]
struct Work<const D: usize> {
    q: Vec<V3>,
    start: Vec<V3>,
    guess: Vec<V3>,
    target: Vec<V3>,
    /// lab-frame `x*` and `v*`
    star: [Vec<V3>; 2],
    mass: Vec<f64>,
    /// mass that couples the ends of each edge; none where it is lumped
    shared_mass: Vec<f64>,
    /// plastic curvature per joint as a vector, 1/m
    set: Vec<V3>,
    /// stretch of each edge at the last evaluation and at the accepted iterate
    axial: Vec<Axial>,
    base: Vec<Axial>,
    /// stretch of each edge as the update promises it
    expected: Vec<Axial>,
    /// joints that may change between yielding and not
    yield_branches: YieldBranches,
    gradient: Vec<V3>,
    update: Vec<f64>,
    load: Vec<f64>,
    /// the update without a look ahead
    plain: Vec<f64>,
    matrix: Banded<D>,
    rolls: Rolls,
    assembly: assembly::Assembly,
    gradients: conjugate::Scratch,
    force: Vec<V3>,
    evaluations: u64,
    solves: u64,
    line_search_halvings: u64,
}

/// Nothing in here outlives a step, so a copy starts with empty arrays.
impl<const D: usize> Clone for Work<D> {
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl<const D: usize> Work<D> {
    /// Whether edges roll, so that twist is carried.
    const ROLLS: bool = D == WITH_ROLL;

    /// The update of node `i`'s place.
    #[inline]
    fn update_of(&self, i: usize) -> V3 {
        V3::new(
            self.update[D * i],
            self.update[D * i + 1],
            self.update[D * i + 2],
        )
    }
}

/// An edge's stretch as Newton's method sees it.
///
/// A lateral move of a tenth of an edge stretches it by half a percent in the second order, which is
/// 250 N in this wire. Hessian and line search therefore take the tension that follows the
/// update linearly (mixed integration points: Magisano, Leonetti, Garcea 2017); the residual is the true one.
#[derive(Clone, Copy, Debug, Default)]
struct Axial {
    along: V3,
    length: f64,
    tension: f64,
    stiffness: f64,
    energy: f64,
}

/// The method can't get past this instant.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "no step of {step:.2e} s or more goes on from here: {cause} at node {node} (update {update:.2e} m)"
)]
pub struct StepError {
    /// smallest step tried, s
    pub step: f64,
    /// node that would not settle
    pub node: usize,
    /// its last update, m
    pub update: f64,
    /// what is likely to blame
    pub cause: &'static str,
}

impl StepError {
    fn at(step: f64, stuck: &newton::NewtonFailure) -> Self {
        Self {
            step,
            node: stuck.node,
            update: stuck.update,
            cause: if stuck.update.is_finite() {
                "Newton's method does not settle"
            } else {
                "a value is not finite"
            },
        }
    }
}

impl Implicit {
    /// `tolerance` in m; steps between `shortest` and `longest`, s.
    pub fn new(scheme: Scheme, tolerance: f64, shortest: f64, longest: f64) -> Self {
        Self {
            tolerance,
            shortest,
            longest,
            next: (1e-5f64).clamp(shortest, longest),
            fixed: None,
            scheme,
            flat: false,
            statistics: SolverStatistics::default(),
            work: Work::default(),
            twisted: Work::default(),
        }
    }
}
