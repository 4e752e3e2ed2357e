//! Single evaluations of the potential, for the laboratory and the benchmarks: nothing is solved.

use super::potential::Potential;
use super::predictor::{moved, step_of};
use super::statics::{potential_at_rest, still};
use super::unknowns::Unknowns;
use super::work::Work;
use super::{Implicit, Scheme, newton};
use crate::math::{Spin, V3};
use crate::system::System;

impl Implicit {
    /// Forces on the nodes at the present state as the method sees them, lab frame, N; held
    /// coordinates count as free.
    pub fn forces(&mut self, sys: &mut System) -> Vec<V3> {
        self.out_of_balance(sys).0
    }

    /// The same, and the torques on the edges about themselves, N m; none where twist is off.
    pub fn out_of_balance(&mut self, sys: &mut System) -> (Vec<V3>, Vec<f64>) {
        self.with_work(sys, |work, _, sys| work.out_of_balance(sys))
    }

    /// Hands `with` the evaluation of potential, gradient and Hessian at the guess of a step of `h`, to
    /// be measured as often as it likes; nothing is committed.
    #[doc(hidden)]
    pub fn evaluating(
        &mut self,
        sys: &mut System,
        h: f64,
        with: impl FnOnce(&mut dyn FnMut() -> f64),
    ) {
        let mut with = Some(with);
        self.with_work(sys, |work, method, sys| {
            work.evaluating(method.scheme, sys, h, &mut |evaluate| {
                if let Some(with) = with.take() {
                    with(evaluate);
                }
            });
        });
    }
}

pub(super) fn out_of_balance_with<const D: usize, U: Unknowns<D>>(
    work: &mut Work<D, U>,
    sys: &mut System,
) -> (Vec<V3>, Vec<f64>) {
    let step = still(sys);
    let (spindle, support) = (sys.state.spindle, sys.state.support);
    work.prepare(sys, &step, &spindle, &support, false);
    let mut potential = potential_at_rest(sys, &step);
    potential.held = [[false; 3]; 2];
    newton::expect_nothing(&potential, work);
    // the tensions that are there are no surprise
    for (j, e) in work.expected.iter_mut().enumerate() {
        e.length = (work.q[j + 1] - work.q[j]).norm();
    }
    potential.evaluate(work);
    let spin = Spin::new(sys.state.spindle.angle);
    let forces = work.gradient.iter().map(|g| -spin.to_lab(*g));
    (forces.collect(), work.unknowns.torques())
}

pub(super) fn evaluating_with<const D: usize, U: Unknowns<D>>(
    scheme: Scheme,
    work: &mut Work<D, U>,
    sys: &mut System,
    h: f64,
    with: &mut dyn FnMut(&mut dyn FnMut() -> f64),
) {
    sys.begin_past();
    let step = step_of(sys, scheme, h);
    let (spindle, support) = (
        sys.state.spindle.after(step.share * h),
        moved(&sys.state.support, step.share * h),
    );
    let nozzle = work.prepare(sys, &step, &spindle, &support, true);
    let mut potential = Potential::of_step(sys, &step, &spindle, &support, nozzle);
    newton::expect_nothing(&potential, work);
    with(&mut || potential.evaluate(work).now);
}
