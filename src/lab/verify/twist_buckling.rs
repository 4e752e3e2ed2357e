//! The torque at which a straight twisted wire leaves its axis.
//!
//! Both ends clamped coaxially, one free to slide under tension. The straight wire is stable as
//! long as the derivative of the rod's forces with respect to the nodes (by central differences,
//! made symmetric) is positive definite. The torque is read at the clamp. Rolls of the edges are
//! left out: to first order they do not couple with sideways motion of a straight wire.
//!
//! In the set-up of a wind that is the first guess. The bow that is held back least is then set off a little below and
//! above it, and the rate at which it dies or grows in the wind's own steps tells where it would stay.

use super::bench::Stepper;
use super::equilibrium::method;
use super::{Answer, Answers, Context, VerifyError};
use crate::math::V3;
use crate::math::{align, frame_along};
use crate::rod::{Rod, Section, Twist};
use crate::scene::Integrator;
use crate::system::{Support, System};
use nalgebra::{DMatrix, DVector};

/// Fewest edges, and edges per bending length `sqrt(EI/T)`; the error falls with the square.
const EDGES: f64 = 80.0;
const PER_BENDING_LENGTH: f64 = 12.0;

/// Fewest edges over the rotation at which the wire is likely to leave its axis, 1/rad.
const PER_RADIAN: f64 = 2.5;

/// Share of the rotation below and above the critical one at which growth is looked at: small enough that drag
/// holds the bow back more than its mass does, and growth goes evenly with the rotation.
const BESIDE: f64 = 0.005;
/// Lowest frequency of a clamped wire in `sqrt(EI/m)/L^2`.
const CLAMPED: f64 = 22.4;
/// Drag over the rate of growth without it that taut wire has beside the critical rotation.
const DAMPED: f64 = 2.0;
/// Bow that is set off, in wire diameters, longest step, time until it has its shape and longest watch, all over the
/// inverse of that frequency.
const BOW: f64 = 0.1;
const LOOK: f64 = 0.1;
const START: f64 = 5.0;
const WATCH: f64 = 20.0;
/// Steps of inverse iteration; each takes the other bows back by a factor of about ten.
const INVERSE_STEPS: usize = 10;
/// A bow that has grown or gone back by this factor has shown its rate.
const ENOUGH: f64 = 10.0;

/// Bisections once the torque is known to a factor of two.
const HALVINGS: usize = 16;

/// Runs a case.
pub fn run(ctx: &Context) -> Result<Answers, VerifyError> {
    let (length, pull) = (ctx.positive("L_m")?, ctx.number("T_N")?);
    let section = ctx.elastic();
    let bending_lengths = length * (pull.max(0.0) / section.ei).sqrt();
    // of a string, and of a wire without tension
    let likely = (4.0 * section.ei * pull.max(0.0)).sqrt() + 8.99 * section.ei / length;
    let fit = EDGES
        .max(PER_BENDING_LENGTH * bending_lengths)
        .max(PER_RADIAN * likely * length / section.gj)
        .min(400.0);
    let edges = ctx.free_edges(length, length / fit)?;
    let straight = |rotation: f64| Straight::new(&section, length, pull, rotation, edges);
    let stable = |rotation: f64| straight(rotation).stiffness(ctx).cholesky().is_some();
    let mut low = 0.0;
    let mut high = 1.0;
    while stable(high) {
        low = high;
        high *= 2.0;
        // a joint must stay clear of half a turn
        if high > edges as f64 {
            return Err(VerifyError::NoAnswer(format!(
                "still straight after {low} rad"
            )));
        }
    }
    for _ in 0..HALVINGS {
        let mid = 0.5 * (low + high);
        if stable(mid) {
            low = mid;
        } else {
            high = mid;
        }
    }
    let mut rotation = 0.5 * (low + high);
    if ctx.winds() {
        let bow = softest(straight((1.0 - BESIDE) * rotation).stiffness(ctx))
            .ok_or_else(|| VerifyError::NoAnswer("no bow is softest".to_owned()))?;
        let growth = |share: f64| straight(share * rotation).growth(ctx, &bow);
        let [below, above] = [growth(1.0 - BESIDE)?, growth(1.0 + BESIDE)?];
        if !(below < 0.0 && above > 0.0) {
            return Err(VerifyError::NoAnswer(format!(
                "the wire does not leave its axis near {rotation} rad: it grows by {below} and {above} 1/s"
            )));
        }
        rotation *= 1.0 - BESIDE * (above + below) / (above - below);
    }
    Ok(vec![(
        "critical_torque_Nm",
        Answer::Number(straight(rotation).torque()),
    )])
}

/// The displacement that a positive definite stiffness holds back least, largest component 1, by inverse iteration; `None`
/// where it is not positive definite.
fn softest(stiffness: DMatrix<f64>) -> Option<DVector<f64>> {
    let inverse = stiffness.cholesky()?;
    let n = inverse.l_dirty().nrows();
    // along every bow, and the same everywhere
    let mut bow = DVector::from_fn(n, |i, _| 1.0 + libm::sin(i as f64));
    for _ in 0..INVERSE_STEPS {
        inverse.solve_mut(&mut bow);
        bow /= bow.amax();
    }
    Some(bow)
}

/// The straight wire along z, its far end turned.
struct Straight {
    sys: System,
    length: f64,
}

impl Straight {
    fn new(section: &Section, length: f64, pull: f64, rotation: f64, edges: usize) -> Self {
        let h = length / edges as f64;
        let points: Vec<V3> = (0..=edges).map(|i| V3::z() * (h * i as f64)).collect();
        let stretch = 1.0 + pull / section.ea;
        let mut rod = Rod::through(&points, Some(vec![h / stretch; edges]));
        let base = frame_along(&V3::z(), None);
        let turned = |share: f64| align(&base, &V3::z(), rotation * share);
        for j in 0..edges {
            rod.frame[j] = turned((j as f64 + 0.5) / edges as f64);
        }
        let mut sys = System::new(section.clone(), rod);
        sys.state.support[0] = Support::clamped(points[0], turned(0.0));
        sys.state.support[1] = Support {
            hold: [true, true, false],
            ..Support::clamped(points[edges], turned(1.0))
        };
        sys.model.loads.nodal = vec![(edges, V3::z() * pull)];
        sys.evaluate(None);
        Self { sys, length }
    }

    /// Torque that the near clamp puts into the wire, N m.
    fn torque(&self) -> f64 {
        self.sys.state.load.clamp_moment[0].z.abs()
    }

    /// Rate at which a small `bow` grows under drag as the wind's own steps have it, 1/s; negative if it goes back.
    fn growth(mut self, ctx: &Context, bow: &DVector<f64>) -> Result<f64, VerifyError> {
        let section = &self.sys.model.section;
        let pull = self.sys.model.loads.nodal[0].1.z.max(0.0);
        let (ei, mass) = (section.ei, section.mass_per_length());
        let clamped = CLAMPED / (self.length * self.length) * (ei / mass).sqrt();
        // a taut wire leaves its axis in waves of sqrt(EI/T), at a rate that does not fall with its length
        let taut = DAMPED * (2.0 * BESIDE).sqrt() * pull / (ei * mass).sqrt();
        let unit = 1.0 / (clamped + taut);
        let speed = BOW * section.diameter / unit;
        self.sys.model.twist = Twist::QuasiStatic;
        self.sys.model.loads.drag = 1.0 / unit;
        for ((i, a), share) in self.unknowns().zip(bow) {
            self.sys.state.rod.v[i][a] = speed * share;
        }
        self.sys.state.past.forget();
        self.sys.refresh();
        let mut step = Stepper::implicit(ctx.tolerance, LOOK * unit);
        let seen = |sys: &System| {
            let parts = sys.state.rod.x.iter();
            parts.map(|x| x.x * x.x + x.y * x.y).sum::<f64>().sqrt()
        };
        step.through(&mut self.sys, START * unit, LOOK * unit)?;
        let start = seen(&self.sys);
        let (mut size, mut time) = (start, 0.0);
        while time < WATCH * unit && size < ENOUGH * start && size > start / ENOUGH {
            step.through(&mut self.sys, LOOK * unit, LOOK * unit)?;
            time += LOOK * unit;
            size = seen(&self.sys);
        }
        Ok(libm::log(size / start) / time)
    }

    /// All coordinates of the inner nodes, and the sliding of the end: node and axis.
    fn unknowns(&self) -> impl Iterator<Item = (usize, usize)> + use<> {
        let last = self.sys.state.rod.nodes() - 1;
        (1..last)
            .flat_map(|i| (0..3).map(move |a| (i, a)))
            .chain([(last, 2)])
    }

    /// What drives small displacements back, by central differences and made symmetric, N/m.
    fn stiffness(mut self, ctx: &Context) -> DMatrix<f64> {
        let mut method = method(&self.sys);
        let mut forces = |sys: &mut System| {
            if ctx.integrator == Integrator::Implicit {
                return method.forces(sys);
            }
            sys.evaluate(None);
            sys.state.load.force.clone()
        };
        let place: Vec<(usize, usize)> = self.unknowns().collect();
        let n = place.len();
        let step = 1e-6 * self.length;
        let mut stiffness = DMatrix::<f64>::zeros(n, n);
        for (column, &(i, a)) in place.iter().enumerate() {
            for side in [1.0, -1.0] {
                let home = self.sys.state.rod.x[i][a];
                self.sys.state.rod.x[i][a] = home + side * step;
                let force = forces(&mut self.sys);
                self.sys.state.rod.x[i][a] = home;
                // a node's force reaches two nodes to either side
                for (row, &(k, b)) in place.iter().enumerate() {
                    if k.abs_diff(i) <= 2 {
                        stiffness[(row, column)] -= side * force[k][b] / (2.0 * step);
                    }
                }
            }
        }
        (&stiffness + stiffness.transpose()) * 0.5
    }
}
