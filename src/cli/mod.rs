//! Command line: one file per command, one place for exit codes.

mod bench;
mod check;
mod choice;
mod failure;
mod frames;
mod progress;
mod run;
mod signals;
mod stress;
mod variables;
mod verify;

use clap::{Args, Parser, Subcommand};
use coilwind::scene::{SceneError, assignment};
use coilwind::settings::SceneSettings;
use failure::Failure;
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Simulation of wire winding: an elastic-plastic rod on a turning core.
///
/// Exit codes: 0 done, 1 a defect or check failed where asked for, 2 bad input, 3 the solver gave
/// up (what was computed is on disk), 130 interrupted (likewise).
#[derive(Debug, Parser)]
#[command(name = "coilwind", version)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

// A new command is a file beside this one with its arguments and a function that runs it.
#[derive(Debug, Subcommand)]
enum Command {
    /// Wind a scene and write summary.json, history.csv, turns.csv, stations.csv, coil.vtp, core.vtp
    /// and coil.png
    Run(run::RunArgs),
    /// Validate a scene and say what is wrong, and where
    Check(check::CheckArgs),
    /// List every variable: inputs, outputs, diagnostics, parameters
    Variables(variables::VariablesArgs),
    /// Compare exact answers with what the code that winds computes
    Verify(verify::VerifyArgs),
    /// Time a known problem or a whole scene and print error and cost as one line of JSON
    Bench(bench::BenchArgs),
    /// Wind random valid scenes, judge them by what must always hold, keep what fails
    Stress(stress::StressArgs),
}

/// A scene and what to change in it.
#[derive(Args, Debug)]
struct SceneArgs {
    /// Scene file (TOML), or the name of a packed scene such as fig8
    scene: String,
    /// Set a parameter, with or without its unit: wire.diameter=7e-4, wire.diameter_mm=0.7
    #[arg(long, value_name = "NAME=VALUE", value_parser = assignment)]
    set: Vec<(String, String)>,
}

impl SceneArgs {
    /// Defaults, then the scene, then every `--set` in its order.
    fn settings(&self) -> Result<SceneSettings, SceneError> {
        let mut settings = SceneSettings::load(&self.scene)?;
        for (name, value) in &self.set {
            settings.set_text(name, value)?;
        }
        Ok(settings)
    }
}

/// Parses the arguments, runs the command and turns its failure into an exit code.
pub(crate) fn main() -> ExitCode {
    let result = match Cli::parse().command {
        Command::Run(args) => run::run(&args),
        Command::Check(args) => check::check(&args),
        Command::Variables(args) => variables::variables(&args),
        Command::Verify(args) => verify::verify(&args),
        Command::Bench(args) => bench::bench(&args),
        Command::Stress(args) => stress::stress(&args),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("coilwind: {failure}");
            failure.exit_code()
        }
    }
}

/// A flag that Ctrl-C raises; a second Ctrl-C ends the program at once.
fn stop_flag() -> Arc<AtomicBool> {
    let flag = Arc::new(AtomicBool::new(false));
    let raised = Arc::clone(&flag);
    let handler = ctrlc::set_handler(move || {
        if raised.swap(true, Ordering::SeqCst) {
            std::process::exit(130);
        }
    });
    if handler.is_err() {
        eprintln!("warning: Ctrl-C will end the run without results");
    }
    flag
}

/// Writes to standard output; a reader that has seen enough (`| head`) is no failure.
fn print(text: &str) -> Result<(), Failure> {
    use std::io::{ErrorKind, Write};
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(Failure::write("standard output", error))
        }
        _ => Ok(()),
    }
}
