//! Turns in their places beside holes, low rims and climbs, which were told as defects.

use coilwind::measure::{Defect, DefectKind};
use coilwind::settings::{NozzleFollows, SceneSettings};
use coilwind::simulation::Simulation;
use std::f64::consts::TAU;
use std::path::Path;

/// Defects of so many turns of a scene of its own motion, whose table, if it has one, is in `folder`.
fn told(text: &str, folder: &Path, turns: f64) -> Vec<Defect> {
    let settings = SceneSettings::from_toml_str(text, "coil.toml", folder).expect("reads");
    let (scene, _) = settings.build_for(NozzleFollows::Law).expect("a scene");
    let mut sim = Simulation::new(&scene).expect("starts");
    let end = sim.motion_profile().time_at(turns * TAU);
    sim.advance_profile(end).expect("winds");
    sim.defects()
}

fn kinds(defects: &[Defect]) -> Vec<(DefectKind, u32)> {
    defects.iter().map(|d| (d.kind, d.turn)).collect()
}

/// The turn after one that sank into a hole of the layer below lies in its groove, and high over the sunken one: it was a double turn.
#[test]
fn a_turn_beside_a_sunken_one_is_no_double_turn() {
    let folder = tempfile::tempdir().unwrap();
    // the fourth of six places of the first layer is left out
    let places = [
        -1.4, -0.89, -0.38, 0.64, 1.15, 1.4, 0.89, 0.38, -0.13, -0.64,
    ];
    let rows = places.iter().enumerate().map(|(turn, y)| {
        let turn = turn as f64;
        format!("{turn},{y}\n{},{y}\n", turn + 0.875)
    });
    let table = format!("turns,y_mm\n{}", rows.collect::<String>());
    std::fs::write(folder.path().join("way.csv"), table).unwrap();
    let defects = told(
        "[wire]\ndiameter_mm = 0.5\n[core]\nwidth_x_mm = 20\nheight_z_mm = 10\ncorner_radius_mm = 1\n\
         flange.inner_distance_mm = 3.3\nflange.height_mm = 3\n[nozzle]\ndistance_mm = 20\n[spindle]\nspeed = 100\n\
         [tensioner]\ntension = 8\n[traverse]\nmode = 'table'\nfile = 'way.csv'\n",
        folder.path(),
        9.875,
    );
    let found = kinds(&defects);
    assert!(found.contains(&(DefectKind::Gap, 4)), "{found:?}");
    assert!(
        found.iter().all(|(kind, _)| *kind == DefectKind::Gap),
        "{found:?}"
    );
}

/// Above the rim there was no flange, and wire that lies between it and the turn before had risen out of its row.
#[test]
fn a_turn_on_the_edge_of_a_rim_has_climbed_by_plan() {
    for height in [1.25, 1.35] {
        let scene = format!(
            "[wire]\ndiameter_mm = 1\n[core]\nwidth_x_mm = 20\nheight_z_mm = 20\ncorner_radius_mm = 3\n\
             flange.inner_distance_mm = 6.6\nflange.height_mm = {height}\n[nozzle]\ndistance_mm = 19\n[spindle]\nspeed = 50\n\
             [tensioner]\ntension = 25\n[traverse]\nmode = 'orthocyclic'\n[winding]\nlayers = 2\n"
        );
        assert_eq!(kinds(&told(&scene, Path::new(""), 8.2)), [], "{height}");
    }
}

/// Wire that comes down from the climb of its own row leans on it from the side. It was an overlap once it lay 0.87 diameters aside.
#[test]
fn wire_that_comes_down_from_a_climb_is_no_overlap() {
    let defects = told(
        "[wire]\ndiameter_mm = 1.5\nmaterial = 'copper-soft'\nenamelled_diameter_mm = 1.605\n[core]\nwidth_x_mm = 54.094\n\
         height_z_mm = 162.282\ncorner_radius_mm = 8.814\nflange.inner_distance_mm = 10.5745\nflange.height_mm = 5.136\n\
         [nozzle]\ndistance_mm = 95.794\n[spindle]\nspeed = 100\n[tensioner]\ntension = 86.0757\n\
         [traverse]\nmode = 'orthocyclic'\n[winding]\nlayers = 2\nturns_per_layer = 6\ndirection = '-y'\n",
        Path::new(""),
        8.8,
    );
    assert_eq!(kinds(&defects), []);
}
