//! `coilwind check`: is this scene possible?

use super::failure::Failure;
use super::scene::SceneArgs;
use super::terminal::print;
use clap::Args;
use coilwind::simulation::Simulation;

/// Arguments of `check`.
#[derive(Args, Debug)]
pub(super) struct CheckArgs {
    #[command(flatten)]
    scene: SceneArgs,
}

/// Builds the scene and the wire at rest; warnings go to standard error.
pub(super) fn check(args: &CheckArgs) -> Result<(), Failure> {
    let (_, scene, warnings) = args.scene.build()?;
    for warning in &warnings {
        eprintln!("warning: {warning}");
    }
    let mut simulation = Simulation::new(&scene).map_err(|reason| Failure::Start {
        scene: args.scene.scene.clone(),
        reason,
    })?;
    for event in simulation.drain_events() {
        eprintln!("warning: {}", event.text);
    }
    let seconds = simulation.motion_profile().end();
    print(&format!(
        "{}: valid; {} wire of {} mm at {} N, {} turns at {} rad/s in {seconds:.4} s\n",
        args.scene.scene,
        scene.wire_material,
        scene.wire.diameter * 1e3,
        scene.tensioner.tension,
        scene.spindle.turns,
        scene.spindle.speed,
    ))
}
