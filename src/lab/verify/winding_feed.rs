//! Feed rate and free length while a rounded rectangle takes up wire.
//!
//! A whole winding run: clamp, feed, contact, freezing. The scene makes the wire the ideal string
//! of the reference:
//!
//! - its bending rigidity is so small that it stands off a corner by less than 1e-4 of its radius;
//! - it moves far below the speed of waves in the free span;
//! - it has some drag and a constant pull at the nozzle.
//!
//! The wire is softer in stretch (0.8 %) to allow longer steps; feed
//! counts unstretched wire, so it is multiplied by the stretch at the nozzle. A small pitch keeps
//! the turns apart.

use super::{Answer, Answers, Context, VerifyError};
use crate::math::Spin;
use crate::scene::{Core, Integrator, Scene};
use crate::settings::SceneSettings;
use crate::signals::Inputs;
use crate::simulation::Simulation;
use std::f64::consts::TAU;

/// Height over a corner that bending leaves, as a share of the bend radius.
const STAND_OFF: f64 = 1e-4;

/// Stretch under the pull.
const STRETCH: f64 = 8e-3;

/// Core surface speed at the nozzle's distance as a share of the wave speed in the free span.
pub(super) const SPEED: f64 = 0.03;

/// Edge length on the core as a share of the bend radius of a corner, in explicit steps.
const SPACING: f64 = 0.2;

/// Edges of the free span against those on the core: a power of two, since edges are halved.
const COARSER: f64 = 8.0;

/// Axial pitch in diameters.
pub(super) const PITCH: f64 = 1.3;

/// Angle turned before anything is measured, rad; angle between samples, rad.
const RUN_IN: f64 = 0.6;
const SAMPLE: f64 = TAU / 2880.0;

/// One look at the run: unstretched wire fed, m, and length of the free span, m.
#[derive(Clone, Copy, Debug)]
struct Sample {
    fed: f64,
    free: f64,
}

/// Runs a case.
pub fn run(ctx: &Context) -> Result<Answers, VerifyError> {
    let scene = string(ctx)?;
    let samples = wind(&scene)?;
    let n = samples.len() - 1;
    let stretch = 1.0 + STRETCH;
    let perimeter = (samples[n].fed - samples[0].fed) * stretch;
    // feed speed over core speed, from sample to sample
    let rates = samples
        .windows(2)
        .map(|s| (s[1].fed - s[0].fed) * stretch / SAMPLE);
    let (mut p_min, mut p_max) = (f64::INFINITY, 0.0_f64);
    for p in rates {
        (p_min, p_max) = (p_min.min(p), p_max.max(p));
    }
    let (mut free_min, mut free_max) = (f64::INFINITY, 0.0_f64);
    for s in &samples {
        (free_min, free_max) = (free_min.min(s.free), free_max.max(s.free));
    }
    Ok(vec![
        ("centreline_perimeter_m", Answer::Number(perimeter)),
        ("p_min_m", Answer::Number(p_min)),
        ("p_max_m", Answer::Number(p_max)),
        ("free_length_min_m", Answer::Number(free_min)),
        ("free_length_max_m", Answer::Number(free_max)),
    ])
}

/// The scene of the case: an ideal string on its core.
pub(super) fn string(ctx: &Context) -> Result<Scene, VerifyError> {
    let (width_x, height_z) = (ctx.positive("core_w_m")?, ctx.positive("core_h_m")?);
    let corner_radius = ctx.number("corner_radius_m")?;
    let distance = ctx.positive("nozzle_distance_m")?;
    let tension = ctx.positive("T0_N")?;
    let mut scene = SceneSettings::default()
        .build()
        .map_err(|e| VerifyError::NoAnswer(e.to_string()))?;
    let mut wire = ctx.elastic();
    let bend = corner_radius + wire.radius();
    let twist = wire.gj / wire.ei;
    wire.ei = STAND_OFF * tension * bend * bend;
    wire.gj = wire.ei * twist;
    wire.ea = tension / STRETCH;
    wire.strength = f64::INFINITY;
    let pitch = PITCH * wire.diameter;
    scene.core = Core::RoundedBox {
        width_x,
        height_z,
        length_y: 0.5 * distance + 20.0 * pitch,
        corner_radius,
        flange: None,
    };
    scene.nozzle.distance = distance;
    scene.nozzle.y_start = 0.0;
    scene.nozzle.exit_friction = 0.0;
    scene.tensioner.tension = tension;
    scene.tensioner.mass = 0.0;
    scene.tensioner.line_length = 0.0;
    let wave = (tension / wire.mass_per_length()).sqrt();
    scene.spindle.speed = SPEED * wave / distance;
    scene.friction.kinetic = scene.friction.static_;
    if let (Integrator::Implicit, Some(spacing)) = (ctx.integrator, ctx.spacing) {
        // contact is the default scene's
        scene.solver.integrator = Integrator::Implicit;
        scene.solver.spacing_near = spacing;
        scene.solver.spacing_free = spacing * COARSER;
        scene.solver.tolerance = ctx.tolerance;
    } else {
        scene.contact.restitution = 0.3;
        scene.contact.stiffness = 300.0 * tension / bend / wire.diameter;
        let spacing = SPACING * bend;
        scene.solver.integrator = Integrator::Verlet;
        scene.solver.spacing_near = spacing;
        scene.solver.spacing_free = spacing * COARSER;
        scene.solver.refine_distance = 2.0 * bend;
        scene.solver.step = 0.0;
        scene.solver.step_share = 0.7;
        scene.freeze.keep_length = 10.0 * spacing;
    }
    // leads by the slope of the steady helix, so that no turn crosses the clamp
    scene.traverse.per_turn = pitch;
    scene.traverse.lead = pitch;
    scene.wire = wire;
    Ok(scene)
}

/// Winds one turn after the run-in.
fn wind(scene: &Scene) -> Result<Vec<Sample>, VerifyError> {
    let fail = |e: crate::simulation::SimError| VerifyError::NoAnswer(e.to_string());
    let mut sim = Simulation::new(scene).map_err(fail)?;
    let wave = (scene.tensioner.tension / scene.wire.mass_per_length()).sqrt();
    sim.system_mut().model.loads.drag = 0.5 * wave / scene.nozzle.distance;
    let speed = scene.spindle.speed;
    let mut angle = 0.0;
    let mut samples = Vec::new();
    while angle < RUN_IN + TAU + 1.5 * SAMPLE {
        if angle >= RUN_IN {
            samples.push(look(&sim));
        }
        angle += SAMPLE;
        let inputs = Inputs {
            spindle_speed: speed,
            nozzle_position: scene.traverse.lead + scene.traverse.per_turn * angle / TAU,
            tension_setpoint: scene.tensioner.tension,
            ..Inputs::HELD
        };
        sim.advance(inputs, SAMPLE / speed).map_err(fail)?;
    }
    samples.truncate((TAU / SAMPLE).round() as usize + 1);
    Ok(samples)
}

/// Reads the fed length, m, and the length of the free span, m.
///
/// The free span is a straight line from the nozzle to its point nearest to the core. The nodes
/// alone give that length to within an edge.
fn look(sim: &Simulation) -> Sample {
    let sys = sim.system();
    let rod = &sys.state.rod;
    let last = rod.nodes() - 1;
    let nozzle = rod.x[last];
    let lift = (1..last).rev().find(|i| sys.touches(*i)).unwrap_or(0);
    let towards = (rod.x[(lift + 1).min(last - 1)] - nozzle).normalize();
    let spin = Spin::new(sys.state.spindle.angle);
    let distance = |s: f64| sys.distance_to_core(spin.to_core(nozzle + towards * s));
    let straight = (rod.x[lift] - nozzle).norm();
    let reach = 4.0 * rod.rest[lift];
    let free = least(distance, straight - reach, straight + reach);
    Sample {
        fed: sim.outputs().fed_length,
        free,
    }
}

/// Place of the least value of a function with one minimum (golden section).
fn least(f: impl Fn(f64) -> f64, mut a: f64, mut b: f64) -> f64 {
    let g = 0.5 * (5.0_f64.sqrt() - 1.0);
    for _ in 0..40 {
        let (c, d) = (b - g * (b - a), a + g * (b - a));
        if f(c) < f(d) {
            b = d;
        } else {
            a = c;
        }
    }
    0.5 * (a + b)
}
