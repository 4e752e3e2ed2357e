//! Runs that are stopped and go on: to the same bytes as those that were not, and never over another run.
#![cfg(unix)]

use crate::stopping::{assert_same, coilwind, files, refused, said, short, wait_for_checkpoint};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

fn resume(out: &Path) -> Command {
    let mut command = coilwind();
    command
        .args(["run", "--quiet", "--checkpoint-every", "0.02", "--resume"])
        .arg(out);
    command
}

/// Kills a run at random instants until it has ended; returns how often.
fn killed_until_it_ends(first: &mut Command, out: &Path, random: &mut ChaCha8Rng) -> u32 {
    let mut child = first.args(["--checkpoint-every", "0.02"]).spawn().unwrap();
    let mut kills = 0;
    loop {
        // (longer and longer, so that a machine under load gets past a checkpoint as well)
        let wait = 50 + u64::from(random.next_u32() % (500 + 20 * kills));
        std::thread::sleep(Duration::from_millis(wait));
        if let Some(status) = child.try_wait().unwrap() {
            assert!(status.success(), "{status}");
            return kills;
        }
        child.kill().unwrap();
        child.wait().unwrap();
        kills += 1;
        assert!(kills < 200, "it makes no way");
        // Killed before its first checkpoint, a run begins again.
        child = if out.join("checkpoint.bin").exists() {
            resume(out).spawn().unwrap()
        } else {
            short(out)
                .args(["--force", "--checkpoint-every", "0.02"])
                .spawn()
                .unwrap()
        };
    }
}

#[test]
fn a_run_that_is_killed_goes_on_to_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let whole = folder.path().join("whole");
    assert!(short(&whole).status().unwrap().success());
    let mut random = ChaCha8Rng::seed_from_u64(20);
    let mut kills = 0;
    for round in 0..10 {
        let out = folder.path().join(round.to_string());
        kills += killed_until_it_ends(&mut short(&out), &out, &mut random);
        assert_same(&whole, &out, &format!("round {round}"));
        if kills >= 10 {
            break;
        }
    }
    assert!(kills >= 10, "only {kills} kills");
}

/// On a communication grid, stopped by a signal, which ends a step in its middle.
/// A stop in the middle of a step went back to the checkpoint before, which may be that of the start.
#[test]
fn a_run_that_is_stopped_loses_nothing() {
    let folder = tempfile::tempdir().unwrap();
    for k in 0..8 {
        let out = folder.path().join(k.to_string());
        let words = ["run", "fig8", "--checkpoint-every", "600", "--no-report"];
        let mut command = coilwind();
        command.args(words).arg("--out").arg(&out);
        let child = command.stderr(Stdio::piped()).spawn().unwrap();
        wait_for_checkpoint(&out);
        std::thread::sleep(Duration::from_millis(40 + 3 * k));
        let mut kill = Command::new("kill");
        let killed = kill.args(["-INT", &child.id().to_string()]).status();
        assert!(killed.unwrap().success());
        let output = child.wait_with_output().unwrap();
        let said = said(&output);
        assert_eq!(output.status.code(), Some(130), "{said}");
        assert!(!said.contains("computed again"), "{said}");
    }
}

#[test]
fn a_run_by_inputs_that_is_stopped_goes_on_to_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let inputs = folder.path().join("in.csv");
    std::fs::write(
        &inputs,
        "time,spindle_speed,tension_setpoint\n0,0,15\n0.004,300,15\n0.004,300,12\n0.3,300,12\n",
    )
    .unwrap();
    let run = |out: &Path| {
        let mut command = coilwind();
        command.args([
            "run", "fig8", "--quiet", "--step", "3e-4", "--frames", "2", "--inputs",
        ]);
        command.arg(&inputs).arg("--out").arg(out);
        command.args(["--set", "solver.spacing_near_mm=0.5"]);
        command
    };
    let whole = folder.path().join("whole");
    assert!(run(&whole).status().unwrap().success());
    let out = folder.path().join("out");
    let mut child = run(&out)
        .args(["--checkpoint-every", "0.02"])
        .spawn()
        .unwrap();
    let mut stops = 0;
    loop {
        std::thread::sleep(Duration::from_millis(250));
        if let Some(status) = child.try_wait().unwrap() {
            assert!(status.success() || status.code() == Some(130), "{status}");
            if status.success() {
                break;
            }
        } else {
            let signal = if stops % 2 == 0 { "-INT" } else { "-TERM" };
            let kill = Command::new("kill")
                .args([signal, &child.id().to_string()])
                .status();
            assert!(kill.unwrap().success());
            let code = child.wait().unwrap().code();
            if code == Some(0) {
                break;
            }
            assert_eq!(code, Some(130));
            let summary = std::fs::read_to_string(out.join("summary.json")).unwrap();
            assert!(summary.contains("\"interrupted\""), "{summary}");
            assert!(out.join("report.html").exists());
        }
        stops += 1;
        assert!(stops < 200, "it makes no way");
        child = resume(&out).spawn().unwrap();
    }
    assert!(stops > 0, "it was never stopped");
    assert_same(&whole, &out, "inputs");

    // Other inputs are no inputs of this run.
    let mut child = run(&out)
        .args(["--force", "--checkpoint-every", "0.02"])
        .spawn()
        .unwrap();
    wait_for_checkpoint(&out);
    child.kill().unwrap();
    child.wait().unwrap();
    std::fs::write(&inputs, "time,spindle_speed\n0,0\n0.03,200\n").unwrap();
    let output = resume(&out).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(
        said(&output).contains("not the inputs that the run began with"),
        "{}",
        said(&output)
    );
}

#[test]
fn what_goes_on_is_told_where_a_run_is_stopped() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let mut command = short(&out);
    command
        .args(["--set", "spindle.turns=50", "--fail-on-defect"])
        .stderr(Stdio::piped());
    let child = command.spawn().unwrap();
    wait_for_checkpoint(&out);
    std::thread::sleep(Duration::from_millis(200));
    // Nobody else may go on with a run that is going on.
    let output = resume(&out).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(said(&output).contains("going on"), "{}", said(&output));
    let report = coilwind().arg("report").arg(&out).output().unwrap();
    assert!(
        said(&report).contains("the run is under way"),
        "{}",
        said(&report)
    );
    let kill = Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status();
    assert!(kill.unwrap().success());
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130));
    // A few turns of fifty were judged as if no more had been planned.
    let summary = std::fs::read(out.join("summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_slice(&summary).unwrap();
    let told = summary["reasons"].to_string();
    let time = summary["simulated_s"].as_f64().unwrap();
    let sentence = format!("The run was interrupted at t = {time:.6} s");
    assert!(told.contains(&sentence), "{sentence}: {told}");
    let line = format!(
        "go on with: coilwind run --resume {} --fail-on-defect --quiet",
        out.display()
    );
    assert!(said(&output).contains(&line), "{}", said(&output));
}

/// A run of a fiftieth of a turn.
fn of_a_moment(out: &Path) -> Command {
    let mut command = coilwind();
    command.args(["run", "fig8", "--set", "spindle.turns=0.02"]);
    command.args(["--set", "spindle.ramp_turns=0.02", "--out"]);
    command.arg(out);
    command
}

#[test]
fn a_folder_with_another_run_is_not_overwritten() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let quick = |more: &[&str]| {
        let mut command = of_a_moment(&out);
        command.arg("--quiet").args(more);
        command
    };
    assert!(quick(&["--frames", "2"]).status().unwrap().success());
    let mut report = coilwind();
    report
        .arg("report")
        .args([&out, &out])
        .stdout(Stdio::null());
    assert!(report.status().unwrap().success());
    assert!(out.join("compare.html").exists());
    let before = files(&out);
    let output = quick(&[]).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(said(&output).lines().count(), 1, "{}", said(&output));
    assert!(said(&output).contains("--force"), "{}", said(&output));
    assert_eq!(files(&out), before, "nothing was touched");
    let output = resume(&out).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(
        said(&output).contains("the run has ended"),
        "{}",
        said(&output)
    );

    assert!(
        quick(&["--force", "--no-geometry"])
            .status()
            .unwrap()
            .success()
    );
    let left: Vec<String> = files(&out).into_iter().map(|(name, _)| name).collect();
    assert_eq!(
        left,
        [
            "defects.csv",
            "history.csv",
            "scene.toml",
            "stations.csv",
            "summary.json",
            "turns.csv"
        ],
        "nothing of the run before is left"
    );
    assert!(!out.join("frames").exists());
    // A scene of one's own in the folder is no run, but it would be lost.
    let own = folder.path().join("own");
    std::fs::create_dir(&own).unwrap();
    std::fs::write(own.join("scene.toml"), "[wire]\ndiameter_mm = 0.5\n").unwrap();
    let output = coilwind()
        .args(["run", "fig8", "--out"])
        .arg(&own)
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2), "{}", said(&output));
}

/// Files on their way when a run was killed stayed for ever where the run that goes on does not write them.
#[test]
fn what_a_kill_left_on_its_way_goes() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let leftover = [
        out.join("coil.png.partial"),
        out.join("frames/frame_9999.vtp.partial"),
    ];
    let own = out.join("own.partial");
    let leave = || {
        std::fs::create_dir_all(out.join("frames")).unwrap();
        for path in leftover.iter().chain([&own]) {
            std::fs::write(path, "half").unwrap();
        }
    };
    let gone = |command: &mut Command| {
        let output = command.output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{}", said(&output));
        assert!(!leftover.iter().any(|path| path.exists()), "{command:?}");
        assert!(own.exists(), "a file of somebody else");
    };
    let mut child = short(&out).spawn().unwrap();
    wait_for_checkpoint(&out);
    child.kill().unwrap();
    child.wait().unwrap();
    leave();
    gone(&mut resume(&out));
    leave();
    gone(coilwind().arg("report").arg(&out).stderr(Stdio::piped()));
    leave();
    gone(short(&out).arg("--force"));
}

#[test]
fn a_folder_without_a_whole_run_says_what_to_do() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("none");
    let output = resume(&out).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(
        said(&output).contains("begin one with: coilwind run SCENE"),
        "{}",
        said(&output)
    );

    let file = folder.path().join("file");
    std::fs::write(&file, "{}").unwrap();
    refused(&mut resume(&file), "is a file; name the folder of a run");
    refused(
        &mut of_a_moment(&file),
        "is a file; name a folder with --out",
    );

    let mut child = short(&out).spawn().unwrap();
    let checkpoint = out.join("checkpoint.bin");
    while !checkpoint.exists() {
        std::thread::sleep(Duration::from_millis(5));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    let report = || {
        let mut command = coilwind();
        command.arg("report").arg(&out).stderr(Stdio::piped());
        command
    };
    refused(&mut report(), "go on with: coilwind run --resume");
    let whole = std::fs::read(&checkpoint).unwrap();
    std::fs::remove_file(&checkpoint).unwrap();
    refused(&mut report(), "scene.toml --out");
    refused(&mut resume(&out), "checkpoint.bin is missing; begin again");
    // A run that had stopped before its first checkpoint was told to have ended.
    for (status, told) in [
        (
            "interrupted",
            "checkpoint.bin is missing; begin again with: ",
        ),
        ("failed", "checkpoint.bin is missing; begin again with: "),
        ("done", "the run has ended"),
    ] {
        let summary = format!("{{\"status\": \"{status}\"}}\n");
        std::fs::write(out.join("summary.json"), summary).unwrap();
        refused(&mut resume(&out), told);
    }
    std::fs::remove_file(out.join("summary.json")).unwrap();
    let mut bent = whole.clone();
    bent[whole.len() / 2] ^= 1;
    for bytes in [&whole[..whole.len() / 2], &whole[..5], &bent] {
        std::fs::write(&checkpoint, bytes).unwrap();
        refused(
            &mut resume(&out),
            "not whole; begin again with: coilwind run",
        );
    }
    std::fs::write(&checkpoint, &whole).unwrap();
    // (it went on as before, beside a scene that said otherwise)
    let scene = std::fs::read_to_string(out.join("scene.toml")).unwrap();
    std::fs::write(out.join("scene.toml"), format!("{scene}\n")).unwrap();
    refused(&mut resume(&out), "scene.toml is not the one that the run");
    std::fs::write(out.join("scene.toml"), &scene).unwrap();
    std::fs::write(out.join("history.csv"), "time\n0\n").unwrap();
    refused(&mut resume(&out), "history.csv is not the one");
}
/// A run went on along another table than it had begun with, without a word.
#[test]
fn a_table_that_has_changed_is_not_the_motion_of_the_run() {
    let folder = tempfile::tempdir().unwrap();
    for (key, table, other) in [
        (
            "traverse",
            "turns,y_mm\n0,0\n20,8\n",
            "turns,y_mm\n0,0\n20,9\n",
        ),
        (
            "spindle",
            "turns,share\n0,1\n20,0.5\n",
            "turns,share\n0,1\n20,0.4\n",
        ),
    ] {
        let (out, file) = (folder.path().join(key), folder.path().join("table.csv"));
        std::fs::write(&file, table).unwrap();
        let mut command = short(&out);
        let mode = if key == "traverse" {
            "table"
        } else {
            "by-angle"
        };
        for setting in [
            format!("traverse.mode={mode}"),
            format!("{key}.file={}", file.display()),
        ] {
            command.args(["--set", &setting]);
        }
        command.args(["--checkpoint-every", "0.02"]);
        let mut child = command.spawn().unwrap();
        wait_for_checkpoint(&out);
        child.kill().unwrap();
        child.wait().unwrap();
        std::fs::write(&file, other).unwrap();
        let told = format!(
            "the table in {} ({key}.file) is not the one",
            file.display()
        );
        refused(&mut resume(&out), &told);
        std::fs::write(&file, table).unwrap();
        assert!(resume(&out).status().unwrap().success());
    }
}

/// A full disk was bad input, and nothing said that the run could go on.
#[test]
fn a_run_that_a_full_disk_ends_says_how_it_goes_on() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    std::fs::create_dir(&out).unwrap();
    let full = out.join("turns.csv");
    std::os::unix::fs::symlink("/dev/full", &full).unwrap();
    let output = short(&out).output().unwrap();
    assert_eq!(output.status.code(), Some(3), "{}", said(&output));
    let command = format!(
        "make room, then go on with: coilwind run --resume {}",
        out.display()
    );
    for part in ["No space left", "turns.csv", &command] {
        assert!(said(&output).contains(part), "{part}: {}", said(&output));
    }
    std::fs::remove_file(&full).unwrap();
    let output = resume(&out).output().unwrap();
    assert!(output.status.success(), "{}", said(&output));
}

/// A page could not be made from damaged files, and the command that was to mend it refused.
#[test]
fn a_damaged_run_that_has_ended_is_to_begin_again() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let run = |more: &[&str]| {
        let mut command = of_a_moment(&out);
        command.arg("--no-report").args(more).output().unwrap()
    };
    // One frame at each row of the history at most: more were left out without a word.
    let output = run(&["--frames", "1000000"]);
    assert!(output.status.success(), "{}", said(&output));
    let kept = std::fs::read_dir(out.join("frames")).unwrap().count();
    let line = format!("warning: {kept} of 1000000 frames are kept, one at each row");
    assert!(said(&output).contains(&line), "{kept}: {}", said(&output));

    let history = std::fs::read_to_string(out.join("history.csv")).unwrap();
    let damaged = history.replace("\n0,", "\nzero,");
    assert_ne!(damaged, history);
    std::fs::write(out.join("history.csv"), damaged).unwrap();
    let output = coilwind().arg("report").arg(&out).output().unwrap();
    assert_eq!(output.status.code(), Some(2), "{}", said(&output));
    let command = format!(
        "begin again with: coilwind run {}/scene.toml",
        out.display()
    );
    assert!(said(&output).contains(&command), "{}", said(&output));
    assert!(!said(&output).contains("--resume"), "{}", said(&output));
}

/// The list of frames named files that were gone, and no film could be made of the others.
#[test]
fn frames_that_are_gone_are_told_and_listed_no_more() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let mut run = coilwind();
    run.args([
        "run",
        "fig8",
        "--quiet",
        "--frames",
        "60",
        "--checkpoint-every",
        "0.02",
    ]);
    run.args([
        "--set",
        "spindle.turns=12",
        "--set",
        "solver.spacing_near_mm=0.8",
    ]);
    let mut child = run.arg("--out").arg(&out).spawn().unwrap();
    let first = out.join("frames/frame_0001.vtp");
    while !first.exists() {
        std::thread::sleep(Duration::from_millis(5));
    }
    std::thread::sleep(Duration::from_millis(300));
    child.kill().unwrap();
    child.wait().unwrap();
    std::fs::remove_file(&first).unwrap();
    let mut resume = coilwind();
    let output = resume.args(["run", "--resume"]).arg(&out).output().unwrap();
    assert!(output.status.success(), "{}", said(&output));
    let line = "warning: 59 of 60 frames are kept: 1 were gone when the run went on";
    assert!(said(&output).contains(line), "{}", said(&output));
    let list = std::fs::read_to_string(out.join("frames.pvd")).unwrap();
    assert!(
        list.contains("frame_0060.vtp") && !list.contains("frame_0001.vtp"),
        "{list}"
    );
}

/// The command that was told wound the scene's own motion, to its end and without frames.
#[test]
fn a_run_that_begins_again_takes_its_inputs_its_end_and_its_frames() {
    let folder = tempfile::tempdir().unwrap();
    let place = folder.path().join("it's here");
    std::fs::create_dir(&place).unwrap();
    let inputs = "time,spindle_speed\n0,0\n0.004,90\n0.03,90\n";
    std::fs::write(place.join("in puts.csv"), inputs).unwrap();
    let out = place.join("out");
    let mut run = Command::new(env!("CARGO_BIN_EXE_coilwind"));
    run.current_dir(&place)
        .args(["run", "fig8", "--quiet", "--out", "out"])
        .args(["--inputs", "in puts.csv", "--step", "0.002"])
        .args(["--stop-time", "0.01", "--frames", "3"]);
    let output = run.output().unwrap();
    assert!(output.status.success(), "{}", said(&output));
    // The summary has the name of the scene's file.
    let results = || {
        let mut files = files(&out);
        files.retain(|(name, _)| name != "summary.json");
        files
    };
    let wound = results();
    assert!(out.join("frames.pvd").is_file());

    std::fs::write(out.join("history.csv"), "time\nzero\n").unwrap();
    let output = coilwind().arg("report").arg(&out).output().unwrap();
    assert_eq!(output.status.code(), Some(2), "{}", said(&output));
    let said_all = said(&output);
    let (_, command) = said_all.split_once("begin again with: coilwind ").unwrap();
    let line = format!("{} {command}", env!("CARGO_BIN_EXE_coilwind"));
    // In another folder, and in a shell.
    let again = Command::new("sh")
        .current_dir("/")
        .args(["-c", &line])
        .output()
        .unwrap();
    assert!(again.status.success(), "{line}: {}", said(&again));
    assert!(results() == wound);
}

/// `run scene.toml --out .` said that the folder held another run, and `--force`, as it advised, replaced the only copy of the scene.
#[test]
fn a_scene_of_ones_own_is_not_overwritten() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("scene.toml");
    let own = "# my own\n[spindle]\nturns = 0.02\nramp_turns = 0.01\n";
    std::fs::write(&scene, own).unwrap();
    let run = |force: &[&str]| {
        let mut command = coilwind();
        command.args(["run", "--quiet", "--no-report", "scene.toml", "--out", "."]);
        command.args(force).current_dir(folder.path());
        command
    };
    for force in [&[][..], &["--force"]] {
        refused(&mut run(force), "would be lost");
        assert_eq!(std::fs::read_to_string(&scene).unwrap(), own);
    }
    // the scene that a run has kept may be wound again in its place
    let out = folder.path().join("out");
    let first = coilwind()
        .args(["run", "--quiet", "--no-report"])
        .args([scene.as_os_str(), "--out".as_ref(), out.as_os_str()])
        .status();
    assert!(first.unwrap().success());
    let again = coilwind()
        .args([
            "run",
            "--quiet",
            "--no-report",
            "scene.toml",
            "--out",
            ".",
            "--force",
        ])
        .current_dir(&out)
        .status();
    assert!(again.unwrap().success());
}
