//! Newton's method on the incremental potential, with line search.

use super::circle::Circle;
use super::largest::largest;
use super::potential::Potential;
use super::slope::Slope;
use super::unknowns::Unknowns;
use super::update::{load_gradient, solve_linear};
use super::work::{Axial, Work};
use crate::contact::LimitFrom;
use crate::math::{V3, scaled};

/// Newton steps after which the coefficients of friction stay what the slide of the first iterate makes them, see
/// [`LimitFrom::NormalForce`]. Of a prescribed step its caller wants the solution, with coefficients of its own.
const SLIDES: usize = 1;
/// Newton steps in which friction limits follow the normal force. Most solves are done after three; where slides still turn to and
/// fro after so many, the limits stay, and the rest is the minimum of a potential. The solution then lags behind its own limits.
const FOLLOWS: usize = 6;
/// An update of more than so many times what is close is not the last but one.
const CHORD: f64 = 100.0;
/// Updates with old factors in a row that are tried. Three take a tenth of the time off one (`fig8`, 2e-6 m).
const CHORDS: usize = 3;
/// Share of the update before below which another is tried.
const SHRINKS: f64 = 0.2;
/// What a last update with old factors may leave, as a share of what is close in a step of the length that the error asks
/// for. Lightly pressed wire is a tenth of a micrometre deep, and friction follows the depth: with ten times as much,
/// gaps of `shoulder_drop` come out up to 11 % too small at the default tolerance, with this 6 %.
const CHORD_LEFT: f64 = 0.03;
/// The largest share of what is close in a shorter step: that is less already.
const CHORD_LEFT_SHORT: f64 = 0.3;
/// The same for the midpoint rule, which keeps what is wrong with a step for ever.
const CHORD_KEPT: f64 = 1e-3;
/// Rounding noise of the potential as a share of its size.
const NOISE: f64 = 1e-13;

/// How far a solve may go.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct NewtonLimits {
    /// Newton steps before the solve counts as failed
    pub(super) steps: usize,
    /// largest move of a node in one Newton step, m, for wire of 0.7 mm
    pub(super) longest: f64,
    /// largest move of an edge's end against its start, over its length
    pub(super) turn: f64,
    /// root mean square of the first update from which on the solve isn't worth its while, m
    pub(super) far: f64,
    /// halvings of one Newton step before the solve counts as failed
    pub(super) line_search_halvings: usize,
    /// a guess stands unsolved if inertia alone bounds the update by so much, m
    pub(super) guess: f64,
    /// what a last update with the factors of the one before may leave, as a share of what is close; 0: there is none
    pub(super) chord: f64,
    /// Newton steps that look the coefficients of friction up by the slide, at most [`FOLLOWS`]
    pub(super) slides: usize,
    /// share of the contact force that an update may promise wrongly, as what is close is a share of what it is in a long step
    pub(super) promise: f64,
}

impl NewtonLimits {
    /// That of a time step, whose guess is close.
    pub(super) const STEP: Self = Self {
        steps: 12,
        longest: 0.5e-3,
        turn: f64::INFINITY,
        far: f64::INFINITY,
        line_search_halvings: 12,
        guess: 0.0,
        chord: CHORD_KEPT,
        slides: FOLLOWS,
        promise: 1.0,
    };

    /// That of a time step, a `short` one or one that may as well be shorter. Then that is cheaper than a long search
    /// for a smaller Newton step (`fig8` at 30 rad/s: a tenth of all evaluations). A scheme that is `damped` forgets a
    /// small error; of a prescribed step its caller wants the solution.
    ///
    /// The first update tells how far the guess is off, within a few per cent where the solve comes to an end. One
    /// beyond `far` saves the rest of a solve that the error would throw away.
    /// `share` is the length of the step over that which the error asks for, at most 1.
    pub(super) fn of_step(short: bool, far: f64, guess: f64, share: f64, damped: bool) -> Self {
        Self {
            far,
            line_search_halvings: if short {
                Self::STEP.line_search_halvings
            } else {
                2
            },
            guess,
            chord: if damped {
                (CHORD_LEFT / share).min(CHORD_LEFT_SHORT)
            } else {
                CHORD_KEPT
            },
            slides: if damped { SLIDES } else { FOLLOWS },
            promise: share,
            ..Self::STEP
        }
    }

    /// Whether a shorter step is cheaper than a long search.
    fn may_shorten(&self) -> bool {
        self.line_search_halvings < Self::STEP.line_search_halvings
    }

    /// Halvings of an update in a line search: a shorter step does not help `rolls`.
    fn halvings(&self, rolls: bool) -> usize {
        match rolls {
            true => Self::STEP.line_search_halvings,
            false => self.line_search_halvings,
        }
    }

    /// Share of an update that is within reach, at most 1.
    fn share<const D: usize, U: Unknowns<D>>(
        &self,
        work: &Work<D, U>,
        update: f64,
        diameter: f64,
    ) -> f64 {
        let mut share = (scaled(self.longest, diameter) / update).min(1.0);
        if self.turn.is_finite() {
            for j in 0..work.q.len() - 1 {
                let change = work.update_of(j + 1) - work.update_of(j);
                share = share.min(self.turn * work.axial[j].length / change.norm());
            }
        }
        share.min(U::share(&work.update, self.turn))
    }
}

/// Why a solve gave up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct NewtonFailure {
    /// node with the largest update
    pub(super) node: usize,
    /// that update, m
    pub(super) update: f64,
    /// Newton steps taken
    pub(super) steps: usize,
    /// root mean square of the first update, m, if that was too far
    pub(super) far: Option<f64>,
}

/// Moves `work.q` to the minimum; `close` is the update below which it is there, m.
#[inline(never)]
pub(super) fn solve<const D: usize, U: Unknowns<D>>(
    potential: &mut Potential,
    work: &mut Work<D, U>,
    close: f64,
    limits: NewtonLimits,
) -> Result<usize, NewtonFailure> {
    expect_nothing(potential, work);
    take_limits(potential, LimitFrom::Lagged);
    let mut value = potential.evaluate(work).now;
    take_limits(potential, LimitFrom::Slide);
    // a guess that is good enough costs no solve
    if bound_by_inertia(potential, work) < limits.guess {
        return Ok(0);
    }
    let mut last_update = f64::INFINITY;
    let mut circle = Circle::NEW;
    let mut worst = (0, f64::INFINITY);
    for step in 1..=limits.steps {
        if step > FOLLOWS {
            take_limits(potential, LimitFrom::Lagged);
        } else if step > limits.slides {
            take_limits(potential, LimitFrom::NormalForce);
        }
        work.solves += 1;
        let fits = solve_linear(potential, work, limits.promise).map_err(|node| NewtonFailure {
            node,
            update: f64::NAN,
            steps: step,
            far: None,
        })?;
        let mut slope = Slope::of(work);
        if slope.curvature() <= 0.0 {
            work.update.clone_from(&work.plain);
            slope = Slope::of(work);
        }
        let (update, node, rolls) = largest_update(potential, work);
        let failure = |far| NewtonFailure {
            node,
            update,
            steps: step,
            far,
        };
        if !update.is_finite() {
            return Err(failure(None));
        }
        if step == 1 {
            let way = work.mean_update();
            if way > limits.far {
                return Err(failure(Some(way)));
            }
        }
        let mut share = limits.share(work, update, potential.diameter);
        if circle.closes(update, share == 1.0) && limits.may_shorten() {
            return Err(failure(None));
        }
        work.keep_start();
        // (the next evaluation fills in all of the stretch)
        std::mem::swap(&mut work.base, &mut work.axial);
        // near the end each step shrinks the update by the same factor or better
        let next = if last_update.is_finite() {
            update * (update / last_update).min(1.0)
        } else {
            update
        };
        if share == 1.0 && fits && (update < close || next < 0.5 * close) {
            work.take(1.0);
            return Ok(step);
        }
        if share == 1.0 && fits && limits.chord > 0.0 {
            match end_by_chords(
                potential,
                work,
                value + slope.rise(1.0),
                (update, close),
                limits.chord * close,
            ) {
                Chord::Ends => return Ok(step + 1),
                Chord::Nearer => {
                    value = potential.evaluate(work).now;
                    if let Some(line) = &mut potential.line {
                        line.state.renew_limits();
                    }
                    last_update = update;
                    continue;
                }
                Chord::Vain => {}
            }
        }
        let halvings = limits.halvings(rolls);
        (value, share) = search_along(
            potential,
            work,
            (value, slope),
            (update, close),
            share,
            halvings,
        )
        .ok_or_else(|| failure(None))?;
        last_update = if share == 1.0 { update } else { f64::INFINITY };
        worst = (node, update);
    }
    Err(NewtonFailure {
        node: worst.0,
        update: worst.1,
        steps: limits.steps,
        far: None,
    })
}

/// Inertia bounds the update from above, m.
fn bound_by_inertia<const D: usize, U: Unknowns<D>>(
    potential: &Potential,
    work: &Work<D, U>,
) -> f64 {
    let weight = potential.gamma * potential.gamma;
    let radius = 0.5 * potential.diameter;
    let bound = work
        .gradient
        .iter()
        .zip(&work.mass)
        .map(|(g, m)| g.amax() * weight / m)
        .fold(0.0, f64::max);
    bound.max(work.unknowns.bound(potential.gamma, radius))
}

/// Takes the update from where the potential has this `value`, J, or half of it as often as it takes for the potential to fall as
/// `slope` promises. The value there and the share that was taken; `None` where so many `halvings` do not suffice.
fn search_along<const D: usize, U: Unknowns<D>>(
    potential: &mut Potential,
    work: &mut Work<D, U>,
    (value, slope): (f64, Slope),
    (update, close): (f64, f64),
    mut share: f64,
    halvings: usize,
) -> Option<(f64, f64)> {
    for _ in 0..=halvings {
        work.take(share);
        expect_tension(work, share);
        let trial = potential.evaluate(work);
        let most = value + slope.rise(share);
        if trial.merit <= most + NOISE * value.abs() || share * update < close {
            if let Some(line) = &mut potential.line {
                line.state.renew_limits();
            }
            return Some((trial.now, share));
        }
        work.line_search_halvings += 1;
        share *= 0.5;
    }
    None
}

/// What updates with old factors did.
enum Chord {
    /// the solve is done
    Ends,
    /// the iterate is nearer, but not there
    Nearer,
    /// nothing
    Vain,
}

/// Takes the whole update, of size `first`, which may lead to this `value` of the potential at most, J, and with the factors it came
/// from up to [`CHORDS`] after it, until one leaves no more than `left` (m).
///
/// An update is about a thirtieth of the one before, and old factors are good enough for it. What is then wrong is
/// about its square over the one before. It needs neither a new Hessian nor new factors with looks ahead, more than half
/// the cost of an iteration. Where the first of them does not shrink enough, the work was in vain.
fn end_by_chords<const D: usize, U: Unknowns<D>>(
    potential: &mut Potential,
    work: &mut Work<D, U>,
    value: f64,
    (first, close): (f64, f64),
    left: f64,
) -> Chord {
    if first > CHORD * close {
        return Chord::Vain;
    }
    work.take(1.0);
    expect_tension(work, 1.0);
    let trial = potential.evaluate_forces(work);
    if trial.merit > value + NOISE * value.abs() {
        return Chord::Vain;
    }
    work.plain.clone_from(&work.update);
    let mut before = first;
    for chord in 0..CHORDS {
        work.solves += 1;
        load_gradient(work);
        std::mem::swap(&mut work.update, &mut work.load);
        work.solve_factored(0.5 * potential.diameter);
        let (next, ..) = largest_update(potential, work);
        let ends = next < left || next * next <= before * left;
        if !ends && (next > SHRINKS * before || chord + 1 == CHORDS) {
            if chord == 0 {
                std::mem::swap(&mut work.update, &mut work.plain);
                return Chord::Vain;
            }
            return Chord::Nearer;
        }
        work.keep_start();
        work.take(1.0);
        if ends {
            return Chord::Ends;
        }
        potential.evaluate_forces(work);
        before = next;
    }
    Chord::Nearer
}

/// Largest update of an unknown, m, its node, and whether it is a roll, which counts by the way of the wire's surface.
fn largest_update<const D: usize, U: Unknowns<D>>(
    potential: &Potential,
    work: &Work<D, U>,
) -> (f64, usize, bool) {
    let (update, at) = largest::<D>(&work.update, 0.5 * potential.diameter);
    (update, at / D, at % D == 3)
}

fn take_limits(potential: &mut Potential, from: LimitFrom) {
    if let Some(line) = &mut potential.line {
        line.state.limit_from = from;
    }
}

/// At the start tensions are expected to stay what they were at the last accepted instant.
pub(super) fn expect_nothing<const D: usize, U: Unknowns<D>>(
    potential: &Potential,
    work: &mut Work<D, U>,
) {
    work.expected.clear();
    for j in 0..potential.rod.edges() {
        let tension = potential.tension.get(j).copied().unwrap_or(0.0);
        let strain = potential.rod.stretch[j].strain + tension / potential.laws.stretch.modulus;
        work.expected.push(Axial {
            tension,
            length: potential.rod.rest[j] * (1.0 + strain),
            ..Default::default()
        });
    }
    for stretch in [&mut work.axial, &mut work.base] {
        stretch.resize(work.expected.len(), Axial::default());
    }
}

/// What the update promises for the stretch of each edge.
#[inline(never)]
fn expect_tension<const D: usize, U: Unknowns<D>>(work: &mut Work<D, U>, share: f64) {
    let nodes = work.update.as_chunks::<D>().0;
    let edges = work.expected.iter_mut().zip(&work.base);
    for ((e, a), (u, v)) in edges.zip(nodes.iter().zip(&nodes[1..])) {
        let change = V3::new(v[0] - u[0], v[1] - u[1], v[2] - u[2]) * share;
        let longer = a.along.dot(&change);
        e.length = a.length + longer;
        e.tension = a.tension + a.stiffness * longer;
        e.energy = a.energy + longer * (a.tension + 0.5 * a.stiffness * longer);
    }
}
