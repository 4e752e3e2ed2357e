//! A nozzle that travels evenly lays as many turns as the layers hold, and coils are as high as their layers.

use crate::common::parse;
use coilwind::scene::NozzleLaw;
use std::f64::consts::TAU;

/// Six layers of 0.6 mm wire on a round core between flanges so far apart, mm, the first turn at the lower one.
fn window(inner: f64, keys: &str) -> String {
    let first = 0.3 - 0.5 * inner;
    format!(
        "[wire]\ndiameter_mm = 0.6\n[core]\nshape = 'cylinder'\nradius_mm = 6\n[core.flange]\ninner_distance_mm = {inner}\n\
         height_mm = 5\n[nozzle]\ndistance_mm = 25\ny_start_mm = {first}\n[start]\nclamp_y_mm = {first}\n\
         [tensioner]\ntension = 10\n[winding]\nlayers = 6\n{keys}\n"
    )
}

fn law(inner: f64, keys: &str) -> NozzleLaw {
    let scene = parse(&window(inner, keys)).unwrap().build();
    scene.unwrap().nozzle_law
}

/// A disc coil of six layers of a turn was over after three and a half turns, and no word said so.
#[test]
fn a_disc_coil_has_all_its_turns() {
    for inner in [0.62, 0.85] {
        let disc = law(inner, "[traverse]\nmode = 'helical'");
        assert_eq!(disc.turns(), 6.0);
        let climbs: Vec<_> = disc.jumps().iter().map(|jump| jump[1] / TAU).collect();
        assert_eq!(climbs, [1.0, 2.0, 3.0, 4.0, 5.0]);
        // planned from half a turn sooner on, the last of an odd number of layers was no layer
        assert!(disc.jumps().iter().all(|[from, to]| from == to));
    }
}

/// Where layers begin is what tells that a place beside their flange is empty.
#[test]
fn layers_begin_beside_their_flanges() {
    let rooms = |keys: &str, inner: f64| -> Vec<f64> {
        let law = law(inner, keys);
        law.layer_starts().iter().map(|start| start.room).collect()
    };
    let near = |found: Vec<f64>, mm: [f64; 6]| {
        let off = found
            .iter()
            .zip(mm)
            .map(|(room, mm)| (room - 1e-3 * mm).abs());
        found.len() == 6 && off.fold(0.0, f64::max) < 1e-9
    };
    for mode in ["helical", "orthocyclic"] {
        let mode = format!("[traverse]\nmode = '{mode}'");
        // with room for half a pitch more every layer begins at its flange, without it every other half a pitch from it
        assert!(near(rooms(&mode, 4.5), [0.0; 6]));
        assert!(near(rooms(&mode, 4.2), [0.0, 0.3, 0.0, 0.3, 0.0, 0.3]));
    }
}

/// With a dwell of less than half a turn every layer but the last lost what was missing.
#[test]
fn a_short_dwell_takes_no_turns_from_a_layer() {
    let usual = law(4.0, "[traverse]\nmode = 'helical'");
    assert_eq!(usual.turns(), usual.held().expect("layers"));
    for dwell in [0.0, 0.25] {
        let short = law(
            4.0,
            &format!("[traverse]\nmode = 'helical'\ndwell_turns = {dwell}"),
        );
        assert!((short.turns() - usual.turns()).abs() < 1e-9, "{dwell}");
        for turn in 0..=100 {
            let angle = 0.01 * f64::from(turn) * usual.end();
            let off = short.position(angle) - usual.position(angle);
            assert!(off.abs() < 1e-12, "{dwell} {turn}: {off}");
        }
    }
    // a longer one adds turns, and the layers hold as many as before
    let long = law(4.0, "[traverse]\nmode = 'helical'\ndwell_turns = 3");
    assert!(long.turns() > usual.turns() + 12.0);
    assert_eq!(long.held(), usual.held());
}

/// The coil was taken to lie in grooves of turns side by side, whatever their distance: too high for turns apart, too low for turn on turn.
#[test]
fn a_coil_is_as_high_as_its_layers() {
    let told = |keys: &str, inner: f64, height: f64| {
        let height = format!("height_mm = {height}");
        let text = window(inner, keys).replace("height_mm = 5", &height);
        let built = parse(&text).unwrap().build_with_warnings();
        let high = |w: &str| w.contains("high, above the flanges");
        built.unwrap().1.iter().any(|w| high(&w.message))
    };
    // six layers, turn on turn: 3.6 mm
    assert!(told("[traverse]\nmode = 'helical'", 0.62, 3.55));
    assert!(!told("[traverse]\nmode = 'helical'", 0.62, 3.65));
    // turns 0.96 mm apart: a layer rises by 0.36 mm, six are 2.4 mm high
    let apart = "pitch_mm = 0.96\nturns_per_layer = 4\n[traverse]\nmode = 'orthocyclic'";
    assert!(told(apart, 8.0, 2.35));
    assert!(!told(apart, 8.0, 2.45));
}
