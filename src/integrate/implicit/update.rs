//! The update of Newton's method: solved again until the tangents of contact and yielding fit where it leads.

use super::potential::Potential;
use super::unknowns::{Unknowns, add_at};
use super::work::Work;
use crate::contact::{ContactPoint, NodeWeights};
use crate::math::V3;
use crate::rod::{Block, Laws, add_outer};

/// Times that an update is solved again for contact and yielding it meets on its way.
const LOOKS_AHEAD: usize = 8;

/// The right-hand side: minus the gradient.
pub(super) fn load_gradient<const D: usize, U: Unknowns<D>>(work: &mut Work<D, U>) {
    work.load.resize(D * work.gradient.len(), 0.0);
    let nodes = work.load.as_chunks_mut::<D>().0.iter_mut();
    for (i, (load, places)) in nodes.zip(&work.gradient).enumerate() {
        *load = work.unknowns.gradient(i, places).map(|g| -g);
    }
}

/// The update from gradient and Hessian, with tangents of contact that fit where it leads; whether all of them do.
#[inline(never)]
pub(super) fn solve_linear<const D: usize, U: Unknowns<D>>(
    potential: &mut Potential,
    work: &mut Work<D, U>,
    promise: f64,
) -> Result<bool, usize> {
    let nodes = work.q.len();
    load_gradient(work);
    for look in 0.. {
        work.matrix.factor().map_err(|pivot| pivot.node)?;
        work.update.clone_from(&work.load);
        work.beyond.take(potential.line.as_ref(), potential.held);
        work.solve_factored(0.5 * potential.diameter);
        if look == 0 {
            work.plain.clone_from(&work.update);
        }
        if look == LOOKS_AHEAD {
            return Ok(false);
        }
        let mut any = predict_branches(potential.laws, work);
        let Work {
            q,
            update,
            load,
            matrix,
            there,
            ..
        } = work;
        let move_of = |point: usize| {
            let mut way = V3::zeros();
            let weights = ContactPoint::of_number(point).weights();
            weights.add_way::<D>(update, &mut way);
            way
        };
        let mut correct = |place: &NodeWeights, stiffness: &Block, gradient: &V3| {
            place.spread_block(stiffness, matrix);
            for (i, w) in place.iter() {
                for a in 0..3 {
                    load[D * i + a] -= w * gradient[a];
                }
            }
        };
        if let Some(line) = &mut potential.line {
            let farthest = farthest_move::<D>(update);
            any |= line.predict(
                potential.elapsed,
                (farthest, promise),
                move_of,
                |point, stiffness, gradient| {
                    let place = ContactPoint::of_number(point).weights();
                    correct(&place, stiffness, gradient);
                },
            );
            let mut conditions = line
                .model
                .of_pairs(potential.elapsed, line.state.limit_from);
            conditions.prediction *= promise;
            if let Some(pairs) = &mut line.state.self_contact {
                there.clear();
                for (i, p) in q.iter().enumerate() {
                    there.push(p + V3::new(update[D * i], update[D * i + 1], update[D * i + 2]));
                }
                any |= pairs.predict(
                    &mut line.scratch.pairs,
                    &conditions,
                    (q, potential.last, there),
                    |young, old, stiffness, gradient| {
                        correct(young, stiffness, gradient);
                        correct(old, stiffness, gradient);
                    },
                );
            }
        }
        if !any {
            break;
        }
        // nothing but the ends is held, but for plane statics
        if work.matrix.ends_changed() || potential.flat {
            potential.pinned(nodes, |i, a| {
                work.matrix.pin(i, a);
                work.load[D * i + a] = 0.0;
            });
            for (i, a) in work.unknowns.pinned() {
                work.matrix.pin(i, a);
                work.load[D * i + a] = 0.0;
            }
        }
        work.solves += 1;
    }
    Ok(true)
}

/// Upper bound of the way of a node in an update, m.
fn farthest_move<const D: usize>(update: &[f64]) -> f64 {
    let square = |u: &[f64; D]| u[0] * u[0] + u[1] * u[1] + u[2] * u[2];
    let nodes = update.as_chunks::<D>().0;
    let most = nodes.iter().map(square).fold(0.0, f64::max);
    // (rounding)
    most.sqrt() * (1.0 + 1e-9)
}

/// Looks where the update leads every joint, and corrects the tangents of those that change their branch.
fn predict_branches<const D: usize, U: Unknowns<D>>(laws: &Laws, work: &mut Work<D, U>) -> bool {
    let Work {
        yield_branches,
        update,
        load,
        matrix,
        ..
    } = work;
    let nodes = update.len() / D;
    let mut any = false;

    let bending = yield_branches
        .bending
        .iter_mut()
        .map(|yield_branch| (&laws.bend, yield_branch));
    let twist = yield_branches
        .twist
        .iter_mut()
        .map(|yield_branch| (&laws.twist, yield_branch));
    for (law, (joint, yield_branch)) in bending.chain(twist) {
        let j = *joint as usize;
        // derivative of the angle by the rolls, which stand with the first nodes of their edges
        let (by_rolls, mut rolls) = (U::by_rolls(yield_branch), [0.0; 3]);
        let move_of = |u: &[f64]| V3::new(u[0], u[1], u[2]);
        let mut angle = 0.0;
        if j > 0 {
            let u = &update[D * (j - 1)..D * (j + 1)];
            angle += yield_branch.rows[0].dot(&(move_of(&u[D..]) - move_of(u)));
            rolls[0] = by_rolls[0];
            angle += rolls[0] * U::roll(update, j - 1);
        }
        if j + 1 < nodes {
            let u = &update[D * j..D * (j + 2)];
            angle += yield_branch.rows[1].dot(&(move_of(&u[D..]) - move_of(u)));
            rolls[1] = by_rolls[1];
            angle += rolls[1] * U::roll(update, j);
        }
        let Some((stiffness, moment)) = yield_branch.predict(law, angle) else {
            continue;
        };
        any = true;
        // derivative of the angle by the nodes
        let mut rows = [V3::zeros(); 3];
        if j > 0 {
            rows[0] -= yield_branch.rows[0];
            rows[1] += yield_branch.rows[0];
        }
        if j + 1 < nodes {
            rows[1] -= yield_branch.rows[1];
            rows[2] += yield_branch.rows[1];
        }
        let none = |a: usize| rows[a] == V3::zeros() && rolls[a] == 0.0;
        for a in 0..3 {
            if none(a) {
                continue;
            }
            let i = j + a - 1;
            for k in 0..3 {
                load[D * i + k] -= moment * rows[a][k];
            }
            U::relieve(load, i, moment * rolls[a]);
            for b in a..3 {
                if none(b) {
                    continue;
                }
                let mut block = Block::default();
                add_outer(&mut block, &(rows[a] * stiffness), &rows[b]);
                add_at(matrix, i, b - a, &block);
                let (one, other) = ((&rows[a], rolls[a]), (&rows[b], rolls[b]));
                U::add_stiffness(matrix, i, b - a, one, other, stiffness);
            }
        }
    }
    any
}
