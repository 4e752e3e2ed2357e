//! `coilwind motion`: a scene's own motion as sampled inputs.

use std::path::Path;
use std::process::Command;

/// What the command writes to standard error when it ends with this code.
fn finished(arguments: &[&str], code: i32) -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_coilwind"))
        .args(arguments)
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(code), "{said}");
    said
}

fn number(folder: &str, key: &str) -> f64 {
    let text = std::fs::read_to_string(Path::new(folder).join("summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_str(&text).unwrap();
    summary[key].as_f64().unwrap()
}

/// A master that plays back the scene's own motion winds the same coil.
#[test]
fn motion_of_a_scene_as_inputs() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let set = [
        "--set",
        "spindle.turns=1.3",
        "--set",
        "solver.tolerance_um=5",
    ];
    let csv = path("motion.csv");
    let motion = ["motion", "bobbin", "--step", "1e-3", "--out", &csv];
    finished(&[&motion[..], &set[..]].concat(), 0);
    let mut table = csv::Reader::from_path(&csv).unwrap();
    let header: Vec<_> = table.headers().unwrap().iter().map(str::to_owned).collect();
    assert_eq!(header, ["time", "spindle_speed", "nozzle_position"]);
    let rows: Vec<_> = table.records().map(Result::unwrap).collect();
    assert!(rows.len() > 100, "{}", rows.len());
    assert_eq!(&rows[rows.len() - 1][1], "100");

    let (own, played) = (path("own"), path("played"));
    let run = |out| {
        [
            &["run", "bobbin", "--quiet", "--no-report", "--out", out][..],
            &set[..],
        ]
        .concat()
    };
    finished(&run(&own), 0);
    let inputs = ["--inputs", &csv, "--step", "1e-3"];
    finished(&[&run(&played)[..], &inputs[..]].concat(), 0);
    for (key, most) in [
        ("spindle_angle_rad", 1e-9),
        ("turns_wound", 1e-3),
        ("simulated_s", 1e-12),
    ] {
        let off = number(&own, key) - number(&played, key);
        assert!(off.abs() < most, "{key} differs by {off}");
    }
    for step in ["0", "-1", "1e-12", "1e9"] {
        let wrong = finished(&["motion", "bobbin", &format!("--step={step}")], 2);
        assert!(
            wrong.contains(&format!("--step {}", step.parse::<f64>().unwrap())),
            "{wrong}"
        );
    }
    let wrong = finished(&["motion", "bobbin", "--step", "0"], 2);
    assert!(
        wrong.contains("--step 0") && wrong.contains("s to the length of the motion"),
        "{wrong}"
    );
}

/// Inputs that ended before the stop time went on as they were, with the nozzle standing, and heaped up wire without a word.
#[test]
fn inputs_that_end_before_the_stop_time_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let inputs = path("inputs.csv");
    std::fs::write(&inputs, "time,spindle_speed\n0,0\n3e-4,5\n").unwrap();
    let run = |more: &[&str]| {
        let (out, own) = (path("out"), ["run", "fig8", "--no-geometry", "--no-report"]);
        let by = [
            "--force", "--inputs", &inputs, "--step", "1e-4", "--out", &out,
        ];
        finished(&[&own[..], &by, more].concat(), 0)
    };
    let told = "the inputs end at 0.0003 s; until --stop-time 0.0006 s";
    assert!(run(&["--stop-time", "6e-4"]).contains(told));
    assert!(!run(&["--stop-time", "6e-4", "--quiet"]).contains(told));
    assert!(!run(&[]).contains("--stop-time"));
}

/// A record that begins later wound from 0 on with its first row, and one that begins before lost its rows, without a word.
#[test]
fn inputs_whose_first_time_is_not_0_are_told_with_what_holds() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let inputs = path("inputs.csv");
    let run = |rows: &str, more: &[&str]| {
        let table = format!("time,spindle_speed,tension_setpoint\n{rows}");
        std::fs::write(&inputs, table).unwrap();
        let (out, own) = (path("out"), ["run", "fig8", "--no-geometry", "--no-report"]);
        let by = [
            "--force", "--inputs", &inputs, "--step", "1e-4", "--out", &out,
        ];
        finished(&[&own[..], &by, more].concat(), 0)
    };
    let late = "2e-4,5,12\n3e-4,5,12\n";
    let told = format!(
        "warning: {inputs}: the first time is 0.0002 s, and the run begins at 0 s; until then its first row holds: \
         spindle_speed = 5 rad/s, tension_setpoint = 12 N; if the record begins there, take 0.0002 s off all times"
    );
    assert!(run(late, &[]).contains(&told), "{}", run(late, &[]));
    assert!(!run(late, &["--quiet"]).contains("first time"));
    let ensemble = run(late, &["--ensemble", "2"]);
    assert!(ensemble.contains(&told), "{ensemble}");
    let early = run("-2e-4,5,12\n3e-4,5,12\n", &[]);
    assert!(
        early.contains("the first time is -0.0002 s") && early.contains("add 0.0002 s to all"),
        "{early}"
    );
    assert!(!run("0,5,12\n3e-4,5,12\n", &[]).contains("first time"));
}

/// A negative number was an unknown argument, and its range was not told.
#[test]
fn a_negative_number_is_told_its_range() {
    for (option, range) in [
        ("--stop-time", "a number above 0"),
        ("--frames", "0..=4294967295"),
    ] {
        let told = finished(&["run", "fig8", option, "-1"], 2);
        assert!(told.contains(range), "{told}");
        assert!(!told.contains("unexpected argument"), "{told}");
    }
}

/// A peak of the tension that broke the wire in short steps was not seen in long ones, without a word.
#[test]
fn rows_between_points_that_a_run_does_not_see_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let (inputs, out) = (path("inputs.csv"), path("out"));
    let run = |rows: &str, step: &str| {
        let table = format!("time,spindle_speed,tension_setpoint\n{rows}");
        std::fs::write(&inputs, table).unwrap();
        let own = ["run", "fig8", "--no-geometry", "--no-report", "--force"];
        let by = ["--inputs", &inputs, "--step", step, "--out", &out];
        finished(&[&own[..], &by].concat(), 0)
    };
    let peak = "0,5,12\n1.2e-3,5,12\n1.4e-3,6,14\n1.6e-3,7,20\n1.8e-3,8,12\n4e-3,8,12\n";
    let told = format!(
        "warning: {inputs}: 2 rows lie between points that are 0.001 s apart, and the run does not see them: most of all tension_setpoint = 20 N at 0.0016 s, where the run goes from 12 to 12 N; rows are at least 0.0002 s apart, and --step can be that"
    );
    let said = run(peak, "1e-3");
    assert!(said.contains(&told), "{said}");
    assert!(!run(peak, "2e-4").contains("does not see"));
    // a ramp that ends between points, and a jump, which has a point of its own
    let seen =
        "0,5,12\n1.3e-3,8,12\n1.6e-3,8,12\n1.6e-3,8,14\n2.2e-3,8,14\n2.2e-3,8,12\n4e-3,8,12\n";
    let said = run(seen, "1e-3");
    assert!(!said.contains("does not see"), "{said}");
}
