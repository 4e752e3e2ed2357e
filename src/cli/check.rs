//! `coilwind check`: is this scene possible?

use super::failure::Failure;
use super::members::rounded;
use super::scene::SceneArgs;
use super::terminal::print;
use super::waiting::Waiting;
use clap::Args;
use coilwind::geometry::stl;
use coilwind::scene::{Bilinear, Core};
use coilwind::simulation::Simulation;
use std::fs::File;
use std::path::Path;

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
        true => String::new(),
        false => format!(
            " with a stress-strain curve of its own, {} GPa,",
            rounded(1e-9 * wire.modulus(), DIGITS)
        ),
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
    if let Core::Mesh { path, unit, .. } = &scene.core {
        print(&size_of(path, *unit).unwrap_or_default())?;
    }
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

/// How large a mesh is along the axes, and between which places along its own, in words; `None` where it is no longer there.
fn size_of(path: &Path, unit: f64) -> Option<String> {
    let mesh = stl::read(&mut File::open(path).ok()?, unit).ok()?;
    let [low, high] = mesh.bounds();
    let mm = |x: f64| rounded(1e3 * x, DIGITS);
    let size = high - low;
    Some(format!(
        "mesh: {} x {} x {} mm along x, y, z; its axis is y, from {} to {} mm\n",
        mm(size.x),
        mm(size.y),
        mm(size.z),
        mm(low.y),
        mm(high.y),
    ))
}
