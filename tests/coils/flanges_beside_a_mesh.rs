//! Flanges by key beside a core from an STL file, against the same bobbin by formula.

use crate::bobbin::{DIAMETER, STRAIGHT, TURNS, small_bobbin};
use crate::stl::write_revolved;
use coilwind::measure::STATIONS_PER_TURN;
use coilwind::settings::SceneSettings;
use coilwind::simulation::Simulation;
use std::f64::consts::TAU;
use std::path::Path;

/// Facets lie at most 0.2 um inside of the barrel's 6 mm.
const SIDES: usize = 360;
/// Heights may differ by this, m rms.
const SAME: f64 = 20e-6;
/// Into the second layer.
const WOUND: f64 = TURNS as f64 + 3.5;

/// The small bobbin with its barrel from a file, `half` its length, mm.
fn with_barrel(folder: &Path, half: f64) -> SceneSettings {
    write_revolved(
        &folder.join("barrel.stl"),
        &[[-half, 6.0], [half, 6.0]],
        SIDES,
    );
    let text = small_bobbin(3, 20.0).replace(
        "shape = 'cylinder'\nradius_mm = 6",
        "shape = 'mesh'\nfile = 'barrel.stl'",
    );
    SceneSettings::from_toml_str(&text, "bobbin.toml", folder).expect("reads")
}

fn wound(settings: &SceneSettings) -> Simulation {
    let mut sim = Simulation::new(&settings.build().expect("a scene")).expect("starts");
    let end = sim.motion_profile().time_at(WOUND * TAU);
    sim.advance_profile(end).expect("the run goes on");
    sim
}

#[test]
fn a_barrel_between_flanges_winds_as_the_bobbin_does() {
    let folder = tempfile::tempdir().expect("a folder");
    let by_formula =
        SceneSettings::from_toml_str(&small_bobbin(3, 20.0), "bobbin.toml", Path::new(""))
            .expect("reads");
    // the barrel ends within the flanges, or goes on beyond them
    for half in [3.0, 5.0] {
        let sims = [by_formula.clone(), with_barrel(folder.path(), half)].map(|s| wound(&s));
        let (mut sum, mut count, mut highest) = (0.0, 0, 0.0_f64);
        let stations = sims[0].coil().stations().zip(sims[1].coil().stations());
        for (k, (a, b)) in stations.enumerate() {
            // crossovers are where they are to a degree or two
            if a.measured && b.measured && STRAIGHT.contains(&(k % STATIONS_PER_TURN)) {
                sum += (a.height - b.height).powi(2);
                count += 1;
                highest = highest.max(b.height);
            }
        }
        let off = (sum / f64::from(count)).sqrt();
        println!("{half} mm: {:.2} um rms over {count} stations", 1e6 * off);
        assert!(count > 600, "{count}");
        assert!(off < SAME, "{off} m");
        assert!(highest > 0.8 * DIAMETER, "no second layer: {highest} m");
        for (a, b) in sims[0].turns().iter().zip(sims[1].turns()) {
            if a.settled == 1.0 && b.settled == 1.0 {
                assert_eq!(
                    (a.layer, a.verdict),
                    (b.layer, b.verdict),
                    "turn {}",
                    a.turn
                );
            }
        }
        let [depth, deep] = sims.map(|sim| sim.summary().penetration.largest_over_d);
        assert!(deep < 0.02, "{depth} and {deep} diameters deep");
    }
}

#[test]
fn a_mesh_that_ends_before_the_flanges_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let refused = with_barrel(folder.path(), 2.0)
        .build()
        .unwrap_err()
        .to_string();
    for word in [
        "core.flange.inner_distance",
        "ends before the flanges",
        "at most 0.004 m",
    ] {
        assert!(refused.contains(word), "{refused}");
    }
}

/// A mesh whose middle is not where the flanges' is was refused with "allowed: at most -0 m".
#[test]
fn a_mesh_that_lies_beside_the_flanges_is_told_where_they_stand() {
    let folder = tempfile::tempdir().expect("a folder");
    let settings = with_barrel(folder.path(), 20.0);
    let outline = [[0.0, 6.0], [40.0, 6.0]];
    write_revolved(&folder.path().join("barrel.stl"), &outline, SIDES);
    let refused = settings.build().unwrap_err().to_string();
    let half = 1e3 * 0.5 * settings.core.flange.inner_distance;
    for word in [
        "core.flange.inner_distance",
        "it reaches from 0 to 0.04 m",
        "a mesh with its middle at y = 0",
    ] {
        assert!(refused.contains(word), "{refused}");
    }
    assert!(
        refused.contains("which stand at y = -"),
        "{half} mm: {refused}"
    );
}

/// The room to a flange was that to the outer end of a mesh whose flanges are its own.
#[test]
fn the_room_to_a_flange_of_a_mesh_is_that_to_its_inner_face() {
    let folder = tempfile::tempdir().expect("a folder");
    let outline = [
        [-3.0, 9.0],
        [-2.0, 9.0],
        [-2.0, 6.0],
        [2.0, 6.0],
        [2.0, 9.0],
        [3.0, 9.0],
    ];
    write_revolved(&folder.path().join("own.stl"), &outline, SIDES);
    let text = "wire.diameter_mm = 0.4\ntensioner.tension = 6\ncore.shape = 'mesh'\ncore.file = 'own.stl'\n\
        nozzle.distance_mm = 20\nnozzle.y_start_mm = -1.8\nstart.clamp_y_mm = -1.8\nspindle.speed = 60\n\
        traverse.mode = 'orthocyclic'\nwinding.layers = 1\nsolver.tolerance = 8e-6\n";
    let settings = SceneSettings::from_toml_str(text, "own.toml", folder.path()).expect("reads");
    let mut sim = Simulation::new(&settings.build().expect("a scene")).expect("starts");
    let half_turn = sim.motion_profile().time_at(0.6 * TAU);
    sim.advance_profile(half_turn).expect("the run goes on");
    let o = sim.outputs();
    let room = (o.layon_position + 2e-3).min(2e-3 - o.layon_position) - 0.2e-3;
    assert!(
        (o.flange_clearance - room).abs() < 5e-6 && room < 0.3e-3,
        "{} {room}",
        o.flange_clearance
    );
}
