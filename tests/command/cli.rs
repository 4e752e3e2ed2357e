//! The command through its front door: exit codes, messages and the files left behind.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::{Command, Output};

fn coilwind(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_coilwind"));
    command.args(arguments);
    command
}

fn finished(command: &mut Command, code: i32) -> Output {
    let output = command.output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(code), "{said}");
    output
}

/// What a command that exits with this code writes to standard error.
fn complaint(arguments: &[&str], code: i32) -> String {
    String::from_utf8(finished(&mut coilwind(arguments), code).stderr).unwrap()
}

/// A table by column; every cell must be a number.
fn read_csv(path: &Path) -> BTreeMap<String, Vec<f64>> {
    let mut reader = csv::Reader::from_path(path).unwrap();
    let names: Vec<String> = reader
        .headers()
        .unwrap()
        .iter()
        .map(str::to_owned)
        .collect();
    let mut columns: BTreeMap<String, Vec<f64>> = names
        .iter()
        .map(|name| (name.clone(), Vec::new()))
        .collect();
    for record in reader.records() {
        for (name, cell) in names.iter().zip(record.unwrap().iter()) {
            columns.get_mut(name).unwrap().push(cell.parse().unwrap());
        }
    }
    columns
}

fn json(path: &Path) -> serde_json::Value {
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

/// A twentieth of a turn on coarse wire: enough to move, over in a moment.
const SHORT: [&str; 8] = [
    "--set",
    "spindle.turns=0.05",
    "--set",
    "spindle.ramp_turns=0.02",
    "--set",
    "solver.spacing_near_mm=2",
    "--set",
    "solver.spacing_free_mm=4",
];

fn short_run(out: &Path, more: &[&str]) -> Command {
    let mut command = coilwind(&["run", "fig8", "--out", out.to_str().unwrap()]);
    command.args(SHORT).args(more);
    command
}

#[test]
fn check_says_valid_or_where_it_is_wrong() {
    let output = finished(&mut coilwind(&["check", "fig8"]), 0);
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(
        said.starts_with("fig8: valid; table1 wire of 0.7 mm at 15 N"),
        "{said}"
    );

    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("bad.toml");
    let scene = scene.to_str().unwrap();
    std::fs::write(scene, "[core]\n\ncorner_radius_mm = 7\n").unwrap();
    let said = complaint(&["check", scene], 2);
    for part in ["bad.toml:3", "core.corner_radius = 0.007 m", "0 to 0.006 m"] {
        assert!(said.contains(part), "{said}");
    }
    let said = complaint(&["check", scene, "--set", "core.corner_radius_mm=1"], 0);
    assert_eq!(said, "");
}

#[test]
fn bad_input_exits_with_two() {
    for (arguments, part) in [
        (&["run", "fig9"][..], "did you mean fig8?"),
        (
            &["run", "fig8", "--set", "wire.diametr=1"],
            "did you mean wire.diameter?",
        ),
        (&["run", "fig8", "--set", "wire.diameter"], "NAME=VALUE"),
        (&["run", "fig8", "--inputs", "x.csv"], "--step"),
        (
            &["run", "fig8", "--inputs", "no-such.csv", "--step", "1e-4"],
            "no-such.csv",
        ),
        (
            &["run", "fig8", "--inputs", "x.csv", "--step", "0"],
            "a number above 0",
        ),
        (
            &[
                "run",
                "fig8",
                "--set",
                "solver.step=1e-3",
                "--set",
                "solver.integrator=verlet",
            ],
            "solver.step",
        ),
        (
            &["run", "fig8", "--set", "solver.tolerance=0.1"],
            "0 to 0.001 m",
        ),
        (
            &["run", "fig8", "--set", "solver.spacing_near_mm=100"],
            "0 to 0.05 m",
        ),
        (&["wind"], "unrecognized subcommand"),
    ] {
        let said = complaint(arguments, 2);
        assert!(said.contains(part), "{arguments:?}: {said}");
    }
}

#[test]
fn variables_lists_the_table() {
    let output = finished(&mut coilwind(&["variables", "--json"]), 0);
    let rows: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let rows = rows.as_array().unwrap();
    assert_eq!(rows.len(), coilwind::variables::table().len());
    let diameter = rows
        .iter()
        .find(|row| row["name"] == "wire.diameter")
        .unwrap();
    assert_eq!(diameter["start"], 0.0007);
    assert_eq!(diameter["displayUnit"], "mm");

    let output = finished(&mut coilwind(&["variables"]), 0);
    let text = String::from_utf8(output.stdout).unwrap();
    assert_eq!(text.lines().count(), rows.len());
    let tension = text
        .lines()
        .find(|line| line.contains("tension_setpoint "))
        .unwrap();
    assert!(tension.contains(" = 15 N "), "{tension}");
}

#[test]
fn run_leaves_its_files() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("made/on/demand");
    let output = finished(&mut short_run(&out, &["--frames", "2"]), 0);
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(said.contains("turns wound"), "{said}");

    let history = read_csv(&out.join("history.csv"));
    let time = &history["time"];
    // A twentieth of a turn is 18 degrees: a row each, and the start.
    assert_eq!(time.len(), 19);
    assert!(time.windows(2).all(|pair| pair[1] > pair[0]));
    for (row, angle) in history["spindle_angle"].iter().enumerate() {
        assert!(
            (angle.to_degrees() - row as f64).abs() < 1e-6,
            "row {row}: {angle}"
        );
    }
    assert!((history["spindle_speed"][18] - 500.0).abs() < 1e-6);
    for variable in coilwind::variables::table() {
        let choice = ["preset", "preset_number"].contains(&variable.name);
        let expected = !variable.name.contains('.') && !choice;
        assert_eq!(
            history.contains_key(variable.name),
            expected,
            "{}",
            variable.name
        );
    }

    let summary = json(&out.join("summary.json"));
    assert_eq!(summary["status"], "done");
    assert_eq!(summary["scene"], "fig8");
    assert_eq!(summary["simulated_s"].as_f64(), time.last().copied());
    let picture = std::fs::read(out.join("coil.png")).unwrap();
    assert!(picture.starts_with(b"\x89PNG\r\n\x1a\n"));
    for name in ["coil.vtp", "frames/frame_0001.vtp", "frames/frame_0002.vtp"] {
        let wire = std::fs::read_to_string(out.join(name)).unwrap();
        for array in [
            "turn",
            "frozen",
            "tension",
            "height",
            "layer",
            "gap",
            "bulge",
            "plastic_strain",
            "defect",
        ] {
            assert!(
                wire.contains(&format!("Name=\"{array}\"")),
                "{name}: {array}"
            );
        }
    }
    let listed = std::fs::read_to_string(out.join("frames.pvd")).unwrap();
    let at_the_end = format!(
        "<DataSet timestep=\"{}\" part=\"0\" file=\"frames/frame_0002.vtp\"/>",
        time[18]
    );
    assert!(listed.contains(&at_the_end), "{listed}");
    assert_eq!(listed.matches("<DataSet ").count(), 2);
    assert!(!out.join("frames/frame_0003.vtp").exists());
    let core = std::fs::read_to_string(out.join("core.vtp")).unwrap();
    assert!(core.contains("NumberOfPolys"), "{core}");
    // Nothing is at rest after a twentieth of a turn: headers only.
    let stations = std::fs::read_to_string(out.join("stations.csv")).unwrap();
    assert!(
        stations.starts_with("turn,") && stations.lines().count() == 1,
        "{stations}"
    );
    let turns = std::fs::read_to_string(out.join("turns.csv")).unwrap();
    assert!(
        turns.starts_with("turn,layer,turn_in_layer,verdict,"),
        "{turns}"
    );

    // The scene it left runs to the same history.
    let again = folder.path().join("again");
    let scene = out.join("scene.toml");
    let arguments = [
        "run",
        scene.to_str().unwrap(),
        "--quiet",
        "--out",
        again.to_str().unwrap(),
    ];
    let output = finished(&mut coilwind(&arguments), 0);
    assert!(output.stdout.is_empty() && output.stderr.is_empty());
    assert_eq!(
        std::fs::read(out.join("history.csv")).unwrap(),
        std::fs::read(again.join("history.csv")).unwrap()
    );
}

#[test]
fn inputs_are_applied_on_the_grid() {
    let folder = tempfile::tempdir().unwrap();
    let csv = folder.path().join("in.csv");
    std::fs::write(
        &csv,
        "time,spindle_speed,tension_setpoint\n0,0,12\n0.0003,60,12\n0.0003,60,10\n0.00045,60,10\n",
    )
    .unwrap();
    let out = folder.path().join("out");
    let inputs = [
        "--inputs",
        csv.to_str().unwrap(),
        "--step",
        "0.0002",
        "--quiet",
    ];
    finished(&mut short_run(&out, &inputs), 0);
    let history = read_csv(&out.join("history.csv"));
    // Grid, jump at 0.3 ms, and the end; a row shows what was held up to it.
    assert_eq!(history["time"].len(), 5);
    for (time, expected) in history["time"]
        .iter()
        .zip([0.0, 0.0002, 0.0003, 0.0004, 0.00045])
    {
        assert!((time - expected).abs() < 1e-15);
    }
    assert_eq!(history["tension_setpoint"], [12.0, 12.0, 12.0, 10.0, 10.0]);
    let speed = &history["spindle_speed"];
    assert_eq!((speed[0], speed[1], speed[3]), (0.0, 0.0, 60.0));
    assert!((speed[2] - 40.0).abs() < 1e-9);
    assert!(history["nozzle_position"].iter().all(|&y| y == 0.0));

    std::fs::write(&csv, "time,spindle_speed\n0,0\n1,5000\n").unwrap();
    let output = finished(&mut short_run(&out, &inputs), 2);
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(said.contains("in.csv:3: spindle_speed = 5000"), "{said}");
}

#[test]
fn stop_time_cuts_a_run_short() {
    let folder = tempfile::tempdir().unwrap();
    finished(
        &mut short_run(folder.path(), &["--stop-time", "4e-4", "--quiet"]),
        0,
    );
    let history = read_csv(&folder.path().join("history.csv"));
    assert_eq!(history["time"].last(), Some(&4e-4));
}

#[test]
fn defects_fail_only_where_asked() {
    let folder = tempfile::tempdir().unwrap();
    let csv = folder.path().join("in.csv");
    // The tensioner pulls harder than the wire holds.
    std::fs::write(&csv, "time,tension_setpoint\n0,60\n0.001,300\n").unwrap();
    let out = folder.path().join("out");
    let inputs = [
        "--inputs",
        csv.to_str().unwrap(),
        "--step",
        "1e-4",
        "--quiet",
        "--set",
        "tensioner.mass=0",
    ];
    finished(&mut short_run(&out, &inputs), 0);
    let mut strict = short_run(&out, &inputs);
    let output = finished(strict.args(["--fail-on-defect", "--force"]), 1);
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(said.contains("break"), "{said}");
}

/// A run that failed had the verdict of what had settled until then, such as aligned, and ended without its three lines.
///
/// Steps of half a millisecond that the solver may not shorten do not get past a corner of the core.
#[test]
fn a_run_that_fails_is_not_judged() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let mut run = coilwind(&["run", "fig8", "--set", "spindle.turns=1.2"]);
    run.args(["--set", "solver.step=5e-4", "--out"]).arg(&out);
    let output = finished(&mut run, 3);
    let summary = json(&out.join("summary.json"));
    assert_eq!(summary["status"], "failed");
    assert_eq!(summary["verdict"], "unjudged");
    let reasons = summary["reasons"].as_array().unwrap();
    let why = summary["reason"].as_str().unwrap();
    assert_eq!(reasons.len(), 1, "{reasons:?}");
    let first = reasons[0].as_str().unwrap();
    assert!(
        first.starts_with("Not judged") && first.ends_with(why),
        "{first}"
    );

    let said = String::from_utf8(output.stdout).unwrap();
    let lines: Vec<&str> = said.lines().collect();
    assert_eq!(lines.len(), 3, "verdict, why and where: {said}");
    assert!(lines[0].starts_with("verdict: unjudged;"), "{said}");
    assert_eq!(lines[1], format!("why: {first}"));
    assert!(lines[2].ends_with("report.html"), "{said}");
    let page = std::fs::read_to_string(out.join("report.html")).unwrap();
    assert!(page.contains("\"verdict\":\"unjudged\""));
}

/// A broken wire ended with status done, verdict aligned and no word.
#[test]
fn a_broken_wire_is_no_success() {
    let folder = tempfile::tempdir().unwrap();
    let csv = folder.path().join("in.csv");
    std::fs::write(&csv, "time,tension_setpoint\n0,60\n0.001,300\n").unwrap();
    let out = folder.path().join("out");
    let csv = csv.to_str().unwrap();
    let inputs = [
        "--inputs",
        csv,
        "--step",
        "1e-4",
        "--set",
        "tensioner.mass=0",
    ];
    let output = finished(&mut short_run(&out, &inputs), 0);
    let said = String::from_utf8(output.stdout).unwrap();
    let lines: Vec<&str> = said.lines().collect();
    assert_eq!(lines.len(), 3, "verdict, why and where: {said}");
    assert!(lines[0].starts_with("verdict: break;"), "{said}");
    assert!(
        lines[1].starts_with("why: The wire broke in turn 1"),
        "{said}"
    );
    assert_eq!(
        lines[2],
        format!("report: {}", out.join("report.html").display())
    );
    let summary = json(&out.join("summary.json"));
    assert_eq!(summary["verdict"], "break");
    let defect = &summary["defects"][0];
    assert_eq!(
        (&defect["kind"], &defect["turn"]),
        (&"break".into(), &1.into())
    );
    assert!(defect["time_s"].as_f64().unwrap() > 0.0 && defect["angle_deg"].is_number());
    assert_eq!(defect["place_m"].as_array().unwrap().len(), 3);
    let table = std::fs::read_to_string(out.join("defects.csv")).unwrap();
    let lines: Vec<&str> = table.lines().collect();
    let columns = "kind,turn,layer,angle_deg,time_s,size_m,size_d,found_turn,found_angle_deg";
    assert_eq!(lines[0], columns);
    assert_eq!(lines.len(), 2, "{table}");
    assert!(lines[1].starts_with("break,1,1,"), "{table}");
}

/// Slack that had passed by the end of the run let `--fail-on-defect` exit with 0.
#[test]
fn slack_that_has_passed_fails_where_asked() {
    let folder = tempfile::tempdir().unwrap();
    let csv = folder.path().join("in.csv");
    let rows = "0,15\n0.001,15\n0.002,0\n0.004,0\n0.005,15\n0.02,15\n";
    std::fs::write(&csv, format!("time,tension_setpoint\n{rows}")).unwrap();
    let out = folder.path().join("out");
    let csv = csv.to_str().unwrap();
    let inputs = ["--inputs", csv, "--step", "1e-4", "--fail-on-defect"];
    let output = finished(&mut short_run(&out, &inputs), 1);
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(said.contains("slack 1; verdict: slack"), "{said}");
    let history = read_csv(&out.join("history.csv"));
    assert_eq!(history["defect_slack"].last(), Some(&0.0), "it has passed");
    assert_eq!(history["defect_count"].last(), Some(&1.0));
}

#[cfg(unix)]
#[test]
fn an_interrupt_leaves_usable_files() {
    let folder = tempfile::tempdir().unwrap();
    let mut run = short_run(folder.path(), &["--set", "spindle.turns=500", "--quiet"])
        .spawn()
        .unwrap();
    let history = folder.path().join("history.csv");
    let rows = || std::fs::read_to_string(&history).map_or(0, |text| text.lines().count());
    let patience = std::time::Instant::now();
    while rows() < 3 && patience.elapsed().as_secs() < 60 {
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    let kill = Command::new("kill")
        .args(["-INT", &run.id().to_string()])
        .status()
        .unwrap();
    assert!(kill.success());
    assert_eq!(run.wait().unwrap().code(), Some(130));
    let time = read_csv(&history)["time"].clone();
    let summary = json(&folder.path().join("summary.json"));
    assert_eq!(summary["status"], "interrupted");
    assert_eq!(summary["simulated_s"].as_f64(), time.last().copied());
}

/// A run heeded neither while it was in a communication step, however long.
#[cfg(unix)]
#[test]
fn a_signal_ends_a_long_communication_step() {
    for signal in ["-INT", "-TERM"] {
        let folder = tempfile::tempdir().unwrap();
        let inputs = folder.path().join("inputs.csv");
        std::fs::write(&inputs, "time,spindle_speed\n0,30\n1000,30\n").unwrap();
        let mut run = coilwind(&["run", "fig8", "--step", "1000", "--quiet", "--inputs"])
            .arg(&inputs)
            .arg("--out")
            .arg(folder.path())
            .spawn()
            .unwrap();
        std::thread::sleep(std::time::Duration::from_secs(1));
        let kill = Command::new("kill")
            .args([signal, &run.id().to_string()])
            .status()
            .unwrap();
        assert!(kill.success());
        assert_eq!(run.wait().unwrap().code(), Some(130), "{signal}");
        let time = read_csv(&folder.path().join("history.csv"))["time"].clone();
        let summary = json(&folder.path().join("summary.json"));
        assert_eq!(summary["status"], "interrupted");
        assert_eq!(summary["simulated_s"].as_f64(), time.last().copied());
        assert!(time.last().copied() > Some(0.0) && time.last().copied() < Some(1000.0));
    }
}

/// The line that a benchmark prints.
fn benchmark(arguments: &[&str]) -> serde_json::Value {
    let mut command = coilwind(&["bench"]);
    let output = finished(command.args(arguments), 0);
    let text = String::from_utf8(output.stdout).unwrap();
    assert_eq!(text.lines().count(), 1, "{text}");
    serde_json::from_str(&text).unwrap()
}

#[test]
fn a_benchmark_prints_one_line_with_the_names_that_others_read() {
    let line = benchmark(&["P1", "--n", "20", "--a", "5", "--repeat", "3"]);
    for name in [
        "peer",
        "problem",
        "n",
        "dt",
        "tol",
        "error",
        "cpu_s",
        "wall_s",
        "steps",
        "iterations",
        "ok",
    ] {
        assert!(line.get(name).is_some(), "{name} in {line}");
    }
    assert_eq!(
        (&line["peer"], &line["problem"]),
        (&"coilwind".into(), &"P1".into())
    );
    assert_eq!(line["ok"], true);
    assert!(line["error"].as_f64().unwrap() < 2e-3);
    let line = benchmark(&["P5", "--n", "20"]);
    assert!(line["ns_per_node_step"].as_f64().unwrap() > 0.0, "{line}");
    assert!(
        line["ns_per_node_iteration"].as_f64().unwrap() > 0.0,
        "{line}"
    );
}

#[test]
fn a_whole_scene_is_compared_with_stored_runs() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("converged.json");
    let file = file.to_str().unwrap();
    // slow, so that the ensemble is no gamble on where the wire lands
    let coarse = ["W", "--omega", "30", "--n", "84", "--tol", "2e-5"];
    let with = |option: &'static str| [coarse.as_slice(), &[option, file]].concat();
    let stored = benchmark(&with("--store"));
    assert_eq!(stored["ok"], true, "{stored}");
    let line = benchmark(&with("--against"));
    assert_eq!(
        (&line["ok"], &line["scene"]),
        (&true.into(), &"fig8".into())
    );
    assert!(line["turns"].as_f64().unwrap() > 2.0);
    // a member of the ensemble by all but a few hundredths of a millimetre
    for (name, most) in [
        ("bulge_error_m", 0.5e-3),
        ("gap_error_m", 0.5e-3),
        ("tension_error_N", 20.0),
    ] {
        assert!(line[name].as_f64().unwrap() < most, "{name} in {line}");
    }
    for name in ["rtf", "nodes_mean", "worst_ms_cpu_s", "omega"] {
        assert!(line[name].as_f64().unwrap() > 0.0, "{name} in {line}");
    }
    let other = complaint(&["bench", "W", "--scene", file], 2);
    assert!(other.contains(file), "{other}");
    let garbled = folder.path().join("garbled.json");
    std::fs::write(&garbled, "{\"scene\": 3}").unwrap();
    let said = complaint(&["bench", "W", "--against", garbled.to_str().unwrap()], 2);
    assert!(
        said.contains("garbled.json") && said.contains("converged runs"),
        "{said}"
    );
}

#[test]
fn a_benchmark_that_makes_no_sense_is_bad_input() {
    let wrong: [(&[&str], &str); 11] = [
        (&["P9"], "P9"),
        (&["P1", "--integrator", "verlet"], "implicit"),
        (&["P3", "--integrator", "rk4"], "implicit"),
        (&["P2", "--integrator", "verlet", "--tol", "1e-6"], "--tol"),
        (&["P2", "--integrator", "rk4", "--dt", "1e-3"], "unstable"),
        (&["P1", "--n", "1"], "4 to 20000"),
        (&["P1", "--a", "500"], "0.01 to 20"),
        (&["P2", "--dt=-1"], "a number above 0"),
        (&["P1", "--repeat", "0"], "--repeat"),
        (&["P5", "--omega", "30"], "P4 and W"),
        (&["W", "--scene", "fig9"], "fig8"),
    ];
    for (arguments, expected) in wrong {
        let said = complaint(&[&["bench"], arguments].concat(), 2);
        assert!(said.contains(expected), "{arguments:?}: {said}");
    }
}

/// The same lines and tables whatever the number of threads.
#[test]
fn stress_does_not_depend_on_threads() {
    let folder = tempfile::tempdir().unwrap();
    let run = |threads: &str| {
        let out = folder.path().join(threads);
        let out = out.to_str().unwrap();
        let arguments = [
            "stress", "--count", "6", "--seed", "4", "--quiet", "--out", out,
        ];
        let mut command = coilwind(&[&arguments[..], &["--threads", threads]].concat());
        let output = command.output().unwrap();
        (
            output.status.code(),
            String::from_utf8(output.stdout).unwrap(),
        )
    };
    let (one, three) = (run("1"), run("3"));
    assert_eq!(one, three);
    assert_eq!(one.0, Some(0), "{}", one.1);
    assert_eq!(one.1.lines().take(6).count(), 6);
    assert!(one.1.ends_with("0 broke an invariant\n"), "{}", one.1);
    let table = std::fs::read_to_string(folder.path().join("1/stability.md")).unwrap();
    assert!(table.contains("| wire diameter, mm |"), "{table}");
}
