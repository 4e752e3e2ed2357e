//! Gap, pitch and state of the coil where they follow from the pitch of a helix.

use crate::coils::{
    D, PULL, RADIUS, developed_distance, eventful, helix, on_cylinder, spec, wound,
};
use coilwind::math::V3;
use coilwind::measure::{
    Coil, CoilSpec, DefectFlags, STATIONS_PER_TURN, SettledNode, Station, Verdict, Worst,
};
use std::f64::consts::{PI, TAU};

#[test]
fn nothing_settled_says_nothing() {
    let coil = Coil::new(spec());
    assert_eq!(coil.flags(), DefectFlags::default());
    assert_eq!(coil.worst(), Worst::default());
    assert_eq!(coil.defect_count(), 0);
    assert_eq!(coil.last_defect(), None);
    assert_eq!(
        (coil.turns_settled(), coil.coil_width(), coil.mean_pitch()),
        (0.0, 0.0, 0.0)
    );
    assert_eq!(
        (coil.fill_factor(), coil.wire_strain(), coil.layer()),
        (0.0, 0.0, 1)
    );
    assert_eq!(coil.verdict(), Verdict::Unsettled);
    assert!(coil.turns().is_empty());
}

#[test]
fn helix_on_a_cylinder_has_the_gap_of_its_pitch() {
    let around = TAU * (RADIUS + D / 2.0);
    for pitch in [D, 1.1 * D, 1.6 * D] {
        let coil = wound(spec(), &helix(3.2, pitch));
        let distance = developed_distance(pitch, around);
        // The nearest point lies square to the wire, so its axial part is shorter once more.
        let (expected, axial) = (distance - D, distance * distance / pitch);
        for station in coil.stations().filter(|s| s.angle > TAU + 1.0) {
            let neighbour = station.neighbour.expect("second turn has a neighbour");
            // Chords 0.4 mm long cut 2 um into the cylinder, aslant to the distance.
            assert!(
                (neighbour.gap - expected).abs() < 5e-9,
                "{pitch} {station:?}"
            );
            assert!(
                (neighbour.axial - axial).abs() < 5e-6 * pitch,
                "{station:?}"
            );
        }
        let turns = coil.turns();
        assert_eq!(turns[0].gap_mean, None);
        assert_eq!(turns[0].verdict, Verdict::Single);
        assert!((turns[1].gap_mean.unwrap() - expected).abs() < 5e-9);
        assert!((coil.mean_pitch() - axial).abs() < 5e-6 * pitch);
        assert!((coil.coil_width() - (3.2 * pitch + D)).abs() < 0.01 * pitch);
        assert!((coil.turns_settled() - 3.2).abs() < 0.01);
    }
}

#[test]
fn verdicts_follow_the_pitch() {
    let cases = [
        (1.0, Verdict::Aligned),
        (1.04, Verdict::Aligned),
        (1.12, Verdict::Marginal),
        (1.3, Verdict::Gap),
    ];
    for (pitch, verdict) in cases {
        let coil = wound(spec(), &helix(2.3, pitch * D));
        assert_eq!(coil.turns()[1].verdict, verdict, "{pitch}");
        assert_eq!(coil.verdict(), verdict);
        assert_eq!(coil.flags().gap, verdict == Verdict::Gap);
    }
}

#[test]
fn wire_wound_backwards_measures_the_same() {
    let place = |angle: f64| (1.1 * D * angle / TAU, 0.0);
    let forward = wound(spec(), &on_cylinder(2.5, 1.0, place));
    let backward = wound(
        CoilSpec {
            direction: -1.0,
            ..spec()
        },
        &on_cylinder(2.5, -1.0, place),
    );
    for (a, b) in forward.stations().zip(backward.stations()) {
        assert!((a.position.z + b.position.z).abs() < 1e-12);
        assert_eq!(a.neighbour.is_some(), b.neighbour.is_some());
        if let (Some(a), Some(b)) = (a.neighbour, b.neighbour) {
            assert!((a.gap - b.gap).abs() < 1e-12);
        }
    }
    assert_eq!(forward.turns()[1].verdict, backward.turns()[1].verdict);
}

#[test]
fn traverse_towards_minus_y_has_positive_axial_distance() {
    let nodes = on_cylinder(2.2, 1.0, |angle| (-D * angle / TAU, 0.0));
    let coil = wound(
        CoilSpec {
            traverse: -1.0,
            ..spec()
        },
        &nodes,
    );
    assert!((coil.mean_pitch() - D).abs() < 2e-4 * D);
    assert_eq!(coil.verdict(), Verdict::Aligned);
}

/// A point at length `s` round a rectangle `w` by `h` (along x and z) rounded by `r`, from the
/// middle of the face on +x towards +z.
fn on_rounded_rectangle(w: f64, h: f64, r: f64, s: f64) -> (f64, f64) {
    let (a, b, corner) = (w / 2.0 - r, h / 2.0 - r, PI / 2.0 * r);
    let quarter = a + b + corner;
    let s = s.rem_euclid(4.0 * quarter);
    let (quadrant, mut t) = ((s / quarter) as usize, s % quarter);
    // Opposite quadrants run the other way round: mirror the length and then the axes.
    if quadrant % 2 == 1 {
        t = quarter - t;
    }
    let (x, z) = if t < b {
        (a + r, t)
    } else if t < b + corner {
        let phi = (t - b) / r;
        (a + r * libm::cos(phi), b + r * libm::sin(phi))
    } else {
        (a - (t - b - corner), b + r)
    };
    match quadrant {
        0 => (x, z),
        1 => (-x, z),
        2 => (-x, -z),
        _ => (x, -z),
    }
}

#[test]
fn helix_on_a_rounded_box_has_the_gap_of_its_pitch_at_enough_stations() {
    let (w, h, r) = (12e-3 + D, 30e-3 + D, 2e-3 + D / 2.0);
    let around = 2.0 * (w + h) - 8.0 * r + TAU * r;
    let pitch = 1.2 * D;
    let nodes: Vec<_> = (0..=(2.4 * around / 0.4e-3) as usize)
        .map(|node| {
            let s = node as f64 * 0.4e-3;
            let (x, z) = on_rounded_rectangle(w, h, r, s);
            SettledNode {
                flange: None,
                position: V3::new(x, pitch * s / around, z),
                arc: s,
                height: 0.0,
                plastic_strain: 0.0,
                tension: PULL,
                time: 0.0,
            }
        })
        .collect();
    let corner_angle = libm::atan2(15e-3, 6e-3);
    let coil = wound(
        CoilSpec {
            corner_angle,
            ..spec()
        },
        &nodes,
    );
    let expected = developed_distance(pitch, around) - D;
    let second: Vec<&Station> = coil
        .stations()
        .skip(STATIONS_PER_TURN)
        .take(STATIONS_PER_TURN)
        .collect();
    for station in &second {
        // At a 2.35 mm corner chords of 0.4 mm cut 9 um deep.
        assert!(
            (station.neighbour.unwrap().gap - expected).abs() < 2e-7,
            "{station:?}"
        );
    }
    assert_eq!(coil.turns()[1].verdict, Verdict::Gap);
    let on = |test: &dyn Fn(f64, f64) -> bool| {
        second
            .iter()
            .filter(|s| test(s.position.x, s.position.z))
            .count()
    };
    let (a, b) = (w / 2.0 - r, h / 2.0 - r);
    assert!(on(&|x, z| x > 0.0 && z.abs() < b) >= 10);
    assert!(on(&|x, z| z > 0.0 && x.abs() < a) >= 10);
    assert!(on(&|x, z| x > a && z > b) >= 3);
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
fn node_positions_do_not_move_the_stations() {
    let a = wound(spec(), &helix(2.0, D));
    let finer: Vec<_> = (0..=2000)
        .map(|k| {
            let angle = f64::from(k) * TAU / 1000.0;
            let r = RADIUS + D / 2.0;
            SettledNode {
                flange: None,
                position: V3::new(r * libm::cos(angle), D * angle / TAU, r * libm::sin(angle)),
                arc: r * angle,
                height: 0.0,
                plastic_strain: 0.0,
                tension: PULL,
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
    assert!((coil.wire_strain() - 1e-5 * 3.0 * TAU).abs() < 1e-6);
    assert_eq!(coil.layer(), 1);
}
