//! P3: half a turn of string-like wire slipping on a cylinder.
//!
//! A dead force holds one end; the other is drawn along its leg, so slowly that inertia is nothing,
//! and is free across it. Error: ratio of the end forces against `exp(mu pi)`, relative. Bending at
//! a thousandth of its stiffness takes 1e-4 off that ratio.

use super::error::BenchError;
use super::options::BenchOptions;
use super::record::{Details, Outcome};
use super::setup::elastic_wire;
use super::watch::Watch;
use crate::contact::{ContactLaw, LineModel};
use crate::geometry::Shape;
use crate::integrate::{Implicit, Scheme};
use crate::math::V3;
use crate::rod::Twist;
use crate::rod::{Rod, Section};
use crate::system::{Support, System};
use std::f64::consts::{FRAC_PI_2, PI};

/// Cylinder radius, m; force on the slack side, N; friction; share of the bending stiffness.
const RADIUS: f64 = 10e-3;
const HOLD: f64 = 10.0;
const FRICTION: f64 = 0.23;
const STRING: f64 = 1e-3;
/// Line load per depth, N/m^2: the scenes' own.
const STIFFNESS: f64 = 1e10;
/// Edges and tolerance.
const EDGES: usize = 80;
const TOLERANCE: f64 = 5e-6;
/// Legs, in bend radii: ten bending lengths and more.
const LEG: f64 = 0.6;
/// Drawing speed, m/s: 2e-4 of the waves'.
const SPEED: f64 = 0.01;
/// Way drawn before the mean is taken and way that it is taken over, edges (touches come and go once
/// per edge); steps over an edge.
const RUN_IN: f64 = 1.0;
const MEAN: f64 = 1.0;
const STEPS: f64 = 10.0;

pub(super) fn run(args: &BenchOptions) -> Result<Outcome, BenchError> {
    let n = args.n.unwrap_or(EDGES);
    if n < 12 {
        return Err(args.wrong(format!("--n {n}"), "too few for half a turn", "12 or more"));
    }
    let tol = args.tol.unwrap_or(TOLERANCE);
    let mut section = elastic_wire()?;
    section.ei *= STRING;
    let mut outcome = Outcome {
        n: Some(n),
        dt: args.dt,
        tol: Some(tol),
        ..Outcome::default()
    };

    let watch = Watch::start();
    let (mut sys, edge) = capstan(&section, n);
    let longest = args.dt.unwrap_or(edge / STEPS / SPEED);
    let mut method = Implicit::new(Scheme::Bdf2, tol, 1e-9, longest);
    let mut ratio = 0.0;
    for (way, counts) in [(RUN_IN, false), (MEAN, true)] {
        let duration = way * edge / SPEED;
        let mut left = duration;
        while left > 0.0 && outcome.failure.is_none() {
            match method.step(&mut sys, left) {
                Ok(h) => {
                    left = if h >= left { 0.0 } else { left - h };
                    if counts {
                        ratio -= sys.state.load.force[n].x / HOLD * (h / duration);
                    }
                }
                Err(stopped) => outcome.failure = Some(stopped.to_string()),
            }
        }
    }
    outcome.spent = watch.spent();
    outcome.steps = method.statistics.steps;
    outcome.iterations = method.statistics.solves;
    outcome.error = Some((ratio / libm::exp(FRICTION * PI) - 1.0).abs());
    outcome.details = Details {
        ratio: Some(ratio),
        stiff_error: Some((ratio / stiff_ratio(&section) - 1.0).abs()),
        ..Details::default()
    };
    Ok(outcome)
}

/// Ratio of the end forces with bending stiffness, as in the packed reference `capstan`: the wire
/// lifts off where `F (1 - cos psi) = EI kappa^2 / 2`, and there rubs with a point force `F sin psi`.
fn stiff_ratio(section: &Section) -> f64 {
    let kappa = 1.0 / (RADIUS + section.radius());
    let energy = 0.5 * section.ei * kappa * kappa;
    let lift_off = |force: f64| libm::acos(1.0 - energy / force);
    let slack = lift_off(HOLD);
    let mut ratio = libm::exp(FRICTION * PI);
    // the angle at the drawn end depends on the ratio, weakly
    for _ in 0..20 {
        let tight = lift_off(HOLD * ratio);
        ratio = (libm::cos(slack) + FRICTION * libm::sin(slack))
            / (libm::cos(tight) - FRICTION * libm::sin(tight))
            * libm::exp(FRICTION * (PI - slack - tight));
    }
    ratio
}

/// Wire on the path of a string, stretched by the holding force, and its edge length.
///
/// In the x-z plane: node 0 at the held end below the axis, the drawn end above it along +x.
fn capstan(section: &Section, n: usize) -> (System, f64) {
    let bend = RADIUS + section.radius();
    let leg = LEG * bend;
    let total = 2.0 * leg + PI * bend;
    let h = total / n as f64;
    // the wire's spline touches between the nodes, which stand off by the sagitta
    let stand_off = bend / libm::cos(0.5 * h / bend);
    let point = |s: f64| {
        let on = |a: f64| V3::new(libm::cos(a), 0.0, libm::sin(a)) * stand_off;
        let start = FRAC_PI_2 + PI;
        if s < leg {
            on(start) + V3::x() * (leg - s)
        } else if s < total - leg {
            on(start - (s - leg) / bend)
        } else {
            on(FRAC_PI_2) + V3::x() * (s - total + leg)
        }
    };
    let points: Vec<V3> = (0..=n).map(|i| point(h * i as f64)).collect();
    let stretch = 1.0 + HOLD / section.ea;
    let rest = points
        .windows(2)
        .map(|p| (p[1] - p[0]).norm() / stretch)
        .collect();
    let mut sys = System::new(section.clone(), Rod::through(&points, Some(rest)));
    sys.model.twist = Twist::Off;
    let law = ContactLaw {
        stiffness: STIFFNESS,
        damping_ratio: 0.0,
        mu_static: FRICTION,
        mu_kinetic: FRICTION,
        slip_speed: 1.0,
    };
    let shape = Shape::Cylinder {
        radius: RADIUS,
        half_y: RADIUS,
    };
    sys.touch_along(LineModel::new(shape, law, section.radius()));
    sys.model.loads.nodal = vec![(0, V3::x() * HOLD)];
    sys.state.support[1] = Support {
        hold: [true, false, false],
        velocity: V3::x() * SPEED,
        point: points[n],
        ..Support::free()
    };
    sys.refresh();
    (sys, h)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::bench::Problem;

    #[test]
    fn the_wire_slips_at_the_ratio_of_a_string() {
        let mut args = BenchOptions::new(Problem::P3);
        args.n = Some(60);
        let outcome = run(&args).unwrap();
        assert_eq!(outcome.failure, None);
        assert!(outcome.error.unwrap() < 0.02, "{:?}", outcome.details.ratio);
        let stiff = outcome.details.stiff_error.unwrap();
        assert!(stiff < 0.02, "{stiff}");
    }

    #[test]
    fn little_stiffness_takes_a_little_off_the_ratio() {
        let mut section = elastic_wire().unwrap();
        section.ei *= STRING;
        let less = 1.0 - stiff_ratio(&section) / libm::exp(FRICTION * PI);
        assert!((7e-4..9e-4).contains(&less), "{less}");
    }
}
