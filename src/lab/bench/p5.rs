//! P5: a waving wire that nothing holds: what a node and step cost.
//!
//! Error: relative drift of its energy over the run.

use super::error::BenchError;
use super::options::BenchOptions;
use super::problem::Method;
use super::record::{Details, Outcome};
use super::setup::{elastic_wire, iterations, stable_step};
use super::watch::Watch;
use crate::integrate::{Explicit, ExplicitMethod, Implicit, Scheme, shift_velocities};
use crate::math::V3;
use crate::rod::Rod;
use crate::rod::Twist;
use crate::system::System;

/// Edge length, m, and number of edges.
const SPACING: f64 = 0.5e-3;
const EDGES: usize = 200;
/// Height of the waves, m, and their number per length, rad/m; speed at the crests, m/s.
const HEIGHT: f64 = 1e-4;
const WAVES: f64 = 300.0;
const SPEED: f64 = 1.0;
/// Step of the implicit method, s: a 40th of the waves' period.
const STEP: f64 = 2e-6;
const TOLERANCE: f64 = 1e-8;
/// Nodes times steps of a run.
const WORK: usize = 400_000;
/// Share of the stability limit that an explicit method takes.
const SHARE: f64 = 0.7;

pub(super) fn run(args: &BenchOptions) -> Result<Outcome, BenchError> {
    let n = args.n.unwrap_or(EDGES);
    let method = args.method();
    let section = elastic_wire()?;
    let stable = stable_step(method, &section, SPACING);
    let dt = match (args.dt, method) {
        (Some(dt), _) => dt,
        (None, Method::Implicit) => STEP,
        (None, _) => SHARE * stable,
    };
    if method != Method::Implicit && dt > stable {
        let reason = format!("unstable with --integrator {}", method.name());
        let allowed = format!("up to {stable:.3e} s");
        return Err(args.wrong(format!("--dt {dt:e}"), reason, allowed));
    }
    let tol = (method == Method::Implicit).then(|| args.tol.unwrap_or(TOLERANCE));
    let mut outcome = Outcome {
        n: Some(n),
        dt: Some(dt),
        tol,
        ..Outcome::default()
    };

    let wave = |i: usize| libm::sin(WAVES * SPACING * i as f64);
    let x: Vec<V3> = (0..=n)
        .map(|i| V3::new(SPACING * i as f64, HEIGHT * wave(i), 0.0))
        .collect();
    let mut sys = System::new(section, Rod::through(&x, None));
    sys.model.twist = Twist::Off;
    for i in 0..=n {
        sys.state.rod.v[i] = V3::new(0.0, 0.0, SPEED * wave(i));
    }
    sys.refresh();
    let mut implicit = Implicit::new(Scheme::Midpoint, tol.unwrap_or(TOLERANCE), dt, dt);
    implicit.fixed = Some(dt);
    let mut explicit = Explicit::new(match method {
        Method::Rk4 => ExplicitMethod::Rk4,
        Method::Verlet | Method::Implicit => ExplicitMethod::Verlet,
    });
    let energy = |sys: &System| sys.stored() + sys.kinetic();
    let before = energy(&sys);
    if method == Method::Verlet {
        shift_velocities(&mut sys, -0.5 * dt);
    }
    let count = (WORK / (n + 1)).max(10) as u64;

    let watch = Watch::start();
    for _ in 0..count {
        match method {
            Method::Implicit => {
                if let Err(stopped) = implicit.step(&mut sys, f64::INFINITY) {
                    outcome.failure = Some(stopped.to_string());
                    break;
                }
            }
            Method::Verlet | Method::Rk4 => explicit.step(&mut sys, dt),
        }
        outcome.steps += 1;
    }
    outcome.spent = watch.spent();
    if method == Method::Verlet {
        shift_velocities(&mut sys, 0.5 * dt);
    }
    outcome.iterations = iterations(method, implicit.statistics, outcome.steps);
    outcome.error = Some((energy(&sys) / before - 1.0).abs());
    let each = |count: u64| Some(1e9 * outcome.spent.cpu / ((n + 1) as f64 * count.max(1) as f64));
    outcome.details = Details {
        ns_per_node_step: each(outcome.steps),
        ns_per_node_iteration: each(outcome.iterations),
        ..Details::default()
    };
    Ok(outcome)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::bench::Problem;

    #[test]
    fn every_method_keeps_the_energy() {
        for method in [Method::Implicit, Method::Verlet, Method::Rk4] {
            let mut args = BenchOptions::new(Problem::P5);
            args.n = Some(20);
            args.integrator = Some(method);
            let outcome = run(&args).unwrap();
            assert_eq!(outcome.failure, None);
            assert!(
                outcome.error.unwrap() < 1e-2,
                "{method:?} {:?}",
                outcome.error
            );
        }
    }
}
