//! Axial waves, modes and stretch of a straight wire.

use super::bench::Stepper;
use super::equilibrium::follow;
use super::modes::{Motion, lowest};
use super::wire::{clamp_along_x, straight};
use super::{Answer, Answers, Context, VerifyError};
use crate::integrate::{Explicit, ExplicitMethod, highest_frequency};
use crate::math::V3;
use crate::rod::Twist;
use crate::scene::Integrator;
use crate::system::Support;
use std::f64::consts::TAU;

/// Edges along the wire: for modes and stretch, and for the pulse.
const EDGES: f64 = 200.0;
const PULSE_EDGES: f64 = 400.0;
/// Half width of the pulse over the wire's length.
const PULSE_WIDTH: f64 = 0.05;
/// Share of the longest stable step.
const STEP_SHARE: f64 = 0.9;
/// Steps after which a pulse is given up.
const MOST_STEPS: usize = 200_000;
/// Speed in the pulse, m/s: a strain far below any limit.
const PULSE_SPEED: f64 = 1e-3;
/// Way of the wire under the pulse in diameters for the steps of a wind, whose tolerance has to see it. The law of stretch is linear
/// however far.
const FAST_PULSE: f64 = 0.5;
/// Looks in the time in which half the pulse's width passes.
const LOOKS: f64 = 30.0;

/// Wave speed, frequencies and the stretch under a force.
pub fn run(ctx: &Context) -> Result<Answers, VerifyError> {
    let (length, force) = (ctx.positive("L_m")?, ctx.number("P_N")?);
    let n = ctx.free_edges(length, length / EDGES)?;
    let mut sys = straight(ctx.elastic(), &vec![length / n as f64; n]);
    sys.state.support[0] = clamp_along_x(V3::zeros());
    let one = lowest(ctx, &mut sys, Motion::Along(0), 2)?;
    sys.state.support[1] = clamp_along_x(V3::x() * length);
    let both = lowest(ctx, &mut sys, Motion::Along(0), 1)?;

    sys.state.support[1] = Support::free();
    follow(ctx, &mut sys, |sys, share| {
        sys.model.loads.nodal = vec![(n, V3::x() * (force * share))];
    })?;
    Ok(vec![
        (
            "wave_speed_m_per_s",
            Answer::Number(wave_speed(ctx, length)?),
        ),
        ("fixed_free_f1_Hz", Answer::Number(one[0])),
        ("fixed_free_f2_Hz", Answer::Number(one[1])),
        ("fixed_fixed_f1_Hz", Answer::Number(both[0])),
        (
            "static_extension_m",
            Answer::Number(sys.state.rod.x[n].x - length),
        ),
    ])
}

/// Speed of a pulse between two nodes of a free wire, m/s, stepped in time.
fn wave_speed(ctx: &Context, length: f64) -> Result<f64, VerifyError> {
    let n = ctx.edges(length, length / PULSE_EDGES)?;
    let h = length / n as f64;
    let mut sys = straight(ctx.elastic(), &vec![h; n]);
    sys.model.twist = Twist::Off;
    let wave = (sys.model.section.ea / sys.model.section.mass_per_length()).sqrt();
    let crest = if ctx.winds() {
        // the wire moves by the integral of the pulse, sqrt(2 pi) half widths
        FAST_PULSE * sys.model.section.diameter * wave / (TAU.sqrt() * PULSE_WIDTH * length)
    } else {
        PULSE_SPEED
    };
    for i in 0..=n {
        let z = (sys.state.rod.x[i].x / length - 0.3) / PULSE_WIDTH;
        sys.state.rod.v[i].x = crest * libm::exp(-0.5 * z * z);
    }
    let top = highest_frequency(&sys.model.section, h, 0.0, false);
    let explicit = match ctx.integrator {
        Integrator::Rk4 => Some(ExplicitMethod::Rk4),
        Integrator::Verlet => Some(ExplicitMethod::Verlet),
        Integrator::Implicit => None,
    };
    let (mut stepper, dt) = match explicit {
        Some(method) => {
            let dt = STEP_SHARE * method.limit() / top;
            let method = Explicit::new(method);
            (Stepper::Explicit(method), dt)
        }
        None => {
            let dt = PULSE_WIDTH * length / wave / LOOKS;
            (Stepper::implicit(ctx.tolerance, dt), dt)
        }
    };
    sys.evaluate(Some(dt));
    // half of the pulse runs right: when its crest passes two nodes
    let stations = [n / 2, 3 * n / 4];
    let mut crests = [Crest::above(0.25 * crest); 2];
    for _ in 0..MOST_STEPS {
        stepper.through(&mut sys, dt, dt)?;
        for (crest, node) in crests.iter_mut().zip(stations) {
            crest.see(sys.state.rod.v[node].x, sys.state.time, dt);
        }
        if let [Some(first), Some(second)] = [crests[0].time, crests[1].time] {
            let distance: f64 = sys.state.rod.rest[stations[0]..stations[1]].iter().sum();
            return Ok(distance / (second - first));
        }
    }
    Err(VerifyError::NoAnswer("the pulse never arrived".to_owned()))
}

/// The first maximum of a signal, by the parabola through three samples.
#[derive(Clone, Copy, Debug, Default)]
struct Crest {
    least: f64,
    last: [f64; 2],
    time: Option<f64>,
}

impl Crest {
    /// A maximum above `least`.
    fn above(least: f64) -> Self {
        Self {
            least,
            ..Self::default()
        }
    }

    fn see(&mut self, value: f64, time: f64, dt: f64) {
        let [a, b] = self.last;
        if self.time.is_none() && b > self.least && b >= a && b > value {
            self.time = Some(time - dt + 0.5 * dt * (a - value) / (a - 2.0 * b + value));
        }
        self.last = [b, value];
    }
}
