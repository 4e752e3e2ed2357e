//! Equilibrium by the same incremental potential without inertia.
//!
//! A step so long that inertia is below rounding, from rest, is a static solve: rod, loads and contact
//! are those of a time step. Plastic state, frames and anchors move on only where an increment has
//! converged.

use super::newton::{self, NewtonLimits};
use super::potential::Potential;
use super::scheme::StepFormula;
use super::unknowns::Unknowns;
use super::work::Work;
use super::{CLOSE, Implicit, StepError};
use crate::math::{Spin, V3};
use crate::system::System;

/// Time over which forces act in a static solve, s: inertia is then 1e-10 of the softest wire's stiffness.
const LONG: f64 = 1e3;
/// Largest move of an edge's end against its start in one Newton step, over its length. Chosen.
const MOST_TURN_AT_REST: f64 = 0.4;
/// Solves of one increment: the last ones turn plastic curvature along with what the first one found.
const PASSES: usize = 3;

impl Implicit {
    /// Moves `sys` to equilibrium under its present loads and supports, and commits it.
    ///
    /// The nozzle holds the wire: nothing is fed. Velocities become zero.
    pub fn equilibrate(&mut self, sys: &mut System) -> Result<(), StepError> {
        self.equilibrium(sys, &[], 0.0).map(|_| ())
    }

    /// The same from where the wire is, moved by `share` of `moved`; returns the solver's steps.
    pub(super) fn equilibrium(
        &mut self,
        sys: &mut System,
        moved: &[V3],
        share: f64,
    ) -> Result<usize, StepError> {
        self.with_work(sys, |work, method, sys| {
            work.equilibrium(method, sys, moved, share)
        })
    }

    pub(super) fn equilibrium_with<const D: usize, U: Unknowns<D>>(
        &mut self,
        work: &mut Work<D, U>,
        sys: &mut System,
        moved: &[V3],
        share: f64,
    ) -> Result<usize, StepError> {
        let step = still(sys);
        let (spindle, support) = (sys.state.spindle, sys.state.support);
        work.prepare(sys, &step, &spindle, &support, false);
        let spin = Spin::new(spindle.angle);
        let last = sys.state.rod.nodes() - 1;
        for (i, d) in moved.iter().enumerate() {
            let d = spin.to_core(d * share);
            for a in 0..3 {
                let held = i == 0 && support[0].hold[a] || i == last && support[1].hold[a];
                if !held {
                    work.guess[i][a] += d[a];
                }
            }
        }
        let limits = NewtonLimits {
            steps: U::STATIC_STEPS,
            longest: f64::INFINITY,
            turn: MOST_TURN_AT_REST,
            guess: CLOSE * self.tolerance,
            chord: 0.0,
            ..NewtonLimits::STEP
        };
        let mut taken = 0;
        for _ in 0..PASSES {
            work.q.clone_from(&work.guess);
            let ends = (&spindle, &support);
            work.unknowns.follow(sys, ends, &work.guess);
            let mut potential = potential_at_rest(sys, &step);
            potential.flat = self.flat;
            let solved = newton::solve(&mut potential, work, CLOSE * self.tolerance, limits);
            let steps = solved.map_err(|failure| {
                self.statistics.newton_failures += 1;
                StepError::at(LONG, &failure)
            })?;
            taken = taken.max(steps);
            work.guess.clone_from(&work.q);
        }
        self.statistics.steps += 1;
        self.statistics.take_from(work);
        for (x, q) in sys.state.rod.x.iter_mut().zip(&work.q) {
            *x = spin.to_lab(*q);
        }
        work.unknowns.hand_over_equilibrium(sys);
        sys.place_supports();
        sys.evaluate_smooth(f64::INFINITY, true);
        sys.state.past.forget();
        Ok(taken)
    }
}

/// Brings everything to rest; the step that a static solve is.
pub(super) fn still(sys: &mut System) -> StepFormula {
    sys.state.rod.v.fill(V3::zeros());
    sys.state.rod.spin.fill(0.0);
    sys.state.past.forget();
    sys.begin_past();
    StepFormula {
        h: LONG,
        gamma: LONG,
        share: 1.0,
        weight: [1.0, 0.0],
        error: 0.0,
        grown: 0.0,
    }
}

/// The potential of the step that [`still`] returned: no wire is fed and none slips.
pub(super) fn potential_at_rest<'a>(sys: &'a mut System, step: &StepFormula) -> Potential<'a> {
    if let Some(mut line) = sys.line_contact() {
        line.begin_solve();
    }
    let (spindle, support) = (sys.state.spindle, sys.state.support);
    Potential {
        first: None,
        elapsed: f64::INFINITY,
        ..Potential::of_step(sys, step, &spindle, &support, None)
    }
}
