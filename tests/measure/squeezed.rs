//! The last turn of a layer in a window that fits exactly, pressed up between the turn before and a flange.

use crate::coils::{D, on_cylinder, spec, wound};
use coilwind::measure::{Coil, CoilSpec, DefectFlags, DefectKind, Profile, SettledNode};
use std::f64::consts::TAU;

/// Turns of a layer.
const TURNS: f64 = 5.0;

/// Two layers between flanges with room for exactly [`TURNS`]. From the fourth turn on wire leans over by `lean`, diameters,
/// within a part of each turn (shares of a turn), so that the fifth has less than its place there. The nozzle turns back at `turned`, turns.
fn squeezed(lean: f64, part: [f64; 2], turned: f64) -> Coil {
    squeezed_in(spec(), lean, part, turned)
}

fn squeezed_in(spec: CoilSpec, lean: f64, part: [f64; 2], turned: f64) -> Coil {
    let lean = |turns: f64| match (part[0]..part[1]).contains(&turns.fract()) {
        true => lean,
        false => 0.0,
    };
    let mut coil = wound(spec, &leaning(lean));
    coil.begin_pass(turned * TAU, -1.0);
    coil
}

/// The wire of such layers, which leans over by so many diameters after so many turns.
fn leaning(lean: impl Fn(f64) -> f64) -> Vec<SettledNode> {
    let place = |angle: f64| {
        let turn = (angle / TAU).floor();
        let within = angle / TAU - turn;
        let leans = lean(angle / TAU);
        // the step to the next place, in the last tenth
        let aside = ((within - 0.9) / 0.1).max(0.0);
        let last = TURNS - 1.0;
        let wedge = (1.0 - (1.0 - leans).powi(2)).sqrt();
        let at = |turn: f64| match turn {
            turn if turn < last - 1.0 => (turn, 0.0),
            turn if turn < last => (turn + leans, 0.0),
            turn if turn < TURNS => (last, wedge),
            turn => {
                // in the groove of the two turns below
                let right = 2.0 * TURNS - 1.0 - turn;
                let leant = |t: f64| t + if t == last - 1.0 { leans } else { 0.0 };
                let (left, right, high) = match right == last {
                    true => (leant(right - 1.0), last, wedge),
                    false => (leant(right - 1.0), leant(right), 0.0),
                };
                let apart = (right - left).hypot(high);
                let over = (1.0 - 0.25 * apart * apart).sqrt() / apart;
                (
                    0.5 * (left + right) - over * high,
                    0.5 * high + over * (right - left),
                )
            }
        };
        let ((y, height), (next_y, next)) = (at(turn), at(turn + 1.0));
        let between = |from: f64, to: f64| D * (from + aside * (to - from));
        (between(y, next_y), between(height, next))
    };
    let mut nodes = on_cylinder(2.0 * TURNS - 2.2, 1.0, place);
    for node in &mut nodes {
        let ways = [-0.5 * D, (TURNS - 0.5) * D].map(|face| face - node.position.y);
        node.flange = Some(if ways[1] < -ways[0] { ways[1] } else { ways[0] });
    }
    nodes
}

/// Share of the last turn from which on wire stands half a diameter high on the turn before, and from which on it has left its row for
/// certain.
const CLIMB: [f64; 2] = [0.3, 0.6];

/// Wire that climbs slowly beside the flange. The turn before leans over as long as it does not step to its next place.
fn slow_climb() -> Vec<SettledNode> {
    leaning(|turns| match turns.fract() {
        within if turns < TURNS - 1.0 && within > 0.85 => 0.0,
        within if within < CLIMB[0] => 0.05,
        within if within < CLIMB[1] => 0.15,
        _ => 0.4,
    })
}

/// The next layer began only where wire had less than three quarters of a diameter beside the turn before, up to a quarter of a turn
/// after it had begun to rise. Until then the turn after had no neighbour, and gaps beside it were not told.
#[test]
fn a_climb_begins_where_wire_sets_out_for_it() {
    let nodes = slow_climb();
    let mut coil = wound(spec(), &nodes);
    coil.begin_pass((TURNS - 0.05) * TAU, -1.0);
    let begins = |turn: f64| ((turn + CLIMB[0]) * 360.0).round() as usize;
    let layers: Vec<u32> = coil.stations().map(|s| s.layer).collect();
    let second = layers.iter().position(|layer| *layer == 2);
    // nodes lie two to three stations apart
    let off = second.map(|station| station.abs_diff(begins(TURNS - 1.0)));
    assert!(off.is_some_and(|off| off <= 3), "{second:?}");
    let climb = begins(TURNS - 1.0) + 3..begins(TURNS - 0.5);
    assert!(layers[climb].iter().all(|layer| *layer == 2));
    let beside: Vec<bool> = coil.stations().map(|s| s.neighbour.is_some()).collect();
    assert!(!beside[begins(TURNS) - 3] && beside[begins(TURNS) + 3]);
}

/// Such a climb was told to be late.
#[test]
fn a_slow_climb_is_as_late_as_where_it_begins() {
    let jumps = [[TURNS - 1.1, TURNS - 1.05].map(|turn| turn * TAU)].into();
    let mut coil = Coil::new(CoilSpec { jumps, ..spec() });
    let mut was_late = false;
    for node in slow_climb() {
        coil.settle(node);
        was_late |= coil.flags().late_jump;
    }
    assert!(
        was_late,
        "{:?}",
        coil.stations()
            .map(|s| (s.angle / TAU, s.layer))
            .filter(|s| s.0 > 4.2 && s.0 < 4.7)
            .step_by(8)
            .collect::<Vec<_>>()
    );
    assert!(!coil.flags().late_jump, "{:?}", coil.defects());
}

/// Wire between a flange and the turn before, with less than its place there, was taken for a next layer where the plan has none, and
/// the coil was aligned.
#[test]
fn the_last_turn_of_the_last_layer_rides_up_on_its_neighbour() {
    let leans = |turns: f64| match (0.3..0.9).contains(&turns.fract()) {
        true => 0.4,
        false => 0.0,
    };
    let one_layer = CoilSpec {
        full: Some(TURNS * TAU),
        jumps: [].into(),
        ..spec()
    };
    let nodes = leaning(leans);
    let one: Vec<SettledNode> = nodes
        .iter()
        .copied()
        .take((nodes.len() as f64 * (TURNS - 0.25) / (2.0 * TURNS - 2.2)) as usize)
        .collect();
    let last = wound(one_layer, &one);
    let told: Vec<_> = last.defects().iter().map(|d| (d.kind, d.turn)).collect();
    // (the turn before leans away from its own neighbour)
    let (gap, overlap) = (DefectKind::Gap, DefectKind::Overlap);
    assert_eq!(told, [(gap, TURNS as u32 - 1), (overlap, TURNS as u32)]);
}

/// A layer up to shortly before the end of its plan, of which each turn leans on the one before over this part of it.
fn ending(part: std::ops::Range<f64>) -> Coil {
    let leans = |turns: f64| match part.contains(&turns.fract()) {
        true => 0.4,
        false => 0.0,
    };
    let spec = CoilSpec {
        full: Some(TURNS * TAU),
        planned: Some(TURNS * TAU),
        ..spec()
    };
    let nodes = leaning(leans);
    let count = nodes.len() as f64 * (TURNS - 0.12) / (2.0 * TURNS - 2.2);
    wound(spec, &nodes[..count as usize])
}

/// Where every turn crosses before the angle of the clamp the end of the last turn has no place, and an even coil was condemned for it.
#[test]
fn the_end_of_a_coil_whose_place_is_taken_is_no_overlap() {
    let found = |from: f64| {
        let coil = ending(from..0.9);
        let begins = coil.without_place_from().map(|at| at as f64 / 360.0);
        (coil.flags().overlap, begins)
    };
    for (from, overlaps) in [(0.3, true), (0.45, true), (0.55, false), (0.7, false)] {
        let (overlap, begins) = found(from);
        assert_eq!(overlap, overlaps, "{from}");
        // (nodes lie two to three stations apart)
        let off = begins.map(|turns| (turns - (TURNS - 1.0) - from).abs());
        assert!(off.is_some_and(|off| off < 0.02), "{from}: {begins:?}");
    }
    assert_eq!(found(0.9), (false, None));
}

/// Wire on the turn before came down again half a turn before the end. It was judged, and excused in the reasons.
#[test]
fn wire_that_comes_down_before_the_end_is_not_excused() {
    let coil = ending(0.15..0.4);
    assert!(coil.flags().overlap);
    assert_eq!(coil.without_place_from(), None);
}

/// In a window of two turns the first lies beside the flange that the layer goes away from, and leaves the second its place. The second
/// was taken for the end of a coil without a place, and its gap was not judged.
#[test]
fn a_turn_beside_the_other_flange_leaves_a_place() {
    let [gap, turns] = [0.4 * D, 2.0];
    let mut nodes = on_cylinder(turns, 1.0, |angle| match angle / TAU {
        turned if turned < 0.9 => (0.0, 0.0),
        turned if turned < 1.0 => ((turned - 0.9) / 0.1 * (D + gap), 0.0),
        _ => (D + gap, 0.0),
    });
    for node in &mut nodes {
        let ways = [-0.5 * D, 1.5 * D + gap].map(|face| face - node.position.y);
        node.flange = Some(if ways[1] < -ways[0] { ways[1] } else { ways[0] });
    }
    let spec = CoilSpec {
        full: Some(turns * TAU),
        planned: Some(turns * TAU),
        ..spec()
    };
    let coil = wound(spec, &nodes);
    assert_eq!(coil.without_place_from(), None);
    let told: Vec<_> = coil.defects().iter().map(|d| (d.kind, d.turn)).collect();
    assert_eq!(told, [(DefectKind::Gap, 2)]);
}

/// Of a coil that rode up turns before its end too, the turns to end with were told, and did not mend it.
#[test]
fn a_coil_that_rides_up_sooner_does_not_end_better() {
    let spec = CoilSpec {
        full: Some(TURNS * TAU),
        planned: Some(TURNS * TAU),
        ..spec()
    };
    let leans = |turns: f64| match (0.55..0.9).contains(&turns.fract()) {
        true => 0.4,
        false => 0.0,
    };
    let mut nodes = leaning(leans);
    let per_turn = nodes.len() as f64 / (2.0 * TURNS - 2.2);
    nodes.truncate((per_turn * (TURNS - 0.12)) as usize);
    for rides in [false, true] {
        if rides {
            // a part of turn 3, on turn 2
            for node in &mut nodes[(2.3 * per_turn) as usize..(2.5 * per_turn) as usize] {
                let out = 1.0 + D / node.position.x.hypot(node.position.z);
                node.position.x *= out;
                node.position.z *= out;
                node.position.y -= D;
                node.height += D;
            }
        }
        let coil = wound(spec.clone(), &nodes);
        let at = coil.without_place_from().expect("no place at the end");
        assert_eq!(coil.rides_up_before(at), rides, "{:?}", coil.defects());
    }
}

#[test]
fn a_climb_that_is_taken_back_was_never_known() {
    taken_back_is_never_known(&slow_climb());
}

#[test]
fn wire_pressed_up_that_is_taken_back_was_never_known() {
    let pressed = |turns: f64| match (0.3..0.5).contains(&turns.fract()) {
        true => 0.4,
        false => 0.0,
    };
    taken_back_is_never_known(&leaning(pressed));
}

/// Measures after so many turns are the same whether more wire had been laid or not.
fn taken_back_is_never_known(nodes: &[SettledNode]) {
    let per_turn = nodes.len() as f64 / (2.0 * TURNS - 2.2);
    let mut told = Coil::new(spec());
    told.begin_pass((TURNS - 0.05) * TAU, -1.0);
    for turn in [4.2, 4.35, 4.49, 4.5, 4.51, 4.59, 4.6, 4.61, 4.8, 5.4] {
        let keep = (turn * per_turn) as usize;
        let mut straight = told.clone();
        nodes[..keep].iter().for_each(|&node| straight.settle(node));
        let mut back = told.clone();
        nodes.iter().for_each(|&node| back.settle(node));
        back.unsettle(nodes.len() - keep);
        assert!(straight == back, "{turn} turns left");
        nodes[keep..].iter().for_each(|&node| back.settle(node));
        nodes[keep..].iter().for_each(|&node| straight.settle(node));
        assert!(straight == back, "wound again from {turn} turns");
    }
}

/// Where it stood half a diameter high it began the next row, and the turn in the groove over it was a double turn.
#[test]
fn a_last_turn_pressed_up_for_a_while_begins_no_row() {
    // wire that the nozzle leads is laid after the nozzle has turned
    for turned in [TURNS - 0.05, TURNS - 0.8] {
        let coil = squeezed(0.15, [0.3, 0.36], turned);
        assert_eq!(coil.flags(), DefectFlags::default(), "{:?}", coil.defects());
        let layers: Vec<u32> = coil.turns().iter().map(|turn| turn.layer).collect();
        assert_eq!(layers, [1, 1, 1, 1, 1, 2, 2, 2]);
        let fifth = |s: &&coilwind::measure::Station| (4.0 * TAU..4.9 * TAU).contains(&s.angle);
        assert!(coil.stations().filter(fifth).all(|s| s.layer == 1));
    }
}

/// It touches the turn before and the flange, and counted as wire that touches nothing.
#[test]
fn a_last_turn_wedged_beside_the_flange_is_not_loose() {
    for lean in [0.05, 0.12] {
        let coil = squeezed(lean, [0.2, 0.85], TURNS - 0.05);
        assert!(!coil.flags().loose_turn, "{:?}", coil.defects());
    }
}

/// What rides up beside a flange goes to the next layer, and is not judged. Out of the last layer of a plan nothing goes.
#[test]
fn a_last_turn_of_the_last_layer_that_rides_up_is_an_overlap() {
    let kinds = |full: Option<f64>, lean: f64| -> Vec<(DefectKind, u32)> {
        let spec = CoilSpec { full, ..spec() };
        let coil = squeezed_in(spec, lean, [0.3, 0.5], TURNS - 0.05);
        let all = coil.defects();
        let found = all.iter().map(|defect| (defect.kind, defect.turn));
        found.filter(|(_, turn)| *turn == 5).collect()
    };
    assert_eq!(kinds(None, 0.2), []);
    let told = kinds(Some(TURNS * TAU), 0.4);
    assert!(told.contains(&(DefectKind::Overlap, 5)), "{told:?}");
}

/// A turn that stood on the one before beside the flange, and came down to its row again, began the next row all the same. The turn
/// after it, in its groove, was a double turn, and what rode up was not told.
#[test]
fn wire_that_comes_down_beside_the_flange_has_ridden_up_and_begun_no_row() {
    for turned in [TURNS - 0.05, TURNS - 0.4] {
        let coil = squeezed(0.4, [0.3, 0.5], turned);
        let all = coil.defects();
        let kinds: Vec<_> = all.iter().map(|d| (d.kind, d.turn)).collect();
        // (the turn before leans over, and so does the one above it)
        let expected = [
            (DefectKind::Overlap, 5),
            (DefectKind::Gap, 4),
            (DefectKind::Gap, 8),
        ];
        assert!(kinds.iter().all(|kind| expected.contains(kind)), "{all:?}");
        assert!(kinds.contains(&expected[0]), "{all:?}");
        let layers: Vec<u32> = coil.turns().iter().map(|turn| turn.layer).collect();
        assert_eq!(layers, [1, 1, 1, 1, 1, 2, 2, 2]);
    }
}

/// It rode up, which is an overlap, and was told to bulge too where it touched flange and turn before all the while.
#[test]
fn a_last_turn_that_rides_up_between_turn_and_flange_does_not_bulge() {
    for lean in [0.1, 0.2, 0.3, 0.4] {
        let spec = CoilSpec {
            full: Some(TURNS * TAU),
            ..spec()
        };
        let coil = squeezed_in(spec, lean, [0.3, 0.5], TURNS - 0.05);
        // (beyond the steps to and from its leaning place)
        let leans = |s: &&coilwind::measure::Station| (4.32 * TAU..4.48 * TAU).contains(&s.angle);
        let bulge = |s: &coilwind::measure::Station| s.bulge.abs();
        let worst = coil.stations().filter(leans).map(bulge).fold(0.0, f64::max);
        assert!(worst < 1e-3 * D, "{lean}: {worst}");
        // as long as three quarters of its place are left it is in its place
        let all = coil.defects();
        let rides_up = all
            .iter()
            .any(|d| (d.kind, d.turn) == (DefectKind::Overlap, 5));
        assert_eq!(rides_up, lean > 0.25, "{lean}: {all:?}");
    }
}

/// It lay on nothing, and so in the first layer, which then was as high as the second.
#[test]
fn wire_that_leans_on_a_turn_lies_in_its_layer() {
    let aside: f64 = 0.92;
    let leaning = 1.0 + (1.0 - aside * aside).sqrt();
    // where the last turn leans on the one before, wire of the first layer has gone on to its next place
    let places = [
        (1.0, 0.0),
        (2.0, 0.0),
        (3.0, 0.0),
        (2.5, 0.75f64.sqrt()),
        (1.02, 1.0),
    ];
    let mut nodes = on_cylinder(5.85, 1.0, |angle| {
        let place = places.get((angle / TAU) as usize).copied();
        let (y, height) = place.unwrap_or((1.02 - aside, leaning));
        (D * y, D * height)
    });
    for node in &mut nodes {
        node.flange = Some(D * (0.52 - aside) - node.position.y);
    }
    let mut coil = wound(spec(), &nodes);
    coil.begin_pass(3.0 * TAU, -1.0);
    let layers: Vec<u32> = coil.turns().iter().map(|turn| turn.layer).collect();
    assert_eq!(layers, [1, 1, 1, 2, 2, 2]);
    let contour = coil.contour();
    assert!(
        contour[0].height_max_m < contour[1].height_mean_m,
        "{contour:?}"
    );
}

/// Wire that stood on the first but one turn, beside no flange, was in a place between that turn and the flange where the first turn
/// lies. Half of a double turn was none.
#[test]
fn wire_high_over_a_place_beside_the_flange_is_not_in_it() {
    // two turns in a window of many, and a third back over the first but one
    let places = [(0.0, 0.0), (0.98, 0.0), (0.9, 1.0)];
    let mut nodes = on_cylinder(2.95, 1.0, |angle| {
        let (y, height) = places[(angle / TAU) as usize];
        (D * y, D * height)
    });
    for node in &mut nodes {
        let way = -0.5 * D - node.position.y;
        node.flange = (way > -2.0 * D).then_some(way);
    }
    let coil = wound(spec(), &nodes);
    assert!(coil.flags().double_turn, "{:?}", coil.defects());
}

/// Where the whole layer bows out, a last turn beside the flange was told to ride up, though it stood hardly higher than at rest. It was so as
/// soon as it lay a tenth of a diameter too close to a turn that had been pressed lower.
#[test]
fn a_last_turn_as_high_as_at_rest_does_not_ride_up() {
    let (bow, low) = (0.86, 0.48);
    for (over, aside, rides_up) in [
        (0.13, 0.895, false),
        (0.25, 0.895, false),
        (0.44, 0.72, true),
    ] {
        let places = [
            (0.0, bow),
            (1.0, bow),
            (2.0, low),
            (2.0 + aside, bow + over),
        ];
        let mut nodes = on_cylinder(3.98, 1.0, |angle| {
            let (y, height) = places[(angle / TAU) as usize];
            (D * y, D * height)
        });
        for node in &mut nodes {
            let way = 3.5 * D - node.position.y;
            node.flange = (way < 2.0 * D).then_some(way);
        }
        let spec = CoilSpec {
            profile: Profile::new(vec![bow * D]),
            full: Some(4.0 * TAU),
            ..spec()
        };
        let coil = wound(spec, &nodes);
        let told: Vec<_> = coil.defects().iter().map(|d| (d.kind, d.turn)).collect();
        let rides = told.contains(&(DefectKind::Overlap, 4));
        assert_eq!(rides, rides_up, "{over}: {told:?}");
        let last = coil.stations().last().unwrap();
        let excess = last.bulge_excess.unwrap();
        assert!((excess - over * D).abs() < 1e-9, "{over}: {}", excess / D);
    }
}

/// Wire that had no place for longer than the last turn was told to have none from the beginning of that turn on. A coil that ended there, as
/// told, ended with wire on the turn before all the same.
#[test]
fn wire_without_a_place_is_told_from_where_it_begins() {
    let mut nodes = on_cylinder(3.95, 1.0, |angle| match angle / TAU {
        turned if turned < 1.0 => (0.0, 0.0),
        turned if turned < 1.7 => (D, 0.0),
        // crosses too soon, and leaves less than half a place
        turned if turned < 2.0 => (1.6 * D, 0.0),
        turned if turned < 2.7 => (2.0 * D, 0.0),
        turned if turned < 3.0 => (2.0 * D, 0.917 * D),
        turned if turned < 3.7 => (2.0 * D, D),
        _ => (2.0 * D, 1.917 * D),
    });
    for node in &mut nodes {
        let way = 2.5 * D - node.position.y;
        node.flange = (way < 2.0 * D).then_some(way);
    }
    let spec = CoilSpec {
        full: Some(4.0 * TAU),
        planned: Some(4.0 * TAU),
        ..spec()
    };
    let begins = wound(spec, &nodes).without_place_from();
    let begins = begins.map(|station| station as f64 / 360.0);
    assert!(
        begins.is_some_and(|turns| (turns - 2.7).abs() < 0.02),
        "{begins:?}"
    );
}
