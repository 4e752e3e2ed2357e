//! All joints of a rod at once, many side by side.
//!
//! [`TwistingJoints`] compute with twist what [`super::twisted()`] computes for one joint,
//! [`BendingJoints`] without twist what [`super::bent()`] computes.
//!
//! Three passes: edges; angles of the joints; and, after the laws of all joints, gradients and
//! Hessians, which the assembly asks for a block of joints at a time ([`Joints`]). The row before
//! the first edge is the clamp there, the row after the last the clamp at the other end.

mod bending_joints;
mod twisting_joints;

use super::yield_branch::YieldBranch;
use crate::math::V3;
use crate::math::simd::{Columns, Lanes, Lanes3, ROWS, RowBlock};
pub use bending_joints::BendingJoints;
use pulp::Simd;
pub use twisting_joints::{Forces, TwistingJoints};

/// Number of columns of a joint's gradient and Hessian; units as in [`super::Bent`] and
/// [`super::Rolled`].
pub const JOINT: usize = 52;
/// Columns of the Hessian by the edge vector before the joint and after it, lower halves.
pub const OWN: [usize; 2] = [0, 6];
/// Columns of the Hessian, rows before, columns after.
pub const CROSS: usize = 12;
/// Columns of the Hessian, roll by roll: before-before, before-after, after-after.
pub const ROLL_OWN: usize = 21;
/// Columns of the Hessian, roll of the edge before or after by either edge vector.
pub const ROLL_WITH: [[usize; 2]; 2] = [[24, 27], [30, 33]];
/// Columns of the gradient by the edge vectors.
pub const GRADIENT: [usize; 2] = [36, 39];
/// Columns of the gradient by the rolls.
pub const TORQUE: usize = 42;
/// Derivative of the angle along the moment by the edge vectors ...
const LEAD: [usize; 2] = [44, 47];
/// ... and by the rolls.
const LEAD_ROLL: usize = 50;

/// Joints whose moments are known, with the gradients and Hessians of their energy for the
/// assembly.
pub trait Joints {
    /// Blocks of eight edges or joints.
    fn blocks(&self) -> usize;

    /// Directions of the edges of `block` from row `first` on.
    fn directions<S: Simd>(&self, simd: S, block: usize, first: usize) -> Lanes3<S>;

    /// Unit direction of edge `j`, its length, m, and its inverse length, 1/m.
    fn edge(&self, j: usize) -> (V3, f64, f64);

    /// Gradients, and Hessians where asked for, of the joints of `block` from row `first` on; with
    /// `near` also the derivatives that [`YieldBranch`] needs.
    fn derive<S: Simd, const HESSIAN: bool>(
        &self,
        simd: S,
        block: usize,
        first: usize,
        near: bool,
        out: &mut RowBlock<JOINT>,
    );

    /// Gradients and Hessians of the joints of `block`.
    ///
    /// `yield_branches` begins with those of this block: their derivatives are filled in and they
    /// leave the slice.
    #[inline(always)]
    fn joints<S: Simd, const HESSIAN: bool>(
        &self,
        simd: S,
        block: usize,
        out: &mut RowBlock<JOINT>,
        yield_branches: &mut &mut [(u32, YieldBranch)],
    ) {
        let here = |yield_branches: &[(u32, YieldBranch)]| {
            let first = yield_branches.first()?.0 as usize;
            (first / ROWS == block).then_some(first % ROWS)
        };
        let near = here(yield_branches).is_some();
        for first in (0..ROWS).step_by(Lanes::<S>::COUNT) {
            self.derive::<S, HESSIAN>(simd, block, first, near, out);
        }
        while let Some(row) = here(yield_branches) {
            let (one, rest) = std::mem::take(yield_branches).split_at_mut(1);
            *yield_branches = rest;
            let yield_branch = &mut one[0].1;
            for k in 0..2 {
                let at = |a: usize| out.get(LEAD[k] + a, row);
                yield_branch.rows[k] = V3::new(at(0), at(1), at(2));
                yield_branch.rolls[k] = out.get(LEAD_ROLL + k, row);
            }
        }
    }
}

/// Unit direction of edge `j`, its length, m, and its inverse length, 1/m, from these `columns` of the `edges`.
#[inline(always)]
fn edge_of<const N: usize>(edges: &Columns<N>, j: usize, columns: [usize; 3]) -> (V3, f64, f64) {
    let (block, row) = edges.row(j);
    let [along, length, inverse] = columns;
    (
        block.vector(along, row),
        block.get(length, row),
        block.get(inverse, row),
    )
}

/// Writes the positions of all nodes into three columns.
fn put_places(columns: &mut Columns<3>, q: &[V3]) {
    columns.put(q, |block, row, p| {
        block.set(0, row, p.x);
        block.set(1, row, p.y);
        block.set(2, row, p.z);
    });
    columns.join();
}

/// A polynomial by its coefficients.
#[inline(always)]
fn series<S: Simd, const N: usize>(terms: &[f64; N], x: Lanes<S>) -> Lanes<S> {
    let mut sum = x * terms[N - 1];
    for k in (1..N - 1).rev() {
        sum = x * (sum + terms[k]);
    }
    sum + terms[0]
}
