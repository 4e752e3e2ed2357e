//! The torque at which a straight twisted wire leaves its axis.
//!
//! Both ends clamped coaxially, one free to slide under tension. The straight wire is stable as
//! long as the derivative of the rod's forces with respect to the nodes (by central differences,
//! made symmetric) is positive definite. The torque is read at the clamp. Rolls of the edges are
//! left out: to first order they do not couple with sideways motion of a straight wire.
//!
//! In the set-up of a wind that is the first guess. A small bow is then set off a little below and above it, and the rate at which
//! it dies or grows in the wind's own steps tells where it would stay.

use super::bench::Stepper;
use super::equilibrium::method;
use super::{Answer, Answers, Context, VerifyError};
use crate::math::V3;
use crate::math::{align, frame_along};
use crate::rod::{Rod, Section, Twist};
use crate::scene::Integrator;
use crate::system::{Support, System};
use nalgebra::DMatrix;
use std::f64::consts::PI;

/// Fewest edges, and edges per bending length `sqrt(EI/T)`; the error falls with the square.
const EDGES: f64 = 80.0;
const PER_BENDING_LENGTH: f64 = 12.0;

/// Share of the rotation below and above the critical one at which growth is looked at.
const BESIDE: f64 = 0.02;
/// Lowest frequency of a clamped wire in `sqrt(EI/m)/L^2`.
const CLAMPED: f64 = 22.4;
/// Bow that is set off, in wire diameters, longest step and time of a watch, both over the inverse of that frequency.
const BOW: f64 = 0.1;
const LOOK: f64 = 0.1;
const WATCH: f64 = 20.0;

/// Bisections once the torque is known to a factor of two.
const HALVINGS: usize = 16;

/// Runs a case.
pub fn run(ctx: &Context) -> Result<Answers, VerifyError> {
    let (length, pull) = (ctx.number("L_m")?, ctx.number("T_N")?);
    let section = ctx.elastic();
    let bending_lengths = length * (pull.max(0.0) / section.ei).sqrt();
    let fit = EDGES.max(PER_BENDING_LENGTH * bending_lengths).min(400.0);
    let edges = ctx.free_edges(length, length / fit)?;
    let stable = |rotation: f64| Straight::new(&section, length, pull, rotation, edges).stable(ctx);
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
        let growth =
            |share: f64| Straight::new(&section, length, pull, share * rotation, edges).growth(ctx);
        let [below, above] = [growth(1.0 - BESIDE)?, growth(1.0 + BESIDE)?];
        if !(below < 0.0 && above > 0.0) {
            return Err(VerifyError::NoAnswer(format!(
                "the wire does not leave its axis near {rotation} rad: it grows by {below} and {above} 1/s"
            )));
        }
        rotation *= 1.0 - BESIDE * (above + below) / (above - below);
    }
    let critical = Straight::new(&section, length, pull, rotation, edges);
    Ok(vec![(
        "critical_torque_Nm",
        Answer::Number(critical.torque()),
    )])
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

    /// Rate at which a small bow grows under drag as the wind's own steps have it, 1/s; negative if it goes back.
    fn growth(mut self, ctx: &Context) -> Result<f64, VerifyError> {
        let section = &self.sys.model.section;
        let unit =
            self.length * self.length * (section.mass_per_length() / section.ei).sqrt() / CLAMPED;
        let bow = BOW * section.diameter;
        self.sys.model.twist = Twist::QuasiStatic;
        self.sys.model.loads.drag = 1.0 / unit;
        let last = self.sys.state.rod.nodes() - 1;
        for i in 1..last {
            let share = libm::sin(PI * i as f64 / last as f64);
            self.sys.state.rod.v[i].x = bow / unit * share * share;
        }
        self.sys.state.past.forget();
        self.sys.refresh();
        let mut step = Stepper::implicit(ctx.tolerance, LOOK * unit);
        let seen = |sys: &System| {
            let parts = sys.state.rod.x.iter();
            parts.map(|x| x.x * x.x + x.y * x.y).sum::<f64>().sqrt()
        };
        let mut at = [0.0; 2];
        for size in &mut at {
            step.through(&mut self.sys, WATCH * unit, LOOK * unit)?;
            *size = seen(&self.sys);
        }
        Ok(libm::log(at[1] / at[0]) / (WATCH * unit))
    }

    /// Whether small displacements are driven back.
    fn stable(mut self, ctx: &Context) -> bool {
        let mut method = method(&self.sys);
        let mut forces = |sys: &mut System| {
            if ctx.integrator == Integrator::Implicit {
                return method.forces(sys);
            }
            sys.evaluate(None);
            sys.state.load.force.clone()
        };
        let nodes = self.sys.state.rod.nodes();
        // all coordinates of the inner nodes, and the sliding of the end
        let place: Vec<(usize, usize)> = (1..nodes - 1)
            .flat_map(|i| (0..3).map(move |a| (i, a)))
            .chain([(nodes - 1, 2)])
            .collect();
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
        let symmetric = (&stiffness + stiffness.transpose()) * 0.5;
        symmetric.cholesky().is_some()
    }
}
