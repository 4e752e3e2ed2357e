//! Turns that step to their places in crossovers: what lies between two that cross one after the other is no gap.

use crate::coils::{D, on_cylinder, spec, wound};
use coilwind::measure::{Coil, CoilSpec, Crossover, DefectKind, SettledNode, Verdict};
use std::f64::consts::TAU;

/// Angle of a crossover, rad.
const ANGLE: f64 = TAU / 6.0;

/// Six turns of which each crosses by `earlier` (rad) before the one before, with `beyond` (diameters) between the fourth and the
/// third.
fn crossing(earlier: f64, beyond: f64, crossover: Option<Crossover>) -> Coil {
    let spec = CoilSpec {
        crossover,
        ..spec()
    };
    wound(spec, &nodes(earlier, beyond))
}

fn nodes(earlier: f64, beyond: f64) -> Vec<SettledNode> {
    let place = |turn: f64| turn + if turn >= 3.0 { beyond } else { 0.0 };
    on_cylinder(6.0, 1.0, |angle| {
        // the end of crossover `turn`, which leads from that turn to the next
        let end = |turn: f64| (turn + 0.9) * TAU - earlier * turn;
        let turn = (0..6)
            .map(f64::from)
            .find(|turn| angle < end(*turn))
            .unwrap_or(6.0);
        let share = (1.0 - (end(turn) - angle) / ANGLE).max(0.0);
        (
            D * (place(turn) + share * (place(turn + 1.0) - place(turn))),
            0.0,
        )
    })
}

fn planned() -> Option<Crossover> {
    Some(Crossover {
        step: D,
        angle: ANGLE,
    })
}

fn gaps(coil: &Coil) -> Vec<u32> {
    let all = coil.defects().into_iter();
    let gaps = all.filter(|defect| defect.kind == DefectKind::Gap);
    gaps.map(|defect| defect.turn).collect()
}

/// Coils of three layers, each wire in its groove, were told to have a gap in every turn of the third.
#[test]
fn turns_that_cross_one_after_the_other_leave_no_gap() {
    let earlier = 20.0_f64.to_radians();
    let unplanned = crossing(earlier, 0.0, None);
    assert!(gaps(&unplanned).len() > 3, "the test tells them apart");
    let coil = crossing(earlier, 0.0, planned());
    assert_eq!(gaps(&coil), [0; 0]);
    let crossing_share = |coil: &Coil| {
        let stations: Vec<bool> = coil.stations().map(|s| s.crosses).collect();
        stations.iter().filter(|crosses| **crosses).count() as f64 / stations.len() as f64
    };
    assert_eq!(crossing_share(&unplanned), 0.0);
    let share = crossing_share(&coil);
    assert!(
        (0.3..0.5).contains(&share),
        "{share} of the wire is left out"
    );
}

#[test]
fn a_gap_beside_crossovers_is_one() {
    for earlier in [0.0, 0.2] {
        assert_eq!(gaps(&crossing(earlier, 0.3, planned())), [4]);
    }
}

/// A turn that crossed to its next place long before the one before it left a hole as wide as a turn, which was called a crossover.
#[test]
fn a_hole_that_crossovers_cannot_leave_is_a_gap() {
    let shifted = |early: f64| {
        let nodes = on_cylinder(6.0, 1.0, |angle| {
            let end = |turn: f64| {
                let early = if turn == 3.0 { early } else { 0.0 };
                (turn + 0.9) * TAU - early
            };
            let turn = (0..6).map(f64::from).find(|turn| angle < end(*turn));
            let turn = turn.unwrap_or(6.0);
            let share = (1.0 - (end(turn) - angle) / ANGLE).max(0.0);
            (D * (turn + share), 0.0)
        });
        gaps(&wound(
            CoilSpec {
                crossover: planned(),
                ..spec()
            },
            &nodes,
        ))
    };
    assert_eq!(shifted(0.4 * ANGLE), [0; 0], "crossovers may differ");
    assert_eq!(shifted(2.5 * ANGLE), [4]);
}

/// Five turns and five more back over them, `aside` (diameters) from the middle of their grooves for most of each turn.
fn second_layer(aside: f64, crossover: Option<Crossover>) -> Coil {
    let nodes = on_cylinder(9.0, 1.0, |angle| {
        let turn = (angle / TAU).floor();
        let share = ((angle / TAU - turn - 1.0) * TAU / ANGLE + 1.0).max(0.0);
        match turn < 5.0 {
            true => (D * (turn + share), 0.0),
            false => {
                let beside = 0.5 - aside;
                (
                    D * (8.5 + aside - turn - share),
                    D * (1.0 - beside * beside).sqrt(),
                )
            }
        }
    });
    let mut coil = wound(
        CoilSpec {
            crossover,
            ..spec()
        },
        &nodes,
    );
    coil.begin_pass(4.9 * TAU, -1.0);
    coil
}

/// Turns that stood on those of the layer below, out of their grooves, were aligned.
#[test]
fn turns_on_top_of_the_layer_below_are_not_aligned() {
    let verdicts = |coil: &Coil| -> Vec<Verdict> {
        let turns = coil.turns();
        turns[6..8].iter().map(|turn| turn.verdict).collect()
    };
    let seated = second_layer(0.0, planned());
    assert_eq!(verdicts(&seated), [Verdict::Aligned; 2]);
    assert!(seated.turns().iter().all(|turn| turn.out_of_groove == 0.0));
    let standing = second_layer(0.4, planned());
    assert_eq!(verdicts(&standing), [Verdict::Marginal; 2]);
    let share = standing.turns()[7].out_of_groove;
    assert!((0.5..0.8).contains(&share), "{share}");
    // wire of a layer without grooves has to stand on others
    let helical = second_layer(0.4, None);
    assert_eq!(verdicts(&helical), [Verdict::Aligned; 2]);
}

/// What is taken back leaves what was there before, crossovers too.
#[test]
fn crossovers_are_forgotten_with_their_wire() {
    let (whole, nodes) = (crossing(0.1, 0.3, planned()), nodes(0.1, 0.3));
    let mut again = whole.clone();
    again.unsettle(700);
    assert!(again.len() < whole.len());
    for node in &nodes[again.len()..] {
        again.settle(*node);
    }
    assert_eq!(again, whole);
}
