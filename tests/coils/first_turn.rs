//! A scene that plans layers between flanges and says nothing of places begins beside a flange.

use crate::stl::write_revolved;
use coilwind::scene::Scene;
use coilwind::settings::SceneSettings;
use std::path::Path;

const FLANGES: &str = "[core.flange]\ninner_distance_mm = 6\nheight_mm = 3\nthickness_mm = 1.5\n";
const LAYERS: &str = "[traverse]\nmode = 'orthocyclic'\n[winding]\nlayers = 2\n";

fn settings(text: &str, more: &[(&str, &str)]) -> SceneSettings {
    let mut settings =
        SceneSettings::from_toml_str(text, "own.toml", Path::new("")).expect("a scene");
    for (name, value) in more {
        settings.set_text(name, value).expect("a setting");
    }
    settings
}

/// Places of first turn and clamp, mm.
fn places(scene: &Scene) -> [f64; 2] {
    [scene.nozzle.y_start, scene.start.clamp_y].map(|y| 1e3 * y)
}

fn near(found: [f64; 2], expected: [f64; 2], what: &str) {
    let apart = (found[0] - expected[0]).hypot(found[1] - expected[1]);
    assert!(apart < 1e-6, "{what}: {found:?}");
}

#[test]
fn a_coil_without_places_begins_beside_its_flange() {
    let text = format!("{FLANGES}{LAYERS}");
    for (more, first) in [
        (&[][..], -2.65),
        (&[("winding.direction", "-y")], 2.65),
        (&[("wire.enamelled_diameter_mm", "0.8")], -2.6),
        (&[("core.flange.insulation_mm", "0.2")], -2.45),
        (&[("traverse.mode", "helical")], -2.65),
        (
            &[
                ("winding.turns_per_layer", "4"),
                ("winding.pitch_mm", "0.7"),
            ],
            -2.65,
        ),
    ] {
        let scene = settings(&text, more).build().expect("a coil");
        near(places(&scene), [first, first], &format!("{more:?}"));
        assert_eq!(scene.nozzle_law.position(0.0), scene.nozzle.y_start);
    }
}

#[test]
fn a_place_that_is_given_holds() {
    let text = format!("{FLANGES}{LAYERS}turns_per_layer = 4\npitch_mm = 0.7\n");
    let given = |more: &[(&str, &str)]| settings(&text, more).build().expect("a coil");
    // the middle of the core is a place like any other
    near(
        places(&given(&[("nozzle.y_start", "0")])),
        [0.0, 0.0],
        "first turn given",
    );
    near(
        places(&given(&[("start.clamp_y_mm", "-2")])),
        [-2.65, -2.0],
        "clamp given",
    );
    near(
        places(&given(&[
            ("nozzle.y_start_mm", "-1"),
            ("start.clamp_y", "0"),
        ])),
        [-1.0, 0.0],
        "both given",
    );
    // a nozzle that just travels begins in the middle
    near(
        places(&given(&[("traverse.mode", "by-angle")])),
        [0.0, 0.0],
        "no layers planned",
    );
    let mut in_code = settings(&text, &[]);
    in_code.nozzle.y_start = -1e-3;
    near(
        places(&in_code.build().expect("a coil")),
        [-1.0, -1.0],
        "set in code",
    );
}

/// A table says where the nozzle begins. Wire clamped in the middle crossed the place of half the turns on its way there.
#[test]
fn a_table_begins_where_the_wire_is_clamped() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(
        folder.path().join("way.csv"),
        "turns,y_mm\n0,-2.65\n7,2.25\n",
    )
    .expect("written");
    let text = format!("{FLANGES}[traverse]\nmode = 'table'\nfile = 'way.csv'\n");
    let mut settings =
        SceneSettings::from_toml_str(&text, "own.toml", folder.path()).expect("read");
    let clamp = |settings: &SceneSettings| 1e3 * settings.build().expect("a coil").start.clamp_y;
    assert!((clamp(&settings) + 2.65).abs() < 1e-9);
    settings
        .set_text("start.clamp_y_mm", "-1")
        .expect("a setting");
    assert!((clamp(&settings) + 1.0).abs() < 1e-9);
}

/// What a run leaves as its scene winds the same coil again.
#[test]
fn a_scene_without_places_is_written_without_them() {
    let settings = settings(&format!("{FLANGES}{LAYERS}"), &[]);
    let text = settings.to_toml();
    let again = SceneSettings::from_toml_str(&text, "scene.toml", Path::new("")).expect("a scene");
    let scenes = [&settings, &again].map(|s| s.build().expect("a coil"));
    assert_eq!(places(&scenes[0]), places(&scenes[1]));
}

/// A bobbin whose file has its own origin: the window is found first, then the place in it.
#[test]
fn a_mesh_away_from_the_middle_is_wound_from_its_flange() {
    let folder = tempfile::tempdir().expect("a folder");
    let outline = [
        [10.0, 9.0],
        [12.0, 9.0],
        [12.0, 6.0],
        [18.0, 6.0],
        [18.0, 9.0],
        [20.0, 9.0],
    ];
    write_revolved(&folder.path().join("own.stl"), &outline, 48);
    let text = format!("core.shape = 'mesh'\ncore.file = 'own.stl'\n{LAYERS}");
    let settings = SceneSettings::from_toml_str(&text, "own.toml", folder.path()).expect("read");
    near(
        places(&settings.build().expect("a coil")),
        [12.35, 12.35],
        "mesh",
    );
}
