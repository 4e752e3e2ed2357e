//! Tension at the nozzle in steady winding, with mass, spring and friction behind it.
//!
//! The scene of [`winding_feed`](super::winding_feed) with its ideal string, which here hardly stretches and has next to no
//! mass: what the tension does is up to the feed alone.

use super::winding_feed::{PITCH, string};
use super::{Answer, Answers, Context, VerifyError};
use crate::feed::{Feed, FeedSpec, Pulley};
use crate::signals::Inputs;
use crate::simulation::Simulation;
use std::f64::consts::{PI, TAU};

/// How much stiffer the wire is in stretch than the case's.
const STIFFER: f64 = 100.0;

/// Core surface speed at the nozzle's distance as a share of the wave speed in the free span.
///
/// Waves that the corners start in the span are no part of the answer, and where the tension falls they are slow: at 0.03 they
/// add a twentieth to a swing of 4 mN in 5 N.
const SPEED: f64 = 0.01;

/// Turns until the motion is steady; angle of a communication step, rad.
const RUN_IN: f64 = 1.25;
const SAMPLE: f64 = TAU / 720.0;

/// Runs a case.
pub fn run(ctx: &Context) -> Result<Answers, VerifyError> {
    let fail = |e: crate::simulation::SimError| VerifyError::NoAnswer(e.to_string());
    let speed = ctx.positive("omega_rad_per_s")?;
    let mut scene = string(ctx)?;
    let pull = scene.tensioner.tension;
    // light enough for its waves to be so much faster than the core
    let wave = speed * scene.nozzle.distance / SPEED;
    let wire = &mut scene.wire;
    wire.density = pull / (wave * wave) / (0.25 * PI * wire.diameter * wire.diameter);
    wire.ea = ctx.elastic().ea * STIFFER;
    scene.spindle.speed = speed;
    let mut sim = Simulation::new(&scene).map_err(fail)?;
    let spec = feed(ctx)?;
    let sys = sim.system_mut();
    sys.model.loads.drag = 0.5 * wave / scene.nozzle.distance;
    sys.set_feed(spec, Feed::at_rest(&spec, pull));
    let pitch = PITCH * scene.wire.diameter;
    let samples = ((RUN_IN + 1.0) * TAU / SAMPLE).round() as usize;
    let steady = (RUN_IN * TAU / SAMPLE).round() as usize;
    let (mut least, mut largest) = (f64::INFINITY, 0.0_f64);
    let (mut sum, mut squares) = (0.0, 0.0);
    for k in 1..=samples {
        // at rest before, it comes up to speed over a quarter of a turn
        let angle = SAMPLE * k as f64;
        let share = (angle / (0.25 * TAU)).min(1.0);
        let inputs = Inputs {
            spindle_speed: speed * share,
            nozzle_position: scene.traverse.lead + pitch * angle / TAU,
            tension_setpoint: pull,
            ..Inputs::HELD
        };
        sim.advance(inputs, SAMPLE / (speed * share))
            .map_err(fail)?;
        if k > steady {
            let out = sim.outputs();
            least = least.min(out.wire_tension_min);
            largest = largest.max(out.wire_tension_max);
            sum += out.wire_tension;
            squares += out.wire_tension * out.wire_tension;
        }
    }
    let mean = sum / (samples - steady) as f64;
    let swing = (squares / (samples - steady) as f64 - mean * mean).sqrt();
    Ok(vec![
        ("tension_min_N", Answer::Number(least)),
        ("tension_max_N", Answer::Number(largest)),
        ("tension_mean_N", Answer::Number(mean)),
        ("tension_rms_N", Answer::Number(swing)),
    ])
}

/// The feed of a case.
fn feed(ctx: &Context) -> Result<FeedSpec, VerifyError> {
    let mass = ctx.positive("tensioner_mass_kg")?;
    let line_stiffness = ctx.positive("line_stiffness_N_per_m")?;
    let pulley = Pulley {
        mass: ctx.number("pulley_mass_kg")?,
        friction: ctx.number("pulley_friction_N")?,
        share: ctx.positive("pulley_place")?,
    };
    Ok(FeedSpec {
        mass,
        damping: 0.0,
        line_stiffness,
        line_damping: 2.0 * ctx.number("line_damping_ratio")? * (line_stiffness * mass).sqrt(),
        exit_friction: 0.0,
        exit_curvature: 0.0,
        line_length: ctx.elastic().ea / line_stiffness,
        line_mass: ctx.number("line_mass_kg")?,
        pulley: (pulley.mass > 0.0 || pulley.friction > 0.0).then_some(pulley),
    })
}
