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
mod roll;
mod scheme;
mod sensitivity;
mod statics;
mod tensioner;

pub use scheme::Scheme;
pub use sensitivity::OutputSensitivity;

use crate::linalg::Banded;
use crate::math::turn_about_y;
use crate::math::{Quat, Spin, V3};
use crate::math::{align, rotate};
use crate::rod::Twist;
use crate::rod::{Joint, Rod, YieldBranches};
use crate::system::{Mass, Spindle, Support, System};
use model::Model;
use roll::{Rolls, WITH_ROLL};
use scheme::{Step, extrapolation};
use serde::{Deserialize, Serialize};
use tensioner::NozzleEdge;

/// Largest growth of the step from one to the next; variable-step BDF2 is stable to 2.4.
const GROWTH: f64 = 1.7;
/// Share of the tolerance that a step length is chosen for: fewer steps thrown away outweigh more
/// steps (at 0.7 a fifth of all steps was rejected, at 0.4 a tenth, for a tenth less work in all).
const AIM: f64 = 0.4;
/// Steps below this multiple of the shortest are taken in trouble only.
const SHORT: f64 = 1e3;
/// Angle by which the nozzle's own motion may turn the edge there in a step, rad: the work that it does is that of the
/// forces at both ends of the step, and those of an edge that swings round have little to do with each other.
const NOZZLE_TURN: f64 = 0.2;
/// Newton's update at which a solve is done, over the tolerance.
const CLOSE: f64 = 0.1;

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

    /// Takes one step of at most `most` seconds; returns its length.
    pub fn step(&mut self, sys: &mut System, most: f64) -> Result<f64, StepError> {
        if sys.model.twist == Twist::Off {
            let mut work = std::mem::take(&mut self.work);
            let taken = self.step_with(&mut work, sys, most);
            self.work = work;
            return taken;
        }
        let mut work = std::mem::take(&mut self.twisted);
        let taken = self.step_with(&mut work, sys, most);
        self.twisted = work;
        taken
    }

    fn step_with<const D: usize>(
        &mut self,
        work: &mut Work<D>,
        sys: &mut System,
        most: f64,
    ) -> Result<f64, StepError> {
        sys.begin_past();
        let mut h = self.fixed.unwrap_or(self.next).min(self.longest);
        if self.fixed.is_none() {
            h = h.min(sys.time_to_turn_nozzle_edge(NOZZLE_TURN).max(self.shortest));
        }
        if h >= most {
            h = most;
        } else if 2.0 * h > most && self.fixed.is_none() {
            // two equal steps to the end instead of a long and a very short one
            h = 0.5 * most;
        }
        let mut failures = 0;
        loop {
            let step = step_of(sys, self.scheme, h);
            let spindle = sys.state.spindle.after(step.share * h);
            let support = moved(&sys.state.support, step.share * h);
            let nozzle = work.prepare(sys, &step, &spindle, &support, true);
            let share = work.share_of_way(sys);
            if share < 1.0 && h > self.shortest && self.fixed.is_none() {
                h = (share * h).max(self.shortest);
                continue;
            }
            if let Some(line) = sys.contact.as_line_mut() {
                line.begin_attempt();
                if let Some(b) = &mut line.self_contact {
                    let (from, guess) = (&sys.state.past.q[0], &work.guess);
                    b.list(from, guess, &sys.state.rod.rest, sys.model.section.diameter);
                }
            }
            let mut model = model_of(sys, &step, &spindle, &support, nozzle);
            let solved = newton::solve(
                &mut model,
                work,
                CLOSE * self.tolerance,
                newton::Reach::of_step(
                    failures > 2 || h < SHORT * self.shortest || self.fixed.is_some(),
                    if h > self.shortest && self.fixed.is_none() {
                        self.tolerance / step.error
                    } else {
                        f64::INFINITY
                    },
                    self.scheme == Scheme::Bdf2,
                ),
            );
            self.statistics.evaluations += std::mem::take(&mut work.evaluations);
            self.statistics.solves += std::mem::take(&mut work.solves);
            self.statistics.line_search_halvings += std::mem::take(&mut work.line_search_halvings);
            self.statistics.cg_iterations += std::mem::take(&mut work.gradients.cg_iterations);
            let missed = sys.contact.as_line().and_then(|l| {
                let pairs = l.self_contact.as_ref()?;
                pairs.missed(&sys.state.past.q[0], &work.q)
            });
            let retry = match solved {
                // farther than the pairs of wire were looked for
                Ok(_) if missed.is_some() && h > self.shortest && self.fixed.is_none() => {
                    self.statistics.rejects += 1;
                    0.5 * h
                }
                Ok(_) => {
                    let error = step.error * work.difference();
                    let factor = libm::cbrt(AIM * self.tolerance / error.max(1e-30));
                    if error <= self.tolerance || h <= self.shortest || self.fixed.is_some() {
                        self.commit(work, sys, &step, spindle, &support, nozzle);
                        self.statistics.steps += 1;
                        // a step cut short by the end of the interval says nothing against a longer one
                        let allowed = h * factor;
                        self.next = if h < self.next && allowed > self.next {
                            allowed.min(GROWTH * self.next)
                        } else if h < self.next && factor > 1.0 {
                            self.next
                        } else {
                            h * factor.clamp(0.3, GROWTH)
                        }
                        .clamp(self.shortest, self.longest);
                        return Ok(h);
                    }
                    self.statistics.rejects += 1;
                    h * factor.clamp(0.2, 0.8)
                }
                Err(newton::NewtonFailure { far: Some(way), .. }) => {
                    self.statistics.rejects += 1;
                    let factor = libm::cbrt(AIM * self.tolerance / (step.error * way));
                    h * factor.clamp(0.3, 0.8)
                }
                Err(stuck) => {
                    self.statistics.newton_failures += 1;
                    failures += 1;
                    if h <= self.shortest || self.fixed.is_some() {
                        return Err(StepError::at(h, &stuck));
                    }
                    0.4 * h
                }
            };
            h = retry.max(self.shortest);
            self.next = h;
            if let Some(line) = sys.contact.as_line_mut() {
                line.undo_attempt();
            }
        }
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
        if sys.model.twist == Twist::Off {
            evaluating_with(self.scheme, &mut self.work, sys, h, with);
        } else {
            evaluating_with(self.scheme, &mut self.twisted, sys, h, with);
        }
    }
}

fn evaluating_with<const D: usize>(
    scheme: Scheme,
    work: &mut Work<D>,
    sys: &mut System,
    h: f64,
    with: impl FnOnce(&mut dyn FnMut() -> f64),
) {
    sys.begin_past();
    let step = step_of(sys, scheme, h);
    let (spindle, support) = (
        sys.state.spindle.after(step.share * h),
        moved(&sys.state.support, step.share * h),
    );
    let nozzle = work.prepare(sys, &step, &spindle, &support, true);
    let mut model = model_of(sys, &step, &spindle, &support, nozzle);
    newton::expect_nothing(&model, work);
    with(&mut || model.evaluate(work).now);
}

impl<const D: usize> Work<D> {
    /// Share of the guess's way that takes no node deeper than its radius into core or frozen wire: error
    /// estimate and contact search
    /// both know nothing of a surface that lies between the ends of a step.
    fn share_of_way(&self, sys: &System) -> f64 {
        let Some(line) = sys.contact.as_line() else {
            return 1.0;
        };
        let mut share: f64 = 1.0;
        for (q, guess) in sys.state.past.q[0].iter().zip(&self.guess) {
            let way = (guess - q).norm();
            if way > line.radius {
                let room = (line.shape.lower_bound(*q) - line.height).max(line.radius);
                share = share.min(room / way);
            }
        }
        // (a little less, so that the second look agrees)
        if share < 1.0 { 0.9 * share } else { 1.0 }
    }

    /// Fills guess, inertial target, masses, and plastic curvature or frames for a step; rolls are
    /// without inertia where not `inert`.
    #[inline(never)]
    fn prepare(
        &mut self,
        sys: &System,
        step: &Step,
        spindle: &Spindle,
        support: &[Support; 2],
        inert: bool,
    ) -> Option<NozzleEdge> {
        let w = &mut *self;
        let (rod, past) = (&sys.state.rod, &sys.state.past);
        let nodes = rod.nodes();
        let spin = Spin::new(spindle.angle);
        let e = extrapolation(step.share * step.h, past);
        let density = sys.model.section.mass_per_length();
        w.guess.clear();
        w.target.clear();
        w.mass.clear();
        w.shared_mass.clear();
        if sys.model.mass == Mass::Consistent {
            w.shared_mass
                .extend((0..rod.edges()).map(|j| sys.mass_between(j)));
        }
        for s in &mut w.star {
            s.clear();
        }
        for i in 0..nodes {
            let (x, v) = (rod.x[i], rod.v[i]);
            let (xs, vs) = if step.weight[1] == 0.0 {
                (x, v)
            } else {
                (step.blend(x, past.x[i]), step.blend(v, past.v[i]))
            };
            w.star[0].push(xs);
            w.star[1].push(vs);
            w.target.push(spin.to_core(xs + vs * step.gamma));
            w.guess.push(match past.known {
                0 => spin.to_core(x + v * (step.share * step.h)),
                1 => past.q[0][i] * e[0] + past.q[1][i] * e[1],
                _ => past.q[0][i] * e[0] + past.q[1][i] * e[1] + past.q[2][i] * e[2],
            });
            w.mass.push(density * voronoi(rod, step.grown, i));
        }
        for (end, i) in [(0, 0), (1, nodes - 1)] {
            let s = &support[end];
            if s.turning && s.holds_all() {
                w.guess[i] = s.point;
            } else {
                let mut lab = spin.to_lab(w.guess[i]);
                for a in 0..3 {
                    if s.hold[a] {
                        lab[a] = s.point[a];
                    }
                }
                w.guess[i] = spin.to_core(lab);
            }
        }
        w.q.clone_from(&w.guess);
        if Self::ROLLS {
            self.rolls.prepare(sys, step, spindle, support, inert);
            self.rolls.lay_out(&mut self.assembly.rolling);
            let (state, ends) = ((&rod.bend[..], &rod.twist[..]), self.rolls.joints());
            (self.assembly.rolling).lay(&sys.model.laws, state, ends, |j| {
                (voronoi(rod, step.grown, j), set_share(rod, step.grown, j))
            });
        } else {
            self.turn_plastic_curvature(sys, spindle, support, step.grown);
            let clamps = clamp_directions(support, spindle);
            self.assembly.plain.begin(rod.edges(), clamps);
        }
        self.assembly.begin(&self.target, &self.mass);
        let (spec, feed) = sys.model.feed.as_ref().zip(sys.state.feed.as_ref())?;
        let last = rod.edges() - 1;
        Some(NozzleEdge::new(
            spec,
            feed,
            past,
            step,
            (
                rod.rest[last],
                sys.set_tension_after(step.share * step.h),
                sys.exit_grip(),
                sys.model.laws.stretch.modulus,
                rod.stretch[last].strain,
            ),
        ))
    }

    /// Plastic curvature of each joint as a vector in the core frame, turned along with the guess.
    fn turn_plastic_curvature(
        &mut self,
        sys: &System,
        spindle: &Spindle,
        support: &[Support; 2],
        grown: f64,
    ) {
        let w = &mut *self;
        let rod = &sys.state.rod;
        let back = turn_about_y(-spindle.angle);
        w.set.clear();
        w.set.resize(rod.nodes(), V3::zeros());
        for i in 0..rod.nodes() {
            let k = rod.bend[i].curvature;
            if k == [0.0; 2] {
                continue;
            }
            let frame = |j: usize| {
                let d = w.guess[j + 1] - w.guess[j];
                align(&(back * rod.frame[j]), &(d / d.norm()), 0.0)
            };
            let clamp = |s: &Support| s.frame.map(|f| if s.turning { f } else { back * f });
            let before = if i > 0 {
                Some(frame(i - 1))
            } else {
                clamp(&support[0])
            };
            let after = if i < rod.edges() {
                Some(frame(i))
            } else {
                clamp(&support[1])
            };
            let (Some(p), Some(n)) = (before, after) else {
                continue;
            };
            w.set[i] = mid_frame_vector(&p, &n, k) * set_share(rod, grown, i);
        }
    }

    /// Root mean square of the update over the wire, m.
    fn mean_update(&self) -> f64 {
        let (sum, mass) = self.weighed(|i| self.update_of(i));
        (sum / mass).sqrt()
    }

    /// Root mean square over the wire of what Newton's method moved the guess by, m.
    fn difference(&self) -> f64 {
        let (mut sum, mass) = self.weighed(|i| self.q[i] - self.guess[i]);
        if Self::ROLLS {
            sum += self.rolls.difference();
        }
        (sum / mass).sqrt()
    }

    /// Sum of the squares of the nodes' ways, each times its mass, and of the masses.
    fn weighed(&self, way: impl Fn(usize) -> V3) -> (f64, f64) {
        let (mut sum, mut mass) = (0.0, 0.0);
        for (i, m) in self.mass.iter().enumerate() {
            sum += m * way(i).norm_squared();
            mass += m;
        }
        (sum, mass)
    }
}

/// The step of `h` from the present instant.
fn step_of(sys: &System, scheme: Scheme, h: f64) -> Step {
    let step = Step::new(scheme, &sys.state.past, h);
    match (&sys.state.feed, sys.state.rod.rest.last()) {
        (Some(feed), Some(rest)) => step.with_feed(&sys.state.past, feed.fed, *rest),
        _ => step,
    }
}

/// Length of wire that node `i` stands for when the edge at the nozzle has `grown`, m.
fn voronoi(rod: &Rod, grown: f64, i: usize) -> f64 {
    let at_nozzle = i + 2 >= rod.nodes();
    rod.voronoi(i) + if at_nozzle { 0.5 * grown } else { 0.0 }
}

/// Share of node `i`'s set curvature and twist when the edge at the nozzle has `grown`, see `System::keep_set_at_nozzle`.
fn set_share(rod: &Rod, grown: f64, i: usize) -> f64 {
    if i + 2 == rod.nodes() {
        rod.voronoi(i) / voronoi(rod, grown, i)
    } else {
        1.0
    }
}

/// A vector with components `k` in the frame half-way between the frames of two edges.
fn mid_frame_vector(p: &Quat, n: &Quat, k: [f64; 2]) -> V3 {
    let joint = Joint::between(p, n);
    let half = crate::math::relative([0.5 * joint.bend[0], 0.5 * joint.bend[1]], 0.0);
    let (s, c) = (libm::sin(0.25 * joint.twist), libm::cos(0.25 * joint.twist));
    let mid = p * Quat::new(c, 0.0, 0.0, s) * half;
    rotate(&mid, &V3::new(k[0], k[1], 0.0))
}

/// What a solve of `step` needs besides the iterate.
fn model_of<'a>(
    sys: &'a mut System,
    step: &Step,
    spindle: &Spindle,
    support: &[Support; 2],
    nozzle: Option<NozzleEdge>,
) -> Model<'a> {
    Model {
        rod: &sys.state.rod,
        laws: &sys.model.laws,
        line: sys.contact.as_line_mut(),
        loads: &sys.model.loads,
        last: &sys.state.past.q[0],
        tension: &sys.state.load.tension,
        nozzle,
        grown: step.grown,
        gamma: step.gamma,
        elapsed: step.share * step.h,
        diameter: sys.model.section.diameter,
        arc0: sys.state.arc0,
        back: Spin::new(spindle.angle),
        held: [support[0].hold, support[1].hold],
        flat: false,
    }
}

/// The supports `dt` later.
fn moved(support: &[Support; 2], dt: f64) -> [Support; 2] {
    let mut s = *support;
    for s in &mut s {
        s.point += s.velocity * dt;
    }
    s
}

/// Directions of the clamped ends in the core frame.
fn clamp_directions(support: &[Support; 2], spindle: &Spindle) -> [Option<V3>; 2] {
    let spin = Spin::new(spindle.angle);
    let of = |s: &Support| {
        s.frame.map(|f| {
            let t = rotate(&f, &V3::z());
            if s.turning { t } else { spin.to_core(t) }
        })
    };
    [of(&support[0]), of(&support[1])]
}
