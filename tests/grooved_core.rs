//! Wire in the V grooves of a drum given as STL: it touches both walls of a groove, and lies in the middle between them.

#[path = "common/stl.rs"]
mod stl;

use coilwind::measure::STATIONS_PER_TURN;
use coilwind::settings::SceneSettings;
use coilwind::simulation::Simulation;
use std::f64::consts::{SQRT_2, TAU};
use stl::write_revolved;

const SIDES: usize = 180;
const DIAMETER_MM: f64 = 0.7;
/// Of the groove's bottom.
const RADIUS_MM: f64 = 8.0;
const PITCH_MM: f64 = 0.9;
const GROOVES: usize = 3;
/// Angles between crossovers, degrees.
const STRAIGHT: std::ops::Range<usize> = 60..240;

/// Middle of a groove, mm.
fn middle(groove: usize) -> f64 {
    (groove as f64 - 0.5 * (GROOVES - 1) as f64) * PITCH_MM
}

/// A drum with V grooves of a right angle between flanges, as (y, radius) from end to end, mm.
fn outline() -> Vec<[f64; 2]> {
    let crest = RADIUS_MM + 0.5 * PITCH_MM;
    let end = 0.5 * GROOVES as f64 * PITCH_MM;
    let rim = RADIUS_MM + 3.0;
    let mut points = vec![[-end - 1.5, rim], [-end, rim], [-end, crest]];
    for groove in 0..GROOVES {
        let y = middle(groove);
        points.extend([[y, RADIUS_MM], [y + 0.5 * PITCH_MM, crest]]);
    }
    points.extend([[end, rim], [end + 1.5, rim]]);
    points
}

#[test]
fn wire_lies_on_both_walls_of_a_groove() {
    let folder = tempfile::tempdir().expect("a folder");
    write_revolved(&folder.path().join("drum.stl"), &outline(), SIDES);
    let start = middle(0);
    let text = format!(
        "
[core]
shape = 'mesh'
file = 'drum.stl'
[wire]
diameter_mm = {DIAMETER_MM}
[nozzle]
distance_mm = 30
y_start_mm = {start}
[start]
clamp_y_mm = {start}
[tensioner]
tension = 15
[spindle]
speed = 100
[traverse]
mode = 'orthocyclic'
crossover_deg = 60
advance_deg = 60
[winding]
turns_per_layer = {GROOVES}
pitch_mm = {PITCH_MM}
"
    );
    let settings =
        SceneSettings::from_toml_str(&text, "grooved.toml", folder.path()).expect("reads");
    let mut sim = Simulation::new(&settings.build().expect("a scene")).expect("starts");
    let end = sim.motion_profile().time_at(2.9 * TAU);
    sim.advance_profile(end).expect("winds");

    let seat = RADIUS_MM + 0.5 * DIAMETER_MM * SQRT_2;
    // a facet is that much nearer to the axis in its middle
    let sagitta = RADIUS_MM * (1.0 - (0.5 * TAU / SIDES as f64).cos());
    let mut seen = 0;
    for (index, station) in sim.coil().stations().enumerate() {
        let (turn, degree) = (index / STATIONS_PER_TURN, index % STATIONS_PER_TURN);
        // the clamp holds the first degrees on the bottom
        if turn > 1 || !STRAIGHT.contains(&degree) {
            continue;
        }
        seen += 1;
        let p = station.position * 1e3;
        let aside = (p.y - middle(turn)).abs();
        assert!(
            aside < 0.01 * DIAMETER_MM,
            "{turn} {degree}: {aside} mm aside"
        );
        let over = p.x.hypot(p.z) - seat;
        assert!(
            over.abs() < sagitta + 0.005 * DIAMETER_MM,
            "{turn} {degree}: {over} mm above its seat"
        );
    }
    assert_eq!(seen, 2 * STRAIGHT.len());
}
