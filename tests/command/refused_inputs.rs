//! What is given to a run beside its scene and cannot be meant: it is refused with what would do.

use std::path::Path;
use std::process::Command;

fn run(folder: &Path, more: &[&str]) -> Command {
    let mut process = Command::new(env!("CARGO_BIN_EXE_coilwind"));
    process.args(["run", "fig8", "--quiet", "--no-geometry", "--out"]);
    process.arg(folder.join("out")).args(more);
    process
}

/// What a command complains of that ends with this code.
fn complaint(mut command: Command, code: i32) -> String {
    let output = command.output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(code), "{said}");
    said
}

/// Such a run took one step to the end of its inputs and was a success.
#[test]
fn a_step_longer_than_the_run_is_refused_with_the_longest() {
    let folder = tempfile::tempdir().unwrap();
    let csv = folder.path().join("in.csv");
    std::fs::write(&csv, "time,spindle_speed\n0,1\n0.002,1\n").unwrap();
    let inputs = ["--inputs", csv.to_str().unwrap(), "--step"];
    let stop = ["--stop-time", "0.001"];
    for (more, longest) in [
        (&["1"][..], "0.002 s"),
        (&["0.0015", stop[0], stop[1]], "0.001 s"),
    ] {
        let said = complaint(run(folder.path(), &[&inputs, more].concat()), 2);
        let step = format!("--step {}", more[0]);
        assert!(said.contains(&step) && said.contains(longest), "{said}");
        assert!(!folder.path().join("out").exists());
    }
    for more in [&["0.002"][..], &["0.001", stop[0], stop[1]]] {
        let all = [&inputs, more, &["--force"]].concat();
        complaint(run(folder.path(), &all), 0);
    }
}

/// Such a run stood at its start and filled the disk.
#[test]
fn a_step_that_never_ends_is_refused_with_the_shortest() {
    let folder = tempfile::tempdir().unwrap();
    let csv = folder.path().join("in.csv");
    std::fs::write(&csv, "time,spindle_speed\n0,1\n0.002,1\n").unwrap();
    let words = ["--inputs", csv.to_str().unwrap(), "--step", "1e-30"];
    let said = complaint(run(folder.path(), &words), 2);
    assert!(said.contains("allowed: 2.0e-12 s and more"), "{said}");
    assert!(!folder.path().join("out").exists());
}

/// The reader's own words stood there: `CSV error: record 2 (line: 3, byte: 23)`.
#[test]
fn a_row_without_all_cells_is_told_with_its_columns() {
    let folder = tempfile::tempdir().unwrap();
    let csv = folder.path().join("in.csv");
    let inputs = ["--inputs", csv.to_str().unwrap(), "--step", "0.001"];
    for (row, parts) in [
        ("0.1", &["1 cell", "write the cells that are missing"][..]),
        ("0.1,1,2,3", &["4 cells", "decimal commas"]),
    ] {
        let text = format!("time,spindle_speed,tension_setpoint\n0,1,2\n{row}\n");
        std::fs::write(&csv, text).unwrap();
        let said = complaint(run(folder.path(), &inputs), 2);
        assert!(!said.contains("CSV error"), "{said}");
        let columns = "in.csv:3: ";
        let wanted = "3 columns (time, spindle_speed, tension_setpoint)";
        for part in parts.iter().chain(&[columns, wanted]) {
            assert!(said.contains(part), "{part}: {said}");
        }
    }
}

/// Of two spacings the last one counted here too.
#[test]
fn a_solver_setting_of_verify_that_is_set_twice_is_refused() {
    let mut verify = Command::new(env!("CARGO_BIN_EXE_coilwind"));
    verify.args(["verify", "--set", "solver.spacing_near=1e-3"]);
    verify.args(["--set", "solver.spacing_near_mm=2"]);
    let said = complaint(verify, 2);
    assert!(
        said.contains("already given as solver.spacing_near"),
        "{said}"
    );
}

/// The last one counted, without a word.
#[test]
fn a_parameter_that_is_set_in_two_units_is_refused_with_both() {
    let folder = tempfile::tempdir().unwrap();
    for (one, other) in [
        ("spindle.speed=60", "spindle.speed_rpm=600"),
        ("wire.diameter_mm=0.5", "wire.diameter=5e-4"),
    ] {
        let sets = ["--set", one, "--set", other];
        let parts = [one.split_once('=').unwrap().0, &other.replace('=', " = ")];
        let mut commands = vec![run(folder.path(), &sets)];
        for (command, problem) in [("check", "fig8"), ("bench", "W")] {
            let mut process = Command::new(env!("CARGO_BIN_EXE_coilwind"));
            process.args([command, problem]).args(sets);
            commands.push(process);
        }
        for command in commands {
            let said = complaint(command, 2);
            assert!(parts.iter().all(|part| said.contains(part)), "{said}");
            assert_eq!(said.lines().count(), 1, "{said}");
        }
    }
}

/// A script adds a value of its own to the options of another.
#[test]
fn of_one_name_that_is_set_twice_the_last_value_counts() {
    let folder = tempfile::tempdir().unwrap();
    let sets = ["9", "0.02"].map(|turns| format!("spindle.turns={turns}"));
    let mut command = run(folder.path(), &["--set", "spindle.ramp_turns=0.01"]);
    command.args(["--set", &sets[0], "--set", &sets[1]]);
    assert_eq!(complaint(command, 0), "");
    let scene = std::fs::read_to_string(folder.path().join("out/scene.toml")).unwrap();
    assert!(scene.contains("turns = 0.02"), "{scene}");
}
