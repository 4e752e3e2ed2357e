//! Symmetric block-banded equations, factored as `L D L^T` from both ends at once.
//!
//! The matrix couples node `i` with itself, `i + 1` and `i + 2` in blocks of `D x D`, as bending of
//! a rod does.
//! A one-ended elimination waits on itself: each pivot needs the one before, and its division and
//! products cannot overlap with anything.
//! Here the chain is folded in the middle instead (a twisted factorisation): step `s` eliminates
//! node `s` and node `nodes - 1 - s` together, in the two lanes of one [`Pair`], until two or three
//! nodes are left, which are factored as a small dense matrix.
//! The lanes never meet before that, so every operation on a `Pair` maps to one two-wide
//! instruction of the baseline instruction set, without padding and with the symmetry fully used;
//! compiled for what the machine has ([`run`]), neighbouring pairs go four wide, with the same bits.
//!
//! Symbols: `w` is a row of the matrix right of its pivot when its turn comes, `l = w / pivot` the
//! same row of `L^T`.

use std::ops::{Add, Mul, Sub};

use crate::math::simd::{WithSimd, run};
use pulp::Simd;
use thiserror::Error;

/// Share of its original diagonal that a pivot must exceed.
///
/// Cancellation leaves an error of a few rounding units of the diagonal; 64 of them keep an exactly
/// loose matrix from passing, and allow stiffness to exceed inertia by 1e13.
const SAFE_SHARE: f64 = 64.0 * f64::EPSILON;

/// Rows that the middle has room for: three nodes of four unknowns.
const WIDEST: usize = 12;

/// An unknown that the matrix does not hold: its pivot is not safely positive.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("the equations leave coordinate {coordinate} of node {node} loose")]
pub struct SingularPivot {
    /// index of the node
    pub node: usize,
    /// index of the unknown within the node
    pub coordinate: usize,
}

/// One number of the chain from the first node, one of the chain from the last.
#[derive(Clone, Copy, Debug, Default)]
#[repr(align(16))]
struct Pair([f64; 2]);

impl Add for Pair {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self([self.0[0] + other.0[0], self.0[1] + other.0[1]])
    }
}

impl Sub for Pair {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self([self.0[0] - other.0[0], self.0[1] - other.0[1]])
    }
}

impl Mul for Pair {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self([self.0[0] * other.0[0], self.0[1] * other.0[1]])
    }
}

impl Pair {
    #[inline(always)]
    fn reciprocal(self) -> Self {
        Self([1.0 / self.0[0], 1.0 / self.0[1]])
    }

    #[inline(always)]
    fn is_safe(self, original: Self) -> bool {
        is_safe(self.0[0], original.0[0]) & is_safe(self.0[1], original.0[1])
    }
}

/// A block of both chains.
type Block<const D: usize> = [[Pair; D]; D];

/// The rows of the two nodes eliminated in one step, of the matrix or of its factors.
#[derive(Clone, Copy, Debug)]
struct Step<const D: usize> {
    /// lower half: the node with itself; as factor: `l` below the reciprocal pivots
    own: Block<D>,
    /// rows of the node, columns of its neighbour towards the middle
    near: Block<D>,
    /// rows of the node, columns of the neighbour after that
    far: Block<D>,
}

impl<const D: usize> Step<D> {
    const ZERO: Self = Self {
        own: [[Pair([0.0; 2]); D]; D],
        near: [[Pair([0.0; 2]); D]; D],
        far: [[Pair([0.0; 2]); D]; D],
    };
}

/// What the nodes eliminated so far take away from the two next in line.
#[derive(Clone, Copy, Debug)]
struct Carry<const D: usize> {
    /// lower half: from the next node with itself
    first: Block<D>,
    /// from the rows of the next node, columns of the one after
    cross: Block<D>,
    /// lower half: from the one after with itself
    second: Block<D>,
}

impl<const D: usize> Carry<D> {
    const NONE: Self = Self {
        first: Step::ZERO.own,
        cross: Step::ZERO.own,
        second: Step::ZERO.own,
    };
}

/// The dense rest where the chains meet; only the lower half is used.
type Middle = [[f64; WIDEST]; WIDEST];

/// A symmetric matrix of blocks that couple a node with the next two, and its factors.
///
/// Matrix and factors are kept apart, so that [`Banded::multiply`] serves refinement after
/// [`Banded::factor`].
/// A matrix that keeps its size, or shrinks, is filled and factored again without allocation.
#[derive(Clone, Debug)]
pub struct Banded<const D: usize> {
    nodes: usize,
    steps: Vec<Step<D>>,
    middle: Middle,
    step_factors: Vec<Step<D>>,
    /// what the nodes before each step take away in it; one more for the middle
    carries: Vec<Carry<D>>,
    /// steps whose rows are still those that were factored last
    kept: usize,
    /// `l` below the reciprocal pivots
    middle_factors: Middle,
}

/// Where the coupling of two nodes is kept.
enum Place {
    /// step and lane; in lane 1 rows belong to the later node
    Step(usize, usize),
    /// first rows of the earlier and of the later node
    Middle(usize, usize),
}

impl<const D: usize> Default for Banded<D> {
    fn default() -> Self {
        Self::new()
    }
}

impl<const D: usize> Banded<D> {
    /// No nodes yet.
    pub fn new() -> Self {
        const { assert!(D > 0 && 3 * D <= WIDEST) };
        Self {
            nodes: 0,
            steps: Vec::new(),
            middle: [[0.0; WIDEST]; WIDEST],
            step_factors: Vec::new(),
            carries: Vec::new(),
            kept: 0,
            middle_factors: [[0.0; WIDEST]; WIDEST],
        }
    }

    /// Becomes the zero matrix of `nodes` nodes.
    pub fn reset(&mut self, nodes: usize) {
        self.resize(nodes);
        self.steps.fill(Step::ZERO);
        self.middle = [[0.0; WIDEST]; WIDEST];
    }

    /// Becomes a matrix of `nodes` nodes, every row of which is put next.
    pub fn resize(&mut self, nodes: usize) {
        self.nodes = nodes;
        // Two nodes at least must be left, or the last of one chain would couple with the other's.
        let steps = nodes.saturating_sub(2) / 2;
        self.steps.resize(steps, Step::ZERO);
        // Factors are written before they are read: no need to clear them.
        self.step_factors.resize(steps, Step::ZERO);
        self.carries.resize(steps + 1, Carry::NONE);
        self.kept = 0;
    }

    /// Whether anything of the first or the last node has changed since the last [`Banded::factor`].
    pub fn ends_changed(&self) -> bool {
        self.kept == 0
    }

    /// Puts what node `i` has: the lower half of its own block, and the blocks with its rows and the columns of the
    /// next node and of the one after, as far as these exist.
    #[inline(always)]
    pub fn put(
        &mut self,
        i: usize,
        own: impl Fn(usize, usize) -> f64,
        near: impl Fn(usize, usize) -> f64,
        far: impl Fn(usize, usize) -> f64,
    ) {
        match self.place(i, i) {
            Place::Step(step, lane) => {
                let kept = &mut self.steps[step].own;
                for a in 0..D {
                    for b in 0..a + 1 {
                        kept[a][b].0[lane & 1] = own(a, b);
                    }
                }
            }
            Place::Middle(row, _) => {
                for a in 0..D {
                    for b in 0..a + 1 {
                        self.middle[row + a][row + b] = own(a, b);
                    }
                }
            }
        }
        if i + 1 < self.nodes {
            self.put_block(i, 1, near);
        }
        if i + 2 < self.nodes {
            self.put_block(i, 2, far);
        }
    }

    #[inline(always)]
    fn put_block(&mut self, i: usize, k: usize, block: impl Fn(usize, usize) -> f64) {
        match self.place(i, i + k) {
            Place::Step(step, lane) => {
                let step = &mut self.steps[step];
                let kept = if k == 1 {
                    &mut step.near
                } else {
                    &mut step.far
                };
                if lane == 0 {
                    for a in 0..D {
                        for b in 0..D {
                            kept[a][b].0[0] = block(a, b);
                        }
                    }
                } else {
                    for a in 0..D {
                        for b in 0..D {
                            kept[b][a].0[1] = block(a, b);
                        }
                    }
                }
            }
            Place::Middle(column, row) => {
                for a in 0..D {
                    for b in 0..D {
                        self.middle[row + b][column + a] = block(a, b);
                    }
                }
            }
        }
    }

    /// Adds a symmetric block to node `i`; only its lower half is read. A block of fewer than `D` rows
    /// belongs to the first unknowns of the node.
    #[inline]
    pub fn add_diagonal<const B: usize>(&mut self, i: usize, block: &[[f64; B]; B]) {
        match self.place(i, i) {
            Place::Step(step, lane) => {
                self.kept = self.kept.min(step);
                let own = &mut self.steps[step].own;
                for a in 0..B {
                    for b in 0..a + 1 {
                        own[a][b].0[lane] += block[a][b];
                    }
                }
            }
            Place::Middle(row, _) => {
                for a in 0..B {
                    for b in 0..a + 1 {
                        self.middle[row + a][row + b] += block[a][b];
                    }
                }
            }
        }
    }

    /// Adds a block to the rows of node `i`, columns of node `i + k`, and its mirror image; one of fewer
    /// than `D` rows to their first unknowns.
    ///
    /// # Panics
    /// Unless `k` is 1 or 2 and node `i + k` exists.
    #[inline]
    pub fn add<const B: usize>(&mut self, i: usize, k: usize, block: &[[f64; B]; B]) {
        assert!(
            k == 1 || k == 2,
            "nodes couple over one or two edges, not {k}"
        );
        match self.place(i, i + k) {
            Place::Step(step, lane) => {
                self.kept = self.kept.min(step);
                let step = &mut self.steps[step];
                let kept = if k == 1 {
                    &mut step.near
                } else {
                    &mut step.far
                };
                if lane == 0 {
                    for a in 0..B {
                        for b in 0..B {
                            kept[a][b].0[0] += block[a][b];
                        }
                    }
                } else {
                    for a in 0..B {
                        for b in 0..B {
                            kept[b][a].0[1] += block[a][b];
                        }
                    }
                }
            }
            Place::Middle(column, row) => {
                for a in 0..B {
                    for b in 0..B {
                        self.middle[row + b][column + a] += block[a][b];
                    }
                }
            }
        }
    }

    /// Adds to the diagonal entry of unknown `a` of node `i`.
    #[inline]
    pub fn add_to_entry(&mut self, i: usize, a: usize, value: f64) {
        assert!(a < D, "a node has {D} unknowns, there is no number {a}");
        match self.place(i, i) {
            Place::Step(step, lane) => {
                self.kept = self.kept.min(step);
                self.steps[step].own[a][a].0[lane] += value;
            }
            Place::Middle(row, _) => self.middle[row + a][row + a] += value,
        }
    }

    /// Holds unknown `a` of node `i`: its row and column become those of the unit matrix.
    ///
    /// Call it after everything is added and before [`Banded::factor`].
    /// The solution is then the right-hand side of that unknown, and the other unknowns do not
    /// feel it: for a held value other than zero, move its column to the right-hand side first.
    pub fn pin(&mut self, i: usize, a: usize) {
        for b in 0..D {
            *self.entry(i, a, i, b) = 0.0;
        }
        for other in i.saturating_sub(2)..(i + 3).min(self.nodes) {
            if other != i {
                for b in 0..D {
                    *self.entry(i, a, other, b) = 0.0;
                }
            }
        }
        *self.entry(i, a, i, a) = 1.0;
    }

    /// Factors the matrix, without pivoting.
    ///
    /// # Errors
    /// Names the first unknown without a safe pivot, in the order of elimination: from both ends
    /// inwards, of two at equal distance the one nearer the start.
    /// The factors are not to be used then.
    pub fn factor(&mut self) -> Result<(), SingularPivot> {
        // from the first step on that something has changed in
        if let Some(step) = run(Eliminate(self)) {
            return Err(self.loose_in_step(step));
        }
        self.factor_middle()?;
        self.kept = self.steps.len();
        Ok(())
    }

    /// Solves in place with the factors of the last [`Banded::factor`].
    ///
    /// # Panics
    /// Unless `b` has one entry for each unknown.
    pub fn solve(&self, b: &mut [f64]) {
        assert_eq!(b.len(), self.nodes * D, "one entry for each unknown");
        run(Sweeps(self, b));
    }

    /// `y = A x` with the matrix as it was added and pinned, factored or not.
    ///
    /// # Panics
    /// Unless `x` and `y` have one entry for each unknown.
    pub fn multiply(&self, x: &[f64], y: &mut [f64]) {
        assert_eq!(x.len(), self.nodes * D, "one entry for each unknown");
        assert_eq!(y.len(), self.nodes * D, "one entry for each unknown");
        y.fill(0.0);
        for (step, rows) in self.steps.iter().enumerate() {
            let mirrored = self.nodes - 1 - step;
            let lanes = [
                [step, step + 1, step + 2],
                [mirrored, mirrored - 1, mirrored - 2],
            ];
            for (lane, [own, near, far]) in lanes.into_iter().enumerate() {
                for a in 0..D {
                    let row = own * D + a;
                    for b in 0..a {
                        symmetric(rows.own[a][b].0[lane], row, own * D + b, x, y);
                    }
                    y[row] += rows.own[a][a].0[lane] * x[row];
                    for b in 0..D {
                        symmetric(rows.near[a][b].0[lane], row, near * D + b, x, y);
                        symmetric(rows.far[a][b].0[lane], row, far * D + b, x, y);
                    }
                }
            }
        }
        let start = self.steps.len() * D;
        for r in 0..self.middle_rows() {
            for c in 0..r {
                symmetric(self.middle[r][c], start + r, start + c, x, y);
            }
            y[start + r] += self.middle[r][r] * x[start + r];
        }
    }

    /// Unknowns that the steps leave over.
    fn middle_rows(&self) -> usize {
        (self.nodes - 2 * self.steps.len()) * D
    }

    /// Where the coupling of nodes `i <= j` is kept.
    #[inline(always)]
    fn place(&self, i: usize, j: usize) -> Place {
        assert!(
            j < self.nodes,
            "there are {} nodes, no number {j}",
            self.nodes
        );
        let steps = self.steps.len();
        let mirrored = self.nodes - 1 - j;
        if i < steps {
            Place::Step(i, 0)
        } else if mirrored < steps {
            Place::Step(mirrored, 1)
        } else {
            Place::Middle((i - steps) * D, (j - steps) * D)
        }
    }

    /// The one place where the coupling of unknown `a` of node `i` and `b` of node `j` is kept.
    fn entry(&mut self, i: usize, a: usize, j: usize, b: usize) -> &mut f64 {
        let ((i, a), (j, b)) = if (i, a) <= (j, b) {
            ((i, a), (j, b))
        } else {
            ((j, b), (i, a))
        };
        match self.place(i, j) {
            Place::Step(step, lane) => {
                self.kept = self.kept.min(step);
                let rows = &mut self.steps[step];
                let (row, column) = if lane == 0 { (a, b) } else { (b, a) };
                let pair = match j - i {
                    0 => &mut rows.own[b][a],
                    1 => &mut rows.near[row][column],
                    _ => &mut rows.far[row][column],
                };
                &mut pair.0[lane]
            }
            Place::Middle(column, row) => &mut self.middle[row + b][column + a],
        }
    }

    /// Finds the unsafe pivot in a step that reported one; the factors hold the reciprocals.
    #[cold]
    fn loose_in_step(&self, step: usize) -> SingularPivot {
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

/// Whether a pivot, given by its reciprocal, exceeds its share of the original diagonal.
///
/// False for zero, negative, infinite and undefined pivots too.
#[inline(always)]
fn is_safe(reciprocal: f64, original: f64) -> bool {
    (reciprocal > 0.0) & (reciprocal * (SAFE_SHARE * original) < 1.0)
}

/// Adds the products of an entry off the diagonal and of its mirror image.
fn symmetric(entry: f64, row: usize, column: usize, x: &[f64], y: &mut [f64]) {
    y[row] += entry * x[column];
    y[column] += entry * x[row];
}

/// Eliminates one node of each chain; false if a pivot is unsafe.
///
/// The blocks of a node are finished before anything is taken from the next two: each number of
/// `after` is then summed over all pivots in a register and stored once.
#[inline(always)]
fn eliminate<const D: usize>(
    rows: &Step<D>,
    carry: &Carry<D>,
    after: &mut Carry<D>,
    factors: &mut Step<D>,
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

/// Eliminates what has changed since the last time; the step with an unsafe pivot.
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
    factors: &Step<D>,
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
    factors: &Step<D>,
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

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{DMatrix, DVector};
    use proptest::prelude::*;

    /// Adds the blocks of a dense matrix, with rubbish where nothing may be read.
    fn banded<const D: usize>(dense: &DMatrix<f64>) -> Banded<D> {
        let nodes = dense.nrows() / D;
        let mut matrix = Banded::new();
        matrix.reset(nodes);
        let block = |i: usize, j: usize| -> [[f64; D]; D] {
            std::array::from_fn(|a| std::array::from_fn(|b| dense[(i * D + a, j * D + b)]))
        };
        for i in 0..nodes {
            let mut own = block(i, i);
            for a in 0..D {
                own[a][a + 1..].fill(f64::NAN);
            }
            matrix.add_diagonal(i, &own);
            for k in 1..(nodes - i).min(3) {
                matrix.add(i, k, &block(i, i + k));
            }
        }
        matrix
    }

    /// `R^T R` of a banded triangle, lifted so that its condition number stays below some hundreds.
    fn positive_definite(nodes: usize, d: usize, seed: &[f64]) -> DMatrix<f64> {
        let n = nodes * d;
        let r = DMatrix::from_fn(n, n, |i, j| {
            let in_band = j >= i && j / d <= i / d + 2;
            if in_band {
                seed[(i * 3 * d + j - i) % seed.len()]
            } else {
                0.0
            }
        });
        r.transpose() * r + DMatrix::identity(n, n) * 0.5
    }

    fn largest(x: &[f64]) -> f64 {
        x.iter().fold(0.0, |most, value| value.abs().max(most))
    }

    /// Factors, solves and multiplies, and compares each with the dense twin.
    fn compare<const D: usize>(dense: &DMatrix<f64>, matrix: &mut Banded<D>, b: &[f64]) {
        let mut product = vec![f64::NAN; b.len()];
        matrix.multiply(b, &mut product);
        let expected = dense * DVector::from_column_slice(b);
        for i in 0..b.len() {
            assert!((product[i] - expected[i]).abs() < 1e-12 * (1.0 + expected[i].abs()));
        }
        matrix.factor().expect("positive definite");
        let mut x = b.to_vec();
        matrix.solve(&mut x);
        let right = DVector::from_column_slice(b);
        let expected = dense
            .clone()
            .cholesky()
            .expect("positive definite")
            .solve(&right);
        for i in 0..b.len() {
            assert!(
                (x[i] - expected[i]).abs() < 1e-11 * (1.0 + expected.amax()),
                "unknown {i}: {} against {}",
                x[i],
                expected[i]
            );
        }
    }

    /// Seeds for the matrix, right-hand side, and a few unknowns to pin.
    fn problem() -> impl Strategy<Value = (usize, Vec<f64>, Vec<f64>, Vec<usize>)> {
        (1usize..=40).prop_flat_map(|nodes| {
            (
                Just(nodes),
                prop::collection::vec(-1.0..1.0f64, 1009),
                prop::collection::vec(-1.0..1.0f64, nodes * 4),
                prop::collection::vec(0..nodes * 3, 0..8),
            )
        })
    }

    proptest! {
        #[test]
        fn agrees_with_the_dense_solve((nodes, seed, b, _) in problem()) {
            let dense = positive_definite(nodes, 3, &seed);
            compare::<3>(&dense, &mut banded(&dense), &b[..nodes * 3]);
            let dense = positive_definite(nodes, 4, &seed);
            compare::<4>(&dense, &mut banded(&dense), &b);
        }

        #[test]
        fn a_pinned_unknown_keeps_its_right_hand_side((nodes, seed, b, pins) in problem()) {
            let mut dense = positive_definite(nodes, 3, &seed);
            let mut matrix = banded::<3>(&dense);
            for &unknown in &pins {
                dense.row_mut(unknown).fill(0.0);
                dense.column_mut(unknown).fill(0.0);
                dense[(unknown, unknown)] = 1.0;
                matrix.pin(unknown / 3, unknown % 3);
            }
            compare(&dense, &mut matrix, &b[..nodes * 3]);
            let mut x = b[..nodes * 3].to_vec();
            matrix.solve(&mut x);
            for &unknown in &pins {
                prop_assert_eq!(x[unknown], b[unknown]);
            }
        }

        #[test]
        fn the_first_loose_unknown_is_named(
            nodes in 1usize..40,
            at in 0usize..120,
            bad in prop::sample::select(vec![0.0, -1.0, f64::NAN, f64::INFINITY]),
        ) {
            let (node, coordinate) = (at / 3 % nodes, at % 3);
            let mut matrix = Banded::<3>::new();
            matrix.reset(nodes);
            for i in 0..nodes {
                for a in 0..3 {
                    matrix.add_to_entry(i, a, if (i, a) == (node, coordinate) { bad } else { 2.0 });
                }
            }
            prop_assert_eq!(matrix.factor(), Err(SingularPivot { node, coordinate }));
        }
    }

    /// A bent wire: stiff along its edges, soft across, held by inertia alone.
    fn beam(nodes: usize, stretch: f64, inertia: f64) -> Banded<3> {
        let mut matrix = Banded::new();
        matrix.reset(nodes);
        for i in 0..nodes {
            for a in 0..3 {
                matrix.add_to_entry(i, a, inertia);
            }
        }
        let scaled = |factor: f64, t: [f64; 3]| -> [[f64; 3]; 3] {
            std::array::from_fn(|a| std::array::from_fn(|b| factor * t[a] * t[b]))
        };
        for i in 0..nodes - 1 {
            let (sin, cos) = (0.3 * i as f64).sin_cos();
            let t = [0.6 * cos, 0.8 * cos, sin];
            matrix.add_diagonal(i, &scaled(stretch, t));
            matrix.add_diagonal(i + 1, &scaled(stretch, t));
            matrix.add(i, 1, &scaled(-stretch, t));
        }
        for i in 0..nodes - 2 {
            let c = [1.0, -2.0, 1.0];
            for k in 0..3 {
                for l in k..3 {
                    let mut block = [[0.0; 3]; 3];
                    for a in 0..3 {
                        block[a][a] = c[k] * c[l];
                    }
                    if k == l {
                        matrix.add_diagonal(i + k, &block);
                    } else {
                        matrix.add(i + k, l - k, &block);
                    }
                }
            }
        }
        matrix
    }

    #[test]
    fn a_stiff_wire_is_solved_to_rounding() {
        let stretch = 1e8;
        for nodes in [3, 4, 5, 50, 401] {
            let mut matrix = beam(nodes, stretch, 1.0);
            matrix.factor().expect("inertia holds it");
            let b: Vec<f64> = (0..nodes * 3).map(|i| (1.7 * i as f64).cos()).collect();
            let mut x = b.clone();
            matrix.solve(&mut x);
            let mut rest = vec![0.0; b.len()];
            matrix.multiply(&x, &mut rest);
            for i in 0..b.len() {
                rest[i] = b[i] - rest[i];
            }
            // Backward error: a few rounding units of the largest row sum, 4 stretches.
            let scale = 4.0 * stretch * largest(&x) + largest(&b);
            assert!(largest(&rest) < 8.0 * f64::EPSILON * scale, "{nodes} nodes");
            // The correction is the error: condition number 4e8 times the rounding unit.
            matrix.solve(&mut rest);
            assert!(largest(&rest) < 1e-7 * largest(&x), "{nodes} nodes");
        }
    }

    #[test]
    fn a_free_wire_without_inertia_is_loose() {
        for nodes in 3..30 {
            assert!(beam(nodes, 1.0, 0.0).factor().is_err(), "{nodes} nodes");
        }
    }

    #[test]
    fn a_pivot_lost_to_cancellation_is_loose() {
        let mut matrix = Banded::<1>::new();
        for nodes in [2, 3, 8] {
            matrix.reset(nodes);
            for i in 0..nodes {
                matrix.add_to_entry(i, 0, 1.0);
            }
            matrix.add_to_entry(1, 0, 4.0 * f64::EPSILON);
            matrix.add(0, 1, &[[1.0]]);
            let loose = SingularPivot {
                node: 1,
                coordinate: 0,
            };
            assert_eq!(matrix.factor(), Err(loose), "{nodes} nodes");
        }
    }

    #[test]
    fn a_matrix_used_again_stays_in_its_memory_and_forgets() {
        let mut matrix = beam(40, 1e3, 1.0);
        matrix.factor().expect("inertia holds it");
        let places = (matrix.steps.as_ptr(), matrix.step_factors.as_ptr());
        matrix.reset(31);
        for i in 0..31 {
            for a in 0..3 {
                matrix.add_to_entry(i, a, 2.0);
            }
        }
        matrix.factor().expect("diagonal");
        let mut x = vec![1.0; 93];
        matrix.solve(&mut x);
        assert!(x.iter().all(|&value| value == 0.5));
        assert_eq!(
            places,
            (matrix.steps.as_ptr(), matrix.step_factors.as_ptr())
        );
    }

    #[test]
    fn no_nodes_are_no_trouble() {
        let mut matrix = Banded::<3>::new();
        matrix.reset(0);
        assert_eq!(matrix.factor(), Ok(()));
        matrix.solve(&mut []);
    }

    /// After a change only the steps from it on are done again: the same factors to the bit as of a new matrix.
    #[test]
    fn factors_are_those_of_the_whole() {
        for nodes in [2, 3, 7, 8, 23, 40] {
            let seed: Vec<f64> = (0..97)
                .map(|k| f64::from(k * 37 % 97) / 97.0 - 0.4)
                .collect();
            let dense = positive_definite(nodes, 4, &seed);
            let bits = |matrix: &mut Banded<4>| {
                matrix.factor().expect("positive definite");
                let mut x: Vec<f64> = (0..4 * nodes).map(|k| (k as f64).sin()).collect();
                matrix.solve(&mut x);
                x.into_iter().map(f64::to_bits).collect::<Vec<_>>()
            };
            for i in 0..nodes {
                let mut kept = banded::<4>(&dense);
                let before = bits(&mut kept);
                assert_eq!(kept.ends_changed(), nodes < 4);
                let mut new = banded::<4>(&dense);
                for matrix in [&mut kept, &mut new] {
                    matrix.add_to_entry(i, 1, 0.3);
                    if i + 1 < nodes {
                        matrix.add(i, 1, &[[0.01; 4]; 4]);
                    }
                    if i == 1 {
                        matrix.pin(0, 2);
                    }
                }
                let after = bits(&mut kept);
                assert!(
                    after == bits(&mut new) && after != before,
                    "node {i} of {nodes}"
                );
                assert!(after == bits(&mut kept), "nothing changed");
            }
        }
    }
}
