//! Enamelled wire: what touches is the outer diameter, what bends, stretches and conducts is the bare one.

use crate::bobbin::{DIAMETER as OUTER, STRAIGHT, TURNS, small_bobbin};
use coilwind::measure::STATIONS_PER_TURN;
use coilwind::scene::Section;
use coilwind::settings::SceneSettings;
use coilwind::simulation::Simulation;
use std::f64::consts::{PI, TAU};
use std::path::Path;

const BARE: f64 = 0.6e-3;

fn settings(wire: &str) -> SceneSettings {
    SceneSettings::from_toml_str(
        &format!("{}[wire]\n{wire}", small_bobbin(2, 15.0)),
        "bobbin.toml",
        Path::new(""),
    )
    .expect("reads")
}

fn section(wire: &str) -> Section {
    let text = format!("[tensioner]\ntension = 5\n[wire]\n{wire}");
    let settings = SceneSettings::from_toml_str(&text, "wire.toml", Path::new("")).expect("reads");
    settings.build().expect("a scene").wire
}

fn wound(wire: &str, turns: f64) -> Simulation {
    let mut sim = Simulation::new(&settings(wire).build().expect("a scene")).expect("starts");
    let end = sim.motion_profile().time_at(turns * TAU);
    sim.advance_profile(end).expect("winds");
    sim
}

#[test]
fn enamel_of_no_thickness_changes_no_bit() {
    let bare = wound("diameter_mm = 0.7", 2.3);
    let enamelled = wound("diameter_mm = 0.7\nenamelled_diameter_mm = 0.7", 2.3);
    assert_eq!(bare.scene().wire, enamelled.scene().wire);
    assert!(bare.coil().stations().eq(enamelled.coil().stations()));
    assert_eq!(
        format!("{:?}", bare.outputs()),
        format!("{:?}", enamelled.outputs())
    );
    assert_eq!(bare.product(), enamelled.product());
}

#[test]
fn mechanics_are_those_of_the_bare_wire() {
    for material in ["copper", "copper-soft", "copper-hard", "aluminium"] {
        let wire = format!("material = '{material}'\ndiameter_mm = 0.6");
        let bare = section(&wire);
        let enamelled = section(&format!("{wire}\nenamelled_diameter_mm = 0.7"));
        assert_eq!((bare.diameter, enamelled.diameter), (BARE, OUTER));
        let same = Section {
            diameter: bare.diameter,
            ..enamelled.clone()
        };
        assert_eq!(same, bare, "{material}");
        let ring = 0.25 * PI * (OUTER * OUTER - BARE * BARE);
        let more = enamelled.mass_per_length() - bare.mass_per_length();
        assert!((more / (1400.0 * ring) - 1.0).abs() < 1e-9, "{more}");
    }
}

/// The same window as wire of 0.7 mm has: turns, pitch, seat and grooves are those of the outer diameter, length and resistance
/// follow.
#[test]
fn enamelled_wire_lies_on_its_outer_diameter() {
    let sim = wound("diameter_mm = 0.6\nenamelled_diameter_mm = 0.7", 12.0);
    let law = &sim.scene().nozzle_law;
    assert_eq!(law.turns(), 12.0);
    let pitch = law.position(TAU) - law.position(0.5 * TAU);
    assert!((pitch - (4.65e-3 - OUTER) / 5.5).abs() < 1e-12, "{pitch}");

    // sqrt(d^2 - p^2/4) above the wire below: 0.866 d of touching turns, a little less of these
    let rise = (OUTER * OUTER - 0.25 * pitch * pitch).sqrt();
    let mut seen = [0; 2];
    for (index, station) in sim.coil().stations().enumerate() {
        let (turn, degree) = (index / STATIONS_PER_TURN, index % STATIONS_PER_TURN);
        let (layer, in_layer) = (turn / TURNS, turn % TURNS);
        if !STRAIGHT.contains(&degree) || in_layer == 0 || in_layer == TURNS - 1 {
            continue;
        }
        let over = station.radius() - 6e-3;
        let seat = 0.5 * OUTER + layer as f64 * rise;
        let most = [0.01, 0.05][layer];
        assert!(
            (over - seat).abs() < most * OUTER,
            "turn {}, {degree} degrees: {over} m over the core instead of {seat}",
            turn + 1
        );
        if let Some(neighbour) = station.neighbour.filter(|_| layer == 0) {
            let gap = neighbour.gap - (pitch - OUTER);
            assert!(
                gap.abs() < 0.05 * OUTER,
                "turn {}, {degree} degrees",
                turn + 1
            );
        }
        seen[layer] += 1;
    }
    assert!(seen.iter().all(|count| *count > 500), "{seen:?}");

    let product = sim.product();
    assert_eq!(product.layers, 2);
    assert_eq!(product.wire_diameter_m, BARE);
    assert_eq!(product.enamelled_diameter_m, OUTER);
    let ohm = product.wire_length_m / 58e6 / (0.25 * PI * BARE * BARE);
    assert!((product.resistance_ohm / ohm - 1.0).abs() < 1e-12);
    let window = product.window.expect("flanges make a window");
    assert_eq!((window.width_m, window.height_m), (4.65e-3, 3e-3));
    let share = product.turns * 0.25 * PI * OUTER * OUTER / (4.65e-3 * 3e-3);
    assert!((window.fill_enamelled / share - 1.0).abs() < 1e-12);
    let share = window.fill_bare / window.fill_enamelled;
    assert!((share - (BARE / OUTER).powi(2)).abs() < 1e-12);
    // as high as the two layers, and clear of the rim by the rest
    let top = OUTER + rise;
    let coil = product.coil.expect("wire");
    assert!((coil.height_m / top - 1.0).abs() < 0.03, "{coil:?}");
    let highest = product.contour.iter().map(|layer| layer.height_max_m);
    let clearance = product.clearance_m.expect("a limit");
    assert!((3e-3 - highest.fold(0.0, f64::max) - clearance).abs() < 1e-12);
}
