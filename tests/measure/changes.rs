//! Wire that is unwound, settled again or judged by new limits.

use crate::coils::{D, eventful, helix, limits, on_cylinder, spec, wound};
use coilwind::measure::{Coil, CoilSpec, DefectFlags, DefectLimits, SettledNode};
use std::f64::consts::TAU;

/// Winding angle at which the nozzle turns back, rad.
const TURN: f64 = 24.01;

fn settle_all(coil: &mut Coil, nodes: &[SettledNode]) {
    nodes.iter().for_each(|&node| coil.settle(node));
}

#[test]
fn what_was_taken_back_was_never_settled() {
    let nodes = eventful();
    for keep in [0, 1, 2, 150, 300, 450, 599, 600, 601, 670] {
        // Passes are the caller's: both coils are told the same.
        let mut straight = Coil::new(spec());
        straight.begin_pass(TURN, -1.0);
        let mut back = straight.clone();
        settle_all(&mut straight, &nodes[..keep]);
        settle_all(&mut back, &nodes);
        back.unsettle(nodes.len() - keep);
        assert_eq!(straight, back, "keep {keep}");
        // And goes on the same.
        settle_all(&mut straight, &nodes[keep..]);
        settle_all(&mut back, &nodes[keep..]);
        assert_eq!(straight, back, "keep {keep}, wound again");
        assert!(straight.defect_count() >= 2);
    }
}

#[test]
fn taking_back_more_than_there_is_leaves_nothing() {
    let mut coil = wound(spec(), &helix(1.2, D));
    coil.unsettle(usize::MAX);
    assert!(coil.is_empty());
    assert_eq!(coil, Coil::new(spec()));
}

#[test]
fn flags_fall_when_the_defect_is_unwound() {
    let nodes = helix(2.0, 1.4 * D);
    let mut coil = wound(spec(), &nodes);
    assert!(coil.flags().gap);
    coil.unsettle(nodes.len() / 2);
    assert_eq!(coil.flags(), DefectFlags::default());
    assert_eq!(coil.last_defect(), None);
    assert!(coil.turns_settled() < 1.01);
}

#[test]
fn incremental_measures_equal_those_of_a_whole_coil() {
    let nodes = eventful();
    let whole = wound(spec(), &nodes);
    let (laid, live) = nodes.split_at(500);
    let coil = wound(spec(), laid);
    let before = coil.clone();
    assert_eq!(coil.what_if(live), whole);
    assert_eq!(coil, before, "a look ahead changes nothing");
    assert_eq!(coil.what_if(live).turns(), whole.turns());
}

#[test]
fn new_limits_judge_old_wire() {
    let mut coil = wound(spec(), &helix(2.0, 1.3 * D));
    assert!(coil.flags().gap);
    let loose = DefectLimits {
        gap: 0.5,
        ..limits()
    };
    coil.set_limits(loose);
    assert!(!coil.flags().gap);
    assert_eq!(
        coil,
        wound(
            CoilSpec {
                limits: loose,
                ..spec()
            },
            &helix(2.0, 1.3 * D)
        )
    );
}

/// Wire was labelled by what the nozzle did when it came to rest, up to a turn after it was laid.
#[test]
fn a_pass_begins_at_the_wire_laid_as_the_nozzle_turned() {
    let nodes = eventful();
    let mut known = Coil::new(spec());
    known.begin_pass(TURN, -1.0);
    settle_all(&mut known, &nodes);
    assert!(known.stations().all(|s| (s.pass == 2) == (s.angle >= TURN)));
    // The nozzle is seen to have turned only once wire laid after that has come to rest.
    for late in [610, 640, nodes.len()] {
        let mut coil = Coil::new(spec());
        settle_all(&mut coil, &nodes[..late]);
        coil.begin_pass(TURN, -1.0);
        settle_all(&mut coil, &nodes[late..]);
        assert_eq!(coil, known, "told after node {late}");
        coil.take_back_pass();
        let one_pass = wound(spec(), &nodes);
        assert_eq!(coil, one_pass);
    }
}

#[test]
fn the_way_of_winding_may_be_known_late() {
    let nodes = on_cylinder(2.5, -1.0, |angle| (-1.1 * D * angle / TAU, 0.0));
    let mut coil = wound(spec(), &nodes);
    assert_eq!(coil.turns_settled(), 0.0, "it seems to be unwound");
    coil.set_direction(-1.0);
    coil.set_first_sense(-1.0);
    let known = CoilSpec {
        direction: -1.0,
        ..spec()
    };
    assert!((coil.turns_settled() - 2.5).abs() < 0.01);
    assert!((coil.mean_pitch() - 1.1 * D).abs() < 1e-3 * D);
    let mut expected = Coil::new(known);
    expected.set_first_sense(-1.0);
    settle_all(&mut expected, &nodes);
    assert_eq!(coil, expected);
}
