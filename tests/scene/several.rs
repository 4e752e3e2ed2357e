//! Scenes with more than one thing wrong, and whom a contradiction is blamed on.

use crate::common::{assert_says, parse, refused};
use coilwind::scene::SceneError;
use coilwind::settings::{NozzleFollows, SceneSettings};

/// `check` stopped at the first of these.
#[test]
fn all_that_is_wrong_is_told_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("seven.toml");
    let text = "[wire]\ndiametr_mm = 0.7\nmaterial = 'steel'\n[wier]\na = 1\n[core]\ncorner_radius_mm = 7\n\
                [friction]\nstatic = 0.1\nkinetic = 0.3\n[tensioner]\ntension = 1e9\n[start]\nclamp_y_mm = 90\n";
    std::fs::write(&scene, text).unwrap();
    let set = [("solver.tolerance_um".to_owned(), "-1".to_owned())];
    let error =
        SceneSettings::load_and_build(scene.to_str().unwrap(), &set, |_| NozzleFollows::Law)
            .expect_err("refused");
    let SceneError::Several { errors } = &error else {
        panic!("one of many: {error}");
    };
    assert_eq!(errors.len(), 8, "{error}");
    let message = error.to_string();
    assert_eq!(message.lines().count(), 8, "a line each: {message}");
    assert_says(
        &message,
        &[
            "seven.toml:2: unknown key wire.diametr_mm",
            "seven.toml:3: wire.material",
            "seven.toml:4: unknown section [wier]",
            "seven.toml:7: core.corner_radius",
            "seven.toml:10: friction.kinetic",
            "seven.toml:12: tensioner.tension",
            "seven.toml:14: start.clamp_y",
            "set by name: solver.tolerance_um = -1",
        ],
    );
}

/// Enamel that is too thin hid a wrong curve of the same wire, and both the nozzle's hole and the trail.
#[test]
fn a_wire_that_cannot_be_hides_nothing_else() {
    let wrong = refused(
        "[wire]\nstress_strain = [[0.001, 69e6], [0.0005, 80e6]]\nenamelled_diameter_mm = 0.4\n[nozzle]\nbore_mm = 0.3\n\
         [traverse]\nmode = 'orthocyclic'\ntrail = 'led'\n[winding]\nturns_per_layer = 3\n",
    );
    assert_eq!(wrong.lines().count(), 4, "{wrong}");
    assert_says(
        &wrong,
        &[
            "wire.enamelled_diameter",
            "wire.stress_strain",
            "nozzle.bore",
            "traverse.trail",
        ],
    );
}

/// A speed out of range in a file was told although `--set` gave another one.
#[test]
fn a_value_set_by_name_takes_the_place_of_a_wrong_one() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("slow.toml");
    std::fs::write(&scene, "[spindle]\nspeed = 0.001\nramp_turns = 'x'\n").unwrap();
    let built = |set: &[(&str, &str)]| {
        let set: Vec<_> = set
            .iter()
            .map(|(k, v)| (k.to_string(), v.to_string()))
            .collect();
        SceneSettings::load_and_build(scene.to_str().unwrap(), &set, |_| NozzleFollows::Law)
            .map(|(settings, ..)| settings.spindle.speed)
            .map_err(|error| error.to_string())
    };
    let both = [("spindle.speed_rpm", "600"), ("spindle.ramp_turns", "0.5")];
    assert!((built(&both).unwrap() - 62.8).abs() < 0.1);
    let one = built(&both[..1]).unwrap_err();
    assert!(
        one.contains("slow.toml:3") && !one.contains("slow.toml:2"),
        "{one}"
    );
    let wrong_too = built(&[("spindle.speed", "1e9"), both[1]]).unwrap_err();
    assert!(
        wrong_too.contains("slow.toml:2") && wrong_too.contains("1e9"),
        "{wrong_too}"
    );
}

/// Mistakes in the table of speeds were told only once everything else was right, those of the nozzle's only once the core was.
#[test]
fn tables_are_read_whatever_else_is_wrong() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        path.display().to_string()
    };
    let speeds = file("speeds.csv", "turns,share\n0,1\n2,3\n1,0.5\n");
    let way = file("way.csv", "turns,y_mm\n0,0\n3,x\n");
    let tables =
        format!("[spindle]\nfile = '{speeds}'\n[traverse]\nmode = 'table'\nfile = '{way}'\n");
    for (more, key) in [
        ("", "traverse.file"),
        (
            "[core.flange]\ninner_distance_mm = 0.3\n",
            "core.flange.inner_distance",
        ),
        ("[core]\nshape = 'mesh'\nfile = 'none.stl'\n", "core.file"),
    ] {
        let said = refused(&format!("{tables}{more}"));
        assert_says(&said, &[key, "\"x\" is no number", "spindle.file"]);
        assert!(said.matches("spindle.file").count() >= 2, "{said}");
    }
}

#[test]
fn what_is_told_together_is_what_is_told_alone() {
    let one = refused("[friction]\nstatic = 0.1\nkinetic = 0.3");
    let both = refused("[friction]\nstatic = 0.1\nkinetic = 0.3\n[start]\nclamp_y_mm = 90");
    assert!(
        both.starts_with(&one) && both.lines().count() == 2,
        "{both}"
    );
    assert_eq!(one.lines().count(), 1);
}

/// Messages named a key that nobody had given, such as the default radius of the corners.
#[test]
fn the_key_to_blame_is_one_that_was_given() {
    for (text, parts) in [
        (
            "[core]\nwidth_x_mm = 3",
            &["test.toml:2: core.width_x = 0.003 m", "at least 0.004 m"][..],
        ),
        (
            "[core]\nlength_y_mm = 0.5",
            &["test.toml:2: core.length_y = 0.0005 m", "at least 0.0007 m"],
        ),
        (
            "[spindle]\nturns = 0.001",
            &[
                "test.toml:2: spindle.turns = 0.001",
                "at least spindle.ramp_turns",
            ],
        ),
        (
            "[wire]\nyield_stress_MPa = 2000",
            &["test.toml:2: wire.yield_stress", "at most wire.flow_stress"],
        ),
    ] {
        let message = refused(text);
        assert_eq!(message.lines().count(), 1, "{message}");
        assert_says(&message, parts);
    }
}

/// The allowed interval of the spacing of the free span was empty: from the spacing near the core to less than that.
#[test]
fn a_free_span_without_room_says_what_would_make_room() {
    let message = refused("[nozzle]\ndistance_mm = 17\n[solver]\nspacing_near_mm = 2");
    assert_says(
        &message,
        &[
            "nozzle.distance = 0.017 m",
            "three edges",
            "solver.spacing_near at most",
        ],
    );
}

/// Thick wire was refused for a spacing that nobody had given.
#[test]
fn thick_wire_has_a_spacing_of_its_own() {
    let text = "[wire]\ndiameter_mm = 5\n[core]\ncorner_radius_mm = 5\n[solver]\ntolerance_um = 2";
    let scene = parse(text)
        .expect("it is read")
        .build()
        .expect("it is built");
    assert!(scene.solver.spacing_near >= 0.5e-3);
}

#[test]
fn a_key_that_the_shape_does_not_use_is_warned_of() {
    let warned = |text: &str| -> Vec<String> {
        let (_, warnings) = parse(text).unwrap().build_with_warnings().unwrap();
        warnings.iter().map(ToString::to_string).collect()
    };
    let warnings =
        warned("[core]\nshape = 'cylinder'\nradius_mm = 10\nwidth_x_mm = 12\nlength_y_mm = 30");
    assert_eq!(warnings.len(), 1, "{warnings:?}");
    assert_says(
        &warnings[0],
        &[
            "test.toml:4: core.width_x = 0.012 m",
            "core.shape = cylinder does not use it",
            "core.shape = rounded-box",
        ],
    );
    let warnings = warned("[core]\nradius_mm = 10");
    assert_says(&warnings[0], &["core.radius", "set core.shape = cylinder"]);
    assert!(warned("[core]\nwidth_x_mm = 12").is_empty());
}

/// The nozzle's way is planned on a core, and what is wrong with its counts was told only where there was one.
#[test]
fn counts_are_told_without_a_core() {
    let layers = "[winding]\nlayers = 2.5\n[traverse]\nmode = 'orthocyclic'\n";
    let alone = refused(&format!("{layers}[core]\nflange.inner_distance_mm = 9\n"));
    let both = refused(&format!("{layers}[core]\nshape = 'mesh'\n"));
    assert_eq!(alone.lines().count(), 1, "{alone}");
    assert_eq!(both.lines().count(), 2, "{both}");
    for said in [alone, both] {
        assert_says(&said, &["winding.layers = 2.5", "whole number"]);
    }
}

/// A refused leaf has its default for the checks after it: these told ranges of a wire, and places beside a core, that nobody had
/// asked for.
#[test]
fn what_only_a_default_makes_wrong_is_not_told() {
    let folder = tempfile::tempdir().unwrap();
    let told = |text: &str| -> String {
        let scene = folder.path().join("scene.toml");
        std::fs::write(&scene, text).unwrap();
        let scene = scene.to_str().unwrap();
        SceneSettings::load_and_build(scene, &[], |_| NozzleFollows::Law)
            .expect_err("refused")
            .to_string()
    };
    for (text, key) in [
        (
            "[wire]\ndiameter_mm = '0.3x'\nenamelled_diameter_mm = 0.35\n",
            "wire.diameter_mm",
        ),
        (
            "[wire]\ndiametr_mm = 0.3\nenamelled_diameter_mm = 0.35\n",
            "wire.diametr_mm",
        ),
        (
            "[core]\nshape = 'cylindr'\nradius_mm = 5\n[nozzle]\ndistance_mm = 9\n",
            "core.shape",
        ),
    ] {
        let said = told(text);
        assert_eq!(said.lines().count(), 1, "{said}");
        assert_says(&said, &[key]);
    }
    // what is wrong with any wire is told, and for which its numbers are
    let said = told(
        "[wire]\ndiameter_mm = -1\n[spindle]\nspeed = 'x'\n[core]\nlength_y_mm = 0\n[start]\nclamp_y_mm = 90\n\
         [friction]\nstatic = 0.1\nkinetic = 0.3\n",
    );
    assert_eq!(said.lines().count(), 5, "{said}");
    assert_says(
        &said,
        &[
            "0.01465 m (with wire.diameter = 0.0007 m, core.length_y = 0.03 m)",
            "at most friction.static, 0.1\n",
        ],
    );
}
