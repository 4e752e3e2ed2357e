//! The coil as a product: layers, contour, fill and clearance of an ideal orthocyclic coil.

use crate::coils::{D, on_cylinder, spec, wound};
use coilwind::measure::Coil;
use std::f64::consts::{PI, TAU};

const TURNS: f64 = 20.0;

/// Rise from layer to layer in grooves of touching turns, m.
fn step() -> f64 {
    0.75f64.sqrt() * D
}

/// A coil of layers of twenty touching turns in each other's grooves, with steps of no length, and so much more wire.
fn ideal(layers: u32, more: f64, climbs: bool) -> Coil {
    let nodes = on_cylinder(f64::from(layers) * TURNS + more, 1.0, |angle| {
        let turn = (angle / TAU).floor();
        let full = f64::from(layers);
        let layer = (turn / TURNS).floor();
        let (layer, along) = match layer < full {
            true => (layer, turn - layer * TURNS),
            false if climbs => (full, turn - full * TURNS),
            false => (full - 1.0, TURNS - 1.0),
        };
        let back = layer % 2.0 == 1.0;
        let y = D * if back { TURNS - 0.5 - along } else { along };
        (y, step() * layer)
    });
    let mut coil = wound(spec(), &nodes);
    for layer in 1..layers {
        let sense = if layer % 2 == 1 { -1.0 } else { 1.0 };
        coil.begin_pass(f64::from(layer) * TURNS * TAU, sense);
    }
    coil
}

#[test]
fn an_ideal_coil_is_as_full_as_geometry_says() {
    for layers in 1..=4 {
        let coil = ideal(layers, -0.01, false);
        assert_eq!(coil.layers(), layers);
        let contour = coil.contour();
        assert_eq!(contour.len() as u32, layers);
        for (below, layer) in contour.iter().enumerate() {
            let top = D + below as f64 * step();
            for height in [
                layer.height_min_m,
                layer.height_mean_m,
                layer.height_median_m,
                layer.height_groove_m,
                layer.height_max_m,
            ] {
                // one node of a step lies between two layers
                assert!((height - top).abs() < 0.01 * D || height == layer.height_max_m);
            }
            // a layer changes once so many stations have said so
            assert!((layer.turns - TURNS).abs() < 0.05, "{layer:?}");
        }
        let top = contour[layers as usize - 1].height_groove_m;
        let width = D * if layers > 1 { TURNS + 0.5 } else { TURNS };
        let turns = TURNS * f64::from(layers);
        let of_geometry = turns * PI / 4.0 * D * D / (width * (D + f64::from(layers - 1) * step()));
        let fill = coil.turns_settled() * PI / 4.0 * D * D / (coil.coil_width() * top);
        assert!(
            (fill / of_geometry - 1.0).abs() < 0.005,
            "{layers} layers: {fill} for {of_geometry}"
        );
    }
}

/// Crossovers that take more than half of a turn were the height of the coil: that of `bobbin` in four layers was 3 % too high.
/// What stands off in the first layer already is height of the coil.
#[test]
fn wide_crossovers_are_not_the_height_of_the_coil() {
    let place = |angle: f64| {
        let (turn, within) = ((angle / TAU).floor(), (angle / TAU).fract());
        let off = if within > 0.5 { 0.2 * D } else { 0.0 };
        match turn < TURNS {
            true => (D * turn, 0.05 * D),
            false => (
                D * (2.0 * TURNS - 0.5 - turn),
                0.05 * D + step() + if within > 0.3 { off.max(0.1 * D) } else { 0.0 },
            ),
        }
    };
    let mut coil = wound(spec(), &on_cylinder(2.0 * TURNS - 0.01, 1.0, place));
    coil.begin_pass(TURNS * TAU, -1.0);
    let contour = coil.contour();
    let [first, second] = &contour[..] else {
        panic!("two layers: {contour:?}");
    };
    let ideal = 1.05 * D + step();
    assert!(
        (first.height_groove_m - 1.05 * D).abs() < 1e-3 * D,
        "{first:?}"
    );
    assert!(second.height_median_m > ideal + 0.09 * D, "{second:?}");
    assert!(
        (second.height_groove_m - ideal).abs() < 2e-3 * D,
        "{second:?}"
    );
}

/// Wire that climbs at the end of its pass counted as a layer of its own.
#[test]
fn a_last_turn_that_climbs_is_no_layer() {
    let coil = ideal(4, 1.4, true);
    let contour = coil.contour();
    assert_eq!((contour.len(), contour[4].layer), (5, 5));
    assert!((contour[4].turns - 1.4).abs() < 0.05);
    assert_eq!(coil.layers(), 4);
    // wire in disorder has layers too, though the nozzle never turned
    assert_eq!(ideal(4, 3.0, true).layers(), 5);
    assert_eq!(Coil::new(spec()).layers(), 0);
    assert!(Coil::new(spec()).contour().is_empty());
}

/// Wire of a coil that ended where a pass had just begun was a layer: it gave the coil its height, and a fill factor as if that were full.
#[test]
fn a_layer_that_hardly_begins_is_none() {
    for (more, layers) in [(0.1, 4), (0.4, 4), (0.6, 5), (1.4, 5)] {
        let mut coil = ideal(4, more, true);
        coil.begin_pass(4.0 * TURNS * TAU, 1.0);
        let last = coil.stations().last().map(|s| (s.layer, s.pass));
        assert_eq!(last, Some((5, 5)));
        assert_eq!(coil.layers(), layers, "{more}");
        let over = coil.turns_over(layers);
        let expected = if layers == 4 { more } else { 0.0 };
        assert!((over - expected).abs() < 0.05, "{over}");
    }
    // the first has begun with the first wire
    assert_eq!(ideal(1, -19.8, false).layers(), 1);
}

/// Each turn of a heap beside a flange lies over the one before: no layer had two turns, and twenty turns seven layers high were
/// told as one layer, which they filled to 108 %.
#[test]
fn turns_that_heap_up_are_layers() {
    for (heaped, layers, climbing) in [(1.4, 1, 1.4), (2.8, 2, 1.8), (5.8, 5, 1.8)] {
        let nodes = on_cylinder(TURNS + heaped, 1.0, |angle| {
            let turn = (angle / TAU).floor();
            (D * turn.min(TURNS - 1.0), D * (turn + 1.0 - TURNS).max(0.0))
        });
        let coil = wound(spec(), &nodes);
        assert_eq!(coil.contour().len() as f64, 1.0 + f64::ceil(heaped));
        assert_eq!(coil.layers(), layers, "{heaped}");
        let over = coil.turns_over(layers);
        // a layer changes once so many stations have said so
        assert!((over - climbing).abs() < 0.15, "{over}");
    }
}

/// Wire over the rim counted as wire in the window.
#[test]
fn wire_beyond_the_limit_line_is_told_by_its_share() {
    let coil = ideal(2, -0.01, false);
    let top = D + step();
    let near = |got: f64, expected: f64| assert!((got - expected).abs() < 0.1, "{got} {expected}");
    assert_eq!(coil.turns_beyond(top + 1e-9, 0.0), 0.0);
    near(coil.turns_beyond(top - 0.5 * D, 0.0), 0.5 * TURNS);
    near(coil.turns_beyond(0.5 * D, 0.0), 1.5 * TURNS);
    near(coil.turns_beyond(-1e-9, 0.0), 2.0 * TURNS);
    // a quarter of the diameter cuts off a segment of (2 pi / 3 - sin(2 pi / 3)) / 2 pi
    let segment = 1.0 / 3.0 - 0.75_f64.sqrt() / TAU;
    near(coil.turns_beyond(top - 0.25 * D, 0.0), segment * TURNS);
}

/// Of a nozzle that swings past each place the last swing, which nothing follows, was a pass, and a last turn that climbs was a layer.
#[test]
fn the_last_swing_of_the_nozzle_makes_no_layer() {
    let mut coil = ideal(4, 1.4, true);
    let sense = coil
        .stations()
        .last()
        .map_or(0.0, |s| if s.pass % 2 == 0 { -1.0 } else { 1.0 });
    let mut turn_at = |turn: f64, way: f64, place: f64| {
        coil.begin_pass_at((4.0 * TURNS + turn) * TAU, way * sense, sense * place * D);
    };
    for place in 0..4 {
        let place = f64::from(place);
        turn_at(place - 3.3, -1.0, place + 1.5);
        turn_at(place - 2.9, 1.0, place);
    }
    turn_at(0.7, -1.0, 5.5);
    assert_eq!(coil.stations().last().unwrap().pass, 5);
    assert_eq!(coil.layers(), 4);
}

#[test]
fn clearance_is_the_distance_to_the_limit_line() {
    let coil = ideal(2, -0.01, false);
    let limit = 4e-3;
    let top = D + step();
    let level = coil.clearance(limit, 0.0).unwrap();
    assert!((level - (limit - top)).abs() < 1e-9, "{level}");
    assert!(coil.clearance(top - 0.2 * D, 0.0).unwrap() < -0.19 * D);
    // a line that falls towards +y comes nearest to the outermost turn there
    let taper = -0.1_f64;
    let y = D * (TURNS - 0.5);
    let centre = top - 0.5 * D;
    let expected = (limit + y * taper.tan() - centre) * taper.cos() - 0.5 * D;
    let got = coil.clearance(limit, taper).unwrap();
    assert!((got - expected).abs() < 1e-9, "{got} {expected}");
    assert_eq!(Coil::new(spec()).clearance(limit, 0.0), None);
}

/// Beside a corner the height of wire changes fast. A layer that ends there has one turn more at some degrees of a sector, and the
/// fill of a coil was up to 3 % too large, as if its second layer lay deeper in the first.
#[test]
fn where_a_layer_ends_does_not_change_its_height() {
    let rise = |turns: f64| {
        let place = |angle: f64| {
            let bow = 2.0 * D * libm::sin(angle).abs();
            let (row, layer) = match angle / TAU {
                turns if turns < 5.0 => (turns, 0.0),
                turns => (9.5 - turns, 0.866 * D),
            };
            (row * D, 0.5 * D + bow + layer)
        };
        let mut coil = wound(spec(), &on_cylinder(turns, 1.0, place));
        coil.begin_pass(5.0 * TAU, -1.0);
        let contour = coil.contour();
        contour[1].height_groove_m - contour[0].height_groove_m
    };
    let full = rise(8.0);
    for turns in [8.3, 8.05, 7.55, 7.7] {
        assert!(
            (rise(turns) - full).abs() < 0.01 * D,
            "{turns}: {}",
            rise(turns) / D
        );
    }
}
