//! What a run leaves where something goes wrong outside of it: no room, no rights, a kill, a second run.
#![cfg(unix)]

use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::time::Duration;

/// A run of `turns` into a folder.
fn run(folder: &Path, turns: f64) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_coilwind"));
    command.args(["run", "fig8", "--quiet", "--no-geometry"]);
    command.args(["--set", &format!("spindle.turns={turns}")]);
    command.arg("--out").arg(folder);
    command.stdout(Stdio::null()).stderr(Stdio::piped());
    command
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Holds every file of a folder to be whole, with rows as long as the header; returns the rows of the history.
fn rows(folder: &Path) -> usize {
    let mut history = 0;
    let files = |folder: &Path| std::fs::read_dir(folder).into_iter().flatten();
    for entry in files(folder).chain(files(&folder.join("frames"))) {
        let path = entry.unwrap().path();
        let ends = |end: &str| path.to_string_lossy().ends_with(end);
        assert!(!ends(".partial"), "{} is left", path.display());
        if ends(".vtp") {
            assert!(std::fs::read(&path).unwrap().ends_with(b"</VTKFile>\n"));
        }
        if path.extension().is_none_or(|e| e != "csv" && e != "json") {
            continue;
        }
        let text = std::fs::read_to_string(&path).unwrap();
        if path.extension().is_some_and(|e| e == "csv") && !text.is_empty() {
            assert!(text.ends_with('\n'), "half a line in {}", path.display());
            let mut reader = csv::Reader::from_path(&path).unwrap();
            let count = reader.records().map(Result::unwrap).count();
            if path.ends_with("history.csv") {
                history = count;
            }
        }
        if path.ends_with("summary.json") {
            let _: serde_json::Value = serde_json::from_str(&text).unwrap();
        }
    }
    history
}

fn wait_for_rows(folder: &Path, child: &mut Child) {
    let history = folder.join("history.csv");
    while !std::fs::metadata(&history).is_ok_and(|m| m.len() > 10_000) {
        assert!(child.try_wait().unwrap().is_none(), "ended before it wrote");
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// The rows of the history of a run that was killed, and every file whole but what a kill may leave: a file that had not
/// taken its place, and a cut row. Rows leave together and whole, but a kill within the write itself may stop at the end of
/// any page of the file: then the last row is a part of one.
fn rows_after_a_kill(folder: &Path) -> usize {
    let _ = std::fs::remove_file(folder.join("checkpoint.bin.partial"));
    let history = folder.join("history.csv");
    let text = std::fs::read_to_string(&history).unwrap();
    let whole = text.rfind('\n').unwrap() + 1;
    let at_a_border = text.len().is_multiple_of(PAGE);
    assert!(whole == text.len() || at_a_border, "cut within a page");
    std::fs::write(&history, &text[..whole]).unwrap();
    rows(folder)
}

/// Bytes that the system writes between two looks for a signal, at least.
const PAGE: usize = 4096;

/// `timeout` and service managers signal a program and its group at once. The second signal ended the program in the middle of what it
/// wrote, without its results.
#[test]
fn signals_that_come_at_once_end_a_run_as_one_does() {
    let folder = tempfile::tempdir().unwrap();
    let mut child = run(folder.path(), 50.0).spawn().unwrap();
    wait_for_rows(folder.path(), &mut child);
    // (by the shell itself, within milliseconds; the run may be gone before the last)
    let again = format!(
        "for k in 1 2 3 4 5 6 7 8; do kill -TERM {}; done",
        child.id()
    );
    let mut shell = Command::new("sh");
    let kill = shell.args(["-c", &again]).stderr(Stdio::null());
    kill.status().unwrap();
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130));
    assert!(said(&output).contains("what was computed so far is in"));
    assert!(folder.path().join("summary.json").is_file());
    rows(folder.path());
}

/// The history ended in the middle of a number.
#[test]
fn a_killed_run_leaves_whole_lines() {
    let folder = tempfile::tempdir().unwrap();
    let mut least = usize::MAX;
    for k in 0..6 {
        let out = folder.path().join(k.to_string());
        let mut child = run(&out, 50.0).spawn().unwrap();
        wait_for_rows(&out, &mut child);
        std::thread::sleep(Duration::from_millis(37 * k));
        child.kill().unwrap();
        child.wait().unwrap();
        least = least.min(rows_after_a_kill(&out));
    }
    assert!(least > 5, "{least} rows");
}

#[test]
fn a_full_disk_is_named() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["history.csv", "turns.csv", "stations.csv"] {
        let out = folder.path().join(name.replace('.', "-"));
        std::fs::create_dir(&out).unwrap();
        std::os::unix::fs::symlink("/dev/full", out.join(name)).unwrap();
        let output = run(&out, 0.3).output().unwrap();
        // Without a history nothing is wound; later, what was computed is on disk.
        let code = if name == "history.csv" { 2 } else { 3 };
        assert_eq!(
            output.status.code(),
            Some(code),
            "{name}: {}",
            said(&output)
        );
        assert!(said(&output).contains("No space left"), "{}", said(&output));
        assert!(said(&output).contains(name), "{}", said(&output));
    }
}

/// A sweep told a full disk as bad input, and an ensemble named the member alone that had met it.
#[test]
fn sweeps_and_ensembles_say_how_to_go_on_after_a_full_disk() {
    let folder = tempfile::tempdir().unwrap();
    let said_by = |out: &str, start: &[&str]| {
        let mut inner = Command::new(env!("CARGO_BIN_EXE_coilwind"));
        inner.args(start).args(["--set", "spindle.turns=0.4"]);
        inner.arg("--out").arg(folder.path().join(out));
        let inner = as_typed(&inner);
        let line = format!("ulimit -f 8; {inner}");
        let output = Command::new("bash").args(["-c", &line]).output().unwrap();
        assert_eq!(output.status.code(), Some(3), "{out}: {}", said(&output));
        said(&output)
    };
    let place = |out: &str| folder.path().join(out).display().to_string();
    let over = ["sweep", "fig8", "--over", "tensioner.tension=10:20:120"];
    let told = said_by("sweep", &over);
    let goes_on = format!("make room, then go on with: coilwind {}", over.join(" "));
    assert!(told.contains(&goes_on), "{told}");
    let told = said_by(
        "ensemble",
        &["run", "fig8", "--ensemble", "3", "--no-geometry"],
    );
    let goes_on = format!("go on with: coilwind run --resume {}", place("ensemble"));
    assert!(told.trim_end().ends_with(&goes_on), "{told}");
}

/// A sweep that had no room for what it is ended as on bad input, without what to do.
#[test]
fn a_sweep_that_cannot_begin_on_a_full_disk_says_how_to_begin() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let mut inner = Command::new(env!("CARGO_BIN_EXE_coilwind"));
    inner.args(["sweep", "fig8", "--over", "tensioner.tension=10:20:2"]);
    inner.args([
        "--set",
        "spindle.turns=0.05",
        "--set",
        "spindle.ramp_turns=0.02",
    ]);
    inner.args(["--quiet", "--out"]).arg(&out);
    let inner = as_typed(&inner);
    let line = format!("ulimit -f 1; {inner}");
    let output = Command::new("bash").args(["-c", &line]).output().unwrap();
    let told = said(&output);
    assert_eq!(output.status.code(), Some(3), "{told}");
    let (_, words) = inner.split_once(' ').unwrap();
    for part in [
        "sweep.json",
        "File too large",
        &format!("make room, then go on with: coilwind {words}"),
    ] {
        assert!(told.contains(part), "{part}: {told}");
    }
    // With room, the command that was told is enough.
    let output = Command::new("bash").args(["-c", &inner]).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
}

/// A command as one types it, for a shell to run under limits.
fn as_typed(command: &Command) -> String {
    let words = std::iter::once(command.get_program()).chain(command.get_args());
    let words: Vec<String> = words.map(|w| w.to_string_lossy().into_owned()).collect();
    words.join(" ")
}

/// Files may not grow beyond a limit, as on a disk that is full by then. The signal for it ended the program without a word.
/// What is there can be read: the history up to a whole row, other files whole or not at all.
#[test]
fn a_limit_on_the_size_of_files_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let mut inner = Command::new(env!("CARGO_BIN_EXE_coilwind"));
    inner.args(["run", "fig8", "--quiet", "--force", "--frames", "3"]);
    inner
        .args(["--set", "spindle.turns=0.9", "--out"])
        .arg(&out);
    let inner = as_typed(&inner);
    let mut most = 0;
    // kB: less than a row, a few rows, many rows, the coil, its picture
    for limit in [1, 8, 70, 250, 600] {
        let line = format!("ulimit -f {limit}; {inner}");
        let output = Command::new("bash").args(["-c", &line]).output().unwrap();
        let code = if limit == 1 { 2 } else { 3 };
        assert_eq!(
            output.status.code(),
            Some(code),
            "{limit}: {}",
            said(&output)
        );
        let told = said(&output);
        assert!(told.contains("File too large"), "{limit}: {told}");
        most = most.max(rows(&out));
        if out.join("summary.json").exists() {
            let mut report = Command::new(env!("CARGO_BIN_EXE_coilwind"));
            report.arg("report").arg(&out);
            let report = report.output().unwrap();
            assert!(report.status.success(), "{limit}: {}", said(&report));
            let again = format!(
                "ulimit -f 8; {} report {}",
                env!("CARGO_BIN_EXE_coilwind"),
                out.display()
            );
            let full = Command::new("bash").args(["-c", &again]).output().unwrap();
            assert_eq!(full.status.code(), Some(3), "{limit}: {}", said(&full));
        }
    }
    assert!(most > 5, "{most} rows");
}

/// Whoever may write everywhere passes.
#[test]
fn a_folder_that_may_not_be_written_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let closed = folder.path().join("closed");
    // not a folder: nobody may write into it, the superuser included
    std::fs::write(&closed, "").unwrap();
    let output = run(&closed.join("out"), 0.3).output().unwrap();
    assert_eq!(output.status.code(), Some(2), "{}", said(&output));
    assert!(said(&output).contains("closed"), "{}", said(&output));
}

/// Both wrote into one file, each at places of its own.
#[test]
fn a_second_run_into_a_folder_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let mut first = run(folder.path(), 50.0).spawn().unwrap();
    wait_for_rows(folder.path(), &mut first);
    for force in [false, true] {
        let mut second = run(folder.path(), 0.3);
        let second = second.args(force.then_some("--force")).output().unwrap();
        assert_eq!(second.status.code(), Some(2), "{}", said(&second));
        assert!(said(&second).contains("another run"), "{}", said(&second));
    }
    assert!(first.try_wait().unwrap().is_none());
    assert!(
        folder.path().join("checkpoint.bin").exists(),
        "it was left alone"
    );
    first.kill().unwrap();
    first.wait().unwrap();
    assert!(rows_after_a_kill(folder.path()) > 5);
    // the folder is free again
    let third = run(folder.path(), 0.3).arg("--force").output().unwrap();
    assert!(third.status.success(), "{}", said(&third));
    assert!(rows(folder.path()) > 5);
}

/// Too little memory ends a run with words, and what it wrote before can be read.
#[test]
fn too_little_memory_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let mut inner = run(&out, 2.0);
    inner.arg("--force");
    let inner = as_typed(&inner);
    for kilobytes in [30_000, 40_000, 60_000] {
        let line = format!("ulimit -v {kilobytes}; exec {}", inner);
        let output = Command::new("bash").args(["-c", &line]).output().unwrap();
        let text = said(&output);
        let named = text.contains("memory") || text.contains("Resource temporarily unavailable");
        assert!(
            output.status.success() || named,
            "{:?}: {text}",
            output.status
        );
        if out.exists() {
            rows(&out);
        }
    }
}

/// A run that was killed and gone on with forgot that defects were to fail it, and that no page was wanted.
#[test]
fn a_run_that_goes_on_keeps_what_was_asked_for_at_its_end() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let mut first = Command::new(env!("CARGO_BIN_EXE_coilwind"));
    first.args(["run", "fig8", "--quiet", "--fail-on-defect", "--no-report"]);
    first.args(["--set", "spindle.speed=100", "--set", "spindle.turns=2.5"]);
    first.args(["--set", "traverse.per_turn_mm=1.2", "--checkpoint-every"]);
    first.arg("0.02").arg("--out").arg(&out);
    let mut child = first.spawn().unwrap();
    while !out.join("checkpoint.bin").is_file() {
        assert!(child.try_wait().unwrap().is_none(), "ended too soon");
        std::thread::sleep(Duration::from_millis(2));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    let mut on = Command::new(env!("CARGO_BIN_EXE_coilwind"));
    let output = on.args(["run", "--quiet", "--resume"]).arg(&out).output();
    let output = output.unwrap();
    assert_eq!(output.status.code(), Some(1), "{}", said(&output));
    assert!(out.join("turns.csv").is_file() && !out.join("report.html").exists());
}
