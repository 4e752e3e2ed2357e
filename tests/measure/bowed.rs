//! Second layers on wire that stands off its core.

use crate::coils::{D, on_cylinder, spec, wound};
use crate::layers::{TURNS, orthocyclic, step};
use coilwind::measure::{Coil, CoilSpec, Profile};
use std::f64::consts::TAU;

/// Height of a loop at rest over this core, m.
const BOW: f64 = 0.5 * D;

/// Two layers in grooves. The first lies 0.1 diameters over the core, and the second stands `off` (m) over its groove.
fn two_layers(off: f64) -> Coil {
    let place = |angle: f64| {
        let (y, height) = orthocyclic(angle);
        let share = height / step();
        (y, height + 0.1 * D + share * off)
    };
    let spec = CoilSpec {
        profile: Profile::new(vec![BOW]),
        ..spec()
    };
    let mut coil = wound(spec, &on_cylinder(2.0 * TURNS - 0.15, 1.0, place));
    coil.begin_pass((TURNS - 0.05) * TAU, -1.0);
    coil
}

/// Wound wire stands lower than a loop at rest. A second layer that did not follow it down was loose, though it too stood lower than at rest.
#[test]
fn a_second_layer_stands_at_rest_as_high_as_over_a_loop_at_rest() {
    let coil = two_layers(0.35 * D);
    assert_eq!(coil.defects(), []);
    // in its groove over a loop at rest it would be off by the rest of the bow
    let turn = 360 * (TURNS as usize + 2) + 180;
    let excess = coil.stations().nth(turn).and_then(|s| s.bulge_excess);
    let expected = (0.1 + 0.35) * D - BOW;
    assert!(
        excess.is_some_and(|excess| (excess - expected).abs() < 1e-3 * D),
        "{excess:?}"
    );
    let flags = two_layers(0.95 * D).flags();
    assert!(flags.bulge && flags.loose_turn, "{flags:?}");
}

/// Two layers on a core whose wire stands off it by `bow` (m) at each angle. The second turn of the second layer passes over the climb of
/// the first, `aside` (diameters) beside it, over the part of the turn in which that says so.
fn over_the_climb(bow: impl Fn(f64) -> f64, aside: impl Fn(f64) -> Option<f64>) -> Coil {
    let place = |angle: f64| {
        let (mut y, mut height) = orthocyclic(angle);
        if let Some(aside) = aside(angle / TAU - TURNS - 1.0) {
            let (before, below) = orthocyclic(angle - TAU);
            y = before - aside * D;
            height = below + D * (1.0 - aside * aside).max(0.0).sqrt();
        }
        (y, height + bow(angle / TAU))
    };
    let nodes = on_cylinder(2.0 * TURNS - 0.15, 1.0, place);
    let spec = CoilSpec {
        profile: None,
        ..spec()
    };
    let mut coil = wound(spec, &nodes);
    coil.begin_pass((TURNS - 0.05) * TAU, -1.0);
    coil
}

/// The first turn of a layer has to cross the climb to it. On a bowed face it does so slowly, and was told to ride up and to bulge.
#[test]
fn wire_that_crosses_its_climb_slowly_does_not_ride_up() {
    let slowly = |turns: f64| (0.0..0.2).contains(&turns).then_some(0.95 * turns / 0.2);
    let coil = over_the_climb(|_| 0.0, slowly);
    assert!(
        !coil.flags().overlap && !coil.flags().bulge,
        "{:?}",
        coil.defects()
    );
    // along the climb it does
    let along = |turns: f64| (0.0..0.2).contains(&turns).then_some(0.02);
    let coil = over_the_climb(|_| 0.0, along);
    assert!(coil.flags().overlap, "{:?}", coil.defects());
}

/// Wire that leaned on the climb was told to ride up where the face under both rose towards its middle.
#[test]
fn wire_that_leans_on_its_climb_on_a_bowed_face_does_not_ride_up() {
    let bow = |turns: f64| 2.0 * D * (1.0 - (2.0 * turns.fract() - 1.0).abs());
    // for longer than a quarter of a turn
    let leaves = |turns: f64| {
        (0.0..0.35)
            .contains(&turns)
            .then_some(0.7 + 0.28 * turns / 0.35)
    };
    let coil = over_the_climb(bow, leaves);
    assert!(!coil.flags().overlap, "{:?}", coil.defects());
}

/// Wire that stands off beside and over the turn before, lower than at rest and with air between the two, was told to ride up on it.
#[test]
fn wire_that_does_not_touch_the_turn_before_has_not_ridden_up() {
    for (rise, rides_up) in [(1.0, false), (0.81, true)] {
        let place = |angle: f64| match angle / TAU {
            turns if turns < 1.0 => (0.0, 0.5 * D),
            _ => (0.6 * D, (0.5 + rise) * D),
        };
        let spec = CoilSpec {
            profile: Profile::new(vec![2.2 * D]),
            ..spec()
        };
        let coil = wound(spec, &on_cylinder(1.95, 1.0, place));
        assert_eq!(coil.flags().overlap, rides_up, "{:?}", coil.defects());
    }
}

/// Loose wire that hung in the air beside the turn before, 0.85 d from it along the axis, was told to ride up on it as well as to bulge.
#[test]
fn loose_wire_that_hangs_beside_the_turn_before_bulges_and_does_not_overlap() {
    for (axial, rides_up) in [(0.85, false), (0.6, true)] {
        let place = |angle: f64| match angle / TAU {
            turns if turns < 1.0 => (0.0, 0.5 * D),
            _ => (axial * D, 2.5 * D),
        };
        let spec = CoilSpec {
            profile: Profile::new(vec![0.5 * D]),
            ..spec()
        };
        let coil = wound(spec, &on_cylinder(1.95, 1.0, place));
        assert_eq!(coil.flags().overlap, rides_up, "{:?}", coil.defects());
        assert!(coil.flags().bulge, "{:?}", coil.defects());
    }
}
