//! Wire in the grooves of a drum given as STL. It touches both walls of a V groove, and lies in the middle between them; in a
//! flat groove of its own width it has three walls beside it.

use crate::stl::write_revolved;
use coilwind::math::V3;
use coilwind::measure::STATIONS_PER_TURN;
use coilwind::settings::SceneSettings;
use coilwind::simulation::Simulation;
use std::f64::consts::{SQRT_2, TAU};

const SIDES: usize = 180;
const DIAMETER_MM: f64 = 0.7;
/// Of the groove's bottom.
const RADIUS_MM: f64 = 8.0;
const PITCH_MM: f64 = 0.9;
const GROOVES: usize = 3;
/// Angles between crossovers, degrees.
const STRAIGHT: std::ops::Range<usize> = 60..240;

/// Middle of a groove, mm.
fn middle(groove: usize, pitch: f64) -> f64 {
    (groove as f64 - 0.5 * (GROOVES - 1) as f64) * pitch
}

/// A drum with V grooves of a right angle between flanges, as (y, radius) from end to end, mm.
fn outline() -> Vec<[f64; 2]> {
    let crest = RADIUS_MM + 0.5 * PITCH_MM;
    let end = 0.5 * GROOVES as f64 * PITCH_MM;
    let rim = RADIUS_MM + 3.0;
    let mut points = vec![[-end - 1.5, rim], [-end, rim], [-end, crest]];
    for groove in 0..GROOVES {
        let y = middle(groove, PITCH_MM);
        points.extend([[y, RADIUS_MM], [y + 0.5 * PITCH_MM, crest]]);
    }
    points.extend([[end, rim], [end + 1.5, rim]]);
    points
}

/// A drum with flat grooves between flanges, which leave `play` (mm) beside the wire's middle; walls lean by 10 degrees.
fn flat_grooves(pitch: f64, play: f64) -> Vec<[f64; 2]> {
    let lean = 10_f64.to_radians().tan();
    let depth = 0.45 * DIAMETER_MM;
    let bottom = 0.5 * (DIAMETER_MM + play) - 0.5 * DIAMETER_MM * lean;
    let top = bottom + depth * lean;
    let (crest, rim) = (RADIUS_MM + depth, RADIUS_MM + 3.0);
    let end = 0.5 * GROOVES as f64 * pitch;
    let mut points = vec![[-end - 1.5, rim], [-end, rim], [-end, crest]];
    for groove in 0..GROOVES {
        let y = middle(groove, pitch);
        points.extend([[y - top, crest], [y - bottom, RADIUS_MM]]);
        points.extend([[y + bottom, RADIUS_MM], [y + top, crest]]);
    }
    points.extend([[end, crest], [end, rim], [end + 1.5, rim]]);
    points
}

/// Winds a turn into each groove of a drum, up to 2.9 turns.
fn wound(outline: &[[f64; 2]], pitch: f64) -> Simulation {
    let folder = tempfile::tempdir().expect("a folder");
    write_revolved(&folder.path().join("drum.stl"), outline, SIDES);
    let start = middle(0, pitch);
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
pitch_mm = {pitch}
"
    );
    let settings =
        SceneSettings::from_toml_str(&text, "grooved.toml", folder.path()).expect("reads");
    let mut sim = Simulation::new(&settings.build().expect("a scene")).expect("starts");
    let end = sim.motion_profile().time_at(2.9 * TAU);
    sim.advance_profile(end).expect("winds");
    sim
}

/// Turn from 0, degree from the clamp and place (core frame, mm) of the wire between the crossovers of two turns. The clamp holds the
/// first degrees on the bottom.
fn between_crossovers(sim: &Simulation) -> Vec<(usize, usize, V3)> {
    let all = sim.coil().stations().enumerate().map(|(index, station)| {
        let (turn, degree) = (index / STATIONS_PER_TURN, index % STATIONS_PER_TURN);
        (turn, degree, station.position * 1e3)
    });
    let seen: Vec<_> = all
        .filter(|(turn, degree, _)| *turn < 2 && STRAIGHT.contains(degree))
        .collect();
    assert_eq!(seen.len(), 2 * STRAIGHT.len());
    seen
}

#[test]
fn wire_lies_on_both_walls_of_a_groove() {
    let sim = wound(&outline(), PITCH_MM);
    let seat = RADIUS_MM + 0.5 * DIAMETER_MM * SQRT_2;
    // a facet is that much nearer to the axis in its middle
    let sagitta = RADIUS_MM * (1.0 - (0.5 * TAU / SIDES as f64).cos());
    for (turn, degree, p) in between_crossovers(&sim) {
        let aside = (p.y - middle(turn, PITCH_MM)).abs();
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
}

/// With two of the three walls held at a time, the third came in where wire was deep in it already. Splits of edges gave 5 % of the
/// dissipation, and 1 % of it was not explained.
#[test]
fn a_groove_that_fits_the_wire_holds_it_by_three_walls() {
    let pitch = 1.0;
    for play in [0.05, 0.02] {
        let sim = wound(&flat_grooves(pitch, play), pitch);
        for (turn, degree, p) in between_crossovers(&sim) {
            let aside = (p.y - middle(turn, pitch)).abs();
            // a wall that leans by 10 degrees is touched 1.5 % of its play later, and gives way to the wire's push
            let most = 0.508 * play + 0.003 * DIAMETER_MM;
            assert!(aside < most, "{play} {turn} {degree}: {aside} mm aside");
            let over = p.x.hypot(p.z) - RADIUS_MM - 0.5 * DIAMETER_MM;
            assert!(over.abs() < 0.03, "{play} {turn} {degree}: {over} mm above");
        }
        let energy = sim.energy();
        let dissipated = energy.plastic_J + energy.friction_J + energy.damping_J;
        for (part, most) in [
            (energy.numerical_J, 0.005),
            (energy.remeshing_J, 0.001),
            (energy.residual_J, 0.002),
        ] {
            assert!(part.abs() < most * dissipated, "{play}: {energy:?}");
        }
    }
}

/// Walls of grooves wider than their pitch cross each other. The wire fell through them, and the run was called a break.
#[test]
fn a_drum_whose_walls_cross_leaves_the_coil_in_doubt() {
    let pitch = 1.0;
    let sim = wound(&flat_grooves(pitch, 0.4), pitch);
    let doubt = sim.doubt().expect("a doubt");
    assert!(doubt.contains("walls of a core from a file"), "{doubt}");
}
