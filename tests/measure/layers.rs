//! Coils of several layers, made on paper: where a layer is one, where a neighbour is one, and what lies below.

use crate::coils::{D, on_cylinder, spec, wound};
use coilwind::measure::{
    Coil, CoilSpec, DefectFlags, DefectKind, STATIONS_PER_TURN, SettledNode, Station, Verdict,
};
use std::f64::consts::TAU;

/// Turns of a layer of the coils here.
pub(crate) const TURNS: f64 = 5.0;

/// Rise from layer to layer in grooves, m.
pub(crate) fn step() -> f64 {
    0.75f64.sqrt() * D
}

/// Place of wire `angle` after the clamp in a coil of layers in grooves: y and height over the core.
///
/// Straight over most of a turn, a step to the next groove in the rest, as orthocyclic winding has it.
pub(crate) fn orthocyclic(angle: f64) -> (f64, f64) {
    let turn = (angle / TAU).floor();
    let within = angle / TAU - turn;
    let layer = (turn / TURNS).floor();
    let place = |turn: f64| {
        let layer = (turn / TURNS).floor();
        let along = turn - layer * TURNS;
        let back = layer % 2.0 == 1.0;
        D * if back { TURNS - 0.5 - along } else { along }
    };
    let aside = ((within - 0.9) / 0.1).max(0.0);
    let y = place(turn) + aside * (place(turn + 1.0) - place(turn));
    let next = ((turn + 1.0) / TURNS).floor();
    (y, step() * (layer + aside * (next - layer)))
}

fn coil_of(layers: u32) -> Coil {
    // Without the last turn's step, which would climb to a layer that is not there.
    let nodes = on_cylinder(f64::from(layers) * TURNS - 0.15, 1.0, orthocyclic);
    let mut coil = wound(spec(), &nodes);
    for layer in 1..layers {
        let sense = if layer % 2 == 1 { -1.0 } else { 1.0 };
        coil.begin_pass((f64::from(layer) * TURNS - 0.05) * TAU, sense);
    }
    coil
}

/// Turns of a coil of single turns: one on the other, or from flange to flange `aside` (m) and back. Each climbs over the last
/// `climb` turns before the clamp's angle comes round again, earlier by a hundredth turn by turn.
fn single_turns(turns: u32, aside: f64) -> Coil {
    let rise = (D * D - aside * aside).sqrt();
    let place = |angle: f64| {
        let turn = (angle / TAU).floor();
        let climb = ((angle / TAU - turn - 0.95 + 0.01 * turn) / 0.05).clamp(0.0, 1.0);
        let at = |turn: f64| aside * (turn % 2.0);
        let y = at(turn) + climb * (at(turn + 1.0) - at(turn));
        (y, rise * (turn + climb))
    };
    let jumps = (1..turns).map(|turn| {
        let end = f64::from(turn) * TAU;
        [end - 0.2 * TAU, end]
    });
    let spec = CoilSpec {
        jumps: jumps.collect(),
        ..spec()
    };
    wound(spec, &on_cylinder(f64::from(turns) - 0.15, 1.0, place))
}

/// The nozzle of a window that holds one turn does not move, or goes back after a turn as if it had hung back: from the third turn on
/// all of them were double turns, overlaps and bulges.
#[test]
fn layers_of_one_turn_are_layers() {
    for aside in [0.0, 0.4 * D, 0.6 * D] {
        let coil = single_turns(7, aside);
        assert_eq!(coil.flags(), DefectFlags::default(), "{:?}", coil.defects());
        assert_eq!(coil.layers(), 7, "{aside}");
        let layers: Vec<u32> = coil.turns().iter().map(|turn| turn.layer).collect();
        assert_eq!(layers, [1, 2, 3, 4, 5, 6, 7]);
    }
}

/// What a layer leaves free beside a flange was not measured.
#[test]
fn first_and_last_turns_of_a_layer_say_how_far_the_flange_is() {
    let faces = [-0.7 * D, (TURNS + 0.1) * D];
    let mut nodes = on_cylinder(2.0 * TURNS - 0.15, 1.0, orthocyclic);
    for node in &mut nodes {
        let ways = faces.map(|face| face - node.position.y);
        let nearer = if ways[1] < -ways[0] { ways[1] } else { ways[0] };
        node.flange = Some(nearer);
    }
    let mut coil = wound(spec(), &nodes);
    coil.begin_pass((TURNS - 0.05) * TAU, -1.0);
    let rooms: Vec<Option<f64>> = coil.turns().iter().map(|t| t.flange_gap).collect();
    let expected = [0.2, 0.6, 0.1, 0.7];
    let told: Vec<usize> = (0..rooms.len()).filter(|k| rooms[*k].is_some()).collect();
    assert_eq!(told, [0, 4, 5, 9]);
    for (room, expected) in rooms.iter().flatten().zip(expected) {
        assert!((room / D - expected).abs() < 1e-3, "{rooms:?}");
    }
}

/// The first turn of a pass was compared with the beginning of its pass: gaps of 6 to 12 mm, and `layer` flickered
/// in grooves.
#[test]
fn layers_in_grooves_have_neither_gaps_nor_flicker() {
    let coil = coil_of(4);
    assert_eq!(coil.flags(), DefectFlags::default(), "{:?}", coil.defects());
    assert!(coil.worst().gap_width < 0.05 * D);
    let layers: Vec<u32> = coil.stations().map(|s| s.layer).collect();
    let changes = layers.windows(2).filter(|pair| pair[0] != pair[1]).count();
    assert_eq!((changes, layers.last()), (3, Some(&4)));
    for station in coil.stations() {
        let within = station.angle / TAU % 1.0;
        let straight = (0.02..0.85).contains(&within);
        let over = format!("turn {:.2}: {station:?}", station.angle / TAU);
        assert!(!straight || station.bulge.abs() < 0.01 * D, "{over}");
        assert!(!straight || station.overlap_depth == 0.0, "{over}");
        if let (Some(n), true) = (station.neighbour, straight) {
            assert!(
                n.gap.abs() < 0.02 * D && (n.axial - D).abs() < 0.02 * D,
                "{over}"
            );
        }
    }
    let turns = coil.turns();
    for (k, turn) in turns.iter().enumerate() {
        let first = k as f64 % TURNS == 0.0;
        let expected = if first {
            Verdict::Single
        } else {
            Verdict::Aligned
        };
        assert_eq!(turn.verdict, expected, "{turn:?}");
        let place = (k as u32 / TURNS as u32 + 1, k as u32 % TURNS as u32 + 1);
        assert_eq!((turn.layer, turn.turn_in_layer), place, "{turn:?}");
    }
}

/// The turn in its layer was late by up to 1.8 turns: it counted from where the nozzle had turned, once that had gone on for a while.
#[test]
fn a_layer_begins_where_wire_climbs_to_it() {
    const CLIMB: f64 = 0.05;
    for shift in [0.0, 0.3, -0.4] {
        let jumps = (1..3).map(|layer| {
            let end = f64::from(layer) * TURNS + shift;
            [(end - 2.0 * CLIMB) * TAU, end * TAU]
        });
        let mut coil = Coil::new(CoilSpec {
            jumps: jumps.collect(),
            ..spec()
        });
        let mut told = Vec::new();
        for node in on_cylinder(3.0 * TURNS - 0.15, 1.0, orthocyclic) {
            coil.settle(node);
            // the nozzle is half a turn ahead of wire that comes to rest, and seen to have turned half a turn later
            let pass = coil.passes() as f64;
            if coil.turns_settled() > pass * TURNS + 0.1 {
                let sense = if coil.passes() % 2 == 1 { -1.0 } else { 1.0 };
                coil.begin_pass((pass * TURNS - CLIMB) * TAU, sense);
            }
            // wire is laid a little ahead of what has come to rest
            let laid = coil.turns_settled() + 0.3;
            told.push((laid, laid - coil.layer_being_laid(laid * TAU).1 / TAU));
        }
        for (laid, told) in told {
            let climbed = ((laid + CLIMB) / TURNS).floor().min(2.0) * TURNS;
            let expected = laid - if climbed > 0.0 { climbed - CLIMB } else { 0.0 };
            // wire that climbs elsewhere than planned is known to once it lies still: a quarter of a turn beyond the plan where it is late
            let from_climb = (laid - TURNS * (laid / TURNS).round()).abs();
            let is_known = from_climb > if shift == 0.0 { 0.1 } else { 1.0 };
            let off = (told - expected).abs();
            assert!(
                !is_known || off < 0.1,
                "{shift}: {laid:.2} is told as {told:.2}, and is {expected:.2}"
            );
        }
        // the tables count alike
        for turn in &coil.turns()[..3 * TURNS as usize - 1] {
            let middle = f64::from(turn.turn) - 0.5;
            let of_turn = (middle + CLIMB).rem_euclid(TURNS);
            assert_eq!(of_turn.ceil() as u32, turn.turn_in_layer, "{turn:?}");
        }
    }
}

/// A nozzle that goes back by two pitches once makes no gap where the pass begins anew.
#[test]
fn going_back_by_two_pitches_once_is_no_gap() {
    let place = |angle: f64| match angle / TAU {
        t if t < 3.0 => (D * t, 0.0),
        t if t < 5.0 => (D * (6.0 - t), step()),
        t => (D * (t - 1.0), 0.0),
    };
    let mut coil = wound(spec(), &on_cylinder(8.0, 1.0, place));
    assert!(coil.flags().gap, "one pass would have gaps");
    coil.begin_pass(3.0 * TAU, -1.0);
    coil.begin_pass(5.0 * TAU, 1.0);
    assert!(!coil.flags().gap, "{:?}", coil.defects());
    let without = |s: &&Station| s.neighbour.is_none();
    // The first turn of each of three rows, which begin up to half a wire's way after the nozzle has turned.
    let count = coil.stations().filter(without).count();
    assert!(
        (3 * STATIONS_PER_TURN - 50..=3 * STATIONS_PER_TURN).contains(&count),
        "{count}"
    );
}

/// A bulge in the second layer was judged by the height of the first, or of the nearest wire beside it.
#[test]
fn a_bulge_in_the_second_layer_is_measured_over_the_first() {
    let nodes: Vec<SettledNode> = on_cylinder(2.0 * TURNS - 0.15, 1.0, |angle| {
        let (y, height) = orthocyclic(angle);
        let off = (7.3..7.6).contains(&(angle / TAU));
        (y, height + if off { 1.2 * D } else { 0.0 })
    });
    let mut coil = wound(spec(), &nodes);
    coil.begin_pass((TURNS - 0.05) * TAU, -1.0);
    let defects = coil.defects();
    let bulges: Vec<_> = defects
        .iter()
        .filter(|d| d.kind == DefectKind::Bulge)
        .collect();
    let [bulge] = bulges[..] else {
        panic!("one bulge: {:?}", coil.defects());
    };
    assert_eq!(
        (bulge.kind.as_str(), bulge.turn, bulge.layer),
        ("bulge", 8, 2)
    );
    assert!((100.0..220.0).contains(&bulge.angle_deg), "{bulge:?}");
    assert!((bulge.size_d.unwrap() - 1.2).abs() < 0.02, "{bulge:?}");
}

/// Wire that has no room left at the flange climbs just before the nozzle turns, which was an overlap.
#[test]
fn the_step_to_the_next_layer_is_no_overlap() {
    let turn = 4.0;
    let place = |angle: f64| match angle / TAU {
        t if t < turn - 0.15 => (D * t, 0.0),
        // Squeezed in half a wire on, then back in the grooves.
        t if t < turn + 1.0 => (D * (turn - 0.65), 0.76 * D),
        t => (D * (2.0 * turn + 0.35 - t), step()),
    };
    let nodes = on_cylinder(6.0, 1.0, place);
    let mut coil = wound(spec(), &nodes);
    assert!(coil.flags().overlap, "as long as the nozzle has not turned");
    coil.begin_pass(turn * TAU, -1.0);
    assert!(!coil.flags().overlap, "{:?}", coil.defects());
    assert_eq!(coil.turns()[3].verdict, Verdict::Aligned);
    // A climb that begins earlier is one.
    let mut early = wound(spec(), &nodes);
    early.begin_pass((turn + 0.3) * TAU, -1.0);
    let defects = early.defects();
    let overlap = defects.iter().any(|d| d.kind == DefectKind::Overlap);
    assert!(overlap, "{defects:?}");
}

/// A second layer the second turn of which lies on the climb of the first beside the flange, up to this turn of the wire, then in
/// its groove.
fn crossing_the_climb(until: f64) -> Coil {
    let place = |angle: f64| {
        let (y, height) = orthocyclic(angle);
        if !(TURNS + 0.9..until).contains(&(angle / TAU)) {
            return (y, height);
        }
        let (before, below) = orthocyclic(angle - TAU);
        let aside = y - before;
        (
            y.max(before - 0.7 * D),
            below + (D * D - aside * aside).max(0.51 * D * D).sqrt(),
        )
    };
    let mut coil = wound(spec(), &on_cylinder(2.0 * TURNS - 0.15, 1.0, place));
    coil.begin_pass((TURNS - 0.05) * TAU, -1.0);
    coil
}

/// Wire crosses the place where its row began to climb. The part before the row's first station was what it was laid over, the
/// part after it was a neighbour that it rode up on.
#[test]
fn crossing_the_climb_beside_the_flange_was_an_overlap() {
    let crossing = crossing_the_climb(TURNS + 1.1);
    let stands =
        |s: &&Station| s.height > 1.5 * D && s.neighbour.is_some_and(|n| n.axial < 0.9 * D);
    let count = crossing.stations().filter(stands).count();
    assert!(count > 30, "it stands on its neighbour: {count}");
    assert!(!crossing.flags().overlap, "{:?}", crossing.defects());
    assert_eq!(crossing.turns()[5].verdict, Verdict::Single);
    assert_eq!(crossing.turns()[6].verdict, Verdict::Marginal);
    // Wire that does not come down from there rides on its neighbour.
    let riding = crossing_the_climb(TURNS + 1.4);
    assert!(riding.flags().overlap, "{:?}", riding.defects());
    assert_eq!(riding.turns()[6].verdict, Verdict::Overlap);
}

/// A second layer whose second turn lies on its first one over a quarter of a turn, on the climb of that and along it: no overlap was told.
#[test]
fn wire_along_the_climb_of_its_own_row_has_ridden_up() {
    let rides = |angle: f64| (TURNS + 1.0..TURNS + 1.2).contains(&(angle / TAU));
    let along = |aside: f64| {
        let place = |angle: f64| {
            let (y, height) = orthocyclic(angle);
            if !rides(angle) {
                return (y, height);
            }
            let (y, below) = orthocyclic(angle - TAU);
            (y - aside * D, below + D * (1.0 - aside * aside).sqrt())
        };
        let mut coil = wound(spec(), &on_cylinder(2.0 * TURNS - 0.15, 1.0, place));
        coil.begin_pass((TURNS - 0.05) * TAU, -1.0);
        coil
    };
    let on_top = along(0.02);
    let overlaps = on_top.defects().into_iter();
    let overlap = overlaps.filter(|d| d.kind == DefectKind::Overlap).count();
    assert_eq!(overlap, 1, "{:?}", on_top.defects());
    // beside the climb it leans on it; wire that crosses it by a table was an overlap or none, as it lay 0.01 d nearer or farther
    for aside in [0.7, 0.52, 0.48, 0.38] {
        let beside = along(aside);
        assert!(!beside.flags().overlap, "{aside}: {:?}", beside.defects());
    }
}

/// Wire had climbed early. In its last layer it lay on its own first turn for more than half a turn, and came down again. That was
/// told as a jump as well, early by all turns of the layer.
#[test]
fn a_double_turn_after_an_early_jump_is_no_jump() {
    let rides = |angle: f64| (TURNS + 0.97..TURNS + 1.7).contains(&(angle / TAU));
    let place = |angle: f64| {
        if !rides(angle) {
            return orthocyclic(angle);
        }
        let (y, below) = orthocyclic(angle - TAU);
        (y, below + D)
    };
    let jump = [TURNS + 0.75, TURNS + 0.8].map(|turn| turn * TAU);
    let plan = CoilSpec {
        jumps: [jump].into(),
        full: Some((2.0 * TURNS + 0.8) * TAU),
        ..spec()
    };
    let mut coil = wound(plan, &on_cylinder(2.0 * TURNS - 0.15, 1.0, place));
    coil.begin_pass((TURNS - 0.05) * TAU, -1.0);
    let defects = coil.defects();
    let of = |kind| defects.iter().filter(move |d| d.kind == kind);
    assert_eq!(of(DefectKind::DoubleTurn).count(), 1, "{defects:?}");
    let early: Vec<_> = of(DefectKind::EarlyJump).map(|d| d.turn).collect();
    assert_eq!(early, [TURNS as u32], "{defects:?}");
}

/// Place of wire in three layers between flanges. Before the last turn of the second layer wire sinks into the hole beside the
/// flange, down to the first layer's height, and comes up again.
fn sunk_beside_the_flange(angle: f64) -> (f64, f64) {
    let turn = angle / TAU;
    let sunk = (0.33 * D, 0.3 * D);
    match turn {
        t if (8.86..8.98).contains(&t) => sunk,
        t if (8.98..9.02).contains(&t) => {
            let share = (t - 8.98) / 0.04;
            let (y, height) = orthocyclic(9.5 * TAU);
            (
                sunk.0 + share * (y - sunk.0),
                sunk.1 + share * (height - sunk.1),
            )
        }
        _ => orthocyclic(angle),
    }
}

/// Wire that came up from a hole beside the flange began the next row. The last turn of its layer was in that row, and the first of
/// the next layer, which lies half a pitch back, was an overlap and a double turn.
#[test]
fn wire_that_comes_up_from_a_hole_beside_the_flange_goes_on_in_its_row() {
    let face = -0.5 * D;
    let mut nodes = on_cylinder(3.0 * TURNS - 0.15, 1.0, sunk_beside_the_flange);
    for node in &mut nodes {
        let way = face - node.position.y;
        node.flange = (way > -2.0 * D).then_some(way);
    }
    let mut coil = wound(spec(), &nodes);
    // the nozzle turns where the wire of the third layer begins
    coil.begin_pass((TURNS - 0.05) * TAU, -1.0);
    coil.begin_pass((2.0 * TURNS + 0.02) * TAU, 1.0);
    let turns = coil.turns();
    for (turn, place) in [(10, (2, 5)), (11, (3, 1)), (12, (3, 2))] {
        let turn = &turns[turn - 1];
        assert_eq!((turn.layer, turn.turn_in_layer), place, "{turn:?}");
    }
    let verdicts: Vec<Verdict> = turns[9..].iter().map(|turn| turn.verdict).collect();
    assert!(
        verdicts.iter().all(|verdict| !verdict.is_defect()),
        "{:?}",
        coil.defects()
    );
    // the hole itself stays told
    let defects = coil.defects();
    let kinds: Vec<_> = defects.iter().map(|d| (d.kind, d.turn)).collect();
    assert_eq!(kinds, [(DefectKind::Gap, 9)], "{defects:?}");
}

/// Wire on its way to the next layer lay between a flange and the last turn, more than 30 degrees beside it, and was told to bulge.
#[test]
fn wire_between_a_flange_and_a_turn_lies_on_both() {
    let aside = 0.93;
    let rise = |aside: f64| (1.0 - aside * aside).sqrt();
    let wedged = rise(aside);
    let nodes = |room: f64| -> Vec<SettledNode> {
        let place = |angle: f64| match (angle / TAU).floor() {
            // it climbs, and slips on towards the flange
            last if last >= 2.0 && angle < 2.1 * TAU => (D * 1.8, D * rise(0.8)),
            last if last >= 2.0 => (D * (1.0 + aside), D * wedged),
            turn => (D * turn, 0.0),
        };
        let mut nodes = on_cylinder(3.0, 1.0, place);
        for node in &mut nodes {
            node.flange = Some(D * (1.0 + aside + room + 0.5) - node.position.y);
        }
        nodes
    };
    for (room, drop) in [(0.0, 0.0), (0.03, wedged - rise(0.96)), (0.2, wedged)] {
        let mut coil = wound(spec(), &nodes(room));
        coil.begin_pass(2.0 * TAU, -1.0);
        let bulge = coil
            .stations()
            .nth(2 * 360 + 200)
            .expect("a third turn")
            .bulge;
        assert!((bulge - drop * D).abs() < 1e-3 * D, "{room}: {bulge}");
    }
}

/// The second turn of a layer had a bulge of minus half a diameter, as if the first lay below it and not between it and the flange.
#[test]
fn wire_beyond_the_turn_beside_a_flange_lies_on_the_core() {
    // (wire on wire is never level to the last digit)
    let place = |angle: f64| match angle < TAU {
        true => (0.0, 0.0),
        false => (-D, 1e-4 * D),
    };
    let mut nodes = on_cylinder(1.9, 1.0, place);
    for node in &mut nodes {
        node.flange = Some(1.4 * D - node.position.y);
    }
    let coil = wound(
        CoilSpec {
            traverse: -1.0,
            ..spec()
        },
        &nodes,
    );
    let station = coil.stations().nth(360 + 200).expect("a second turn");
    assert!(station.bulge.abs() < 1e-3 * D, "{}", station.bulge);
}

/// Five turns, four in their grooves and two more, between flanges. Each turn crosses to its next place between 0.8 and 0.9 of a turn.
/// In the first layer that leaves a hole beside the first flange, which the last but one turn of the second sinks into.
fn sinks_beside_the_flange() -> Vec<SettledNode> {
    let groove = libm::sqrt(1.0 - 0.4 * 0.4);
    let wedge = groove + libm::sqrt(1.0 - 0.6 * 0.6);
    let at = |turn: f64| match turn {
        turn if turn < 5.0 => (turn, 0.0),
        turn if turn < 9.0 => (8.6 - turn, groove),
        turn if turn < 10.0 => (0.0, wedge),
        turn => (turn - 9.0, 2.0 * groove),
    };
    let mut nodes = on_cylinder(10.9, 1.0, |angle| {
        let (turn, within) = ((angle / TAU).floor(), (angle / TAU).fract());
        let (y, height) = match within {
            within if turn == 7.0 && (0.8..0.9).contains(&within) => (0.0, 0.0),
            within if within < 0.8 => at(turn),
            _ => at(turn + 1.0),
        };
        (D * y, D * height)
    });
    for node in &mut nodes {
        let ways = [-0.5 * D, 5.5 * D].map(|face| face - node.position.y);
        node.flange = Some(if ways[1] < -ways[0] { ways[1] } else { ways[0] });
    }
    nodes
}

/// The turn after wire in a hole had turned back by what the hole lies farther out. Its row was that of the layer to come, whose first
/// turn then stood on its own row: a double turn, an overlap and a bulge.
#[test]
fn wire_that_comes_up_from_a_hole_has_not_turned() {
    let mut coil = wound(spec(), &sinks_beside_the_flange());
    coil.begin_pass(4.8 * TAU, -1.0);
    coil.begin_pass(8.0 * TAU, 1.0);
    let flags = coil.flags();
    assert!(!flags.double_turn && !flags.overlap, "{:?}", coil.defects());
    let layer = |turn: usize| coil.stations().nth(360 * turn + 180).unwrap().layer;
    assert_eq!([7, 8, 9, 10].map(layer), [2, 2, 3, 3]);
}
