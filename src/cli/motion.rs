//! `coilwind motion`: the scene's own motion as sampled inputs, for `run --inputs` and for masters of the FMU.

use super::failure::Failure;
use super::scene::SceneArgs;
use super::terminal::print;
use clap::Args;
use coilwind::simulation::{MotionProfile, Simulation};
use std::fmt::Write;
use std::path::PathBuf;

/// Most rows: a file of half a gigabyte.
const MOST_ROWS: f64 = 1e7;

/// Arguments of `motion`.
#[derive(Args, Debug)]
pub(super) struct MotionArgs {
    #[command(flatten)]
    scene: SceneArgs,
    /// Communication step, s
    #[arg(long, value_name = "H", default_value_t = 5e-4)]
    step: f64,
    /// CSV file to write; standard output without it
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

/// Writes time, speed and nozzle position of every communication step.
pub(super) fn motion(args: &MotionArgs) -> Result<(), Failure> {
    let (_, scene, warnings) = args.scene.build()?;
    for warning in &warnings {
        eprintln!("warning: {warning}");
    }
    let simulation = Simulation::new(&scene).map_err(|reason| Failure::Start {
        scene: args.scene.scene.clone(),
        reason,
    })?;
    let profile = simulation.motion_profile();
    let end = profile.end();
    if !(args.step > 0.0 && args.step <= end && end / args.step <= MOST_ROWS) {
        return Err(Failure::Signals {
            file: format!("--step {}", args.step),
            reason: format!(
                "allowed: {:.3e} s to the length of the motion, {end} s",
                end / MOST_ROWS
            ),
        });
    }
    let text = sampled(profile, args.step);
    match &args.out {
        None => print(&text),
        Some(file) => std::fs::write(file, text).map_err(|source| Failure::Write {
            path: file.display().to_string(),
            source,
        }),
    }
}

/// Rows at multiples of `step`, s, and at the end of the motion.
///
/// A row has the mean speed of the step that begins there, so that the core's angle comes out right, and the nozzle's position at
/// that step's end, where a nozzle of sampled inputs arrives.
fn sampled(profile: &MotionProfile, step: f64) -> String {
    let end = profile.end();
    let mut text = "time,spindle_speed,nozzle_position\n".to_owned();
    let mut row = |time: f64, until: f64| {
        let speed = match until > time {
            true => (profile.angle(until) - profile.angle(time)) / (until - time),
            false => profile.speed(time),
        };
        let _ = writeln!(text, "{time},{speed},{}", profile.nozzle(until));
    };
    for count in 0_u64.. {
        let time = count as f64 * step;
        if time >= end {
            break;
        }
        row(time, (time + step).min(end));
    }
    row(end, end);
    text
}
