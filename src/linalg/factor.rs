//! Factorisation `A = L D L^T` of a block-banded matrix, from both ends inwards.

use super::banded::{Banded, Carry, StepRows, WIDEST};
use super::pair::is_safe;
use crate::math::simd::{WithSimd, run};
use pulp::Simd;
use thiserror::Error;

/// The first unknown whose pivot is not safely positive: the matrix is singular there, or nearly.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("the equations leave coordinate {coordinate} of node {node} loose")]
pub struct SingularPivot {
    /// index of the node
    pub node: usize,
    /// index of the unknown within the node
    pub coordinate: usize,
}

impl<const D: usize> Banded<D> {
    /// Factors the matrix, without pivoting.
    ///
    /// # Errors
    /// Names the first unknown without a safe pivot, in the order of elimination: from both ends
    /// inwards, of two at equal distance the one nearer the start.
    /// The factors are not to be used then.
    pub fn factor(&mut self) -> Result<(), SingularPivot> {
        // from the first step on that something has changed in
        if let Some(step) = run(Eliminate(self)) {
            return Err(self.singular_in_step(step));
        }
        self.factor_middle()?;
        self.kept = self.steps.len();
        Ok(())
    }

    /// Finds the unsafe pivot in a step that reported one; the factors hold the reciprocals.
    #[cold]
    fn singular_in_step(&self, step: usize) -> SingularPivot {
        let (rows, factors) = (&self.steps[step], &self.step_factors[step]);
        // A bad pivot spoils those after it in its own lane only: the first of a lane is the cause.
        for (lane, node) in [(0, step), (1, self.nodes - 1 - step)] {
            for coordinate in 0..D {
                let original = rows.own[coordinate][coordinate].0[lane];
                if !is_safe(factors.own[coordinate][coordinate].0[lane], original) {
                    return SingularPivot { node, coordinate };
                }
            }
        }
        unreachable!("step {step} reported an unsafe pivot")
    }

    /// Takes what both chains carry from the middle and factors the rest.
    fn factor_middle(&mut self) -> Result<(), SingularPivot> {
        let rows = self.middle_rows();
        let carry = &self.carries[self.steps.len()];
        let m = &mut self.middle_factors;
        *m = self.middle;
        if !self.steps.is_empty() {
            let last = rows - D;
            for a in 0..D {
                for b in 0..a + 1 {
                    m[a][b] -= carry.first[a][b].0[0];
                    m[D + a][D + b] -= carry.second[a][b].0[0];
                    m[last + a][last + b] -= carry.first[a][b].0[1];
                    m[last - D + a][last - D + b] -= carry.second[a][b].0[1];
                }
                for b in 0..D {
                    m[D + b][a] -= carry.cross[a][b].0[0];
                    m[last + a][last - D + b] -= carry.cross[a][b].0[1];
                }
            }
        }
        for p in 0..rows {
            let reciprocal = 1.0 / m[p][p];
            if !is_safe(reciprocal, self.middle[p][p]) {
                return Err(SingularPivot {
                    node: self.steps.len() + p / D,
                    coordinate: p % D,
                });
            }
            m[p][p] = reciprocal;
            let mut w = [0.0; WIDEST];
            for r in p + 1..rows {
                w[r] = m[r][p];
                m[r][p] *= reciprocal;
            }
            for r in p + 1..rows {
                let l = m[r][p];
                for c in p + 1..r + 1 {
                    m[r][c] -= l * w[c];
                }
            }
        }
        Ok(())
    }
}

/// A loop over the unknowns of a node, written out so that every index is a constant.
///
/// The optimiser gives up on unrolling nests as deep as these, and then keeps the blocks in memory.
macro_rules! unrolled {
    ($i:ident < $d:ident, $body:block) => {
        unrolled!(@ $i $d $body 0 1 2 3)
    };
    (@ $i:ident $d:ident $body:block $($n:literal)*) => {
        $(if $n < $d {
            let $i = $n;
            $body
        })*
    };
}

/// Eliminates one node of each chain; false if a pivot is unsafe.
///
/// The blocks of a node are finished before anything is taken from the next two. Each number of
/// `after` is then summed over all pivots in a register and stored once.
#[inline(always)]
fn eliminate<const D: usize>(
    rows: &StepRows<D>,
    carry: &Carry<D>,
    after: &mut Carry<D>,
    factors: &mut StepRows<D>,
) -> bool {
    let mut own = rows.own;
    let mut near = rows.near;
    let mut far = rows.far;
    unrolled!(a < D, {
        for b in 0..a + 1 {
            own[a][b] = own[a][b] - carry.first[a][b];
        }
        for b in 0..D {
            near[a][b] = near[a][b] - carry.cross[a][b];
        }
    });
    let mut safe = true;
    unrolled!(p < D, {
        let reciprocal = own[p][p].reciprocal();
        safe &= reciprocal.is_safe(rows.own[p][p]);
        factors.own[p][p] = reciprocal;
        for r in p + 1..D {
            let l = own[r][p] * reciprocal;
            factors.own[r][p] = l;
            for c in p + 1..r + 1 {
                own[r][c] = own[r][c] - l * own[c][p];
            }
            for b in 0..D {
                near[r][b] = near[r][b] - l * near[p][b];
                far[r][b] = far[r][b] - l * far[p][b];
            }
        }
        for b in 0..D {
            factors.near[p][b] = near[p][b] * reciprocal;
            factors.far[p][b] = far[p][b] * reciprocal;
        }
    });
    unrolled!(x < D, {
        for y in 0..x + 1 {
            let mut sum = carry.second[x][y];
            for p in 0..D {
                sum = sum + factors.near[p][x] * near[p][y];
            }
            after.first[x][y] = sum;
        }
        for y in 0..D {
            let mut sum = factors.near[0][x] * far[0][y];
            for p in 1..D {
                sum = sum + factors.near[p][x] * far[p][y];
            }
            after.cross[x][y] = sum;
        }
        for y in 0..x + 1 {
            let mut sum = factors.far[0][x] * far[0][y];
            for p in 1..D {
                sum = sum + factors.far[p][x] * far[p][y];
            }
            after.second[x][y] = sum;
        }
    });
    safe
}

/// Eliminates the steps from the first changed one on; gives the step with an unsafe pivot, if any.
struct Eliminate<'a, const D: usize>(&'a mut Banded<D>);

impl<const D: usize> WithSimd for Eliminate<'_, D> {
    type Output = Option<usize>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Option<usize> {
        let all = self.0;
        for step in std::mem::take(&mut all.kept)..all.steps.len() {
            let (before, after) = all.carries.split_at_mut(step + 1);
            let factors = &mut all.step_factors[step];
            if !eliminate(&all.steps[step], &before[step], &mut after[0], factors) {
                return Some(step);
            }
        }
        None
    }
}
