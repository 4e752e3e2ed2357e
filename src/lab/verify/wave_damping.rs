//! What variable-step BDF2 takes off an axial wave: amplitude and period of a standing wave.
//!
//! A straight elastic wire, clamped at one end, swings along itself in one of its modes. Communication steps of two lengths in
//! turn make the method step as the case says: each is short enough for its error. The reference is the eigenvalue of the
//! formula over such a pair of steps; nothing of it is told to the wire.

use super::case::no_answer;
use super::wire::{clamp_along_x, straight};
use super::{Answer, Answers, Context, VerifyError};
use crate::integrate::{Implicit, Scheme};
use crate::math::V3;
use crate::rod::Twist;
use crate::system::System;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Amplitude of the wave in tolerances; a step of 0.4 of an oscillation's phase is then within the tolerance.
const AMPLITUDE: f64 = 25.0;
/// Pairs of steps after which the start is forgotten, and pairs over which damping is measured.
const RUN_IN: usize = 20;
const PAIRS: usize = 100;
/// Shortest and longest step of a wind, s.
const SHORTEST: f64 = 1e-9;
const LONGEST: f64 = 0.1;

/// Runs a case.
pub fn run(ctx: &Context) -> Result<Answers, VerifyError> {
    let length = ctx.positive("L_m")?;
    let (mode, phase) = (ctx.positive("mode")?, ctx.positive("omega_h")?);
    let ratio = ctx.positive("step_ratio")?;
    let section = ctx.elastic();
    let wave = (section.ea / section.mass_per_length()).sqrt();
    let omega = (mode - 0.5) * PI * wave / length;
    let steps = [phase / omega, ratio * phase / omega];
    let n = ctx.edges(length, length / 400.0)?;
    let mut sys = straight(section, &vec![length / n as f64; n]);
    sys.model.twist = Twist::Off;
    sys.state.support[0] = clamp_along_x(V3::zeros());
    let shape = |i: usize| libm::sin((2.0 * mode - 1.0) * FRAC_PI_2 * i as f64 / n as f64);
    for i in 0..=n {
        sys.state.rod.x[i].x += AMPLITUDE * ctx.tolerance * shape(i);
    }
    sys.refresh();
    let mut method = Implicit::new(Scheme::Bdf2, ctx.tolerance, SHORTEST, LONGEST);
    let mut pair = |sys: &mut System| -> Result<u64, VerifyError> {
        let before = method.statistics.steps;
        for h in steps {
            let mut left = h;
            while left > 0.0 {
                let taken = method.step(sys, left).map_err(no_answer)?;
                left = if taken >= left { 0.0 } else { left - taken };
            }
        }
        Ok(method.statistics.steps - before)
    };
    // amplitude and phase of the mode: x - i v / omega turns evenly
    let seen = |sys: &System| {
        let rod = &sys.state.rod;
        let (mut x, mut v) = (0.0, 0.0);
        for i in 0..=n {
            let weight = rod.voronoi(i) * shape(i);
            x += weight * (rod.x[i].x - length * i as f64 / n as f64);
            v += weight * rod.v[i].x;
        }
        (libm::hypot(x, v / omega), libm::atan2(-v / omega, x))
    };
    for _ in 0..RUN_IN {
        pair(&mut sys)?;
    }
    let (first, mut last) = (seen(&sys).0, seen(&sys).1);
    let mut turned = 0.0;
    for _ in 0..PAIRS {
        if pair(&mut sys)? != 2 {
            return Err(VerifyError::NoAnswer(
                "the method divided a step; a smaller omega_h is wanted".to_owned(),
            ));
        }
        let now = seen(&sys).1;
        turned += libm::remainder(now - last, TAU);
        last = now;
    }
    let periods = PAIRS as f64 * (steps[0] + steps[1]) * omega / TAU;
    Ok(vec![
        (
            "decrement_per_period",
            Answer::Number(-libm::log(seen(&sys).0 / first) / periods),
        ),
        (
            "period_over_exact",
            Answer::Number(periods * TAU / turned.abs()),
        ),
    ])
}
