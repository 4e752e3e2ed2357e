//! Minimal residuals for what no symmetric band holds, the band as preconditioner.
//!
//! Generalised minimal residuals, without restarts (Saad and Schultz 1986, "GMRES", SIAM J. Sci. Stat. Comput. 7). They need
//! as many steps as there are stretches of wire that slide on their own, and one of them costs a fraction of an evaluation.

use super::beyond_band::BeyondBand;
use crate::linalg::Banded;

/// Share of the update that may be left: the next iterate shrinks it by more.
const CLOSE: f64 = 1e-2;
/// Steps at most.
const MOST_STEPS: usize = 30;

/// Vectors of the iteration.
#[derive(Clone, Debug, Default)]
pub(super) struct Scratch {
    /// orthogonal directions of length one
    basis: Vec<Vec<f64>>,
    /// by steps, a column of the upper triangle that their products with the matrix make, and the turn that made it one
    columns: Vec<[f64; MOST_STEPS]>,
    turns: Vec<[f64; 2]>,
}

/// Solves (banded + beyond) x = b in place; `matrix` is factored. A roll counts at this `radius`, m.
#[inline(never)]
pub(super) fn solve<const D: usize>(
    matrix: &Banded<D>,
    beyond: &BeyondBand,
    b: &mut [f64],
    s: &mut Scratch,
    radius: f64,
) {
    matrix.solve(b);
    let whole = dot::<D>(b, b, radius).sqrt();
    if whole == 0.0 || !whole.is_finite() {
        return;
    }
    s.columns.clear();
    s.turns.clear();
    direction(&mut s.basis, 0).extend(b.iter().map(|b| b / whole));
    let mut right = [0.0; MOST_STEPS + 1];
    right[0] = whole;
    for k in 0..MOST_STEPS {
        direction(&mut s.basis, k + 1).resize(b.len(), 0.0);
        let (known, rest) = s.basis.split_at_mut(k + 1);
        let (last, next) = (&known[k], &mut rest[0]);
        beyond.add_product::<D>(last, next);
        matrix.solve(next);
        for (next, last) in next.iter_mut().zip(last) {
            *next += last;
        }
        let mut column = [0.0; MOST_STEPS];
        for (entry, v) in column.iter_mut().zip(known) {
            *entry = dot::<D>(next, v, radius);
            add(next, v, -*entry);
        }
        let left = dot::<D>(next, next, radius).sqrt();
        for (i, [c, s]) in s.turns.iter().enumerate() {
            let (x, y) = (column[i], column[i + 1]);
            (column[i], column[i + 1]) = (c * x + s * y, c * y - s * x);
        }
        let size = (column[k] * column[k] + left * left).sqrt();
        let turn = [column[k] / size, left / size];
        column[k] = size;
        (right[k], right[k + 1]) = (turn[0] * right[k], -turn[1] * right[k]);
        s.turns.push(turn);
        s.columns.push(column);
        if right[k + 1].abs() <= CLOSE * whole {
            break;
        }
        for x in next.iter_mut() {
            *x /= left;
        }
    }
    b.fill(0.0);
    for k in (0..s.columns.len()).rev() {
        let column = &s.columns[k];
        let share = right[k] / column[k];
        for (right, entry) in right[..k].iter_mut().zip(column) {
            *right -= entry * share;
        }
        add(b, &s.basis[k], share);
    }
}

/// Direction `k`, emptied.
fn direction(basis: &mut Vec<Vec<f64>>, k: usize) -> &mut Vec<f64> {
    if basis.len() <= k {
        basis.push(Vec::new());
    }
    basis[k].clear();
    &mut basis[k]
}

/// Adds `share` of `b` to `a`.
fn add(a: &mut [f64], b: &[f64], share: f64) {
    for (a, b) in a.iter_mut().zip(b) {
        *a += share * b;
    }
}

/// Product of two updates, m^2; a roll counts at this `radius`, m.
fn dot<const D: usize>(a: &[f64], b: &[f64], radius: f64) -> f64 {
    let mut sum = [0.0; D];
    for (a, b) in a.as_chunks::<D>().0.iter().zip(b.as_chunks::<D>().0) {
        for k in 0..D {
            sum[k] += a[k] * b[k];
        }
    }
    let places: f64 = sum[..3].iter().sum();
    places + sum[3..].iter().sum::<f64>() * radius * radius
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::{ContactPoint, Coupling, SlipCoupling};
    use crate::math::{Block, V3, add_identity, add_outer};
    use nalgebra::{DMatrix, DVector};

    /// Numbers between -1 and 1, the same at every call.
    fn numbers() -> impl FnMut() -> f64 {
        let mut state = 1u64;
        move || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        }
    }

    /// A wire of `nodes` nodes, stiff along and soft across, whose points slide on what they touch.
    fn system(nodes: usize) -> (Banded<4>, BeyondBand) {
        let mut next = numbers();
        let mut vector = move || V3::new(next(), next(), next());
        let mut matrix = Banded::<4>::new();
        matrix.reset(nodes);
        for i in 0..nodes {
            for a in 0..4 {
                matrix.add_to_entry(i, a, 1.0);
            }
        }
        let mut beyond = BeyondBand {
            held: [[true, true, false], [false, false, true]],
            ..BeyondBand::default()
        };
        for point in ContactPoint::all(nodes - 1).skip(2).step_by(3) {
            let mut block = Block::default();
            add_identity(&mut block, 0.5);
            add_outer(&mut block, &(vector() * 4.0), &V3::x());
            point
                .weights()
                .spread_block(&symmetric(&block), &mut matrix);
            let mut block = Block::default();
            add_outer(&mut block, &(vector() * 3.0), &vector());
            beyond.slips.push(SlipCoupling {
                point: point.weights(),
                foot: None,
                block,
            });
        }
        let (young, old) = (
            ContactPoint::Node(nodes - 3).weights(),
            ContactPoint::Edge(2),
        );
        let old = old.weights().negative();
        let mut block = Block::default();
        add_identity(&mut block, 2.0);
        for at in [&young, &old] {
            at.spread_block(&block, &mut matrix);
        }
        beyond.couplings.push(Coupling { young, old, block });
        let mut block = Block::default();
        add_outer(&mut block, &vector(), &vector());
        beyond.slips.push(SlipCoupling {
            point: young,
            foot: Some(old),
            block,
        });
        for (end, i) in [(0, 0), (1, nodes - 1)] {
            for a in 0..3 {
                if beyond.held[end][a] {
                    matrix.pin(i, a);
                }
            }
        }
        (matrix, beyond)
    }

    /// Positive definite: half the sum with the transpose, and enough on the diagonal.
    fn symmetric(block: &Block) -> Block {
        let mut sum = Block::default();
        for r in 0..3 {
            for c in 0..3 {
                sum[r][c] = 0.5 * (block[r][c] + block[c][r]);
            }
        }
        add_identity(&mut sum, 4.0);
        sum
    }

    #[test]
    fn it_solves_what_elimination_solves() {
        for nodes in [8, 14, 30] {
            let (mut matrix, beyond) = system(nodes);
            let n = 4 * nodes;
            let mut columns = Vec::new();
            for k in 0..n {
                let mut x = vec![0.0; n];
                x[k] = 1.0;
                let (mut banded, mut other) = (vec![0.0; n], vec![0.0; n]);
                matrix.multiply(&x, &mut banded);
                beyond.add_product::<4>(&x, &mut other);
                columns.extend(banded.iter().zip(&other).map(|(a, b)| a + b));
            }
            let mut next = numbers();
            let mut b: Vec<f64> = (0..n).map(|_| next()).collect();
            for (first, held) in [0, n - 4].into_iter().zip(beyond.held) {
                for (b, _) in b[first..].iter_mut().zip(held).filter(|(_, held)| *held) {
                    *b = 0.0;
                }
            }
            let whole = DMatrix::from_vec(n, n, columns).lu();
            let want = whole.solve(&DVector::from_vec(b.clone())).expect("regular");
            matrix.factor().expect("positive");
            let mut symmetric = b.clone();
            matrix.solve(&mut symmetric);
            let mut scratch = Scratch::default();
            solve(&matrix, &beyond, &mut b, &mut scratch, 0.3);
            let off = |x: &[f64]| (DVector::from_row_slice(x) - &want).norm() / want.norm();
            assert!(off(&symmetric) > 0.1, "{}", off(&symmetric));
            let steps = scratch.columns.len();
            assert!(off(&b) < 3.0 * CLOSE, "{} in {steps}", off(&b));
            assert!(steps < MOST_STEPS);
        }
    }
}
