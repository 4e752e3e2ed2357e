//! A run in which wire at rest leaves the computation against one in which all of it stays.
//!
//! With the settings of the packed scene as they are: `freeze.window` 1 rad and `freeze.creep` 2e-6 m/rad.
//! By stations evenly spaced in polar angle, both runs then agree to 17 um rms at 30 rad/s and 12 um at 300 rad/s.
//! Their gaps differ by 3 to 14 um where wire lies close. At 300 rad/s with leads of 0.9 to 1 mm frozen wire leaves gaps that are 15 to 26 um
//! smaller, 20 um on average (129 and 154 um at 0.92 mm).
//! 1.5 rad and 6e-6 m/rad are too lax. They give 34 um at 30 rad/s; at 300 rad/s 9 um, but another verdict.

use coilwind::measure::{Coil, Verdict};
use coilwind::settings::SceneSettings;
use coilwind::simulation::Simulation;

/// Bulge may differ by this, m rms: a twentieth of what the verdict hangs on.
const SAME_BULGE: f64 = 25e-6;
/// The gap of a whole turn may differ by this, m rms: a fifth of the gap that is a defect. Wire that stays in the computation is moved
/// a little by all that lands after it.
const SAME_GAP: f64 = 21e-6;
const TURNS: &str = "2.5";
/// Stations that both runs must have: turns 2 and the half after it, less what is off the core at the end.
const STATIONS: usize = 400;

/// A packed scene and the lead of its nozzle, mm.
type Coiled<'a> = (&'a str, &'a str);

/// Its second turn has a gap of 0.05 diameters, at which "aligned" ends.
const AT_A_LIMIT: Coiled = ("fig8", "0.7");
/// Wire lies close.
const ALIGNED: Coiled = ("fig8_gap", "0.35");
/// It leaves a third of a diameter free.
const GAP: Coiled = ("fig8", "0.95");
/// The same, for a mean: where wire lands after a gap differs by some micrometres from one lead to the next.
const GAPS: [Coiled; 6] = [
    ("fig8", "0.90"),
    ("fig8", "0.92"),
    ("fig8", "0.94"),
    ("fig8", "0.96"),
    ("fig8", "0.98"),
    ("fig8", "1.00"),
];

fn wound((scene, lead): Coiled, speed: &str, freeze: &str) -> Coil {
    let mut settings = SceneSettings::load(scene).expect("packed");
    for (name, value) in [
        ("traverse.per_turn_mm", lead),
        ("spindle.speed", speed),
        ("spindle.turns", TURNS),
        ("freeze.enabled", freeze),
    ] {
        settings.set_text(name, value).expect("a valid setting");
    }
    let scene = settings.build().expect("a valid scene");
    let mut simulation = Simulation::new(&scene).expect("the scene starts");
    let end = simulation.motion_profile().end();
    while simulation.time() < end * (1.0 - 1e-12) {
        let piece = (end - simulation.time()).min(end / 100.0);
        simulation.advance_profile(piece).expect("the run goes on");
    }
    simulation.coil_with_live_wire()
}

/// Root mean square of the difference in bulge over the stations that both have measured, and their number.
fn difference(a: &Coil, b: &Coil) -> (f64, usize) {
    let (mut sum, mut count) = (0.0, 0);
    for (a, b) in a.stations().zip(b.stations()) {
        if a.measured && b.measured {
            sum += (a.bulge - b.bulge).powi(2);
            count += 1;
        }
    }
    ((sum / count as f64).sqrt(), count)
}

/// Winds with and without freezing, and compares bulge and gap; the verdicts of the second turn.
fn same_with_and_without(coiled: Coiled, speed: &str) -> [Verdict; 2] {
    let (verdicts, apart) = with_and_without(coiled, speed);
    assert!(apart.abs() < SAME_GAP, "{apart} m");
    verdicts
}

/// Winds with and without freezing, and compares the bulge; the verdicts of the second turn, and by how much its gaps are
/// apart, m.
fn with_and_without(coiled: Coiled, speed: &str) -> ([Verdict; 2], f64) {
    let coils = ["true", "false"].map(|freeze| wound(coiled, speed, freeze));
    let (off, stations) = difference(&coils[0], &coils[1]);
    // (the third turn ends in wire that is not laid yet)
    let [a, b] = coils.map(|coil| coil.turns()[1].clone());
    let (gap, other) = (a.gap_rms.expect("a gap"), b.gap_rms.expect("a gap"));
    println!(
        "{coiled:?} at {speed} rad/s: bulge {:.1} um rms over {stations} stations, gap {:.1} and {:.1} um rms",
        off * 1e6,
        gap * 1e6,
        other * 1e6
    );
    assert!(stations > STATIONS, "{stations} stations");
    assert!(off < SAME_BULGE, "{off} m");
    assert_eq!([a.settled, b.settled], [1.0; 2]);
    ([a.verdict, b.verdict], gap - other)
}

#[test]
fn bulge_and_gap_are_the_same_in_slow_winding() {
    same_with_and_without(AT_A_LIMIT, "30");
}

#[test]
fn bulge_and_gap_are_the_same_in_fast_winding() {
    same_with_and_without(AT_A_LIMIT, "300");
}

#[test]
fn verdicts_are_the_same_in_slow_winding() {
    assert_eq!(same_with_and_without(ALIGNED, "30"), [Verdict::Aligned; 2]);
    assert_eq!(same_with_and_without(GAP, "30"), [Verdict::Gap; 2]);
}

#[test]
fn verdicts_are_the_same_in_fast_winding() {
    assert_eq!(same_with_and_without(ALIGNED, "300"), [Verdict::Aligned; 2]);
    let mut apart = 0.0;
    for coiled in GAPS {
        let (verdicts, by) = with_and_without(coiled, "300");
        assert_eq!(verdicts, [Verdict::Gap; 2]);
        apart += by / GAPS.len() as f64;
    }
    assert!(apart.abs() < SAME_GAP, "{apart} m");
}

/// Winds a packed scene with other settings to its end.
fn wound_as(scene: &str, settings: &[(&str, &str)]) -> Simulation {
    let mut all = SceneSettings::load(scene).expect("packed");
    for (name, value) in settings {
        all.set_text(name, value).expect("a valid setting");
    }
    let mut simulation = Simulation::new(&all.build().expect("valid")).expect("starts");
    let end = simulation.motion_profile().end();
    simulation.advance_profile(end).expect("the run goes on");
    simulation
}

/// A bow that stood off by more than `freeze.margin` never came to rest, nor did what was wound after it: it had no verdict, and each turn
/// cost more than the one before.
#[test]
fn wire_farther_off_than_the_margin_comes_to_rest_where_nothing_draws_at_it() {
    let tall = [
        ("core.height_z_mm", "100"),
        ("core.length_y_mm", "60"),
        ("tensioner.tension", "1.2"),
        ("nozzle.distance_mm", "100"),
        ("spindle.speed", "30"),
        ("spindle.turns", "3"),
    ];
    let simulation = wound_as("fig8", &tall);
    let highest = simulation.coil().stations().map(|s| s.height);
    let highest = highest.fold(0.0, f64::max);
    assert!(highest > 5e-3, "{highest} m: within the margin");
    let settled = simulation.outputs().turns_settled;
    assert!(settled > 2.0, "{settled} turns");
}

/// Wire that lay on live wire only was part of the free span to the outputs: of five turns, 2.87 were wound.
#[test]
fn wire_laid_on_wire_that_is_not_at_rest_is_wound() {
    let layers = |freeze: &'static str| {
        [
            ("traverse.trail", "free"),
            ("winding.turns_per_layer", "3"),
            ("winding.layers", "2"),
            ("core.flange.inner_distance_mm", "2.47"),
            ("nozzle.y_start_mm", "-0.885"),
            ("start.clamp_y_mm", "-0.885"),
            ("spindle.turns", "5"),
            ("freeze.enabled", freeze),
        ]
    };
    let [at_rest, live] =
        ["true", "false"].map(|freeze| *wound_as("bobbin", &layers(freeze)).outputs());
    assert!(live.turns_wound > 4.9, "{} turns", live.turns_wound);
    let off = (live.turns_wound - at_rest.turns_wound).abs();
    assert!(off < 0.05, "{off} turns");
    let (free, expected) = (live.free_length, at_rest.free_length);
    // (by as much as wire of that angle is long)
    assert!((free - expected).abs() < 3e-3, "{free} m, {expected} m");
}
