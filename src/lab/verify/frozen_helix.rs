//! Wire wound on a cylinder until it freezes: length fed per turn, and place, pitch and tension of what is frozen.
//!
//! A whole winding run of elastic wire with the default scene's contact, friction, feed steps and freezing. The tensioner has no
//! mass and the nozzle no friction, so that the free span is under the set tension. Without friction on the core, laid wire has
//! what bending leaves of it.

use super::{Answer, Answers, Context, VerifyError};
use crate::geometry::FrozenNode;
use crate::math::Spin;
use crate::math::V3;
use crate::scene::{Core, Integrator, Scene, si};
use crate::settings::SceneSettings;
use crate::signals::Inputs;
use crate::simulation::Simulation;
use std::f64::consts::TAU;

/// Turns that are wound; the fed length is that of the last one.
const TURNS: f64 = 5.4;
/// Angle of a communication step, rad: a fiftieth of a turn.
const SAMPLE: f64 = TAU / 50.0;
/// Turns from the clamp on whose wire the start still shapes.
const START: f64 = 2.5;

/// Refuses a wind so fast that what the wire weighs as it goes round is more than a tenth of its tension: it would not lie.
fn whirls_little(ctx: &Context, scene: &Scene, radius: f64) -> Result<(), VerifyError> {
    let (pull, mass) = (scene.tensioner.tension, ctx.section.mass_per_length());
    let most = (0.1 * pull / mass).sqrt() / radius;
    if scene.spindle.speed <= most {
        return Ok(());
    }
    Err(VerifyError::Input {
        name: "omega_rad_per_s".to_owned(),
        problem: format!(
            "{}: at most {} is wanted for this radius and tension, or the wire flies off",
            si(scene.spindle.speed),
            si(most)
        ),
    })
}

/// Runs a case.
pub fn run(ctx: &Context) -> Result<Answers, VerifyError> {
    let (radius, pitch) = (ctx.positive("R_m")?, ctx.positive("pitch_m")?);
    let scene = scene(ctx, radius, pitch)?;
    whirls_little(ctx, &scene, radius)?;
    let fail = |e: crate::simulation::SimError| VerifyError::NoAnswer(e.to_string());
    let mut sim = Simulation::new(&scene).map_err(fail)?;
    let speed = scene.spindle.speed;
    let samples = (TURNS * TAU / SAMPLE).round() as usize;
    let turn = (TAU / SAMPLE).round() as usize;
    let mut fed = Vec::with_capacity(samples);
    let mut moved: f64 = 0.0;
    let mut jump: f64 = 0.0;
    let mut followed = 0;
    let mut before = Live::of(&sim);
    for i in 1..=samples {
        let angle = SAMPLE * i as f64;
        let inputs = Inputs {
            spindle_speed: speed,
            nozzle_position: scene.traverse.lead + pitch * angle / TAU,
            tension_setpoint: scene.tensioner.tension,
            ..Inputs::HELD
        };
        sim.advance(inputs, SAMPLE / speed).map_err(fail)?;
        fed.push(sim.outputs().fed_length);
        let after = Live::of(&sim);
        for node in sim.system().state.frozen.nodes() {
            if let Some((place, tension)) = before.find(node.arc) {
                moved = moved.max((node.point - place).norm());
                jump = jump.max((node.tension - tension).abs());
                followed += 1;
            }
        }
        before = after;
    }
    if followed < sim.system().state.frozen.len() / 2 {
        return Err(VerifyError::NoAnswer(
            "frozen wire is not where live wire was".to_owned(),
        ));
    }
    let laid: Vec<FrozenNode> = sim
        .system()
        .state
        .frozen
        .nodes()
        .filter(|n| n.arc > START * TAU * radius)
        .collect();
    let [Some(first), Some(last)] = [laid.first(), laid.last()] else {
        return Err(VerifyError::NoAnswer("no wire froze".to_owned()));
    };
    let mean = |of: fn(&FrozenNode) -> f64| laid.iter().map(of).sum::<f64>() / laid.len() as f64;
    let turned: f64 = laid
        .windows(2)
        .map(|n| {
            let [a, b] = [n[0].point, n[1].point];
            libm::atan2(a.z * b.x - a.x * b.z, a.x * b.x + a.z * b.z).abs()
        })
        .sum();
    Ok(vec![
        (
            "fed_per_turn_m",
            Answer::Number(fed[samples - 1] - fed[samples - 1 - turn]),
        ),
        (
            "laid_radius_m",
            Answer::Number(mean(|n| libm::hypot(n.point.x, n.point.z))),
        ),
        (
            "laid_pitch_m",
            Answer::Number((last.point.y - first.point.y).abs() * TAU / turned),
        ),
        ("laid_tension_N", Answer::Number(mean(|n| n.tension))),
        ("moved_by_freezing_m", Answer::Number(moved)),
        ("tension_jump_by_freezing_N", Answer::Number(jump)),
    ])
}

/// The live wire at a communication point.
struct Live {
    /// unstretched length from the clamp, m, place in the core frame, m, and tension after it, N
    nodes: Vec<(f64, V3, f64)>,
}

impl Live {
    fn of(sim: &Simulation) -> Self {
        let state = &sim.system().state;
        let spin = Spin::new(state.spindle.angle);
        let mut arc = state.arc0;
        let mut nodes = Vec::with_capacity(state.rod.edges());
        for j in 0..state.rod.edges() {
            nodes.push((
                arc,
                spin.to_core(state.rod.x[j]),
                state.load.tension.get(j).copied().unwrap_or(f64::NAN),
            ));
            arc += state.rod.rest[j];
        }
        Self { nodes }
    }

    /// Place and tension of the node at this length from the clamp.
    fn find(&self, arc: f64) -> Option<(V3, f64)> {
        let found = self.nodes.iter().find(|n| (n.0 - arc).abs() < 1e-9);
        found.map(|n| (n.1, n.2))
    }
}

/// The scene of the case.
fn scene(ctx: &Context, radius: f64, pitch: f64) -> Result<Scene, VerifyError> {
    let mut scene = SceneSettings::default()
        .build()
        .map_err(|e| VerifyError::NoAnswer(e.to_string()))?;
    scene.wire = ctx.elastic();
    scene.core = Core::Cylinder {
        flange: None,
        radius,
        length_y: 60.0 * pitch,
    };
    scene.nozzle.distance = 4.0 * radius;
    scene.nozzle.y_start = 0.0;
    scene.nozzle.exit_friction = 0.0;
    scene.tensioner.tension = ctx.positive("T0_N")?;
    scene.tensioner.mass = 0.0;
    scene.tensioner.line_length = 0.0;
    scene.spindle.speed = ctx.positive("omega_rad_per_s")?;
    scene.traverse.per_turn = pitch;
    // where the straight span of the steady helix starts: no turn is laid in on the way there
    let axis = radius + scene.wire.radius();
    let distance = scene.nozzle.distance;
    let free = (distance * distance - axis * axis).sqrt();
    scene.traverse.lead = pitch * free / (TAU * axis);
    let mu = ctx.number("mu")?;
    scene.friction.static_ = mu;
    scene.friction.kinetic = mu;
    if let (Integrator::Implicit, Some(spacing)) = (ctx.integrator, ctx.spacing) {
        scene.solver.spacing_near = spacing;
        scene.solver.tolerance = ctx.tolerance;
    } else {
        return Err(VerifyError::NoAnswer(
            "the explicit method carries no history of frozen wire".to_owned(),
        ));
    }
    Ok(scene)
}
