//! The centreline and its nearest points against dense sampling and finite differences.

use super::curve::HOPS;
use super::segment::across;
use super::{Curve, Foot, SplineTube};
use crate::math::V3;
use proptest::prelude::*;

const R: f64 = 0.35e-3;

/// A helix about y with waves across, edges from 0.4 mm to `longest`.
fn wavy(radius: f64, pitch: f64, wave: f64, longest: f64, phase: f64, turns: f64) -> SplineTube {
    let mut tube = SplineTube::new(R);
    let (mut angle, mut arc, mut node) = (0.0, 0.0, 0);
    while angle < turns * std::f64::consts::TAU {
        let around = radius + wave * libm::sin(7.3 * angle + phase);
        let y = pitch * angle / std::f64::consts::TAU + wave * libm::cos(5.1 * angle + phase);
        let point = V3::new(around * libm::cos(angle), y, around * libm::sin(angle));
        tube.push(point, arc);
        let share = 0.5 + 0.5 * libm::sin(1.7 * f64::from(node) + phase);
        let edge = 0.4e-3 + (longest - 0.4e-3) * share * share;
        angle += edge / radius;
        arc += edge;
        node += 1;
    }
    tube
}

fn wire() -> impl Strategy<Value = SplineTube> {
    let longest = 0.4e-3..3e-3f64;
    (
        4e-3..9e-3f64,
        0.5e-3..1.5e-3f64,
        0.0..0.3e-3f64,
        longest,
        0.0..6.3f64,
    )
        .prop_map(|(r, pitch, wave, longest, phase)| wavy(r, pitch, wave, longest, phase, 3.2))
}

fn tangent_at(tube: &SplineTube, foot: &Foot) -> V3 {
    let segment = foot.segment as usize;
    tube.curve().view(segment, V3::zeros()).tangent(foot.share)
}

/// On the curve, at t = segment + share.
fn on(tube: &SplineTube, t: f64) -> V3 {
    tube.curve().view(t as usize, V3::zeros()).arm(t.fract())
}

fn reachable(tube: &SplineTube, share: f64) -> f64 {
    0.5 + share * (tube.len() - 1) as f64
}

/// Radius of curvature at t, m.
fn bend_radius(tube: &SplineTube, t: f64) -> f64 {
    let view = tube.curve().view(t as usize, V3::zeros());
    let along = view.along(t.fract());
    along.norm().powi(3) / along.cross(&view.bend).norm()
}

#[test]
fn centreline_follows_the_formula_from_end_to_end() {
    let tube = wavy(5e-3, 0.7e-3, 0.2e-3, 2e-3, 0.4, 1.0);
    let points = tube.points();
    let n = points.len();
    assert!((on(&tube, 0.5) - points[0]).norm() < 1e-17);
    assert!((on(&tube, n as f64 - 0.5) - points[n - 1]).norm() < 1e-17);
    for k in 1..n - 1 {
        for s in [0.0, 0.3, 0.9] {
            let basis = [0.5 * (1.0 - s) * (1.0 - s), 0.5 + s - s * s, 0.5 * s * s];
            let p = points[k - 1] * basis[0] + points[k] * basis[1] + points[k + 1] * basis[2];
            assert!((on(&tube, k as f64 + s) - p).norm() < 1e-17);
        }
    }
    for k in 1..n {
        // place and derivative are the same from both sides
        let (a, b) = (
            tube.curve().view(k - 1, V3::zeros()),
            tube.curve().view(k, V3::zeros()),
        );
        assert!((a.arm(1.0) - b.arm(0.0)).norm() < 1e-17);
        assert!((a.along(1.0) - b.along(0.0)).norm() < 1e-17);
        assert_eq!(a.g_high, b.g_low);
    }
}

proptest! {
    #[test]
    fn gather_and_foot_find_what_sampling_finds(
        tube in wire(),
        t in 0.0..1.0f64,
        off in (-1.0..1.0f64, -1.0..1.0f64, -1.0..1.0f64),
        reach in 0.3e-3..3e-3f64,
        own in 0.0..1.5f64,
    ) {
        let p = on(&tube, reachable(&tube, t)) + V3::new(off.0, off.1, off.2) * 2e-3;
        let own = own * tube.arc()[tube.len() - 1];
        let mut starts = Vec::new();
        tube.gather(p, reach, own, &mut starts);
        prop_assert!(starts.is_sorted_by(|a, b| a < b));
        let feet: Vec<Foot> = starts.iter().map(|&s| tube.foot(p, s)).collect();
        for (foot, &start) in feet.iter().zip(&starts) {
            prop_assert!(foot.segment == start && foot.distance <= reach);
            prop_assert!(tube.arc()[start as usize] <= own);
            // a minimum in its own right
            let t = f64::from(foot.segment) + foot.share;
            for h in [-1e-4, 1e-4] {
                if (0.5..=tube.len() as f64 - 0.5).contains(&(t + h)) {
                    prop_assert!((on(&tube, t + h) - p).norm() >= foot.distance - 1e-15);
                }
            }
            prop_assert!((foot.point + foot.normal * foot.distance - p).norm() < 1e-16);
            prop_assert!((tangent_at(&tube, foot).norm() - 1.0).abs() < 1e-12);
            prop_assert!(foot.at_end || foot.normal.dot(&tangent_at(&tube, foot)).abs() * foot.distance < 1e-14);
        }
        for slow in tube.feet_brute(p, reach * (1.0 - 1e-9), f64::INFINITY) {
            // which segment has a minimum at a joint is a matter of rounding
            let at_joint = (slow.share - slow.share.round()).abs() < 1e-6;
            if tube.arc()[slow.segment as usize] > own || at_joint && !slow.at_end {
                continue;
            }
            // of two on one segment the nearer
            let found = feet.iter().any(|foot| {
                (foot.point - slow.point).norm() < 1e-6
                    || foot.segment == slow.segment && foot.distance <= slow.distance
            });
            prop_assert!(found, "{slow:?} {feet:?}");
        }
    }

    #[test]
    fn normal_is_the_gradient_of_the_distance(
        tube in wire(),
        t in 0.0..1.0f64,
        round in 0.0..6.3f64,
        out in 0.02..0.8f64,
    ) {
        let t = reachable(&tube, t);
        let along = tube.curve().view(t as usize, V3::zeros()).along(t.fract()).normalize();
        let side = across(&along);
        let way = side * libm::cos(round) + along.cross(&side) * libm::sin(round);
        let bend = bend_radius(&tube, t).min(bend_radius(&tube, (t - 0.5).max(0.5)))
            .min(bend_radius(&tube, (t + 0.5).min(tube.len() as f64 - 0.5)));
        let distance = out * bend.min(1.5e-3);
        let p = on(&tube, t) + way * distance;
        let foot = tube.foot(p, t as u32);
        prop_assert!((foot.distance - distance).abs() < 1e-15 || foot.distance < distance);
        let h = 1e-8;
        let slope = V3::from_fn(|axis, _| {
            let mut step = V3::zeros();
            step[axis] = h;
            let ahead = tube.foot(p + step, foot.segment).distance;
            (ahead - tube.foot(p - step, foot.segment).distance) / (2.0 * h)
        });
        // second derivatives: 1/distance across, and along the wire at most 1/(bend - distance)
        let second = 1.0 / foot.distance + 1.0 / (0.2 * bend);
        prop_assert!((slope - foot.normal).norm() < 2.0 * h * second + 1e-8);
    }

    #[test]
    fn foot_slides_over_joints_without_a_jump(
        tube in wire(),
        joint in 0.1..0.9f64,
        round in 0.0..6.3f64,
    ) {
        let joint = (joint * tube.len() as f64).floor();
        let along = tube.curve().view(joint as usize, V3::zeros()).along(0.0).normalize();
        let side = across(&along);
        let way = side * libm::cos(round) + along.cross(&side) * libm::sin(round);
        let bend = bend_radius(&tube, joint).min(bend_radius(&tube, joint - 1e-9));
        let p = on(&tube, joint) + way * (0.5 * bend).min(0.3e-3);
        for start in [joint as u32 - 1, joint as u32] {
            let step = along * 1e-9;
            let (a, b) = (tube.foot(p - step, start), tube.foot(p + step, start));
            prop_assert_eq!(a.segment + 1, b.segment);
            prop_assert!((a.distance - b.distance).abs() < 1e-14);
            prop_assert!((a.normal - b.normal).norm() < 1e-4);
            prop_assert!((a.point - b.point).norm() < 1e-7);
            prop_assert!((tangent_at(&tube, &a) - tangent_at(&tube, &b)).norm() < 1e-4);
        }
    }

    /// Wire cut in two by a seam is the wire in one piece: one side has the foot, the other says
    /// that it is beyond.
    #[test]
    fn a_seam_does_not_show(
        tube in wire(),
        (cut, along) in (0.1..0.9f64, -2.5..2.5f64),
        off in prop::array::uniform3(-0.8..0.8f64),
    ) {
        let cut = 2 + (cut * (tube.len() - 5) as f64) as usize;
        let mut frozen = SplineTube::new(R);
        for i in 0..cut {
            frozen.push(tube.points()[i], tube.arc()[i]);
        }
        let shared = [cut, cut + 1].map(|i| (tube.points()[i], tube.arc()[i]));
        frozen.go_on(Some(shared));
        prop_assert_eq!(frozen.len(), cut);
        let live = Curve { points: &tube.points()[cut..], seams: [true, false] };
        let t = (cut as f64 + 1.0 + along).clamp(0.5, (tube.len() - 1) as f64);
        // (beyond a centre of curvature both sides may have a foot)
        let mut about = (-12..=12).map(|i| t + 0.25 * f64::from(i));
        let inside = |t: &f64| *t > 0.5 && *t < (tube.len() - 1) as f64;
        prop_assume!(about.all(|t| !inside(&t) || bend_radius(&tube, t) > 2.5 * R));
        let p = on(&tube, t) + V3::from(off) * R;
        let whole = tube.foot(p, t as u32);
        let sides = [
            frozen.foot(p, whole.segment),
            live.foot(p, whole.segment.saturating_sub(cut as u32)),
        ];
        let depth = sides.map(|foot| foot.depth(2.0 * R));
        prop_assert!(depth[0] < 0.0 || depth[1] < 0.0, "{:?}", sides);
        let most = depth[0].max(depth[1]);
        prop_assert!((most - whole.depth(2.0 * R)).abs() < 1e-12, "{:?} {:?}", sides, whole);
        // to the frozen side, from which it is looked for, it is there or not
        let mut starts = Vec::new();
        frozen.gather(p, 2.0 * R, f64::INFINITY, &mut starts);
        let found = starts.iter().any(|s| frozen.foot(p, *s).depth(2.0 * R) == depth[0]);
        prop_assert!(depth[0] < 0.0 || found, "{:?} {}", starts, depth[0]);
        frozen.go_on(None);
        prop_assert_eq!(frozen.pop(), Some((tube.points()[cut - 1], tube.arc()[cut - 1])));
    }

    #[test]
    fn popping_undoes_pushing(tube in wire(), share in 0.0..1.0f64) {
        let keep = (share * tube.len() as f64) as usize;
        let mut built = SplineTube::new(R);
        for i in 0..keep {
            built.push(tube.points()[i], tube.arc()[i]);
        }
        let mut popped = tube.clone();
        for i in (keep..tube.len()).rev() {
            prop_assert_eq!(popped.pop(), Some((tube.points()[i], tube.arc()[i])));
        }
        prop_assert_eq!(&popped, &built);
        for i in keep..tube.len() {
            popped.push(tube.points()[i], tube.arc()[i]);
        }
        prop_assert_eq!(&popped, &tube);
    }
}

#[test]
fn foot_slides_to_its_minimum_from_afar() {
    let tube = wavy(20e-3, 0.7e-3, 0.0, 0.4e-3, 0.0, 1.0);
    let p = on(&tube, 100.3) * 1.02;
    let here = tube.foot(p, 100);
    for start in 50..150 {
        let foot = tube.foot(p, start);
        assert!((foot.point - here.point).norm() < 1e-14 && foot.segment == here.segment);
    }
    // too far for the number of joints: it stops on the way, and does not claim an end
    let lost = tube.foot(p, 200);
    assert!(lost.segment == 200 - HOPS as u32 && !lost.at_end);
    // a number left from a longer wire
    assert!(tube.foot(p, u32::MAX).distance > here.distance);
}

#[test]
fn ends_and_short_wire() {
    let mut tube = SplineTube::new(R);
    let mut starts = vec![7];
    tube.gather(V3::zeros(), 1.0, 1.0, &mut starts);
    assert!(starts.is_empty() && tube.is_empty() && tube.pop().is_none());
    assert!(tube.feet_brute(V3::zeros(), 1.0, 1.0).is_empty());
    tube.push(V3::zeros(), 0.0);
    tube.gather(V3::zeros(), 1.0, 1.0, &mut starts);
    assert!(starts.is_empty());
    tube.push(V3::new(1e-3, 0.0, 0.0), 1e-3);
    for (x, segment, at_end, foot_x) in [
        (-1e-3, 0, true, 0.0),
        (0.2e-3, 0, false, 0.2e-3),
        (0.7e-3, 1, false, 0.7e-3),
        (3e-3, 1, true, 1e-3),
    ] {
        let p = V3::new(x, 0.5e-3, 0.0);
        tube.gather(p, 5e-3, 1.0, &mut starts);
        assert_eq!(starts, [segment]);
        for start in 0..2 {
            let foot = tube.foot(p, start);
            assert_eq!((foot.segment, foot.at_end), (segment, at_end));
            assert!((foot.point - V3::new(foot_x, 0.0, 0.0)).norm() < 1e-18);
            assert!((tangent_at(&tube, &foot) - V3::x()).norm() < 1e-15);
            assert!((foot.normal * foot.distance - (p - foot.point)).norm() < 1e-18);
        }
    }
    // on the centreline the normal is still a unit vector across the wire
    let foot = tube.foot(V3::new(0.25e-3, 0.0, 0.0), 0);
    assert!(foot.distance == 0.0 && foot.normal.dot(&tangent_at(&tube, &foot)).abs() < 1e-15);
    assert!((foot.normal.norm() - 1.0).abs() < 1e-15);
}

#[test]
fn passages_side_by_side_count_each() {
    // eleven turns, pitch one diameter: a point over the middle one sees those within reach
    let tube = wavy(10e-3, 2.0 * R, 0.0, 0.4e-3, 0.0, 11.0);
    let t = 0.5 * tube.len() as f64;
    let p = on(&tube, t);
    let p = p + V3::new(p.x, 0.0, p.z).normalize() * 0.1 * R;
    let mut starts = Vec::new();
    for (reach, count) in [(0.2 * R, 1), (2.3 * R, 3), (4.3 * R, 5), (6.3 * R, 7)] {
        tube.gather(p, reach, f64::INFINITY, &mut starts);
        assert_eq!(starts.len(), count, "{starts:?}");
    }
    // wire younger than half a turn before p is left out
    let own = tube.arc()[t as usize] - 30e-3;
    tube.gather(p, 4.3 * R, own, &mut starts);
    assert_eq!(starts.len(), 2);
    // a reach past everything looks at everything
    tube.gather(p, 1.0, f64::INFINITY, &mut starts);
    assert!(starts.len() >= 11);
    tube.gather(V3::repeat(1e300), 1.0, f64::INFINITY, &mut starts);
    assert!(starts.is_empty());
}

#[test]
fn beyond_the_centre_of_curvature_a_segment_gives_its_nearer_side() {
    let mut tube = SplineTube::new(R);
    let corners = [(-3.0, 9.0), (-1.0, 3.0), (0.0, 0.0), (1.0, 3.0), (3.0, 9.0)];
    for (i, (x, y)) in corners.into_iter().enumerate() {
        tube.push(V3::new(x, y, 0.0) * 1e-3, i as f64 * 3e-3);
    }
    let mut starts = Vec::new();
    for x in [-0.02e-3, 0.02e-3] {
        let p = V3::new(x, 1.3e-3, 0.0);
        assert_eq!(tube.feet_brute(p, 1e-3, 1.0).len(), 2);
        tube.gather(p, 1e-3, 1.0, &mut starts);
        assert_eq!(starts, [2]);
        let foot = tube.foot(p, 2);
        assert!(foot.point.x * x > 0.0);
        assert!((foot.normal.dot(&tangent_at(&tube, &foot))).abs() < 1e-12);
    }
}

#[test]
fn folded_wire_stays_finite() {
    let mut tube = SplineTube::new(R);
    for (i, x) in [0.0, 1.0, 0.0, 1.0].into_iter().enumerate() {
        tube.push(V3::new(x, 0.0, 0.0) * 1e-3, i as f64 * 1e-3);
    }
    for x in [0.0, 0.25, 0.5, 0.75, 1.0, 2.0] {
        for start in 0..4 {
            let foot = tube.foot(V3::new(x, 0.1, 0.0) * 1e-3, start);
            assert!(
                (tangent_at(&tube, &foot).norm() - 1.0).abs() < 1e-12,
                "{foot:?}"
            );
            assert!((foot.normal.norm() - 1.0).abs() < 1e-12);
        }
    }
}
