//! Command line: one file per command, one place for exit codes.

mod bench;
mod check;
mod checkpoint;
mod choice;
mod drive;
mod ends;
mod ensemble;
mod ensemble_files;
mod failure;
mod folder;
mod frames;
mod lock;
mod members;
mod motion;
mod progress;
mod read_files;
mod report;
mod run;
mod runs_bar;
mod scene;
mod shell;
mod signals;
mod stress;
mod sweep;
mod sweep_answer;
mod sweep_files;
mod sweep_find_max;
mod sweep_grid;
mod sweep_ledger;
mod sweep_map;
mod sweep_page;
mod sweep_range;
mod sweep_row;
mod sweep_statistics;
mod sweep_wind;
mod terminal;
mod variables;
mod verify;
mod waiting;

use clap::error::ErrorKind;
use clap::{Parser, Subcommand};
use coilwind::scene::refuse_repeated;
use failure::Failure;
use std::process::ExitCode;

/// Simulation of wire winding: an elastic-plastic rod on a turning core.
///
/// Exit codes: 0 done, 1 a defect or check failed where asked for, 2 bad input.
/// With what was computed on disk: 3 the solver gave up, the run is in doubt, or a file could
/// not be written; 130 interrupted.
/// 4: `sweep --find-max` has no answer.
#[derive(Debug, Parser)]
#[command(name = "coilwind", version)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

// A new command is a file beside this one with its arguments and a function that runs it.
#[derive(Debug, Subcommand)]
enum Command {
    /// Wind a scene and write summary.json, history.csv, turns.csv, stations.csv, defects.csv, scene.toml,
    /// coil.vtp, core.vtp, coil.png and report.html; or go on with a run that was stopped
    Run(run::RunArgs),
    /// Wind every combination of values on all cores, and leave a table of verdicts; or find the
    /// highest value without a defect
    Sweep(sweep::SweepArgs),
    /// Make the page about a run again, or compare two runs, from the files that they left
    Report(report::ReportArgs),
    /// Validate a scene and say what is wrong, and where
    Check(check::CheckArgs),
    /// Write the scene's own motion as sampled inputs, for `run --inputs` or a master of the FMU
    Motion(motion::MotionArgs),
    /// List every variable: inputs, outputs, diagnostics, parameters
    Variables(variables::VariablesArgs),
    /// Compare exact answers with what the code that winds computes
    Verify(verify::VerifyArgs),
    /// Time a known problem or a whole scene and print error and cost as one line of JSON
    Bench(bench::BenchArgs),
    /// Wind random valid scenes, judge them by what must always hold, keep what fails
    Stress(stress::StressArgs),
}

/// Parses the arguments, runs the command and turns its failure into an exit code.
pub(crate) fn main() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => return not_understood(&error),
    };
    terminal::outlive_file_limit();
    let result = match cli.command {
        Command::Run(args) => wind(&args),
        Command::Sweep(args) => sweep::sweep(&args),
        Command::Report(args) => report::report(&args),
        Command::Check(args) => check::check(&args),
        Command::Motion(args) => motion::motion(&args),
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

/// Runs a scene or an ensemble of it, or goes on with one.
fn wind(args: &run::RunArgs) -> Result<(), Failure> {
    refuse_repeated(&args.set)?;
    match (args.ensemble, &args.resume) {
        (Some(count), _) => ensemble::run(args, count),
        (None, Some(directory)) if ensemble_files::can_go_on(directory) => {
            ensemble::resume(args, directory)
        }
        _ => run::run(args),
    }
}

/// Tells what is wrong with the arguments. A value that is refused says itself what would do, in one line.
fn not_understood(error: &clap::Error) -> ExitCode {
    if error.kind() != ErrorKind::ValueValidation {
        error.exit();
    }
    let text = error.to_string();
    let line = text.lines().next().unwrap_or_default();
    eprintln!("coilwind: {}", line.trim_start_matches("error: "));
    ExitCode::from(2)
}
