//! `coilwind check`: is this scene possible?

use super::failure::Failure;
use super::members::rounded;
use super::scene::SceneArgs;
use super::terminal::print;
use super::waiting::Waiting;
use clap::Args;
use coilwind::scene::Bilinear;
use coilwind::simulation::Simulation;

/// Digits of numbers that people read.
const DIGITS: usize = 6;

/// Arguments of `check`.
#[derive(Args, Debug)]
pub(super) struct CheckArgs {
    #[command(flatten)]
    scene: SceneArgs,
}

/// Builds the scene and the wire at rest; warnings go to standard error.
pub(super) fn check(args: &CheckArgs) -> Result<(), Failure> {
    let waiting = Waiting::for_start();
    let (settings, scene, warnings) = args.scene.build()?;
    for warning in &warnings {
        eprintln!("warning: {warning}");
    }
    let mut simulation = Simulation::new(&scene).map_err(|reason| Failure::Start {
        scene: args.scene.scene.clone(),
        reason,
    })?;
    drop(waiting);
    for event in simulation.drain_events() {
        eprintln!("warning: {}", event.text);
    }
    let seconds = simulation.motion_profile().end();
    let wire = &scene.wire;
    let enamel = match wire.diameter > wire.bare_diameter {
        true => format!(
            " ({} mm with its enamel)",
            rounded(wire.diameter * 1e3, DIGITS)
        ),
        false => String::new(),
    };
    // density and resistivity stay the metal's, where no key gives them
    let curve = match settings.wire.stress_strain.is_empty() {
        true => "",
        false => " with a stress-strain curve of its own",
    };
    let turns = match scene.spindle.turns {
        1.0 => "1 turn".into(),
        turns => format!("{} turns", rounded(turns, DIGITS)),
    };
    print(&format!(
        "{}: valid; {} wire of {} mm{enamel}{curve} at {} N, {turns} at {} rad/s in {seconds:.4} s\n",
        args.scene.scene,
        scene.wire_material,
        rounded(wire.bare_diameter * 1e3, DIGITS),
        rounded(scene.tensioner.tension, DIGITS),
        rounded(scene.spindle.speed, DIGITS),
    ))?;
    let Some(laws) = &scene.wire_laws else {
        return Ok(());
    };
    let percent = |law: Bilinear| 100.0 * law.error;
    print(&format!(
        "laws of the section: yield at {:.4} N, {:.4} N.mm, torque {:.4} N.mm; off the exact ones by up to {:.1} %, {:.1} %, {:.1} %\n",
        wire.n_y,
        1e3 * wire.m_y,
        1e3 * wire.t_y,
        percent(laws.stretch),
        percent(laws.bend),
        percent(laws.twist),
    ))
}
