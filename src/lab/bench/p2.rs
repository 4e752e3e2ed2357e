//! P2: ten periods of a cantilever's first mode, small.
//!
//! Released from the mode's shape, the tip follows `A cos(omega_1 t)`. Error: its largest deviation
//! from that over the amplitude. What the step does to the amplitude is told on its own.

use super::error::BenchError;
use super::options::BenchOptions;
use super::problem::Method;
use super::record::{Details, Outcome};
use super::setup::{along_x, cantilever, clamped_edges, elastic_wire, iterations, stable_step};
use super::watch::Watch;
use crate::integrate::{Explicit, ExplicitMethod, Implicit, Scheme, shift_velocities};
use crate::math::V3;
use crate::rod::Section;
use crate::system::{Mass, System};
use std::f64::consts::TAU;

/// Length, m, and amplitude of the tip over it.
const LENGTH: f64 = 0.1;
const AMPLITUDE: f64 = 1e-3 * LENGTH;
/// Periods.
const PERIODS: f64 = 10.0;
/// Root of `cos b cosh b = -1`.
const ROOT: f64 = 1.875_104_068_711_961;
/// Edges, and steps a period for each.
const EDGES: usize = 40;
const STEPS: f64 = 5.0;
/// Newton's tolerance, m: it stops ten times closer. Ten times looser, steps of a 400th of the period
/// take some guesses without a solve and the amplitude drifts by 6e-4.
const TOLERANCE: f64 = 1e-4 * AMPLITUDE;
/// Share of the stability limit that an explicit method takes.
const SHARE: f64 = 0.9;
/// Most steps that can be asked for.
const MOST: f64 = 1e9;

pub(super) fn run(args: &BenchOptions) -> Result<Outcome, BenchError> {
    let n = args.n.unwrap_or(EDGES);
    let section = elastic_wire()?;
    let frequency = first_frequency(&section);
    let end = PERIODS * TAU / frequency;
    let method = args.method();
    let stable = stable_step(method, &section, LENGTH / n as f64);
    let wanted = match (args.dt, method) {
        (Some(dt), _) => dt,
        (None, Method::Implicit) => end / (PERIODS * STEPS * n as f64),
        (None, _) => SHARE * stable,
    };
    // whole steps to the end
    let count = (end / wanted - 1e-9).ceil().max(1.0);
    if wanted > end || count > MOST {
        let allowed = format!("{:.3e} to {end:.3e} s", end / MOST);
        return Err(args.wrong(format!("--dt {wanted:e}"), "out of range", allowed));
    }
    let dt = end / count;
    if method != Method::Implicit && dt > stable {
        let reason = format!("unstable with --integrator {} at n = {n}", method.name());
        let allowed = format!("up to {stable:.3e} s");
        return Err(args.wrong(format!("--dt {wanted:e}"), reason, allowed));
    }
    let tol = (method == Method::Implicit).then(|| args.tol.unwrap_or(TOLERANCE));
    let mut outcome = Outcome {
        n: Some(n),
        dt: Some(dt),
        tol,
        ..Outcome::default()
    };

    let mut tip = Vec::with_capacity(count as usize);
    let watch = Watch::start();
    let rest = match method {
        Method::Implicit => clamped_edges(LENGTH, n),
        // the step is as the square of the shortest edge
        _ => vec![LENGTH / n as f64; n],
    };
    let mut sys = released(section, rest);
    if method == Method::Implicit {
        sys.model.mass = Mass::Consistent;
    }
    let mut implicit = Implicit::new(Scheme::Midpoint, tol.unwrap_or(TOLERANCE), dt, dt);
    implicit.fixed = Some(dt);
    let mut explicit = Explicit::new(match method {
        Method::Rk4 => ExplicitMethod::Rk4,
        Method::Verlet | Method::Implicit => ExplicitMethod::Verlet,
    });
    if method == Method::Verlet {
        shift_velocities(&mut sys, -0.5 * dt);
    }
    for _ in 0..count as u64 {
        match method {
            Method::Implicit => {
                if let Err(stopped) = implicit.step(&mut sys, f64::INFINITY) {
                    outcome.failure = Some(stopped.to_string());
                    break;
                }
            }
            Method::Verlet | Method::Rk4 => explicit.step(&mut sys, dt),
        }
        tip.push(sys.state.rod.x[n].y);
    }
    outcome.spent = watch.spent();
    outcome.steps = tip.len() as u64;
    outcome.iterations = iterations(method, implicit.statistics, outcome.steps);
    let error = tip
        .iter()
        .enumerate()
        .map(|(i, y)| (y - AMPLITUDE * libm::cos(frequency * dt * (i + 1) as f64)).abs())
        .fold(0.0, f64::max);
    outcome.error = Some(error / AMPLITUDE);
    outcome.details = Details {
        amplitude_loss: amplitude_loss(&tip, frequency * dt),
        ..Details::default()
    };
    Ok(outcome)
}

/// Angular frequency of the first mode, rad/s.
fn first_frequency(section: &Section) -> f64 {
    let k = ROOT / LENGTH;
    k * k * (section.ei / section.mass_per_length()).sqrt()
}

/// The cantilever with the mode's curvature at its joints: bent, but not stretched.
///
/// Nodes then lie inside the mode's curve by `h^2/12` of its curvature, as they do when the polygon swings.
fn released(section: Section, rest: Vec<f64>) -> System {
    let mut sys = cantilever(section, &along_x(&rest), rest);
    let amplitude = AMPLITUDE / mode(1.0) * (ROOT / LENGTH).powi(2);
    let rod = &mut sys.state.rod;
    let (mut angle, mut arc) = (0.0, 0.0);
    for i in 0..rod.edges() {
        angle += amplitude * curvature(arc / LENGTH) * rod.voronoi(i);
        let (s, c) = (libm::sin(angle), libm::cos(angle));
        rod.x[i + 1] = rod.x[i] + V3::new(c, s, 0.0) * rod.rest[i];
        arc += rod.rest[i];
    }
    rod.realign();
    sys.refresh();
    sys
}

/// First mode of a cantilever at a share of its length.
fn mode(share: f64) -> f64 {
    shape(ROOT * share, -1.0)
}

/// Its curvature over the square of `ROOT` per length.
fn curvature(share: f64) -> f64 {
    shape(ROOT * share, 1.0)
}

/// The mode at `b`, with the `sign` of its circular functions: they change it where it is derived twice.
fn shape(b: f64, sign: f64) -> f64 {
    let sigma = (libm::cosh(ROOT) + libm::cos(ROOT)) / (libm::sinh(ROOT) + libm::sin(ROOT));
    let even = libm::cosh(b) + sign * libm::cos(b);
    even - sigma * (libm::sinh(b) + sign * libm::sin(b))
}

/// Share of the amplitude lost over all periods, from fits of a harmonic to the first and the last.
///
/// A harmonic of the wrong frequency takes some amplitude for phase, so the fits are repeated with
/// the frequency that the first ones show.
fn amplitude_loss(tip: &[f64], phase: f64) -> Option<f64> {
    let period = (TAU / phase).round() as usize;
    if period < 8 || tip.len() < 3 * period {
        return None;
    }
    let between = tip.len() - period;
    let fits = |phase: f64| {
        (
            harmonic(&tip[..period], phase),
            harmonic(&tip[between..], phase),
        )
    };
    let (first, last) = fits(phase);
    // how far the last fit is ahead of where this frequency would have brought the first
    let ahead = last.1 - first.1 - phase * between as f64;
    let own = phase + libm::remainder(ahead, TAU) / between as f64;
    let (first, last) = fits(own);
    let share = tip.len() as f64 / between as f64;
    Some((1.0 - last.0 / first.0) * share)
}

/// Amplitude and phase at the first value of the harmonic of step `phase` nearest to some values.
fn harmonic(y: &[f64], phase: f64) -> (f64, f64) {
    let (mut cc, mut cs, mut ss, mut yc, mut ys) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for (i, y) in y.iter().enumerate() {
        let (c, s) = (libm::cos(phase * i as f64), libm::sin(phase * i as f64));
        cc += c * c;
        cs += c * s;
        ss += s * s;
        yc += y * c;
        ys += y * s;
    }
    let det = cc * ss - cs * cs;
    let (a, b) = ((yc * ss - ys * cs) / det, (ys * cc - yc * cs) / det);
    ((a * a + b * b).sqrt(), libm::atan2(-b, a))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::bench::Problem;
    use crate::lab::verify::CaseFile;

    #[test]
    fn the_frequency_is_that_of_the_packed_reference() {
        let files = CaseFile::packed().unwrap();
        let file = files.iter().find(|f| f.kind == "bending_modes").unwrap();
        let case = file
            .cases
            .iter()
            .find(|c| c.id == "clamped-free_T0_L50mm")
            .unwrap();
        let f1 = case.expected["f1_Hz"].as_f64().unwrap();
        // it falls with the square of the length, which is 50 mm there
        let ours = first_frequency(&elastic_wire().unwrap()) / TAU * 4.0;
        assert!((ours / f1 - 1.0).abs() < 1e-9, "{ours} {f1}");
    }

    #[test]
    fn the_tip_converges_with_second_order_and_keeps_its_amplitude() {
        let end = PERIODS * TAU / first_frequency(&elastic_wire().unwrap());
        let run = |n: usize| {
            let mut args = BenchOptions::new(Problem::P2);
            args.n = Some(n);
            args.dt = Some(end / (PERIODS * 5.0 * n as f64));
            let outcome = run(&args).unwrap();
            assert_eq!(outcome.failure, None);
            assert!(outcome.details.amplitude_loss.unwrap().abs() < 1e-3);
            outcome.error.unwrap()
        };
        let (coarse, fine) = (run(10), run(20));
        assert!(
            (coarse / fine).log2() > 1.9 && fine < 0.2,
            "{coarse} {fine}"
        );
    }

    #[test]
    fn edges_converge_with_fourth_order() {
        let end = PERIODS * TAU / first_frequency(&elastic_wire().unwrap());
        let error = |n: usize| {
            let mut args = BenchOptions::new(Problem::P2);
            args.n = Some(n);
            // the steps' own part is 5e-5
            args.dt = Some(end / (PERIODS * 2000.0));
            run(&args).unwrap().error.unwrap()
        };
        let (coarse, fine) = (error(4), error(8));
        assert!(
            (coarse / fine).log2() > 3.6 && fine < 6e-4,
            "{coarse} {fine}"
        );
    }

    #[test]
    fn a_known_loss_is_found_whatever_the_frequency() {
        let phase = TAU / 50.0;
        let tip: Vec<f64> = (1..=500)
            .map(|i| {
                let lost = 1.0 - 0.02 * f64::from(i) / 500.0;
                lost * libm::cos(0.99 * phase * f64::from(i))
            })
            .collect();
        let loss = amplitude_loss(&tip, phase).unwrap();
        assert!((loss - 0.02).abs() < 1e-3, "{loss}");
    }

    #[test]
    fn an_explicit_step_beyond_its_limit_is_bad_input() {
        let mut args = BenchOptions::new(Problem::P2);
        args.integrator = Some(Method::Verlet);
        args.dt = Some(1e-4);
        let error = run(&args).unwrap_err().to_string();
        assert!(
            error.contains("unstable") && error.contains("up to"),
            "{error}"
        );
    }
}
