//! Double turns, skipped grooves, jumps out of turn, loose and stretched wire, made on paper; and what is none of them.

use crate::coils::{D, PULL, on_cylinder, spec, wound};
use coilwind::measure::{
    Coil, CoilSpec, Defect, DefectFlags, DefectKind, STATIONS_PER_TURN, SettledNode, Verdict,
};
use std::f64::consts::TAU;

/// Turns of a layer of the coils here.
const TURNS: f64 = 5.0;

/// Rise from layer to layer in grooves, m.
fn step() -> f64 {
    0.75f64.sqrt() * D
}

/// Defects of one kind.
fn of(kind: DefectKind, coil: &Coil) -> Vec<Defect> {
    let all = coil.defects().into_iter();
    all.filter(|defect| defect.kind == kind).collect()
}

/// The only defect of a kind.
#[track_caller]
fn only(kind: DefectKind, coil: &Coil) -> Defect {
    match &of(kind, coil)[..] {
        [one] => one.clone(),
        _ => panic!("one {kind}: {:?}", coil.defects()),
    }
}

/// Straight over most of a turn, then a step to the next place; a place is y over d and the layer from 0.
fn in_places(places: &'static [(f64, f64)]) -> impl Fn(f64) -> (f64, f64) {
    move |angle| {
        let turn = (angle / TAU).floor();
        let at = |turn: f64| places[(turn as usize).min(places.len() - 1)];
        let aside = ((angle / TAU - turn - 0.9) / 0.1).max(0.0);
        let ((y, layer), (next_y, next)) = (at(turn), at(turn + 1.0));
        let between = |from: f64, to: f64| from + aside * (to - from);
        (D * between(y, next_y), step() * between(layer, next))
    }
}

/// Four turns, a fifth in the groove of the last two, two more beside the fourth.
const DOUBLE: [(f64, f64); 7] = [
    (0.0, 0.0),
    (1.0, 0.0),
    (2.0, 0.0),
    (3.0, 0.0),
    (2.5, 1.0),
    (4.0, 0.0),
    (5.0, 0.0),
];

#[test]
fn a_turn_on_its_own_row_is_a_double_turn() {
    let nodes = on_cylinder(6.8, 1.0, in_places(&DOUBLE));
    let coil = wound(spec(), &nodes);
    let double = only(DefectKind::DoubleTurn, &coil);
    assert_eq!(double.turn, 5);
    assert!((double.size_d.unwrap() - 0.866).abs() < 0.02, "{double:?}");
    assert_eq!(coil.turns()[4].verdict, Verdict::DoubleTurn);
    assert!(coil.flags().double_turn);
    // the turn after it lies where it should, beside the fourth, and has no gap to the fifth
    assert!(
        of(DefectKind::Gap, &coil).iter().all(|gap| gap.turn < 6),
        "{:?}",
        coil.defects()
    );
    assert_eq!(coil.turns()[6].verdict, Verdict::Aligned);
}

/// A double turn that stood off the turns below it was told larger than a wire on a wire can rise.
#[test]
fn what_stands_off_a_turn_of_its_own_row_is_no_part_of_a_double_turn() {
    let place = in_places(&DOUBLE);
    let nodes = on_cylinder(6.8, 1.0, |angle| {
        let (y, height) = place(angle);
        let off = ((angle / TAU - 4.5) / 0.1).abs();
        (y, height + 0.6 * D * (1.0 - off).max(0.0))
    });
    let coil = wound(spec(), &nodes);
    let double = only(DefectKind::DoubleTurn, &coil);
    assert_eq!(double.turn, 5);
    assert!((double.size_d.unwrap() - 0.866).abs() < 0.02, "{double:?}");
    let bulge = only(DefectKind::Bulge, &coil);
    assert_eq!((bulge.turn, bulge.angle_deg), (5, 180.0));
}

/// A nozzle that hung back began a row of its own, so that a turn on other turns was a layer and no defect.
#[test]
fn a_nozzle_that_hangs_back_for_a_turn_begins_no_layer() {
    let nodes = on_cylinder(6.8, 1.0, in_places(&DOUBLE));
    let told = |angles: [f64; 2]| {
        let mut coil = wound(spec(), &nodes);
        coil.begin_pass(angles[0], -1.0);
        assert!(of(DefectKind::DoubleTurn, &coil).is_empty(), "not yet");
        let before = coil.clone();
        coil.begin_pass(angles[1], 1.0);
        let after = coil.clone();
        coil.take_back_pass();
        assert_eq!(coil, before, "taken back as if never told");
        after
    };
    let coil = told([4.0 * TAU, 5.0 * TAU]);
    assert_eq!(only(DefectKind::DoubleTurn, &coil).turn, 5);
    assert_eq!(coil.stations().last().unwrap().pass, 1);
    // a nozzle that stays away for longer winds a layer
    let coil = told([3.6 * TAU, 5.0 * TAU]);
    assert!(of(DefectKind::DoubleTurn, &coil).is_empty());
    assert_eq!(coil.stations().last().unwrap().pass, 3);
}

/// A groove between turns that do not quite touch is wider than one between turns that do: there the layer flickered.
#[test]
fn a_double_turn_in_a_wide_groove_lies_in_the_second_layer_all_round() {
    const WIDE: [(f64, f64); 6] = [
        (0.0, 0.0),
        (1.0, 0.0),
        (2.0, 0.0),
        (3.04, 0.0),
        (2.52, 1.0),
        (4.1, 0.0),
    ];
    let coil = wound(spec(), &on_cylinder(5.8, 1.0, in_places(&WIDE)));
    let whole = 4 * STATIONS_PER_TURN..5 * STATIONS_PER_TURN - 40;
    let layers: Vec<u32> = coil.stations().map(|station| station.layer).collect();
    // (a layer counts once it has for as long as a defect needs)
    let second = &layers[whole.start + 8..whole.end];
    assert!(second.iter().all(|layer| *layer == 2), "{second:?}");
    assert!(layers[..whole.start - 40].iter().all(|layer| *layer == 1));
}

/// The nozzle turned a turn late, and wire stood on its row for most of the turn. What comes before the end of a pass was not judged: a
/// double turn was called an overlap, and the turn after it had a gap.
#[test]
fn a_double_turn_before_the_nozzle_turns_is_one() {
    const LATE: [(f64, f64); 7] = [
        (0.0, 0.0),
        (1.0, 0.0),
        (2.0, 0.0),
        (1.5, 1.0),
        (1.6, 1.0 + 1.0 / 0.866),
        (0.5, 1.0),
        (0.5, 1.0),
    ];
    let mut nodes = on_cylinder(6.0, 1.0, in_places(&LATE));
    for node in &mut nodes {
        let way = 2.6 * D - node.position.y;
        node.flange = (way < 2.0 * D).then_some(way);
    }
    let mut coil = wound(spec(), &nodes);
    coil.begin_pass(4.7 * TAU, -1.0);
    let double = only(DefectKind::DoubleTurn, &coil);
    assert_eq!(double.turn, 5);
    // over the turn that it lies on, and not the one below that
    assert!((double.size_d.unwrap() - 1.0).abs() < 0.02, "{double:?}");
}

#[test]
fn riding_up_for_less_than_half_a_turn_is_an_overlap_and_no_double_turn() {
    let place = |angle: f64| match angle / TAU {
        turn if (4.0..4.4).contains(&turn) => (2.5 * D, step()),
        turn => (D * turn.floor(), 0.0),
    };
    let coil = wound(spec(), &on_cylinder(6.8, 1.0, place));
    assert!(
        coil.flags().overlap && !coil.flags().double_turn,
        "{:?}",
        coil.defects()
    );
}

/// A layer of five, and a second layer back over it in these grooves.
fn two_layers(grooves: &'static [f64]) -> Coil {
    let place = move |angle: f64| {
        let turn = (angle / TAU).floor();
        let at = |turn: f64| match turn < TURNS {
            true => (turn, 0.0),
            false => (
                grooves[((turn - TURNS) as usize).min(grooves.len() - 1)],
                1.0,
            ),
        };
        let aside = ((angle / TAU - turn - 0.9) / 0.1).max(0.0);
        let ((y, layer), (next_y, next)) = (at(turn), at(turn + 1.0));
        (
            D * (y + aside * (next_y - y)),
            step() * (layer + aside * (next - layer)),
        )
    };
    let turns = TURNS + grooves.len() as f64 - 0.15;
    let mut coil = wound(spec(), &on_cylinder(turns, 1.0, place));
    coil.begin_pass((TURNS - 0.05) * TAU, -1.0);
    coil
}

#[test]
fn a_groove_left_out_is_found_where_it_is() {
    let coil = two_layers(&[4.5, 3.5, 1.5, 0.5]);
    let skipped = only(DefectKind::SkippedGroove, &coil);
    assert_eq!((skipped.turn, skipped.layer), (8, 2));
    assert!(
        (skipped.size_d.unwrap() - 1.0).abs() < 0.02,
        "a whole wire has room: {skipped:?}"
    );
    assert_eq!(coil.turns()[7].verdict, Verdict::SkippedGroove);
    let whole = two_layers(&[4.5, 3.5, 2.5, 1.5, 0.5]);
    assert_eq!(
        whole.flags(),
        DefectFlags::default(),
        "{:?}",
        whole.defects()
    );
}

/// Wire of a layer that is planned to be so many turns.
fn planned(turns: f64) -> CoilSpec {
    CoilSpec {
        jumps: [[(turns - 0.1) * TAU, turns * TAU]].into(),
        ..spec()
    }
}

/// Five turns, then back over them.
fn jumping(spec: CoilSpec) -> Coil {
    jumping_up_to(9.0, spec)
}

/// The same up to this turn.
fn jumping_up_to(end: f64, spec: CoilSpec) -> Coil {
    let place = |angle: f64| {
        let turn = (angle / TAU).floor();
        match turn < TURNS {
            true => (D * turn, 0.0),
            false => (D * (2.0 * TURNS - 0.5 - turn), step()),
        }
    };
    let mut coil = wound(spec, &on_cylinder(end, 1.0, place));
    coil.begin_pass(TURNS * TAU, -1.0);
    coil
}

#[test]
fn a_jump_is_early_or_late_by_the_plan_only() {
    for turns in [4.6, 5.0, 5.4] {
        let coil = jumping(planned(turns));
        assert_eq!(
            coil.flags(),
            DefectFlags::default(),
            "{turns}: {:?}",
            coil.defects()
        );
    }
    assert_eq!(
        jumping(spec()).flags(),
        DefectFlags::default(),
        "nothing is planned"
    );
    let early = jumping(planned(6.0));
    let jump = only(DefectKind::EarlyJump, &early);
    assert_eq!((jump.turn, jump.layer), (6, 2), "{jump:?}");
    assert!(
        (jump.size_d.unwrap() - 0.9).abs() < 0.05,
        "a turn, less the step: {jump:?}"
    );
    assert!(!early.flags().late_jump);
    let late = jumping(planned(4.0));
    let jump = only(DefectKind::LateJump, &late);
    assert_eq!((jump.turn, jump.layer), (5, 1), "{jump:?}");
    assert!((jump.size_d.unwrap() - 1.0).abs() < 0.05, "{jump:?}");
    assert_eq!(late.turns()[4].verdict, Verdict::LateJump);
}

/// Nothing said that wire climbed out of the last layer of a plan, or out of the only one.
#[test]
fn a_climb_out_of_the_last_layer_is_early() {
    let one_layer = |full: f64| CoilSpec {
        full: Some(full * TAU),
        ..spec()
    };
    // the coil is not whole yet
    let jump = only(DefectKind::EarlyJump, &jumping(one_layer(12.0)));
    assert_eq!((jump.turn, jump.layer), (6, 2));
    assert!((jump.size_d.unwrap() - 7.0).abs() < 0.05, "{jump:?}");
    // the last turn, known where it ends
    let jump = only(DefectKind::EarlyJump, &jumping(one_layer(6.0)));
    assert!((jump.size_d.unwrap() - 1.0).abs() < 0.05, "{jump:?}");
    // the last third of that turn has not come to rest: no defect was told
    let last = |end: f64| jumping_up_to(end, one_layer(6.0)).flags().early_jump;
    assert!(last(5.65) && !last(5.45));
    // what comes after the plan is not judged
    assert!(!jumping(one_layer(5.0)).flags().early_jump);
}

/// Of wire that climbed twice before its jump the second climb was told, at another place and by fewer turns.
#[test]
fn wire_that_climbs_twice_is_early_from_its_first_climb() {
    let place = |angle: f64| match (angle / TAU).floor() {
        turn if turn < 5.0 => (D * turn, 0.0),
        turn if turn < 9.0 => (D * (9.5 - turn), step()),
        turn => (D * (turn - 8.0), 2.0 * step()),
    };
    let mut coil = wound(planned(12.0), &on_cylinder(12.2, 1.0, place));
    coil.begin_pass(5.0 * TAU, -1.0);
    coil.begin_pass(9.0 * TAU, 1.0);
    let jump = only(DefectKind::EarlyJump, &coil);
    assert_eq!((jump.turn, jump.layer), (6, 2));
    assert!((jump.size_d.unwrap() - 6.9).abs() < 0.05, "{jump:?}");
}

/// Turns side by side, altered where `is_there` says.
fn altered(is_there: impl Fn(f64) -> bool, alter: impl Fn(&mut SettledNode)) -> Coil {
    let mut nodes = on_cylinder(6.0, 1.0, |angle| (D * angle / TAU, 0.0));
    // a node comes to rest a second after its angle has reached 30 rad
    let there = |node: &&mut SettledNode| is_there(node.time * 30.0 / TAU);
    nodes.iter_mut().filter(there).for_each(alter);
    wound(spec(), &nodes)
}

#[test]
fn wire_that_hangs_loose_over_half_a_turn_is_a_loose_turn() {
    let loose = altered(
        |turn| (3.0..3.6).contains(&turn),
        |node| node.height += 0.2 * D,
    );
    let turn = only(DefectKind::LooseTurn, &loose);
    // where it stands off, from the start of its fourth turn on
    assert!(turn.turn == 4 && turn.angle_deg < 220.0, "{turn:?}");
    assert!((turn.size_d.unwrap() - 0.2).abs() < 0.01, "{turn:?}");
    let short = altered(
        |turn| (3.0..3.4).contains(&turn),
        |node| node.height += 0.2 * D,
    );
    assert!(!short.flags().loose_turn && !short.flags().bulge);
}

/// Wire on its way to the next layer, which is not judged, made a turn loose, by a height that no table had.
#[test]
fn wire_on_its_way_to_the_next_layer_is_not_loose() {
    let loose = |turned: f64| {
        let mut coil = altered(
            |turn| (3.0..3.6).contains(&turn),
            |node| {
                node.height += if node.time > 3.5 * TAU / 30.0 {
                    0.4
                } else {
                    0.2
                } * D
            },
        );
        coil.begin_pass(turned * TAU, -1.0);
        of(DefectKind::LooseTurn, &coil)
    };
    let [turn] = &loose(5.9)[..] else {
        panic!("a turn that hangs loose over its judged wire is");
    };
    assert!((turn.size_d.unwrap() - 0.4).abs() < 0.01, "{turn:?}");
    // its middle was named with a size that is elsewhere
    assert!((179.0..220.0).contains(&turn.angle_deg), "{turn:?}");
    assert_eq!(loose(3.65), [], "a quarter of a turn before is not judged");
}

#[test]
fn a_turn_with_less_than_half_its_tension_is_loose() {
    let slack = |share: f64| {
        let there = |turn| (2.0..4.0).contains(&turn);
        altered(there, |node| node.tension = share * PULL)
    };
    let turn = only(DefectKind::LooseTurn, &slack(0.3));
    assert!((3..=4).contains(&turn.turn), "{turn:?}");
    assert_eq!(turn.size_m, None, "it lies where it should");
    assert_eq!(slack(0.6).flags(), DefectFlags::default());
}

#[test]
fn one_noisy_node_raises_nothing() {
    let nodes = on_cylinder(6.0, 1.0, |angle| (D * angle / TAU, 0.0));
    for noise in [0.2, 0.9] {
        let mut noisy = nodes.clone();
        let node = &mut noisy[600];
        (node.tension, node.plastic_strain) = (0.0, noise);
        node.height += noise * D;
        let coil = wound(spec(), &noisy);
        assert_eq!(coil.flags(), DefectFlags::default(), "{:?}", coil.defects());
    }
}

#[test]
fn wire_drawn_out_is_overstretched_where_it_is() {
    let stretched = altered(
        |turn| (3.2..3.3).contains(&turn),
        |node| node.plastic_strain = 0.03,
    );
    let place = only(DefectKind::Overstretch, &stretched);
    assert_eq!(place.turn, 4);
    let around = TAU * (crate::coils::RADIUS + D / 2.0);
    assert!(
        (place.size_m.unwrap() - 0.03 * around).abs() < 0.02 * around * 0.03,
        "{place:?}"
    );
    let within = altered(
        |turn| (3.2..3.3).contains(&turn),
        |node| node.plastic_strain = 0.019,
    );
    assert!(!within.flags().overstretch);
}

/// Of wire drawn out in its first turn, only what lay between clamp and place was told: a fifth of the stretch.
#[test]
fn wire_drawn_out_in_its_first_turn_is_so_by_a_turn() {
    let stretched = altered(|turn| turn > 0.2, |node| node.plastic_strain = 0.03);
    let turn = TAU * (crate::coils::RADIUS + D / 2.0);
    let size = only(DefectKind::Overstretch, &stretched).size_m.unwrap();
    assert!((size / turn - 0.03).abs() < 0.001, "{size}");
}

/// Verdicts of the complete turns from the second on.
fn verdicts(coil: &Coil) -> Vec<Verdict> {
    let turns = coil.turns();
    turns[1..5].iter().map(|turn| turn.verdict).collect()
}

/// One run over all of the wire was told in the turn where it is largest, and the turns beside it were aligned.
#[test]
fn every_turn_of_wire_that_is_drawn_out_is_overstretched() {
    let stretched = altered(|turn| turn > 1.0, |node| node.plastic_strain = 0.3);
    only(DefectKind::Overstretch, &stretched);
    assert_eq!(verdicts(&stretched), [Verdict::Overstretch; 4]);
}

/// The stretch beside the clamp, where nothing is judged, cut it in two.
#[test]
fn wire_that_is_drawn_out_from_its_clamp_on_is_one_defect() {
    let stretched = altered(|_| true, |node| node.plastic_strain = 0.3);
    only(DefectKind::Overstretch, &stretched);
}

#[test]
fn every_turn_that_lies_without_tension_is_loose() {
    let slack = altered(|turn| turn > 2.0, |node| node.tension = 0.3 * PULL);
    only(DefectKind::LooseTurn, &slack);
    assert_eq!(verdicts(&slack)[1..], [Verdict::LooseTurn; 3]);
}

/// Of a coil that is loose throughout turn 2 was aligned, and its row of loose turns was cut in two there: a turn back its wire lies
/// beside the clamp.
#[test]
fn a_coil_that_is_loose_from_its_clamp_on_is_one_defect() {
    for alter in [
        (|node: &mut SettledNode| node.tension = 0.3 * PULL) as fn(&mut SettledNode),
        |node| node.height += 0.2 * D,
    ] {
        let slack = altered(|_| true, alter);
        only(DefectKind::LooseTurn, &slack);
        assert_eq!(slack.turns()[1].verdict, Verdict::LooseTurn);
    }
}

/// A nozzle that goes beyond each place and comes back to it seemed to hang back for ever: its coil had one pass, and all wire
/// after the first jump was a bulge.
#[test]
fn a_nozzle_that_swings_past_each_place_turns_with_the_layer() {
    let plain = two_layers(&[3.5, 2.5, 1.5, 0.5]);
    assert_eq!(plain.flags(), DefectFlags::default());
    let mut coil = plain.clone();
    coil.take_back_pass();
    let mut turn_at =
        |turn: f64, sense: f64, place: f64| coil.begin_pass_at(turn * TAU, sense, place * D);
    for place in 1..5 {
        let place = f64::from(place);
        turn_at(place - 0.05, -1.0, place + 1.5);
        if place < 4.0 {
            turn_at(place + 0.9, 1.0, place);
        }
    }
    for place in 0..4 {
        let place = f64::from(place);
        turn_at(place + 4.95, 1.0, 2.0 - place);
        turn_at(place + 5.9, -1.0, 3.5 - place);
    }
    assert_eq!(coil.stations().last().unwrap().pass, 2);
    assert_eq!(coil.flags(), DefectFlags::default(), "{:?}", coil.defects());
}
