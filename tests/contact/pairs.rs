//! Live wire against live wire: the listed pairs against all points and all segments.

use crate::brute;
use crate::brute::Coil;
use coilwind::contact::{
    ContactLaw, ContactPoint, ContactResponse, Coupling, LimitFrom, PairConditions, PairScratch,
    SelfContact,
};
use coilwind::math::V3;
use proptest::prelude::*;

const DIAMETER: f64 = 0.7e-3;
const STIFFNESS: f64 = 1e10;
const LENGTH: f64 = 0.5e-3;
const ONSET: f64 = 1e-5;
const STEP: f64 = 50e-6;
/// Way of a point in a step: 10 m/s for that time, m.
const WAY: f64 = 0.5e-3;
/// Wire this many diameters back along itself is no partner.
const OWN: f64 = 5.0;
/// Older wire is looked at as far as this, m: a pair follows one passage, so that a second near it makes a point doubtful, touch or not.
const NEAR: f64 = 1.5 * DIAMETER;

fn law(mu: f64) -> ContactLaw {
    ContactLaw {
        stiffness: STIFFNESS,
        damping_ratio: 0.0,
        mu_static: mu,
        mu_kinetic: mu,
        slip_speed: 0.01,
    }
}

fn place(q: &[V3], point: usize) -> V3 {
    let weights = ContactPoint::of_number(point).weights();
    weights.iter().map(|(i, w)| q[i] * w).sum()
}

fn rests(q: &[V3]) -> Vec<f64> {
    q.windows(2).map(|e| (e[1] - e[0]).norm()).collect()
}

/// Wire of up to two turns, so that a partner lies one turn back or nowhere.
fn coil() -> impl Strategy<Value = Coil> {
    (
        0..2usize,
        0.85..1.5f64,
        0.0..0.15e-3f64,
        0.0..6.3f64,
        0.6e-3..1.2e-3f64,
        1.1..2.0f64,
    )
        .prop_map(|(kind, pitch, wave, phase, longest, turns)| Coil {
            kind,
            diameter: DIAMETER,
            pitch: pitch * DIAMETER,
            gap: 0.1e-3,
            wave,
            phase,
            longest,
            turns,
            layer: 9.0,
        })
}

/// The wire a step later: long waves of at most [`WAY`].
fn moved(q: &[V3], (size, phase): (V3, f64)) -> Vec<V3> {
    let wave = |i: usize| libm::sin(0.4 * i as f64 + phase);
    q.iter()
        .enumerate()
        .map(|(i, q)| q + size * (wave(i) * WAY / 3f64.sqrt()))
        .collect()
}

/// Pushes of all pairs in touch: point and gradient.
fn fast(
    (pairs, scratch): (&mut SelfContact, &mut PairScratch),
    q: &[V3],
    last: &[V3],
    mu: f64,
) -> Vec<(Coupling, ContactResponse)> {
    let mut all = Vec::new();
    let conditions = PairConditions {
        law: &law(mu),
        onset: ONSET,
        diameter: DIAMETER,
        prediction: 1e-7,
        step: STEP,
        limit_from: LimitFrom::Slide,
    };
    pairs.evaluate(
        scratch,
        &conditions,
        (q, last),
        |_| LENGTH,
        |coupling, response| all.push((*coupling, *response)),
    );
    all
}

/// Depth, normal and point of all pairs in touch, and whether one is too close to a rule's edge to tell.
fn slow(q: &[V3], arc: &[f64]) -> (Vec<(f64, V3, usize)>, bool) {
    let (mut all, mut doubtful) = (Vec::new(), false);
    for point in 1..2 * (q.len() - 1) {
        let own = arc[point / 2] - OWN * DIAMETER;
        let mut of_point = 0;
        for m in brute::minima(q, place(q, point), NEAR) {
            let at = arc[m.t as usize];
            // the point's own passage, with a foot that is no partner
            if at > own + 2e-3 {
                continue;
            }
            doubtful |= at > own - 2e-3;
            of_point += 1;
            let depth = DIAMETER - m.distance;
            if depth <= 0.0 {
                continue;
            }
            // half through each other: nothing that a step may do
            doubtful |= depth > 0.5 * DIAMETER;
            all.push((depth, m.normal, point));
        }
        doubtful |= of_point > 1;
    }
    (all, doubtful)
}

fn way() -> impl Strategy<Value = (V3, f64)> {
    (-1.0..1.0f64, -1.0..1.0f64, -1.0..1.0f64, 0.0..6.3f64)
        .prop_map(|(x, y, z, phase)| (V3::new(x, y, z), phase))
}

proptest! {
    // all pairs of a whole coil take a twentieth of a second
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn a_step_misses_no_pair(coil in coil(), ways in proptest::collection::vec(way(), 4), mirror: bool) {
        let (mut q, _) = coil.wound();
        if mirror {
            q.iter_mut().for_each(|q| q.z = -q.z);
        }
        let rest = rests(&q);
        let mut arc = vec![0.0];
        rest.iter().for_each(|r| arc.push(arc[arc.len() - 1] + r));
        let (mut pairs, mut scratch) = (SelfContact::default(), PairScratch::default());
        for way in ways {
            let last = q.clone();
            q = moved(&q, way);
            // a guess that falls short of the way, as far as the method lets it pass
            let guess: Vec<V3> = last.iter().zip(&q).map(|(a, b)| a + (b - a) * 0.8).collect();
            pairs.list(&mut scratch, (&last, &guess), &rest, DIAMETER);
            prop_assert_eq!(scratch.missed(&last, &last), None);
            if scratch.missed(&last, &q).is_some() {
                return Ok(());
            }
            let (want, doubtful) = slow(&q, &arc);
            if doubtful {
                return Ok(());
            }
            let got = fast((&mut pairs, &mut scratch), &q, &last, 0.0);
            let deep: Vec<_> = want.iter().filter(|w| w.0 > 1e-12).collect();
            prop_assert!(got.len() >= deep.len() && got.len() <= want.len() + 1);
            for (depth, normal, point) in deep {
                let same = |(coupling, push): &&(Coupling, ContactResponse)| {
                    let f = -push.gradient / (STIFFNESS * LENGTH);
                    let onset = if *depth < ONSET {
                        depth * depth / (2.0 * ONSET)
                    } else {
                        depth - 0.5 * ONSET
                    };
                    coupling.young.nodes == ContactPoint::of_number(*point).weights().nodes
                        && (f - normal * onset).norm() < 1e-12 + onset * 1e-7
                };
                prop_assert!(got.iter().any(|g| same(&g)), "missed {depth:e} of point {point}");
            }
            prop_assert_eq!(pairs.deepest() > 0.0, !got.is_empty());
        }
    }

    /// Force and reaction cancel, and so do their moments: the weights put both where they act.
    #[test]
    fn pairs_put_no_force_and_no_moment_on_the_whole(coil in coil(), way in way(), mu in 0.0..0.4f64) {
        let (q, _) = coil.wound();
        let (mut pairs, mut scratch) = (SelfContact::default(), PairScratch::default());
        let now = moved(&q, way);
        pairs.list(&mut scratch, (&q, &now), &rests(&q), DIAMETER);
        for (coupling, push) in fast((&mut pairs, &mut scratch), &now, &q, mu) {
            let (mut force, mut moment) = (V3::zeros(), V3::zeros());
            for side in [&coupling.young, &coupling.old] {
                for (i, w) in side.iter() {
                    force += push.gradient * w;
                    moment += now[i].cross(&(push.gradient * w));
                }
            }
            let size = push.gradient.norm();
            prop_assert!(force.norm() < 1e-12 * size);
            // friction acts at the foot and at the point, a diameter apart
            prop_assert!(moment.norm() < (mu * DIAMETER + 1e-12) * size);
        }
    }
}

/// Wire that is live over more than two turns can land on what lies two turns back.
#[test]
fn wire_two_turns_back_is_a_partner_too() {
    let coil = Coil {
        kind: 1,
        diameter: DIAMETER,
        pitch: 1.3 * DIAMETER,
        gap: 0.0,
        wave: 0.0,
        phase: 0.0,
        longest: 0.8e-3,
        turns: 2.95,
        layer: 1.8,
    };
    let (q, arc) = coil.wound();
    let (mut pairs, mut scratch) = (SelfContact::default(), PairScratch::default());
    pairs.list(&mut scratch, (&q, &q), &rests(&q), DIAMETER);
    let got = fast((&mut pairs, &mut scratch), &q, &q, 0.0);
    let (want, _) = slow(&q, &arc);
    assert_eq!(got.len(), want.len());
}
