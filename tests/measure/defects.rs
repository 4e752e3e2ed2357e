//! Gaps, overlaps and bulges that are made on purpose, and what is none.

use crate::coils::{D, limits, on_cylinder, spec, wound};
use coilwind::measure::{
    BulgeLimit, CoilSpec, DefectFlags, DefectKind, DefectLimits, Profile, STATION_STEP,
    STATIONS_PER_TURN, Verdict,
};
use std::f64::consts::{PI, TAU};

#[test]
fn a_made_gap_is_found_where_it_is() {
    // Turn 2 steps aside by 0.4 d from 2 to 3 rad of its angle.
    let aside = |angle: f64| {
        let within = angle - TAU;
        D * angle / TAU
            + if (2.0..3.0).contains(&within) {
                0.4 * D
            } else {
                0.0
            }
    };
    let coil = wound(spec(), &on_cylinder(2.0, 1.0, |angle| (aside(angle), 0.0)));
    let turn = &coil.turns()[1];
    assert_eq!(turn.verdict, Verdict::Gap);
    assert!((turn.gap_max.unwrap() - 0.4 * D).abs() < 2e-3 * D);
    assert!((turn.gap_run - 1.0 / TAU).abs() < 1.5 / STATIONS_PER_TURN as f64);
    assert_eq!(
        coil.flags(),
        DefectFlags {
            gap: true,
            ..DefectFlags::default()
        }
    );
    let place = coil.last_defect().unwrap();
    assert_eq!(place.turn, 2);
    // Found when a tenth of a turn is above the limit.
    assert!(
        (place.angle - (2.0 + 0.1 * TAU)).abs() < 2.0 * STATION_STEP,
        "{place:?}"
    );
    assert_eq!(coil.defect_count(), 1);
    assert!((coil.worst().gap_width - 0.4 * D).abs() < 2e-3 * D);
    // and its lasting gap is the limit between a gap and none
    let lasting = coil.lasting_gap(2).unwrap();
    assert!((lasting - 0.4 * D).abs() < 2e-3 * D, "{lasting}");
    for share in [0.9999, 1.0001] {
        let mut coil = coil.clone();
        coil.set_limits(DefectLimits {
            gap: share * lasting / D,
            ..limits()
        });
        assert_eq!(coil.flags().gap, share < 1.0);
    }
}

/// A run over the border of two turns raised the flag, and neither turn had the verdict.
#[test]
fn a_defect_over_the_border_of_two_turns_belongs_to_one() {
    let aside = |angle: f64| {
        let off = (2.0 * TAU - 0.4..2.0 * TAU + 0.4).contains(&angle);
        D * angle / TAU + if off { 0.4 * D } else { 0.0 }
    };
    let all = DefectLimits {
        skip_angle: 0.0,
        ..limits()
    };
    let spec = CoilSpec {
        limits: all,
        ..spec()
    };
    let coil = wound(spec, &on_cylinder(2.8, 1.0, |angle| (aside(angle), 0.0)));
    let [gap] = &coil.defects()[..] else {
        panic!("one gap: {:?}", coil.defects());
    };
    assert_eq!(coil.defect_count(), 1);
    let verdicts: Vec<_> = coil.turns().iter().map(|turn| turn.verdict).collect();
    assert_eq!(
        verdicts[gap.turn as usize - 1],
        Verdict::Gap,
        "{verdicts:?}"
    );
    assert_eq!(coil.verdict(), Verdict::Gap);
}

#[test]
fn a_gap_shorter_than_its_fraction_is_no_defect() {
    let aside = |angle: f64| {
        let within = angle - TAU;
        D * angle / TAU
            + if (2.0..2.5).contains(&within) {
                0.4 * D
            } else {
                0.0
            }
    };
    let coil = wound(spec(), &on_cylinder(2.0, 1.0, |angle| (aside(angle), 0.0)));
    assert_eq!(coil.turns()[1].verdict, Verdict::Marginal);
    assert!(!coil.flags().gap);
    assert!(coil.lasting_gap(2).unwrap() < 1e-2 * D);
    assert_eq!(coil.lasting_gap(3), None);
}

#[test]
fn swapped_turns_overlap() {
    // Turn 2 lands on the far side of turn 1.
    let y = |angle: f64| if angle < TAU { 0.0 } else { -1.02 * D };
    let coil = wound(spec(), &on_cylinder(1.8, 1.0, |angle| (y(angle), 0.0)));
    let turn = &coil.turns()[1];
    assert_eq!(turn.verdict, Verdict::Overlap);
    assert_eq!(turn.overlap_max, D, "no more than a wire is wide");
    assert!(coil.flags().overlap);
}

#[test]
fn wire_riding_up_overlaps_and_is_in_the_second_layer() {
    // Turn 2 lies at 0.3 d from turn 1 and touches it from above, from 2 to 4 rad.
    let place = |angle: f64| {
        let within = angle - TAU;
        if within < 0.0 {
            (0.0, 0.0)
        } else if (2.0..4.0).contains(&within) {
            (0.3 * D, (1.0f64 - 0.09).sqrt() * D)
        } else {
            (1.02 * D, 0.0)
        }
    };
    let coil = wound(spec(), &on_cylinder(2.0, 1.0, place));
    let turn = &coil.turns()[1];
    assert_eq!(turn.verdict, Verdict::Overlap);
    assert!((turn.overlap_max - 0.7 * D).abs() < 1e-3 * D);
    assert_eq!(turn.layer_max, 2);
    assert!(coil.flags().overlap && !coil.flags().gap);
    let on_top = coil.stations().nth(STATIONS_PER_TURN + 170).unwrap();
    assert_eq!(on_top.layer, 2);
    assert!(on_top.neighbour.unwrap().gap.abs() < 2e-3 * D);
    let beside = coil.stations().nth(STATIONS_PER_TURN + 300).unwrap();
    assert_eq!(beside.layer, 1);
}

/// One station made the verdict, and eight the flag: wire that leans on its neighbour for seven degrees was an `overlap` without a
/// defect.
#[test]
fn a_verdict_of_overlap_wants_as_long_a_run_as_the_flag() {
    let leaning = |stations: f64| {
        let place = move |angle: f64| match angle - TAU {
            within if within < 0.0 => (0.0, 0.0),
            within if (2.0..2.0 + stations * STATION_STEP).contains(&within) => {
                (0.85 * D, 0.53 * D)
            }
            _ => (1.02 * D, 0.0),
        };
        wound(spec(), &on_cylinder(2.0, 1.0, place))
    };
    let brief = leaning(5.0);
    assert!(brief.turns()[1].overlap_max > 0.1 * D);
    assert!(!brief.flags().overlap);
    assert_eq!(brief.turns()[1].verdict, Verdict::Aligned);
    assert_eq!(brief.verdict(), Verdict::Aligned);
    let long = leaning(12.0);
    assert!(long.flags().overlap);
    assert_eq!(long.turns()[1].verdict, Verdict::Overlap);
}

#[test]
fn a_second_layer_after_the_traverse_turned_back_is_no_defect() {
    // Three turns out, then turns in the valleys above on the way back.
    let valley = 0.75f64.sqrt() * D;
    let out = on_cylinder(3.0, 1.0, |angle| (D * (angle / TAU).floor(), 0.0));
    let all = on_cylinder(5.0, 1.0, |angle| {
        let turn = (angle / TAU).floor();
        if turn < 3.0 {
            (D * turn, 0.0)
        } else {
            (D * (4.5 - turn), valley)
        }
    });
    let mut coil = wound(spec(), &out);
    coil.begin_pass(3.0 * TAU, -1.0);
    for &node in &all[out.len()..] {
        coil.settle(node);
    }
    assert_eq!(coil.flags(), DefectFlags::default());
    assert_eq!(coil.layer(), 2);
    let station = coil.stations().nth(3 * STATIONS_PER_TURN + 100).unwrap();
    assert_eq!(
        (station.pass, station.layer, station.neighbour),
        (2, 2, None)
    );
    assert!((station.height - valley).abs() < 1e-9);
    assert!(station.bulge.abs() < 1e-9, "lies on the wires below");
    let last = coil.stations().nth(4 * STATIONS_PER_TURN + 100).unwrap();
    assert!((last.neighbour.unwrap().axial - D).abs() < 1e-6 * D);
}

/// Where the nozzle turns, nothing is judged for a quarter of a turn: that cut a gap of one row in two.
#[test]
fn a_gap_that_goes_on_where_the_nozzle_turns_is_one() {
    let aside = |turn: f64| if turn > 3.3 { 0.5 * D } else { 0.0 };
    let beside = |angle: f64| (D * angle / TAU + aside(angle / TAU), 0.0);
    let mut coil = wound(spec(), &on_cylinder(4.28, 1.0, beside));
    coil.begin_pass(4.1 * TAU, -1.0);
    let defects = coil.defects();
    assert!(
        matches!(&defects[..], [gap] if gap.kind == DefectKind::Gap),
        "{defects:?}"
    );
}

#[test]
fn bulge_is_judged_against_the_quasi_static_height() {
    let stand_off = |angle: f64| 1.5 * D * libm::sin(angle).powi(2);
    let profile = Profile::new(
        (0..720)
            .map(|k| stand_off(f64::from(k) * TAU / 720.0))
            .collect(),
    );
    let nodes = |share: f64| {
        on_cylinder(2.0, 1.0, move |angle| {
            (D * angle / TAU, share * stand_off(angle))
        })
    };
    let quiet = wound(
        CoilSpec {
            profile: profile.clone(),
            ..spec()
        },
        &nodes(1.0),
    );
    assert!(!quiet.flags().bulge);
    assert!(
        (quiet.worst().bulge_height - 1.5 * D).abs() < 1e-3 * D,
        "reported as it is"
    );
    assert!(quiet.turns()[1].bulge_excess_max.unwrap().abs() < 2e-3 * D);

    let fast = wound(
        CoilSpec {
            profile: profile.clone(),
            ..spec()
        },
        &nodes(1.5),
    );
    assert!(fast.flags().bulge);
    assert_eq!(fast.turns()[1].verdict, Verdict::Bulge);
    assert!((fast.turns()[1].bulge_excess_max.unwrap() - 0.75 * D).abs() < 2e-3 * D);

    let no_yardstick = wound(
        CoilSpec {
            profile: None,
            ..spec()
        },
        &nodes(1.5),
    );
    assert_eq!(no_yardstick.turns()[1].bulge_excess_max, None);
    let diameter = BulgeLimit::Fallback { limit_m: D };
    assert_eq!(no_yardstick.bulge_limit(), diameter);
    assert!(
        no_yardstick.flags().bulge,
        "2.25 d of clear air were aligned for want of a yardstick"
    );
    assert_eq!(no_yardstick.turns()[0].verdict, Verdict::Bulge);
    let low = wound(
        CoilSpec {
            profile: None,
            ..spec()
        },
        &nodes(0.6),
    );
    assert!(!low.flags().bulge, "0.9 d are within the fallback limit");
    let absolute = DefectLimits {
        bulge_absolute: 1e-3,
        ..limits()
    };
    assert!(
        wound(
            CoilSpec {
                profile: None,
                limits: absolute,
                ..spec()
            },
            &nodes(1.0)
        )
        .flags()
        .bulge
    );
}

#[test]
fn bulge_is_given_per_face() {
    for (face, middle) in [0.0, PI / 2.0, PI, 1.5 * PI].into_iter().enumerate() {
        for direction in [1.0, -1.0] {
            let place = |angle: f64| {
                let from = libm::cos(direction * angle - middle);
                (D * angle / TAU, if from > 0.9 { D } else { 0.0 })
            };
            let coil = wound(
                CoilSpec {
                    direction,
                    ..spec()
                },
                &on_cylinder(2.5, direction, place),
            );
            let faces = coil.turns()[1].bulge_faces;
            for (k, &height) in faces.iter().enumerate() {
                let expected = if k == face { D } else { 0.0 };
                assert!(
                    (height - expected).abs() < 1e-9,
                    "{face} {direction}: {faces:?}"
                );
            }
        }
    }
}

#[test]
fn one_noisy_station_raises_no_flag() {
    // Every kind of wrong, over two nodes (3 degrees) each.
    let place = |angle: f64| {
        let y = D * angle / TAU;
        let within = |from: f64| (from..from + 0.06).contains(&(angle - TAU));
        if within(2.0) {
            (y + D, 0.0)
        } else if within(3.0) {
            (y - 0.5 * D, 0.9 * D)
        } else if within(4.0) {
            (y, 2.0 * D)
        } else {
            (y, 0.0)
        }
    };
    let coil = wound(spec(), &on_cylinder(2.0, 1.0, place));
    let noisy = coil
        .stations()
        .filter(|s| s.measured && s.bulge > 0.5 * D)
        .count();
    assert!(noisy > 0, "the noise is seen");
    assert_eq!(coil.flags(), DefectFlags::default());
    assert_eq!(coil.defect_count(), 0);
}

#[test]
fn the_neighbourhood_of_the_clamp_is_left_out() {
    // Wild within 1 rad of the clamp in turns 1 and 2, orderly elsewhere.
    let place = |angle: f64| {
        let wild = angle < 2.0 * TAU && angle.rem_euclid(TAU) < 1.0;
        if wild {
            (D * (angle / TAU).floor() * 3.0, 3.0 * D)
        } else {
            (D * angle / TAU, 0.0)
        }
    };
    let coil = wound(spec(), &on_cylinder(2.0, 1.0, place));
    assert_eq!(coil.flags(), DefectFlags::default());
    assert_eq!(coil.turns()[1].verdict, Verdict::Aligned);
    // Judged from the clamp on, the same wire is bad.
    let all = DefectLimits {
        skip_angle: 0.0,
        ..limits()
    };
    assert!(
        wound(
            CoilSpec {
                limits: all,
                ..spec()
            },
            &on_cylinder(2.0, 1.0, place)
        )
        .flags()
        .bulge
    );
}

/// Above a turn the angle meant two turns, however many it was of.
#[test]
fn a_skip_angle_of_several_turns_is_heeded() {
    let apart = |angle: f64| (1.4 * D * angle / TAU, 0.0);
    let is_judged = |skip_angle: f64, turns: f64| {
        let limits = DefectLimits {
            skip_angle,
            ..limits()
        };
        let coil = wound(
            CoilSpec { limits, ..spec() },
            &on_cylinder(turns, 1.0, apart),
        );
        !coil.defects().is_empty()
    };
    for (skipped, first) in [(1.0, 3.0), (3.0, 5.0)] {
        assert!(!is_judged(skipped * TAU, first - 1.0), "{skipped} turns");
        assert!(is_judged(skipped * TAU, first), "{skipped} turns");
    }
}
