//! What a change of the inputs makes of the step to come: the step solved on trial, and its tangent.
//!
//! At the solution `q` of a step the gradient `g` of its potential vanishes for the nodes that are free. If the inputs
//! change by `du`, the solution changes by `dq` with `K dq + dg/du du = 0`, `K` the Hessian. The method's own Hessian leaves
//! out what Newton's method does without (the curvature of angles, part of sliding). So it serves as the factored
//! approximation in an iteration on the true one, whose product with `dq` is the difference of two gradients:
//! `dq -= K^-1 (g(q + s dq, u + s du) - g(q - s dq, u - s du)) / 2 s`. Nothing is committed, and no step is repeated.

use super::model::Model;
use super::predictor::{moved, step_of};
use super::scheme::StepFormula;
use super::tensioner::{NozzleEdge, advance};
use super::unknowns::Unknowns;
use super::work::Work;
use super::{CLOSE, Implicit, StepError, conjugate, newton};
use crate::math::{V3, scaled};
use crate::system::{Spindle, Support, System};

/// Inputs by their place in a tangent: spindle speed, nozzle position, set tension.
pub const INPUTS: usize = 3;
/// Way of a node that differences are taken over, m, for wire of 0.7 mm: a hundredth of the depth over which contact sets in.
const WAY: f64 = 1e-8;
/// Set tension that differences are taken over, N, for wire of 0.7 mm.
const PULL: f64 = 1e-3;
/// Update that is nothing but rounding, m.
const ROUNDING: f64 = 1e-12;
/// Change of the tangent at which it is good enough, over its size ...
const ENOUGH: f64 = 1e-6;
/// ... or, where rounding keeps it from shrinking, this.
const NEARLY: f64 = 1e-3;
/// Rounds of the iteration before it counts as failed: sliding wire converges by a third a round.
const ROUNDS: usize = 200;

/// What can be seen of the wire at the end of a step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct OutputSensitivity {
    /// tension at the nozzle, N
    pub tension: f64,
    /// moment of the wire on the core about +y, N m
    pub torque: f64,
    /// wire paid out, m, and its speed, m/s
    pub fed: f64,
    /// see `fed`
    pub feed_speed: f64,
    /// length of wire from the node at lift-off to the nozzle, m
    pub free_length: f64,
    /// that node, core frame, m
    pub lift: V3,
    /// core angle, rad
    pub angle: f64,
}

impl OutputSensitivity {
    /// Difference of two over `by`.
    fn slope(a: &Self, b: &Self, by: f64) -> Self {
        let over = |a: f64, b: f64| (a - b) / by;
        Self {
            tension: over(a.tension, b.tension),
            torque: over(a.torque, b.torque),
            fed: over(a.fed, b.fed),
            feed_speed: over(a.feed_speed, b.feed_speed),
            free_length: over(a.free_length, b.free_length),
            lift: (a.lift - b.lift) / by,
            angle: over(a.angle, b.angle),
        }
    }
}

/// The step to come as its inputs make it.
struct Setting {
    spindle: Spindle,
    support: [Support; 2],
    nozzle: Option<NozzleEdge>,
}

impl Implicit {
    /// What will be seen after a step of `h`, and its derivatives by the inputs, held over the step; the wire lifts off at
    /// node `lift`. The system is left as it was.
    pub fn tangent(
        &mut self,
        sys: &mut System,
        h: f64,
        lift: usize,
    ) -> Result<(OutputSensitivity, [OutputSensitivity; INPUTS]), StepError> {
        sys.begin_past();
        let kept = sys.state.contact.clone();
        let inputs = (sys.state.spindle, sys.state.support, sys.state.set_tension);
        let statistics = self.statistics;
        let tangent = self.with_work(sys, |work, method, sys| work.tangent(method, sys, h, lift));
        self.statistics = statistics;
        (sys.state.spindle, sys.state.support, sys.state.set_tension) = inputs;
        sys.state.contact = kept;
        tangent
    }

    pub(super) fn tangent_with<const D: usize, U: Unknowns<D>>(
        &self,
        work: &mut Work<D, U>,
        sys: &mut System,
        h: f64,
        lift: usize,
    ) -> Result<(OutputSensitivity, [OutputSensitivity; INPUTS]), StepError> {
        let step = step_of(sys, self.scheme, h);
        let base = (sys.state.spindle, sys.state.support, sys.state.set_tension);
        let now = set(work, sys, &step, &base, 0, 0.0);
        sys.begin_attempt(&work.guess);
        let mut model = Model::of_step(sys, &step, &now.spindle, &now.support, now.nozzle);
        // to rounding: the tangent belongs to the solution, not to what is near enough to it
        let close = (1e-4 * CLOSE * self.tolerance).max(ROUNDING);
        let limits = newton::NewtonLimits {
            chord: 0.0,
            ..newton::NewtonLimits::STEP
        };
        newton::solve(&mut model, work, close, limits)
            .or_else(|_| newton::solve(&mut model, work, CLOSE * self.tolerance, limits))
            .map_err(|stuck| StepError::at(h, &stuck))?;
        model.evaluate(work);
        work.expected.clone_from(&work.axial);
        model.evaluate(work);
        work.matrix.factor().map_err(|loose| StepError {
            step: h,
            node: loose.node,
            update: f64::NAN,
            cause: "the equations of the step leave a node loose",
        })?;
        let held = model.held;
        work.keep_start();
        let (nodes, expected) = (work.q.len(), work.expected.clone());
        let diameter = sys.model.section.diameter;
        let (way, pull) = (
            scaled(WAY, diameter),
            scaled(scaled(PULL, diameter), diameter),
        );
        let reach = work.q[nodes - 1].norm().max(way);
        let seen = |work: &mut Work<D, U>, sys: &mut System, input: usize, by: f64, dq: &[f64]| {
            let setting = set(work, sys, &step, &base, input, by);
            work.update.clear();
            work.update.extend_from_slice(dq);
            work.take(by);
            // where nothing pulls at the node at the nozzle, it is where its support is
            work.q[nodes - 1] = work.guess[nodes - 1];
            work.expected.clone_from(&expected);
            let mut model = Model::of_step(
                sys,
                &step,
                &setting.spindle,
                &setting.support,
                setting.nozzle,
            );
            model.held = [[false; 3]; 2];
            model.evaluate(work);
            look(work, sys, &step, &setting, lift)
        };
        let there = seen(work, sys, 0, 0.0, &vec![0.0; D * nodes]);
        let scale = [way / (reach * h), way, pull];
        let mut slopes = [OutputSensitivity::default(); INPUTS];
        for (input, by) in scale.into_iter().enumerate() {
            let mut dq = vec![0.0; D * nodes];
            let (mut settled, mut last) = (false, f64::INFINITY);
            for _ in 0..ROUNDS {
                let after = seen(work, sys, input, by, &dq);
                let mut residual = work.gradients().flatten().collect::<Vec<_>>();
                let before = seen(work, sys, input, -by, &dq);
                for (r, b) in residual.iter_mut().zip(work.gradients().flatten()) {
                    *r = (b - *r) / (2.0 * by);
                }
                for (end, first) in [(0, 0), (1, D * (nodes - 1))] {
                    for a in (0..3).filter(|a| held[end][*a]) {
                        residual[first + a] = 0.0;
                    }
                }
                for (i, a) in work.unknowns.pinned() {
                    residual[D * i + a] = 0.0;
                }
                slopes[input] = OutputSensitivity::slope(&after, &before, 2.0 * by);
                if settled {
                    break;
                }
                match sys.line_scratch().map_or(&[][..], |l| &l.pairs.couplings) {
                    [] => work.matrix.solve(&mut residual),
                    couplings => {
                        let scratch = &mut work.conjugate;
                        conjugate::solve(&work.matrix, couplings, held, &mut residual, scratch);
                    }
                }
                let size = |v: &[f64]| v.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
                for (d, r) in dq.iter_mut().zip(&residual) {
                    *d += r;
                }
                let (change, whole) = (size(&residual), size(&dq));
                settled = change <= ENOUGH * whole || (change >= last && change <= NEARLY * whole);
                last = change;
                if !whole.is_finite() {
                    break;
                }
            }
            if !settled {
                return Err(StepError {
                    step: h,
                    node: lift,
                    update: way,
                    cause: "the tangent of the step does not settle",
                });
            }
        }
        Ok((there, slopes))
    }
}

/// Prepares the step with one input off by `by`.
fn set<const D: usize, U: Unknowns<D>>(
    work: &mut Work<D, U>,
    sys: &mut System,
    step: &StepFormula,
    base: &(Spindle, [Support; 2], f64),
    input: usize,
    by: f64,
) -> Setting {
    (sys.state.spindle, sys.state.support, sys.state.set_tension) = *base;
    match input {
        0 => sys.state.spindle.speed += by,
        1 => sys.state.support[1].point.y += by,
        _ => sys.state.set_tension += by,
    }
    let spindle = sys.state.spindle.after(step.share * step.h);
    let support = moved(&sys.state.support, step.share * step.h);
    let nozzle = work.prepare(sys, step, &spindle, &support, true);
    Setting {
        spindle,
        support,
        nozzle,
    }
}

/// What there is to see at `work.q`, after an evaluation without pins.
///
/// The moment on the core is what the wire does not keep: that of the nozzle's force less what turns the wire's mass.
fn look<const D: usize, U: Unknowns<D>>(
    work: &Work<D, U>,
    sys: &System,
    step: &StepFormula,
    setting: &Setting,
    lift: usize,
) -> OutputSensitivity {
    let q = &work.q;
    let last = q.len() - 1;
    let moment = |x: &V3, f: &V3| x.z * f.x - x.x * f.z;
    let weight = 1.0 / (step.gamma * step.gamma);
    let inertia = |i: usize| (q[i] - work.target[i]) * (work.mass[i] * weight);
    let turned: f64 = (1..last).map(|i| moment(&q[i], &inertia(i))).sum();
    let pull = work.gradient[last] - inertia(last);
    let length = (q[last] - q[last - 1]).norm();
    let mut seen = OutputSensitivity {
        torque: moment(&q[last], &pull) - turned,
        tension: work.axial[last - 1].tension.max(0.0),
        free_length: (lift..last).map(|j| (q[j + 1] - q[j]).norm()).sum(),
        lift: q[lift],
        angle: setting.spindle.angle,
        ..OutputSensitivity::default()
    };
    if let (Some(nozzle), Some(spec), Some(feed)) =
        (&setting.nozzle, &sys.model.feed, &sys.state.feed)
    {
        let grown = nozzle.rest(length) - sys.state.rod.rest[last - 1];
        let set = sys.set_tension_after(step.share * step.h);
        let next = advance(
            spec,
            feed,
            &sys.state.past,
            step,
            (grown, nozzle.line(length), set),
        );
        (seen.fed, seen.feed_speed) = (next.fed, next.rate);
    }
    seen
}
