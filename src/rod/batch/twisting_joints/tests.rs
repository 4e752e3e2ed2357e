//! All joints at once against one joint at a time.

use super::TwistingJoints;
use super::passes::Elastic;
use crate::math::simd::{ROWS, RowBlock, WithSimd, run};
use crate::math::simd::{Width, at_most, width};
use crate::math::{Quat, V3, rotate};
use crate::math::{frame_along, relative};
use crate::rod::batch::{CROSS, GRADIENT, JOINT, Joints, OWN, ROLL_OWN, ROLL_WITH, TORQUE};
use crate::rod::forces::Laws;
use crate::rod::joint::Joint;
use crate::rod::plasticity::{Bend, Scalar, respond_scalar};
use crate::rod::twisting::Turned;
use crate::rod::yield_branch::{YieldBranch, YieldBranches};
use crate::rod::{Section, twisted};
use pulp::Simd;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

const LV: f64 = 0.5e-3;

/// A crooked wire: where it was, where it is, its plastic state.
struct Wire {
    q: Vec<V3>,
    roll: Vec<f64>,
    frames: Vec<Quat>,
    along: Vec<V3>,
    clamps: [Option<Quat>; 2],
    bend: Vec<Bend>,
    twist: Vec<Scalar>,
}

fn wire(seed: u64, edges: usize, crooked: f64) -> Wire {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut number = move || rng.next_u32() as f64 / f64::from(u32::MAX) * 2.0 - 1.0;
    let mut some = |size: f64| V3::new(number(), number(), number()) * size;
    let mut q = vec![V3::zeros()];
    let mut along = Vec::new();
    let mut frames: Vec<Quat> = Vec::new();
    let mut roll = Vec::new();
    for j in 0..edges {
        let d = V3::new(0.0, 0.0, LV) + some(crooked * LV);
        q.push(q[j] + d);
        let was = (d + some(0.1 * LV)).normalize();
        let twist = relative([0.0; 2], some(crooked).x);
        frames.push(frame_along(&was, frames.last()) * twist);
        along.push(rotate(&frames[j], &V3::z()));
        roll.push(some(if j % 5 == 0 { 0.1 } else { 1e-3 }).x);
    }
    let state = |k: V3| Bend {
        curvature: [k.x, k.y],
        rise: k.z.abs() * 1e-5,
    };
    Wire {
        clamps: [Some(frames[0]), None],
        bend: (0..=edges).map(|_| state(some(300.0))).collect(),
        twist: (0..=edges)
            .map(|_| Scalar {
                strain: some(20.0).x,
                rise: 0.0,
            })
            .collect(),
        q,
        roll,
        frames,
        along,
    }
}

fn laws() -> Laws {
    Laws::new(&Section {
        m_y: 5.72e-3,
        t_y: 6e-3,
        ..Section::table1_elastic()
    })
}

/// All blocks of joints.
struct All<'a>(&'a TwistingJoints, &'a mut [(u32, YieldBranch)]);

impl WithSimd for All<'_> {
    type Output = Vec<RowBlock<JOINT>>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
        let Self(batch, mut yield_branches) = self;
        let mut all = vec![RowBlock::default(); batch.blocks()];
        for (block, out) in all.iter_mut().enumerate() {
            batch.joints::<S, true>(simd, block, out, &mut yield_branches);
        }
        assert!(yield_branches.is_empty());
        all
    }
}

fn respond(w: &Wire) -> (Vec<RowBlock<JOINT>>, f64, YieldBranches) {
    let mut batch = TwistingJoints::default();
    let mut yield_branches = YieldBranches::default();
    let edges = w.frames.len();
    batch.begin(&w.frames, &w.along, w.clamps);
    batch.place(&w.q, &w.roll);
    let state = (&w.bend[..], &w.twist[..]);
    batch.lay(&laws(), state, [0, edges - 1], |_| (LV, 1.0));
    let energy = batch.respond(&laws(), Some(&mut yield_branches));
    (
        run(All(&batch, &mut yield_branches.bending)),
        energy,
        yield_branches,
    )
}

fn turned(w: &Wire, j: usize) -> Turned {
    let d = w.q[j + 1] - w.q[j];
    let l = d.norm();
    Turned::edge(&w.frames[j], &w.along[j], d / l, 1.0 / l, w.roll[j])
}

/// The slow twin is one joint at a time.
#[test]
fn each_joint_is_that_of_the_rod_one_by_one() {
    for (seed, edges, crooked) in [(1, 30, 0.05), (2, 7, 0.5), (3, 1, 1.0), (4, 17, 0.9)] {
        let w = wire(seed, edges, crooked);
        let (joints, energy, yield_branches) = respond(&w);
        let mut before = w.clamps[0].map(Turned::clamp).expect("there is one");
        let (mut sum, mut count) = (0.0, 0);
        for j in 0..edges {
            let after = turned(&w, j);
            let (bend, twist) = (&w.bend[j], &w.twist[j]);
            let (bent, rolled) = twisted(&laws(), bend, twist, LV, [&before, &after]);
            before = after;
            sum += bent.energy;
            let mut pairs = Vec::new();
            let list = |at: usize, n: usize| (0..n).map(move |k| (at, k));
            let mut compare = |at: usize, want: &[f64]| {
                let size = want.iter().fold(0.0, |s: f64, x| s.max(x.abs()));
                for (at, k) in list(at, want.len()) {
                    pairs.push((joints[j / ROWS].get(at + k, j % ROWS), want[k], size));
                }
            };
            for e in 0..2 {
                compare(OWN[e], &bent.own[e]);
                compare(GRADIENT[e], [bent.before, bent.after][e].as_slice());
                for f in 0..2 {
                    compare(ROLL_WITH[e][f], rolled.with[e][f].as_slice());
                }
            }
            compare(CROSS, bent.cross.as_flattened());
            compare(ROLL_OWN, &rolled.own);
            compare(TORQUE, &rolled.torque);
            if let Some(yield_branch) = bent.yield_branch {
                let (number, own) = &yield_branches.bending[count];
                assert_eq!(*number, j as u32);
                count += 1;
                for e in 0..2 {
                    let off = (own.rows[e] - yield_branch.rows[e]).norm();
                    assert!(off <= 1e-9 * yield_branch.rows[e].norm() + 1e-12);
                }
                pairs.push((own.moment, yield_branch.moment, yield_branch.moment));
            }
            for (got, want, size) in pairs {
                assert!(
                    (got - want).abs() <= 1e-9 * size.abs() + 1e-14,
                    "joint {j} of {edges}: {got}, {want} one by one"
                );
            }
        }
        assert!((energy - sum).abs() <= 1e-12 * sum.abs());
        assert_eq!(count, yield_branches.bending.len());
    }
}

/// Couple and stiffness of a joint near yielding in twist are those of its law, its rows those of
/// its twist by finite differences.
#[test]
fn branches_of_twist_are_those_of_the_law() {
    let mut seen = [0; 2];
    for (seed, edges, crooked) in [(8, 30, 2e-3), (9, 17, 0.3)] {
        let make = || {
            let mut w = wire(seed, edges, crooked);
            w.twist.fill(Scalar::default());
            w
        };
        let w = make();
        let (_, _, yield_branches) = respond(&w);
        let twist = |w: &Wire, j: usize| {
            let before = match j {
                0 => w.clamps[0].map(Turned::clamp).expect("there is one"),
                _ => turned(w, j - 1),
            };
            Joint::between(&before.frame(), &turned(w, j).frame()).twist
        };
        let couple = |w: &Wire, j: usize, angle: f64| {
            respond_scalar(&laws().twist, &w.twist[j], angle / LV).0
        };
        for (j, yield_branch) in &yield_branches.twist {
            let j = *j as usize;
            let angle = twist(&w, j);
            let (own, far) = (couple(&w, j, angle), couple(&w, j, angle + 1e-7));
            let sign = own.signum();
            assert!(
                (yield_branch.moment - own.abs()).abs() < 1e-12,
                "{j}: {yield_branch:?}"
            );
            let stiffness = (far - own) * 1e7;
            let off = (yield_branch.stiffness - stiffness).abs();
            assert!(off < 1e-3 * stiffness, "{j}: {off} of {stiffness}");
            seen[usize::from(yield_branch.branch == 1)] += 1;
            for e in usize::from(j == 0)..2 {
                let moved = |change: &dyn Fn(&mut Wire, f64)| {
                    let at = |by: f64| {
                        let mut w = make();
                        change(&mut w, by);
                        twist(&w, j)
                    };
                    (at(1.0) - at(-1.0)) * 0.5 * sign
                };
                let edge = j + e - 1;
                let roll = moved(&|w, by| w.roll[edge] += 1e-6 * by) / 1e-6;
                assert!(
                    (roll - yield_branch.rolls[e]).abs() < 1e-6,
                    "{j}, {e}: {roll}"
                );
                for a in 0..3 {
                    // an edge's vector alone: all nodes on its far side move
                    let size = 1e-6 * LV;
                    let shift = |w: &mut Wire, by: f64| {
                        w.q[edge + 1..].iter_mut().for_each(|q| q[a] += size * by);
                    };
                    let row = moved(&shift) / size;
                    let off = (row - yield_branch.rows[e][a]).abs() * LV;
                    assert!(off < 1e-6, "{j}, {e}, {a}: {off}");
                }
            }
        }
    }
    assert!(seen[0] > 2 && seen[1] > 2, "{seen:?}");
}

/// Blocks that are passed over give, to the bit, what looking at each of their joints gives.
#[test]
fn quiet_blocks_are_passed_over() {
    let mut w = wire(8, 60, 5e-5);
    for j in 24..60 {
        (w.bend[j], w.twist[j], w.roll[j]) = (Bend::default(), Scalar::default(), 0.0);
        (w.frames[j], w.along[j]) = (w.frames[23], w.along[23]);
    }
    let laws = laws();
    let mut batch = TwistingJoints::default();
    batch.begin(&w.frames, &w.along, w.clamps);
    batch.place(&w.q, &w.roll);
    batch.lay(&laws, (&w.bend, &w.twist), [0, 59], |_| (LV, 1.0));
    let angles = |batch: &TwistingJoints| -> Vec<u64> {
        let bits = |j: usize| (0..10).map(move |k| batch.angle.get(k, j).to_bits());
        (0..=60).flat_map(bits).collect()
    };
    let answers = |batch: &TwistingJoints| -> Vec<u64> {
        let bits = |j: usize| (0..9).map(move |k| batch.answer.get(k, j).to_bits());
        (0..=60).flat_map(bits).collect()
    };
    let mut slow = batch.clone();
    assert!(slow.large.contains(&true) && slow.large.contains(&false));
    slow.large.fill(true);
    slow.put_all_large_angles();
    assert_eq!(angles(&batch), angles(&slow));
    let (mut few, mut all) = (YieldBranches::default(), YieldBranches::default());
    let energy = batch.respond(&laws, Some(&mut few));
    run(Elastic(&mut slow, &laws));
    assert!(slow.near.contains(&[true; 2]) && slow.near.contains(&[false; 2]));
    slow.near.fill([true; 2]);
    let slowly = slow.answer_near_yielding(&laws, Some(&mut all));
    assert_eq!(energy.to_bits(), slowly.to_bits());
    assert_eq!(answers(&batch), answers(&slow));
    let joints = |found: &[(u32, YieldBranch)]| -> Vec<(u32, u64)> {
        found
            .iter()
            .map(|(j, b)| (*j, b.moment.to_bits()))
            .collect()
    };
    assert_eq!(joints(&few.bending), joints(&all.bending));
    assert_eq!(joints(&few.twist), joints(&all.twist));
}

/// As many at once as there may be: the same to the bit.
#[test]
fn width_is_no_matter() {
    for (seed, edges, crooked) in [(5, 30, 0.05), (6, 23, 0.7), (7, 2, 0.2)] {
        let w = wire(seed, edges, crooked);
        let mut seen = Vec::new();
        let all = [Width::One, Width::Four, Width::Eight].map(|most| {
            at_most(most);
            seen.push(width());
            let (joints, energy, _) = respond(&w);
            let mut bits = Vec::new();
            for j in 0..edges {
                bits.extend((0..JOINT).map(|k| joints[j / ROWS].get(k, j % ROWS).to_bits()));
            }
            (bits, energy.to_bits())
        });
        at_most(Width::Four);
        assert!(all[0] == all[1] && all[1] == all[2], "widths {seen:?}");
    }
}
