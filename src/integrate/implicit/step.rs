//! One step: guess, solve, estimate the error, commit or try again.

use super::commit::feed_after;
use super::nozzle_edge::NozzleEdge;
use super::potential::Potential;
use super::predictor::{moved, step_of};
use super::scheme::StepFormula;
use super::step_control::{
    AFTER_FAILURE, AFTER_MISSED_PAIRS, MOST_TURN, PATIENCE, SHORT, SHORTER,
    SHORTER_BY_FIRST_UPDATE, WITHIN,
};
use super::unknowns::Unknowns;
use super::work::Work;
use super::{CLOSE, Implicit, Scheme, StepError, newton, tensioner};
use crate::math::V3;
use crate::system::System;

impl Implicit {
    /// Takes one step of at most `most` seconds; returns its length.
    pub fn step(&mut self, sys: &mut System, most: f64) -> Result<f64, StepError> {
        self.with_work(sys, |work, method, sys| work.step(method, sys, most))
    }

    pub(super) fn step_with<const D: usize, U: Unknowns<D>>(
        &mut self,
        work: &mut Work<D, U>,
        sys: &mut System,
        most: f64,
    ) -> Result<f64, StepError> {
        sys.begin_past();
        let mut h = self.first_length(sys, most);
        let mut failures = 0;
        loop {
            let may_shorten = h > self.shortest && self.fixed.is_none();
            let step = step_of(sys, self.scheme, h);
            let spindle = sys.state.spindle.after(step.share * h);
            let support = moved(&sys.state.support, step.share * h);
            let nozzle = work.prepare(sys, &step, &spindle, &support, true);
            let share = work.share_of_way(sys);
            if share < 1.0 && may_shorten {
                h = (share * h).max(self.shortest);
                continue;
            }
            sys.begin_attempt(&work.guess);
            let share = sys.share_to_turn(&work.guess, MOST_TURN, self.tolerance);
            if share < 1.0 && may_shorten {
                if let Some(mut line) = sys.line_contact() {
                    line.undo_attempt();
                }
                h = (WITHIN * share * h).max(self.shortest);
                continue;
            }
            let mut potential = Potential::of_step(sys, &step, &spindle, &support, nozzle);
            potential.flat = self.flat;
            let solved = newton::solve(
                &mut potential,
                work,
                CLOSE * self.tolerance * self.share_of_wanted(h),
                newton::NewtonLimits::of_step(
                    failures >= PATIENCE || h < SHORT * self.shortest || self.fixed.is_some(),
                    if may_shorten {
                        self.tolerance / step.error
                    } else {
                        f64::INFINITY
                    },
                    self.largest_guess(h),
                    self.share_of_wanted(h),
                    self.scheme == Scheme::Bdf2 && self.fixed.is_none(),
                ),
            );
            self.statistics.take_from(work);
            let line = sys.line_scratch();
            let missed = line.and_then(|line| line.pairs.missed(&sys.state.past.q[0], &work.q));
            let retry = match solved {
                // farther than the pairs of wire were looked for
                Ok(_) if missed.is_some() && may_shorten => {
                    self.statistics.rejects += 1;
                    AFTER_MISSED_PAIRS * h
                }
                Ok(_) => {
                    let difference = work
                        .difference()
                        .max(feed_difference(sys, &step, nozzle, &work.q));
                    let error = step.error * difference;
                    let factor = self.length_factor(error.max(1e-30));
                    if error <= self.tolerance || !may_shorten {
                        self.commit(work, sys, &step, spindle, &support, nozzle);
                        self.statistics.steps += 1;
                        let forced = error > self.tolerance && self.fixed.is_none();
                        self.statistics.forced += u64::from(forced);
                        self.propose(h, factor);
                        return Ok(h);
                    }
                    self.statistics.rejects += 1;
                    let [least, largest] = SHORTER;
                    h * factor.clamp(least, largest)
                }
                Err(newton::NewtonFailure { far: Some(way), .. }) => {
                    self.statistics.rejects += 1;
                    let factor = self.length_factor(step.error * way);
                    let [least, largest] = SHORTER_BY_FIRST_UPDATE;
                    h * factor.clamp(least, largest)
                }
                Err(failure) => {
                    self.statistics.newton_failures += 1;
                    failures += 1;
                    if !may_shorten {
                        return Err(StepError::at(h, &failure));
                    }
                    AFTER_FAILURE * h
                }
            };
            h = retry.max(self.shortest);
            self.next = h;
            if let Some(mut line) = sys.line_contact() {
                line.undo_attempt();
            }
        }
    }
}

/// How far the places of pulley and tensioner after the step are from where their ways lead, m.
fn feed_difference(sys: &System, step: &StepFormula, nozzle: Option<NozzleEdge>, q: &[V3]) -> f64 {
    let spec = sys.model.feed.as_ref().zip(sys.state.feed.as_ref());
    let next = feed_after(sys, step, nozzle, q);
    spec.zip(next).map_or(0.0, |((spec, feed), (next, _))| {
        tensioner::difference(spec, feed, &sys.state.past, step.share * step.h, &next)
    })
}
