//! Ensembles of runs: stopped and gone on with, and never over what is there.
#![cfg(unix)]

use crate::stopping::{assert_same, coilwind, files, refused, said, short, wait_for_checkpoint};
use std::path::Path;
use std::process::{Command, Stdio};

/// Members that had not begun were named, and no command wound them.
#[test]
fn an_ensemble_that_is_stopped_goes_on_to_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let run = |out: &Path| {
        let mut command = short(out);
        command
            .args(["--ensemble", "3", "--set", "spindle.turns=6"])
            .env("RAYON_NUM_THREADS", "1");
        command
    };
    let whole = folder.path().join("whole");
    assert!(run(&whole).status().unwrap().success());
    let out = folder.path().join("two words");
    let child = run(&out).stderr(Stdio::piped()).spawn().unwrap();
    wait_for_checkpoint(&out.join("1"));
    let kill = Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status();
    assert!(kill.unwrap().success());
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130), "{}", said(&output));
    let command = format!(
        "0 of 3 members are done; go on with: coilwind run --resume '{}'",
        out.display()
    );
    assert!(said(&output).contains(&command), "{}", said(&output));
    assert!(!out.join("3").exists());
    // the same command again named the first member alone
    refused(&mut run(&out), &format!("--resume '{}'", out.display()));
    let mut again = coilwind();
    again.args(["run", "--resume"]).arg(&out);
    let output = again.output().unwrap();
    assert!(output.status.success(), "{}", said(&output));
    let told = String::from_utf8(output.stdout).unwrap();
    let folders = [1, 3].map(|member| out.join(member.to_string()).display().to_string());
    assert!(told.contains(&folders.join(" to ")), "{told}");
    for member in ["1", "2", "3"] {
        assert_same(&whole.join(member), &out.join(member), member);
    }
    for directory in [&whole, &out] {
        // the members, and what came of them
        assert_eq!(std::fs::read_dir(directory).unwrap().count(), 4);
    }
    let told = |directory: &Path| std::fs::read(directory.join("ensemble.json")).unwrap();
    assert_eq!(told(&whole), told(&out));
}

/// A run of a third of a turn into this folder, with `more` of the command line.
fn brief(out: &Path, more: &[&str]) -> Command {
    let mut command = short(out);
    command.args(["--set", "spindle.turns=0.3"]).args(more);
    command
}

/// A run wound into the folder of an ensemble, and a smaller ensemble kept a member of the larger one.
#[test]
fn an_ensemble_is_not_overwritten_and_leaves_no_member_behind() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let run = |more: &[&str]| brief(&out, more);
    assert!(run(&["--ensemble", "3"]).status().unwrap().success());
    refused(&mut run(&[]), "holds an ensemble; add --force");
    refused(&mut run(&["--ensemble", "2"]), "holds an ensemble");
    let mut sweep = coilwind();
    sweep.args([
        "sweep",
        "fig8",
        "--quiet",
        "--over",
        "spindle.speed=60:120:2",
        "--out",
    ]);
    refused(sweep.arg(&out), "holds an ensemble");
    let names = || {
        let entries = std::fs::read_dir(&out).unwrap();
        let name = |entry: std::io::Result<std::fs::DirEntry>| entry.unwrap().file_name();
        let mut names: Vec<_> = entries.map(name).collect();
        names.sort();
        names
    };
    assert_eq!(names(), ["1", "2", "3", "ensemble.json"]);
    let told: serde_json::Value =
        serde_json::from_slice(&std::fs::read(out.join("ensemble.json")).unwrap()).unwrap();
    assert_eq!(told["members"], 3);
    let verdicts = told["verdicts"].as_object().unwrap().values();
    assert_eq!(verdicts.map(|n| n.as_u64().unwrap()).sum::<u64>(), 3);
    // runs that somebody wound into folders with numbers are no members
    std::fs::rename(out.join("2"), out.join("4")).unwrap();
    let smaller = run(&["--ensemble", "2", "--force"]).status();
    assert!(smaller.unwrap().success());
    assert_eq!(names(), ["1", "2", "4", "ensemble.json"]);
    assert!(run(&["--force"]).status().unwrap().success());
    assert!(!out.join("1").exists() && out.join("summary.json").is_file());
    assert!(out.join("4/summary.json").is_file());
}

/// A run or an ensemble with `--force` removed the plan and the rows of a sweep that went on.
#[test]
fn a_sweep_that_goes_on_is_not_overwritten() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let mut sweep = coilwind();
    sweep.args(["sweep", "fig8", "--over", "spindle.speed=60:300:200"]);
    sweep.args(["--threads", "1", "--quiet", "--out"]).arg(&out);
    let mut sweep = sweep.stderr(Stdio::null()).spawn().unwrap();
    let patience = std::time::Instant::now();
    while !out.join("sweep.csv").is_file() && patience.elapsed().as_secs() < 60 {
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    refused(short(&out).arg("--force"), "a sweep is going on here");
    let mut ensemble = short(&out);
    ensemble.args(["--force", "--ensemble", "2"]);
    refused(&mut ensemble, "a sweep is going on here");
    assert!(out.join("sweep.json").is_file() && out.join("sweep.csv").is_file());
    assert!(!out.join("history.csv").exists() && !out.join("1").exists());
    sweep.kill().unwrap();
    sweep.wait().unwrap();
    // one that has stopped is
    assert!(short(&out).arg("--force").status().unwrap().success());
    assert!(!out.join("sweep.json").exists() && !out.join("sweep.csv").exists());
}

/// A second command wound those that had not begun, said that others had failed, and removed the plan of the first.
#[test]
fn an_ensemble_that_goes_on_is_not_gone_on_with_by_another() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let mut first = short(&out);
    first
        .args(["--ensemble", "2", "--set", "spindle.turns=50"])
        .env("RAYON_NUM_THREADS", "1");
    let mut first = first.stderr(Stdio::null()).spawn().unwrap();
    wait_for_checkpoint(&out.join("1"));
    let mut second = coilwind();
    second.args(["run", "--quiet", "--resume"]).arg(&out);
    refused(&mut second, "the ensemble is going on");
    refused(short(&out).arg("--force"), "the ensemble is going on");
    assert!(!out.join("2").exists() && !out.join("history.csv").exists());
    first.kill().unwrap();
    first.wait().unwrap();
    assert!(out.join("ensemble.bin").is_file());
    // what is held is held by a process that lives
    let smaller = short(&out)
        .args(["--ensemble", "1", "--set", "spindle.turns=0.3", "--force"])
        .status();
    assert!(smaller.unwrap().success());
    assert!(!out.join("ensemble.bin").exists());
}

/// "coilwind: : cannot start" was all that was told of it.
#[test]
fn a_member_that_cannot_start_is_named_where_its_ensemble_goes_on() {
    let folder = tempfile::tempdir().unwrap();
    let (out, inputs) = (folder.path().join("out"), folder.path().join("in.csv"));
    // so near to the core that the nearer member has no room
    let rows = "time,spindle_speed,nozzle_offset_x\n0,0,-0.0437\n0.002,0,-0.0437\n";
    std::fs::write(&inputs, rows).unwrap();
    // and the other one meets a full disk
    std::fs::create_dir_all(out.join("2")).unwrap();
    let full = out.join("2/turns.csv");
    std::os::unix::fs::symlink("/dev/full", &full).unwrap();
    let mut first = coilwind();
    first.args(["run", "fig8", "--quiet", "--no-geometry", "--step", "0.001"]);
    first.arg("--inputs").arg(&inputs).arg("--out").arg(&out);
    let begins = "coilwind: fig8: cannot start: ";
    refused(first.args(["--ensemble", "2"]), begins);
    assert!(out.join("ensemble.bin").is_file());
    std::fs::remove_file(&full).unwrap();
    let mut again = coilwind();
    refused(again.args(["run", "--quiet", "--resume"]).arg(&out), begins);
    assert!(out.join("2/summary.json").is_file() && !out.join("ensemble.bin").exists());
}

/// The members that had ended were removed one after the other, up to the one that refused.
#[test]
fn an_ensemble_that_goes_on_keeps_the_members_that_have_ended() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let run = |more: &[&str]| brief(&out, more);
    assert!(run(&["--ensemble", "3"]).status().unwrap().success());
    let before: Vec<_> = (1..=3).map(|k| files(&out.join(k.to_string()))).collect();
    // what a member that is winding does to its history
    let history = std::fs::File::open(out.join("3/history.csv")).unwrap();
    history.lock().unwrap();
    let mut sweep = coilwind();
    sweep.args(["sweep", "fig8", "--quiet", "--force"]);
    sweep.args(["--over", "spindle.speed=60:120:2", "--out"]);
    sweep.arg(&out);
    for mut command in [
        run(&["--force"]),
        run(&["--ensemble", "2", "--force"]),
        sweep,
    ] {
        refused(&mut command, "the run is going on");
        let after: Vec<_> = (1..=3).map(|k| files(&out.join(k.to_string()))).collect();
        assert!(after == before, "{command:?}");
        // (nor is there a file of the run that was refused)
        assert_eq!(std::fs::read_dir(&out).unwrap().count(), 4, "{command:?}");
    }
}
