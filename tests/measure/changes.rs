//! Wire that is unwound, settled again or judged by new limits.

use crate::coils::{D, eventful, helix, limits, spec, wound};
use coilwind::measure::{Coil, CoilSpec, DefectFlags, DefectLimits, SettledNode};

fn settle_all(coil: &mut Coil, nodes: &[SettledNode], from: usize) {
    for (node, &settled) in nodes.iter().enumerate().skip(from) {
        coil.set_traverse(if node < 600 { 1.0 } else { -1.0 });
        coil.settle(settled);
    }
}

#[test]
fn what_was_taken_back_was_never_settled() {
    let nodes = eventful();
    for keep in [0, 1, 2, 150, 300, 450, 599, 600, 601, 670] {
        let mut straight = Coil::new(spec());
        settle_all(&mut straight, &nodes[..keep], 0);
        let mut back = Coil::new(spec());
        settle_all(&mut back, &nodes, 0);
        back.unsettle(nodes.len() - keep);
        // The traverse is the caller's: both are told the same.
        straight.set_traverse(1.0);
        back.set_traverse(1.0);
        assert_eq!(straight, back, "keep {keep}");
        // And goes on the same.
        settle_all(&mut straight, &nodes, keep);
        settle_all(&mut back, &nodes, keep);
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
