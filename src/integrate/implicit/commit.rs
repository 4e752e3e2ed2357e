//! Taking a converged step over as the new state, with its energy balance.

use super::Implicit;
use super::carried::Carried;
use super::first_edge::FirstEdge;
use super::landings::Solved;
use super::nozzle_edge::NozzleEdge;
use super::scheme::{Scheme, StepFormula};
use super::tensioner::advance;
use super::unknowns::Unknowns;
use super::work::Work;
use crate::contact::LimitFrom;
use crate::feed::Feed;
use crate::math::{Spin, V3};
use crate::system::{Spindle, Support, System};

/// What the energy balance of a step takes from its start.
struct Before {
    spindle: Spindle,
    /// N m
    torque_on_core: f64,
    /// the part of it there because forces and motion are a little out of balance, N m
    unbalanced: f64,
    /// tension of the edge at the nozzle, N
    nozzle_tension: Option<f64>,
    carried: Carried,
    /// moment that turns the wire's mass, N m
    turning: Option<f64>,
    /// what the balance has put down to the method so far, J
    numerical: f64,
}

/// Wire that came in through the nozzle during the step.
struct Inflow {
    /// unstretched, m
    grown: f64,
    /// that of half of it, kg: the node before the nozzle gains as much
    mass: f64,
    /// plastic stretch of the wire that passed
    passing: f64,
}

impl Implicit {
    pub(super) fn commit<const D: usize, U: Unknowns<D>>(
        &mut self,
        w: &mut Work<D, U>,
        sys: &mut System,
        step: &StepFormula,
        spindle: Spindle,
        support: &[Support; 2],
        nozzle: Option<NozzleEdge>,
    ) {
        let h = step.h;
        let before = Before::of(w, sys);
        w.unknowns.hand_over(sys, self.scheme, step);
        let fed = feed_after(sys, step, nozzle, &w.q);
        self.take_motion(w, sys, step, spindle, support);
        let inflow = take_feed(sys, fed);
        if self.scheme == Scheme::Bdf2 {
            let length = (w.q[1] - w.q[0]).norm();
            let slip = FirstEdge::of(sys).and_then(|first| first.slip(length));
            if let Some((slip, rest)) = slip {
                sys.slip_frozen(&slip, rest);
            }
        }
        if let Some(line) = sys.state.contact.as_line_mut() {
            // late Newton steps hold the coefficients of friction; what is accepted goes by its own slide
            line.limit_from = LimitFrom::Slide;
        }
        if self.scheme == Scheme::Bdf2 {
            sys.state.turning = Some(
                sys.moment_of(|i| (sys.state.rod.v[i] - w.star[1][i]) * (w.mass[i] / step.gamma)),
            );
        }
        sys.evaluate_smooth(h, true);
        // energy balance: work of forces at both ends of the step
        let turned = sys.state.spindle.angle - before.spindle.angle;
        sys.state.balance.spindle -=
            0.5 * (sys.state.torque_on_core + before.torque_on_core) * turned;
        if sys.state.feed.is_some() {
            book_nozzle(w, sys, &before, &inflow, h);
        }
        let carried = Carried::of(sys);
        book_turning(sys, &before, &carried, turned, h);
        book_numerical(w, sys, &before, &carried, inflow.mass, turned);
        keep_history(w, sys, h);
        if self.scheme == Scheme::Bdf2 {
            let solved = Solved {
                mass: &w.mass,
                star: &w.star[1],
                force: &w.force,
                carried,
                numerical: before.numerical,
            };
            w.impacts
                .stop(sys, step, solved, before.spindle, self.tolerance);
        }
    }

    /// Moves nodes, spindle, supports and set tension to the end of the step.
    fn take_motion<const D: usize, U: Unknowns<D>>(
        &self,
        w: &Work<D, U>,
        sys: &mut System,
        step: &StepFormula,
        spindle: Spindle,
        support: &[Support; 2],
    ) {
        let h = step.h;
        let spin = Spin::new(spindle.angle);
        for i in 0..sys.state.rod.nodes() {
            let x = spin.to_lab(w.q[i]);
            match self.scheme {
                Scheme::Bdf2 => {
                    sys.state.rod.x[i] = x;
                    sys.state.rod.v[i] = (x - w.star[0][i]) / step.gamma;
                }
                Scheme::Midpoint => {
                    let [x0, v0] = &w.before;
                    sys.state.rod.x[i] = x * 2.0 - x0[i];
                    sys.state.rod.v[i] = (x - x0[i]) * (4.0 / h) - v0[i];
                }
            }
        }
        if self.scheme == Scheme::Midpoint {
            sys.state.spindle = sys.state.spindle.after(h);
            sys.carry_supports(h);
        } else {
            sys.state.spindle = spindle;
            sys.state.support = *support;
        }
        sys.state.set_tension = sys.set_tension_after(h);
        sys.state.time += h;
        sys.place_supports();
    }
}

impl Before {
    /// Keeps forces, places and velocities in the work space, too.
    fn of<const D: usize, U: Unknowns<D>>(w: &mut Work<D, U>, sys: &System) -> Self {
        w.force.clone_from(&sys.state.load.force);
        w.before[0].clone_from(&sys.state.rod.x);
        w.before[1].clone_from(&sys.state.rod.v);
        Self {
            spindle: sys.state.spindle,
            torque_on_core: sys.state.torque_on_core,
            unbalanced: sys.state.unbalanced,
            nozzle_tension: sys.state.load.tension.last().copied(),
            carried: Carried::of(sys),
            turning: sys.state.turning,
            numerical: sys.state.balance.numerical,
        }
    }
}

/// Takes over the feed after the step, if there is one, and how much wire came in.
fn take_feed(sys: &mut System, fed: Option<(Feed, f64)>) -> Inflow {
    let grown = fed.map_or(0.0, |(_, grown)| grown);
    let mass = grown * 0.5 * sys.model.section.mass_per_length();
    let mut passing = 0.0;
    if let (Some((next, _)), Some(feed)) = (fed, &mut sys.state.feed) {
        sys.state.past.keep_feed(feed);
        *feed = next;
        let last = sys.state.rod.edges() - 1;
        passing = sys.pass_nozzle(grown);
        sys.keep_set_at_nozzle(grown);
        // the node before the nozzle gains mass that moves as it does
        sys.state.balance.inflow += 0.5 * mass * sys.state.rod.v[last].norm_squared();
    }
    Inflow {
        grown,
        mass,
        passing,
    }
}

/// Work of the wire that comes in, and of the nozzle that moves.
fn book_nozzle<const D: usize, U: Unknowns<D>>(
    w: &Work<D, U>,
    sys: &mut System,
    before: &Before,
    &Inflow { grown, passing, .. }: &Inflow,
    h: f64,
) {
    let last = sys.state.rod.edges() - 1;
    // a moment at the node before, spread over more or less wire: the grid's doing
    sys.state.balance.remeshing += 0.5 * sys.bent_at_nozzle() * grown;
    sys.tighten_line_wire();
    let now = sys.state.load.tension[last];
    let tension = 0.5 * (now + before.nozzle_tension.unwrap_or(now));
    let law = sys.model.laws.stretch;
    sys.state.balance.nozzle -=
        (tension * (1.0 + passing) + 0.5 * tension * tension / law.modulus) * grown;
    let n = sys.state.rod.nodes() - 1;
    let force = (sys.state.load.force[n] + w.force[n]) * 0.5;
    sys.state.balance.nozzle -= force.dot(&sys.state.support[1].velocity) * h;
}

/// What has turned the wire's mass is known better by its motion at both ends than by the mean of the moments there.
fn book_turning(sys: &mut System, before: &Before, carried: &Carried, turned: f64, h: f64) {
    sys.state.pressed = 0.0;
    if let Some(now) = sys.state.turning {
        let given = (carried.momentum - before.carried.momentum) * turned / h;
        let mean = 0.5 * (before.turning.unwrap_or(0.0) + now);
        let over = mean * turned - given;
        sys.state.balance.spindle -= over;
        sys.state.balance.numerical -= over;
        if !sys.contact_follows(h) {
            sys.state.pressed = mean - (carried.momentum - before.carried.momentum) / h;
        }
    }
}

/// What Newton's law and the forces at both ends of the step do not agree on is the method's; `inflow` is the mass that came in, kg.
fn book_numerical<const D: usize, U: Unknowns<D>>(
    w: &Work<D, U>,
    sys: &mut System,
    before: &Before,
    carried: &Carried,
    inflow: f64,
    turned: f64,
) {
    let mut work = 0.0;
    for i in sys.free_nodes() {
        work += 0.5
            * (sys.state.load.force[i] + w.force[i]).dot(&(sys.state.rod.x[i] - w.before[0][i]));
    }
    work += w.unknowns.work(sys);
    let gained = if sys.state.feed.is_some() {
        0.5 * inflow * sys.state.rod.v[sys.state.rod.edges() - 1].norm_squared()
    } else {
        0.0
    };
    let held = 0.5 * (sys.state.unbalanced + before.unbalanced) * turned;
    // (what yields within the step is known better than by the forces at its ends)
    work -= sys.state.load.beyond;
    sys.state.balance.numerical +=
        work - held - (carried.kinetic - before.carried.kinetic - gained);
}

/// Keeps places and velocities of the step's start, and places at its end in the core frame.
fn keep_history<const D: usize, U: Unknowns<D>>(w: &mut Work<D, U>, sys: &mut System, h: f64) {
    let past = &mut sys.state.past;
    let [x0, v0] = &mut w.before;
    std::mem::swap(&mut past.x, x0);
    std::mem::swap(&mut past.v, v0);
    past.q.rotate_right(1);
    past.q[0].clear();
    let spin = Spin::new(sys.state.spindle.angle);
    past.q[0].extend(sys.state.rod.x.iter().map(|x| spin.to_core(*x)));
    past.h = [h, past.h[0]];
    past.known = (past.known + 1).min(2);
}

/// The feed after the step and how much wire came in.
pub(super) fn feed_after(
    sys: &System,
    step: &StepFormula,
    nozzle: Option<NozzleEdge>,
    q: &[V3],
) -> Option<(Feed, f64)> {
    let (nozzle, spec) = (nozzle?, sys.model.feed.as_ref()?);
    let feed = sys.state.feed.as_ref()?;
    let last = sys.state.rod.edges() - 1;
    let length = (q[last + 1] - q[last]).norm();
    let elastic = nozzle.rest(length) - sys.state.rod.rest[last];
    let [line, slope] = nozzle.line(length);
    let pull = nozzle.stretched(length).tension;
    // (friction at the exit is a factor of both)
    let steep = if line > 0.0 { slope * pull / line } else { 0.0 };
    let grown = sys.grown_with_yield(length, elastic, (pull, steep));
    let line = line + slope * (grown - elastic);
    let set = sys.set_tension_after(step.share * step.h);
    let passed = (grown, line, set);
    let next = advance(spec, feed, &sys.state.past, step, passed, &sys.line_yield());
    Some((next, grown))
}
