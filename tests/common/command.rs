//! The command through its front door.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::{Command, Output};

/// A sweep of `fig8` of 0.3 turns on coarse wire: enough to judge, over in a moment.
pub const SHORT: [&str; 10] = [
    "fig8",
    "--quiet",
    "--set",
    "spindle.turns=0.3",
    "--set",
    "spindle.ramp_turns=0.1",
    "--set",
    "solver.spacing_near_mm=1",
    "--set",
    "solver.tolerance=1e-5",
];

/// The command on such a sweep or run, in a folder.
pub fn coilwind(command: &str, out: &Path, more: &[&str]) -> Command {
    let mut process = Command::new(env!("CARGO_BIN_EXE_coilwind"));
    process.arg(command).args(SHORT).arg("--out").arg(out);
    process.args(more);
    process
}

/// What a command says that ends with this code.
pub fn finished(mut command: Command, code: i32) -> Output {
    let output = command.output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(code), "{said}");
    output
}

/// What such a command complains of.
pub fn complaint(command: Command, code: i32) -> String {
    String::from_utf8(finished(command, code).stderr).unwrap()
}

/// The rows of a table by column.
pub fn rows(path: &Path) -> Vec<BTreeMap<String, String>> {
    let mut reader = csv::Reader::from_path(path).unwrap();
    reader.deserialize().map(Result::unwrap).collect()
}
