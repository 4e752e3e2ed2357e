//! Runs of the command that are stopped and go on.

use std::path::Path;
use std::process::{Command, Output};
use std::time::Duration;

pub fn coilwind() -> Command {
    Command::new(env!("CARGO_BIN_EXE_coilwind"))
}

pub fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Twelve turns without pictures, which take longer than all else.
pub fn short(out: &Path) -> Command {
    let mut command = coilwind();
    command.args(["run", "fig8", "--quiet", "--no-geometry"]);
    for setting in [
        "spindle.turns=12",
        "spindle.speed=100",
        "solver.spacing_near_mm=0.8",
    ] {
        command.args(["--set", setting]);
    }
    command.arg("--out").arg(out);
    command
}

pub fn refused(command: &mut Command, part: &str) {
    let output = command.output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(said(&output).lines().count(), 1, "{}", said(&output));
    assert!(said(&output).contains(part), "{part}: {}", said(&output));
}

/// The files of a run but for what the clock writes.
pub fn files(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let frames = std::fs::read_dir(folder.join("frames"))
        .into_iter()
        .flatten();
    let entries = std::fs::read_dir(folder).unwrap().chain(frames);
    let mut found: Vec<(String, Vec<u8>)> = entries
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.is_file() && !path.ends_with("report.html"))
        .map(|path| {
            let name = path.file_name().unwrap().to_string_lossy().into_owned();
            let mut bytes = std::fs::read(&path).unwrap();
            if name == "summary.json" {
                let text = String::from_utf8(bytes).unwrap();
                let timeless = text
                    .lines()
                    .filter(|line| !line.contains("wall_s") && !line.contains("real_time_factor"));
                bytes = timeless.collect::<Vec<_>>().join("\n").into_bytes();
            }
            (name, bytes)
        })
        .collect();
    found.sort();
    found
}

pub fn assert_same(whole: &Path, stopped: &Path, what: &str) {
    let (a, b) = (files(whole), files(stopped));
    let names = |files: &[(String, Vec<u8>)]| -> Vec<String> {
        files.iter().map(|(name, _)| name.clone()).collect()
    };
    assert_eq!(names(&a), names(&b), "{what}");
    for ((name, a), (_, b)) in a.iter().zip(&b) {
        assert!(a == b, "{what}: {name} differs");
    }
}

pub fn wait_for_checkpoint(out: &Path) {
    while !out.join("checkpoint.bin").exists() {
        std::thread::sleep(Duration::from_millis(5));
    }
}
