//! P1: a cantilever bent far by a dead force across its tip.
//!
//! The production method with steps so long that inertia vanishes; what is left of each step is
//! Newton's method on the wire's own energy. The load grows with the pseudo-time, so that the guess
//! extrapolates the path of equilibria, and each step of it is as long as Newton's method takes well.
//! Error: distance of the tip from that of the extensible elastica, over the length.

use super::error::BenchError;
use super::options::BenchOptions;
use super::record::{Details, Outcome};
use super::setup::{along_x, cantilever, clamped_edges, elastic_wire};
use super::watch::Watch;
use crate::integrate::{Implicit, Scheme};
use crate::math::V3;
use crate::rod::Section;

/// Length, m.
const LENGTH: f64 = 0.1;
/// Edges, and pseudo-time of the whole load (s): inertia is 1e-9 of the stiffness and less.
const EDGES: usize = 40;
const DURATION: f64 = 1e4;
/// Newton's tolerance at the full load and on the way there, m.
const TOLERANCE: f64 = 1e-8;
const ON_THE_WAY: f64 = 5e-3;
/// First step over the tip's deflection that a unit of it makes: the tip moves 3 mm, fewest Newton steps from a = 0.1 to 20.
const FIRST_MOVE: f64 = 3e-3;
/// Factorisations that a load step should take, and how its length follows from them.
const WELL: u64 = 3;
const LONGER: f64 = 1.5;
const SHORTER: f64 = 0.4;
/// Smallest step of the load before giving up.
const SMALLEST: f64 = 1e-6;

pub(super) fn run(args: &BenchOptions) -> Result<Outcome, BenchError> {
    let n = args.n.unwrap_or(EDGES);
    let tol = args.tol.unwrap_or(TOLERANCE);
    let duration = args.dt.unwrap_or(DURATION);
    let a = args.a.unwrap_or(10.0);
    let section = elastic_wire()?;
    let force = a * section.ei / (LENGTH * LENGTH);
    let exact = elastica_tip(&section, force, LENGTH);
    let mut outcome = Outcome {
        n: Some(n),
        dt: args.dt,
        tol: Some(tol),
        details: Details {
            a: Some(a),
            ..Details::default()
        },
        ..Outcome::default()
    };

    let watch = Watch::start();
    let rest = clamped_edges(LENGTH, n);
    let mut sys = cantilever(section, &along_x(&rest), rest);
    let mut method = Implicit::new(Scheme::Bdf2, ON_THE_WAY, 1e-9, f64::INFINITY);
    let mut share = 0.0;
    let mut piece = (3.0 * FIRST_MOVE / (a * LENGTH)).min(0.5);
    while share < 1.0 {
        let next = if share + 1.5 * piece >= 1.0 {
            1.0
        } else {
            share + piece
        };
        method.tolerance = if next == 1.0 {
            tol
        } else {
            tol.max(ON_THE_WAY)
        };
        method.fixed = Some(duration * (next - share));
        sys.model.loads.nodal = vec![(n, V3::new(0.0, force * next, 0.0))];
        let before = method.statistics.solves;
        match method.step(&mut sys, f64::INFINITY) {
            Ok(_) => {
                share = next;
                if method.statistics.solves - before <= WELL {
                    piece *= LONGER;
                }
            }
            Err(stopped) => {
                piece *= SHORTER;
                if piece < SMALLEST {
                    outcome.failure = Some(stopped.to_string());
                    break;
                }
            }
        }
    }
    outcome.spent = watch.spent();
    outcome.error = Some((sys.state.rod.x[n] - exact).norm() / LENGTH);
    outcome.steps = method.statistics.steps;
    outcome.iterations = method.statistics.solves;
    Ok(outcome)
}

/// Tip of an extensible, unshearable cantilever under a dead force across it, m.
///
/// `EI th'' = -P (1 + e) cos th` with stretch `e = P sin th / EA`; its first integral makes length and
/// tip quadratures over the angle. `th = alpha - s^2` takes the root out of their end.
fn elastica_tip(section: &Section, force: f64, length: f64) -> V3 {
    let soft = force / section.ea;
    let integrals = |alpha: f64| {
        let end = alpha.sqrt();
        let sum = |f: &dyn Fn(f64, f64) -> f64| {
            simpson(end, |s| {
                let half = 0.5 * s * s;
                let theta = alpha - s * s;
                // sin alpha - sin theta over s^2, without cancellation
                let sinc = if half > 0.0 {
                    libm::sin(half) / half
                } else {
                    1.0
                };
                let drop = libm::cos(alpha - half) * sinc;
                let stretched = 1.0 + 0.5 * soft * (libm::sin(alpha) + libm::sin(theta));
                let rate = (2.0 * force / section.ei * drop * stretched).sqrt();
                f(theta, 2.0 / rate)
            })
        };
        [
            sum(&|_, ds| ds),
            sum(&|t, ds| (1.0 + soft * libm::sin(t)) * libm::cos(t) * ds),
            sum(&|t, ds| (1.0 + soft * libm::sin(t)) * libm::sin(t) * ds),
        ]
    };
    // the wire is longer the farther its tip is turned
    let (mut low, mut high) = (1e-9, std::f64::consts::FRAC_PI_2 - 1e-9);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if integrals(middle)[0] < length {
            low = middle;
        } else {
            high = middle;
        }
    }
    let [_, x, y] = integrals(0.5 * (low + high));
    V3::new(x, y, 0.0)
}

/// Integral from 0 to `end`.
fn simpson(end: f64, f: impl Fn(f64) -> f64) -> f64 {
    const PAIRS: usize = 2000;
    let h = end / (2 * PAIRS) as f64;
    let inner: f64 = (1..2 * PAIRS)
        .map(|i| f(h * i as f64) * if i % 2 == 1 { 4.0 } else { 2.0 })
        .sum();
    (f(0.0) + inner + f(end)) * h / 3.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::bench::Problem;
    use crate::lab::verify::CaseFile;

    #[test]
    fn the_quadrature_gives_the_packed_reference() {
        let files = CaseFile::packed().unwrap();
        let file = files
            .iter()
            .find(|f| f.kind == "elastica_cantilever")
            .unwrap();
        let section = elastic_wire().unwrap();
        for case in &file.cases {
            let get =
                |m: &serde_json::Map<String, serde_json::Value>, k: &str| m[k].as_f64().unwrap();
            let length = get(&case.inputs, "L_m");
            let force = get(&case.inputs, "alpha") * section.ei / (length * length);
            let tip = elastica_tip(&section, force, length);
            let x = get(&case.expected, "extensible_tip_x_m");
            let y = get(&case.expected, "extensible_tip_y_m");
            assert!((tip - V3::new(x, y, 0.0)).norm() < 1e-9 * length, "{tip}");
        }
    }

    #[test]
    fn the_tip_converges_with_second_order() {
        for a in [1.0, 10.0] {
            let error = |n: usize| {
                let mut args = BenchOptions::new(Problem::P1);
                (args.n, args.a) = (Some(n), Some(a));
                let outcome = run(&args).unwrap();
                assert_eq!(outcome.failure, None);
                outcome.error.unwrap()
            };
            let (coarse, fine) = (error(20), error(40));
            assert!(
                fine < 5e-3 && (coarse / fine).log2() > 1.8,
                "{coarse} {fine}"
            );
        }
    }
}
