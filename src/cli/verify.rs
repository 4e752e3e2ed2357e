//! `coilwind verify`.

use super::choice::one_of;
use super::failure::Failure;
use super::terminal::print;
use clap::Args;
use coilwind::lab::verify::{VerifyOptions, run};
use coilwind::scene::Preset;
use std::path::PathBuf;

const PRESETS: &[(&str, &str, Preset)] = &[
    ("paper", "explicit, RK4", Preset::Paper),
    (
        "default",
        "the implicit method that winding uses",
        Preset::Default,
    ),
];

/// Arguments of `verify`.
#[derive(Args, Debug)]
pub(super) struct VerifyArgs {
    /// Kinds to run; all if none is named
    #[arg(value_name = "KIND")]
    kinds: Vec<String>,
    /// Case file to run; the packed reference cases if none is given
    #[arg(long = "file", value_name = "CASES.json")]
    files: Vec<PathBuf>,
    /// Method: default (the implicit one that winding uses) or paper (explicit, RK4)
    #[arg(long, value_name = "paper|default", default_value = "default", value_parser = one_of(PRESETS))]
    preset: Preset,
    /// Solver setting: solver.spacing_near (finest node spacing, m), solver.tolerance (m) or solver.integrator
    #[arg(long = "set", value_name = "NAME=VALUE")]
    set: Vec<String>,
    /// One line of JSON per number
    #[arg(long)]
    json: bool,
}

impl VerifyArgs {
    fn options(&self) -> VerifyOptions {
        VerifyOptions {
            kinds: self.kinds.clone(),
            files: self.files.clone(),
            preset: self.preset,
            set: self.set.clone(),
            json: self.json,
        }
    }
}

/// Runs the cases, a line each; fails if a number is out of tolerance.
pub(super) fn verify(args: &VerifyArgs) -> Result<(), Failure> {
    let mut printed = Ok(());
    let right = run(&args.options(), |line| {
        if printed.is_ok() {
            printed = print(&format!("{line}\n"));
        }
    })?;
    printed?;
    if right { Ok(()) } else { Err(Failure::Verify) }
}
