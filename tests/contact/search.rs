//! The search of line contact against twins without grid, tree and memory: points on long ways past
//! random coils, in steps that make everything it remembers stale.

use crate::brute;
use crate::brute::Coil;
use crate::parts::Parts;
use coilwind::contact::ContactLaw;
use coilwind::math::V3;
use proptest::prelude::*;

/// Line load per depth, N/m^2, and wire that a point stands for, m.
const STIFFNESS: f64 = 1e10;
const LENGTH: f64 = 0.5e-3;
/// A winding step: 10 m/s for 50 us, m and s.
const WAY: f64 = 0.5e-3;
const STEP: f64 = 50e-6;
/// How deep a guess may land, m; the wire radius is 0.35 mm.
const DEEPEST: f64 = 0.25e-3;
/// A depth counts as equal within this, m: a millionth of the depth of a 15 N corner.
const SAME_DEPTH: f64 = 1e-12;
/// Normals within this: what the depth's rounding makes of a foot a wire radius away.
const SAME_NORMAL: f64 = 1e-7;
/// Passages that a point can hold at once.
const PASSAGES: usize = 4;
/// Wire looked at beyond touching, in diameters: a listed passage may be that far.
const SKIN: f64 = 0.15;

fn law(mu: f64) -> ContactLaw {
    ContactLaw {
        stiffness: STIFFNESS,
        damping_ratio: 0.0,
        mu_static: 1.3 * mu,
        mu_kinetic: mu,
        slip_speed: 0.01,
    }
}

fn contact(coil: &Coil, mu: f64) -> Parts {
    let mut line = Parts::new(brute::a_core(coil.kind), law(mu), 0.5 * coil.diameter, 1);
    let (q, arc) = coil.wound();
    for (q, arc) in q.iter().zip(arc) {
        line.contact().lay(*q, arc);
    }
    line
}

fn coil() -> impl Strategy<Value = Coil> {
    (
        0..4usize,
        0.9..1.8f64,
        0.0..0.3e-3f64,
        0.0..0.1e-3f64,
        0.0..6.3f64,
        0.6e-3..1.6e-3f64,
        1.2..4.0f64,
    )
        .prop_map(|(kind, pitch, gap, wave, phase, longest, turns)| Coil {
            kind,
            diameter: 0.7e-3,
            pitch: pitch * 0.7e-3,
            gap,
            wave,
            phase,
            longest,
            turns,
            layer: 2.2,
        })
}

/// Where a way starts.
#[derive(Clone, Copy, Debug)]
struct Start {
    /// share of the coil
    along: f64,
    /// beside the wire there, and over the core, m
    aside: f64,
    height: f64,
}

/// Where to start and the ways from there, in units of [`WAY`].
fn way() -> impl Strategy<Value = (Start, Vec<V3>)> {
    let steps = (-1.0..1.0f64, -1.0..1.0f64, -1.0..1.0f64, -3.0..0.0f64);
    (
        (0.0..1.0f64, -2e-3..2e-3f64, 0.0..1.5e-3f64).prop_map(|(along, aside, height)| Start {
            along,
            aside,
            height,
        }),
        proptest::collection::vec(steps, 40).prop_map(|steps| {
            // long and short steps alike
            let scaled = |(x, y, z, size): (f64, f64, f64, f64)| {
                V3::new(x, y, z) * libm::exp(std::f64::consts::LN_10 * size)
            };
            steps.into_iter().map(scaled).collect()
        }),
    )
}

/// What is near a point.
struct Surroundings {
    /// depth (negative: a gap) and normal of every surface, core first
    all: Vec<(f64, V3)>,
    /// whether the cut at the point's own neighbourhood is near
    doubtful: bool,
    /// whether the point is inside a bend so sharp that one passage is near twice: a foot that is
    /// born there is found up to a skin late
    pinched: bool,
}

impl Surroundings {
    /// More than a point can hold, or passages that come and go.
    fn crowded(&self, diameter: f64) -> bool {
        let listed = |(depth, _): &&(f64, V3)| -depth < 2.0 * SKIN * diameter;
        self.pinched || self.all[1..].iter().filter(listed).count() > PASSAGES
    }
}

fn surroundings(line: &Parts, p: V3, own: f64) -> Surroundings {
    let (distance, normal) = brute::core(&line.model.shape, p);
    let mut all = vec![(line.model.radius - distance, normal)];
    let mut doubtful = false;
    let mut pinched = false;
    let mut last = f64::NEG_INFINITY;
    for m in brute::minima(line.scratch.tube.points(), p, 3.5 * line.model.radius) {
        let arc = line.scratch.tube.arc()[m.t as usize];
        doubtful |= (arc - own).abs() < 4e-3;
        pinched |= arc - last < 5e-3;
        last = arc;
        if arc <= own {
            all.push((2.0 * line.model.radius - m.distance, m.normal));
        }
    }
    Surroundings {
        all,
        doubtful,
        pinched,
    }
}

/// Energy, force and stiffness over contact stiffness: half a cubic, then a line.
fn normal_law(depth: f64, onset: f64) -> (f64, f64) {
    if depth < onset {
        (depth.powi(3) / (6.0 * onset), depth * depth / (2.0 * onset))
    } else {
        let past = depth - onset;
        let (energy, force) = (onset * onset / 6.0, 0.5 * onset);
        (energy + force * past + 0.5 * past * past, force + past)
    }
}

/// The points of a way that a wire could be at: not deeper in anything than a guess may land.
fn walk(line: &Parts, start: &Start, steps: &[V3]) -> Vec<V3> {
    let q = line.scratch.tube.points();
    let at = start.along * (q.len() - 2) as f64 + 0.5;
    let base = brute::on_wire(q, at) + V3::y() * start.aside;
    let (distance, out) = brute::core(&line.model.shape, base);
    let mut p = base + out * (line.model.radius + start.height - distance);
    let home = p;
    let deep = |p: V3| {
        let all = surroundings(line, p, f64::INFINITY).all;
        all.iter().any(|(depth, _)| *depth > DEEPEST)
    };
    if deep(p) {
        return Vec::new();
    }
    let mut way = vec![p];
    for step in steps {
        // drawn back where it strays, so that it stays among the surfaces
        let to = p + step * WAY + (home - p) * 0.1;
        if !deep(to) {
            p = to;
            way.push(p);
        }
    }
    way
}

proptest! {
    #[test]
    fn nothing_within_touch_is_missed(
        coil in coil(),
        (start, steps) in way(),
        own in prop::option::of(0.2..1.0f64),
    ) {
        let mut line = contact(&coil, 0.0);
        let own = own.map_or(f64::INFINITY, |s| s * line.scratch.tube.arc()[line.scratch.tube.len() - 1]);
        for p in walk(&line, &start, &steps) {
            let near = surroundings(&line, p, own);
            let push = line.contact().push(0, p, || LENGTH, || own, STEP);
            if near.crowded(coil.diameter) {
                return Ok(());
            }
            if near.doubtful {
                continue;
            }
            let k = STIFFNESS * LENGTH;
            let touching: Vec<_> = near.all.iter().filter(|(d, _)| *d > SAME_DEPTH).collect();
            let forces: Vec<V3> = line.state.normal_forces(&line.model, 0, LENGTH).filter(|f| f.norm() > k * 1e-15).collect();
            let mut left = forces.clone();
            let (mut energy, mut gradient) = (0.0, V3::zeros());
            for (depth, normal) in &touching {
                let (e, f) = normal_law(*depth, line.model.onset);
                energy += k * e;
                gradient -= normal * (k * f);
                let same = |g: &V3| {
                    (g - normal * (k * f)).norm() < k * (SAME_DEPTH + f * SAME_NORMAL)
                };
                let at = left.iter().position(same);
                prop_assert!(at.is_some(), "missed {depth:e} {normal} of {forces:?}");
                left.swap_remove(at.unwrap_or(0));
            }
            prop_assert!(
                left.iter().all(|f| f.norm() < k * SAME_DEPTH),
                "too much: {left:?} {:?}", near.all
            );
            let push = push.unwrap_or_default();
            let deep = touching.iter().map(|(d, _)| d).sum::<f64>();
            let force = k * (SAME_DEPTH + deep * SAME_NORMAL) * (1 + touching.len()) as f64;
            prop_assert!((push.gradient - gradient).norm() < force);
            prop_assert!((push.energy - energy).abs() < force * (deep + SAME_DEPTH));
        }
    }
}

proptest! {
    /// Against itself with all that it remembers of places taken away before every evaluation: friction
    /// included, since a touch keeps its anchor whenever its surroundings are looked up.
    #[test]
    fn friction_does_not_see_when_surroundings_are_looked_up(
        coil in coil(),
        (start, steps) in way(),
        small in 0.01..1.0f64,
    ) {
        let (mut warm, mut cold) = (contact(&coil, 0.17), contact(&coil, 0.17));
        let k = STIFFNESS * LENGTH;
        let way = walk(&warm, &start, &steps.iter().map(|s| s * small).collect::<Vec<_>>());
        for line in [&mut warm, &mut cold] {
            line.state.place(0, way.first().copied().unwrap_or_default());
        }
        let own = f64::INFINITY;
        for p in way {
            cold.state.forget_surroundings();
            let forces = [&mut warm, &mut cold].map(|line| line.contact().commit(0, p, || LENGTH, || own, STEP));
            if surroundings(&warm, p, own).crowded(coil.diameter) {
                return Ok(());
            }
            prop_assert!((forces[0] - forces[1]).norm() < 1e-9 * (k * 1e-6 + forces[0].norm()), "{forces:?}");
        }
        let lost = [warm.state.loss.friction, cold.state.loss.friction];
        prop_assert!((lost[0] - lost[1]).abs() <= 1e-9 * lost[0]);
    }
}

/// Two feet on the legs of a sharp bend run together as the point goes out through its corner.
#[test]
fn merged_feet_push_once() {
    let coil = Coil {
        kind: 1,
        diameter: 0.7e-3,
        pitch: 1e-3,
        gap: 0.0,
        wave: 0.0,
        phase: 0.0,
        longest: 1e-3,
        turns: 0.1,
        layer: 1.0,
    };
    let mut line = contact(&coil, 0.0);
    line.scratch.tube = coilwind::geometry::SplineTube::new(0.35e-3).into();
    let legs = [
        (-3.5, 9.0),
        (-1.5, 3.0),
        (-0.5, 0.0),
        (0.5, 0.0),
        (1.5, 3.0),
        (3.5, 9.0),
    ];
    for (i, (x, y)) in legs.into_iter().enumerate() {
        line.contact()
            .lay(V3::new(40.0 + x, y, 0.0) * 1e-3, 3e-3 * i as f64);
    }
    let k = STIFFNESS * LENGTH;
    // the centre of curvature is 1/3 mm up
    for (y, most) in [(0.36, 2), (0.34, 2), (0.32, 1), (0.3, 1)] {
        let p = V3::new(40.0, y, 0.0) * 1e-3;
        let push = line
            .contact()
            .push(0, p, || LENGTH, || f64::INFINITY, STEP)
            .unwrap_or_default();
        let (mut energy, mut count) = (0.0, 0);
        for m in brute::minima(line.scratch.tube.points(), p, 0.7e-3) {
            energy += k * normal_law(0.7e-3 - m.distance, line.model.onset).0;
            count += 1;
        }
        assert_eq!(count, most);
        let off = push.energy / energy - 1.0;
        assert!(off.abs() < 1e-9, "{off} at {y} mm");
    }
}
