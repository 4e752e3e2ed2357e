//! The spindle's speed over its angle: a table, a table that begins again, and slower where wire climbs to the next layer.

use coilwind::settings::SceneSettings;
use coilwind::simulation::{MotionProfile, Simulation};
use std::f64::consts::TAU;

fn settings(scene: &str, values: &[(&str, &str)]) -> SceneSettings {
    let mut settings = SceneSettings::load(scene).expect("packed");
    for (name, value) in values {
        settings.set_text(name, value).expect("a setting");
    }
    settings
}

fn profile(settings: &SceneSettings) -> MotionProfile {
    MotionProfile::new(&settings.build().expect("valid"))
}

/// Speed when so many turns are done, rad/s.
fn speed_at(profile: &MotionProfile, turns: f64) -> f64 {
    profile.speed(profile.time_at(turns * TAU))
}

/// A file of this text, and its path.
fn table(text: &str) -> (tempfile::TempDir, String) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("speed.csv");
    std::fs::write(&path, text).expect("written");
    (folder, path.display().to_string())
}

#[test]
fn a_table_limits_the_speed() {
    let (_folder, file) = table("turns,share\n0,0.5\n1,0.5\n1.5,1\n2.5,1\n");
    let profile = profile(&settings(
        "fig8",
        &[("spindle.speed", "200"), ("spindle.file", &file)],
    ));
    assert_eq!(speed_at(&profile, 0.0), 0.0);
    assert!((speed_at(&profile, 0.8) - 100.0).abs() < 1e-9);
    assert!((speed_at(&profile, 2.0) - 200.0).abs() < 1e-9);
    // constant acceleration between
    let between = 0.5 * (100.0_f64.powi(2) + 200.0_f64.powi(2));
    assert!((speed_at(&profile, 1.25).powi(2) - between).abs() < 1e-6);
}

#[test]
fn a_table_in_rpm_begins_again() {
    let (_folder, file) = table("angle_deg,speed_rpm\n0,600\n90,300\n180,600\n");
    let profile = profile(&settings(
        "fig8",
        &[
            ("spindle.speed", "500"),
            ("spindle.ramp_turns", "0.1"),
            ("spindle.file", &file),
            ("spindle.repeat_turns", "0.5"),
        ],
    ));
    for turn in [1.0, 1.5, 2.0] {
        assert!((speed_at(&profile, turn) - 10.0 * TAU).abs() < 1e-9);
        assert!((speed_at(&profile, turn + 0.25) - 5.0 * TAU).abs() < 1e-9);
    }
}

#[test]
fn the_spindle_is_slower_where_wire_climbs() {
    let settings = settings(
        "bobbin",
        &[
            ("spindle.flange_share", "0.3"),
            ("spindle.flange_turns", "2"),
        ],
    );
    let scene = settings.build().expect("valid");
    let profile = MotionProfile::new(&scene);
    let jumps = scene.nozzle_law.jumps();
    assert_eq!(jumps.len(), 3);
    let top = scene.spindle.speed;
    for jump in jumps {
        for angle in jump {
            assert!((speed_at(&profile, angle / TAU) - 0.3 * top).abs() < 1e-9);
        }
        for angle in [jump[0] - 2.01 * TAU, jump[1] + 2.01 * TAU] {
            assert!((speed_at(&profile, angle / TAU) - top).abs() < 1e-9);
        }
    }
}

#[test]
fn a_run_follows_the_profile() {
    let (_folder, file) = table("turns,share\n0,1\n0.4,1\n0.6,0.3\n0.8,1\n");
    let settings = settings(
        "fig8",
        &[
            ("spindle.speed", "100"),
            ("spindle.file", &file),
            ("spindle.turns", "1"),
        ],
    );
    let scene = settings.build().expect("valid");
    let mut simulation = Simulation::new(&scene).expect("a start");
    let profile = simulation.motion_profile().clone();
    let end = profile.end();
    for share in [0.5, 0.6, 0.8, 1.0] {
        let time = share * end;
        simulation
            .advance_profile(time - simulation.time())
            .expect("winds");
        let outputs = simulation.outputs();
        assert!((outputs.spindle_angle - profile.angle(time)).abs() < 1e-9);
    }
    assert!((simulation.outputs().spindle_angle - TAU).abs() < 1e-9);
}

#[test]
fn all_that_is_wrong_with_a_table_is_told() {
    let cases = [
        (
            "turns,share\n0,0.5\n1,0\n2,1.5\n",
            &["line 3: share is 0", "line 4: share is 1.5"][..],
        ),
        (
            "turns,share\n1,0.5\n1,x\n0.5,7\n",
            &[
                "line 2: the first angle",
                "line 3: \"x\"",
                "line 4: the angle does not rise",
                "line 4: share is 7",
            ][..],
        ),
        ("turns,rpm\n0,0.5\n", &["its columns are turns, rpm"][..]),
        ("turns,share\n0,0.5\n", &["less than two rows"][..]),
        ("", &["it is empty"][..]),
    ];
    for (text, told) in cases {
        let (_folder, file) = table(text);
        let error = settings("fig8", &[("spindle.file", &file)])
            .build()
            .expect_err("a mistake")
            .to_string();
        for part in told {
            assert!(error.contains(part), "{text:?}: {error}");
        }
        assert!(error.contains("spindle.file"), "{error}");
    }
    let (_folder, file) = table("turns,share\n0,0.5\n1,1\n");
    for (period, told) in [("0.5", "goes on to 1 turns"), ("1", "not where it begins")] {
        let values = [
            ("spindle.file", file.as_str()),
            ("spindle.repeat_turns", period),
        ];
        let error = settings("fig8", &values)
            .build()
            .expect_err("a mistake")
            .to_string();
        assert!(
            error.contains("spindle.repeat_turns") && error.contains(told),
            "{error}"
        );
    }
}

#[test]
fn a_table_with_many_mistakes_tells_the_first_and_how_many_more() {
    let rows: String = (0..20).map(|k| format!("{k},-1\n")).collect();
    let (_folder, file) = table(&format!("turns,share\n{rows}"));
    let error = settings("fig8", &[("spindle.file", &file)])
        .build()
        .expect_err("mistakes")
        .to_string();
    assert_eq!(error.matches("share is -1").count(), 5, "{error}");
    assert!(error.contains("15 more mistakes"), "{error}");
}
