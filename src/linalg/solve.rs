//! Solution with the factors of a block-banded matrix: a sweep from both ends to the middle, and
//! back.

use super::banded::{Banded, StepRows};
use super::pair::Pair;
use crate::math::simd::{WithSimd, run};
use pulp::Simd;

impl<const D: usize> Banded<D> {
    /// Solves in place with the factors of the last [`Banded::factor`].
    ///
    /// # Panics
    /// Unless `b` has one entry for each unknown.
    pub fn solve(&self, b: &mut [f64]) {
        assert_eq!(b.len(), self.nodes * D, "one entry for each unknown");
        run(Sweeps(self, b));
    }

    /// Solves for the middle once both chains have been swept towards it.
    fn solve_middle(&self, b: &mut [f64], steps: usize, first: &[Pair; D], second: &[Pair; D]) {
        let rows = b.len();
        if steps > 0 {
            for a in 0..D {
                b[a] -= first[a].0[0];
                b[D + a] -= second[a].0[0];
                b[rows - D + a] -= first[a].0[1];
                b[rows - 2 * D + a] -= second[a].0[1];
            }
        }
        let m = &self.middle_factors;
        for r in 0..rows {
            for c in 0..r {
                b[r] -= m[r][c] * b[c];
            }
        }
        for r in (0..rows).rev() {
            b[r] *= m[r][r];
            for k in r + 1..rows {
                b[r] -= m[k][r] * b[k];
            }
        }
    }
}

/// Solves with the factors: towards the middle, there, and back.
struct Sweeps<'a, const D: usize>(&'a Banded<D>, &'a mut [f64]);

impl<const D: usize> WithSimd for Sweeps<'_, D> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self(all, b) = self;
        let steps = all.step_factors.len();
        let (head, rest) = b.split_at_mut(steps * D);
        let (middle, tail) = rest.split_at_mut(rest.len() - steps * D);
        let (head, tail) = (head.as_chunks_mut().0, tail.as_chunks_mut().0);

        // what the solved unknowns take from the next node and the one after
        let mut first = [Pair::default(); D];
        let mut second = [Pair::default(); D];
        let inwards = head.iter_mut().zip(tail.iter_mut().rev());
        for (factors, (x, y)) in all.step_factors.iter().zip(inwards) {
            forward(factors, &mut first, &mut second, x, y);
        }

        all.solve_middle(middle, steps, &first, &second);

        let count = middle.len() / D;
        for a in 0..D {
            let mut at = [0.0; 4];
            for (node, x) in [0, count.wrapping_sub(1), 1, count.wrapping_sub(2)]
                .into_iter()
                .zip(&mut at)
            {
                if node < count {
                    *x = middle[node * D + a];
                }
            }
            first[a] = Pair([at[0], at[1]]);
            second[a] = Pair([at[2], at[3]]);
        }
        let outwards = head.iter_mut().rev().zip(tail);
        for (factors, (x, y)) in all.step_factors.iter().rev().zip(outwards) {
            backward(factors, &mut first, &mut second, x, y);
        }
    }
}

/// Divides one node of each chain by `L`: `x` of the first chain, `y` of the last.
#[inline(always)]
fn forward<const D: usize>(
    factors: &StepRows<D>,
    first: &mut [Pair; D],
    second: &mut [Pair; D],
    x: &mut [f64; D],
    y: &mut [f64; D],
) {
    let mut z = [Pair::default(); D];
    for a in 0..D {
        z[a] = Pair([x[a], y[a]]) - first[a];
    }
    for p in 0..D {
        for r in p + 1..D {
            z[r] = z[r] - factors.own[r][p] * z[p];
        }
    }
    for b in 0..D {
        let mut near = second[b];
        let mut far = factors.far[0][b] * z[0];
        for p in 0..D {
            near = near + factors.near[p][b] * z[p];
        }
        for p in 1..D {
            far = far + factors.far[p][b] * z[p];
        }
        first[b] = near;
        second[b] = far;
    }
    for a in 0..D {
        [x[a], y[a]] = z[a].0;
    }
}

/// Divides one node of each chain by `D L^T`, given the solution of its next two nodes.
#[inline(always)]
fn backward<const D: usize>(
    factors: &StepRows<D>,
    first: &mut [Pair; D],
    second: &mut [Pair; D],
    x: &mut [f64; D],
    y: &mut [f64; D],
) {
    let mut z = [Pair::default(); D];
    for p in 0..D {
        z[p] = Pair([x[p], y[p]]) * factors.own[p][p];
        // The neighbour solved last comes last, so that the rest need not wait for it.
        for b in 0..D {
            z[p] = z[p] - factors.far[p][b] * second[b];
        }
        for b in (0..D).rev() {
            z[p] = z[p] - factors.near[p][b] * first[b];
        }
    }
    for p in (0..D).rev() {
        for r in 0..p {
            z[r] = z[r] - factors.own[p][r] * z[p];
        }
    }
    *second = *first;
    *first = z;
    for a in 0..D {
        [x[a], y[a]] = z[a].0;
    }
}
