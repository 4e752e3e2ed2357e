//! Measures do not depend on how the wire came to rest: all at once, bit by bit, or taken back in between.

mod made;

use coilwind::math::V3;
use coilwind::measure::DefectLimits;
use coilwind::measure::{Coil, CoilSpec, DefectFlags, STATIONS_PER_TURN, SettledNode, Station};
use made::{D, RADIUS, helix, limits, on_cylinder, spec, wound};
use std::f64::consts::{PI, TAU};

/// Three turns with a gap in the second, a turn that rides up, and a traverse that turns back.
fn eventful() -> Vec<SettledNode> {
    on_cylinder(4.3, 1.0, |angle| match angle / TAU {
        turn if turn < 1.4 => (D * turn, 0.0),
        turn if turn < 2.2 => (D * turn + 0.3 * D, 0.0),
        turn if turn < 2.6 => (D * (turn - 0.7), 0.9 * D),
        turn => (D * turn, 0.2 * D),
    })
}

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

/// The obvious twin: every station against every segment of the whole wire one turn back.
fn gap_by_brute_force(station: &Station, nodes: &[SettledNode], angles: &[f64]) -> f64 {
    let target = station.angle - TAU;
    let near = |k: usize| (angles[k] - target).abs() <= 0.5 + 0.04;
    let least = (1..nodes.len())
        .filter(|&k| near(k - 1) && near(k))
        .map(|k| {
            let (a, b) = (nodes[k - 1].position, nodes[k].position);
            let (ab, ap) = (b - a, station.position - a);
            let t = (ap.dot(&ab) / ab.norm_squared()).clamp(0.0, 1.0);
            (ap - ab * t).norm()
        })
        .fold(f64::INFINITY, f64::min);
    least - D
}

#[test]
fn pointer_search_finds_what_brute_force_finds() {
    let nodes = eventful();
    let points: Vec<V3> = nodes.iter().map(|node| node.position).collect();
    let angles = coilwind::math::unwrap_angles(&points, 0.0, 1.0);
    let coil = wound(spec(), &nodes);
    let mut compared = 0;
    for station in coil.stations() {
        if let Some(neighbour) = station.neighbour {
            let gap = gap_by_brute_force(station, &nodes, &angles);
            assert!((neighbour.gap - gap).abs() < 1e-15, "{station:?}: {gap}");
            compared += 1;
        }
    }
    assert!(compared > 3 * STATIONS_PER_TURN);
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

#[test]
fn node_positions_do_not_move_the_stations() {
    let a = wound(spec(), &helix(2.0, D));
    let finer: Vec<_> = (0..=2000)
        .map(|k| {
            let angle = f64::from(k) * TAU / 1000.0;
            let r = RADIUS + D / 2.0;
            SettledNode {
                position: V3::new(r * libm::cos(angle), D * angle / TAU, r * libm::sin(angle)),
                arc: r * angle,
                height: 0.0,
                plastic_strain: 0.0,
                time: 0.0,
            }
        })
        .collect();
    let b = wound(spec(), &finer);
    for (a, b) in a.stations().zip(b.stations()) {
        assert_eq!(a.angle, b.angle);
        assert!((a.position - b.position).norm() < 3e-6);
        assert!((a.arc - b.arc).abs() < 1e-9);
    }
}

#[test]
fn coil_state_is_that_of_the_made_coil() {
    let coil = wound(spec(), &helix(3.0, D));
    let fill = PI / 4.0 * 3.0 / 4.0;
    assert!(
        (coil.fill_factor() - fill).abs() < 0.01 * fill,
        "{}",
        coil.fill_factor()
    );
    assert!((coil.wire_strain() - 1e-3 * 3.0 * TAU).abs() < 1e-4);
    assert_eq!(coil.layer(), 1);
    let profile = coil.height_profile(2).unwrap();
    assert_eq!(profile.heights().len(), STATIONS_PER_TURN);
    assert!(coil.height_profile(0).is_none() && coil.height_profile(4).is_none());
}
