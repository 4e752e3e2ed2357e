//! Storage of a block-banded matrix in the order of its elimination.

use super::pair::{Pair, PairBlock};

/// Rows that the middle has room for: three nodes of four unknowns.
pub(super) const WIDEST: usize = 12;

/// The rows of the two nodes eliminated in one step, of the matrix or of its factors.
#[derive(Clone, Copy, Debug)]
pub(super) struct StepRows<const D: usize> {
    /// lower half: the node with itself; as factor: `l` below the reciprocal pivots
    pub(super) own: PairBlock<D>,
    /// rows of the node, columns of its neighbour towards the middle
    pub(super) near: PairBlock<D>,
    /// rows of the node, columns of the neighbour after that
    pub(super) far: PairBlock<D>,
}

impl<const D: usize> StepRows<D> {
    const ZERO: Self = Self {
        own: [[Pair([0.0; 2]); D]; D],
        near: [[Pair([0.0; 2]); D]; D],
        far: [[Pair([0.0; 2]); D]; D],
    };
}

/// What the nodes eliminated so far take away from the two next in line.
#[derive(Clone, Copy, Debug)]
pub(super) struct Carry<const D: usize> {
    /// lower half: from the next node with itself
    pub(super) first: PairBlock<D>,
    /// from the rows of the next node, columns of the one after
    pub(super) cross: PairBlock<D>,
    /// lower half: from the one after with itself
    pub(super) second: PairBlock<D>,
}

impl<const D: usize> Carry<D> {
    const NONE: Self = Self {
        first: StepRows::ZERO.own,
        cross: StepRows::ZERO.own,
        second: StepRows::ZERO.own,
    };
}

/// The dense rest where the chains meet; only the lower half is used.
pub(super) type Middle = [[f64; WIDEST]; WIDEST];

/// A symmetric matrix of blocks that couple a node with the next two, and its factors.
///
/// Matrix and factors are kept apart, so that [`Banded::multiply`] serves refinement after
/// [`Banded::factor`].
/// A matrix that keeps its size, or shrinks, is filled and factored again without allocation.
#[derive(Clone, Debug)]
pub struct Banded<const D: usize> {
    pub(super) nodes: usize,
    pub(super) steps: Vec<StepRows<D>>,
    pub(super) middle: Middle,
    pub(super) step_factors: Vec<StepRows<D>>,
    /// what the nodes before each step take away in it; one more for the middle
    pub(super) carries: Vec<Carry<D>>,
    /// steps whose rows are still those that were factored last
    pub(super) kept: usize,
    /// `l` below the reciprocal pivots
    pub(super) middle_factors: Middle,
}

/// Where the coupling of two nodes lies in memory.
enum Slot {
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
    /// A matrix without nodes.
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
    #[cfg(any(test, feature = "lab"))]
    pub fn reset(&mut self, nodes: usize) {
        self.resize(nodes);
        self.steps.fill(StepRows::ZERO);
        self.middle = [[0.0; WIDEST]; WIDEST];
    }

    /// Becomes a matrix of `nodes` nodes with arbitrary entries, for [`Banded::put`] to write every
    /// row.
    pub fn resize(&mut self, nodes: usize) {
        self.nodes = nodes;
        // Two nodes at least must be left, or the last of one chain would couple with the other's.
        let steps = nodes.saturating_sub(2) / 2;
        self.steps.resize(steps, StepRows::ZERO);
        // Factors are written before they are read: no need to clear them.
        self.step_factors.resize(steps, StepRows::ZERO);
        self.carries.resize(steps + 1, Carry::NONE);
        self.kept = 0;
    }

    /// Whether anything of the first or the last node has changed since the last
    /// [`Banded::factor`].
    pub fn ends_changed(&self) -> bool {
        self.kept == 0
    }

    /// Writes the rows of node `i` over what was there.
    ///
    /// `own` is the lower half of the diagonal block.
    ///
    /// `near` and `far` are the blocks of the columns of the next node and of the one after, as far as these exist.
    ///
    /// Each closure gives an entry by its row and column within the block.
    #[inline(always)]
    pub fn put(
        &mut self,
        i: usize,
        own: impl Fn(usize, usize) -> f64,
        near: impl Fn(usize, usize) -> f64,
        far: impl Fn(usize, usize) -> f64,
    ) {
        match self.slot(i, i) {
            Slot::Step(step, lane) => {
                let kept = &mut self.steps[step].own;
                for a in 0..D {
                    for b in 0..a + 1 {
                        kept[a][b].0[lane & 1] = own(a, b);
                    }
                }
            }
            Slot::Middle(row, _) => {
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
        match self.slot(i, i + k) {
            Slot::Step(step, lane) => {
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
            Slot::Middle(column, row) => {
                for a in 0..D {
                    for b in 0..D {
                        self.middle[row + b][column + a] = block(a, b);
                    }
                }
            }
        }
    }

    /// Adds a symmetric block to node `i`; only its lower half is read. A block of fewer than `D`
    /// rows belongs to the first unknowns of the node.
    #[inline]
    pub fn add_diagonal<const B: usize>(&mut self, i: usize, block: &[[f64; B]; B]) {
        match self.slot(i, i) {
            Slot::Step(step, lane) => {
                self.kept = self.kept.min(step);
                let own = &mut self.steps[step].own;
                for a in 0..B {
                    for b in 0..a + 1 {
                        own[a][b].0[lane] += block[a][b];
                    }
                }
            }
            Slot::Middle(row, _) => {
                for a in 0..B {
                    for b in 0..a + 1 {
                        self.middle[row + a][row + b] += block[a][b];
                    }
                }
            }
        }
    }

    /// Adds a block to the rows of node `i`, columns of node `i + k`, and its mirror image; one of
    /// fewer than `D` rows to their first unknowns.
    ///
    /// # Panics
    /// Unless `k` is 1 or 2 and node `i + k` exists.
    #[inline]
    pub fn add<const B: usize>(&mut self, i: usize, k: usize, block: &[[f64; B]; B]) {
        assert!(
            k == 1 || k == 2,
            "nodes couple over one or two edges, not {k}"
        );
        match self.slot(i, i + k) {
            Slot::Step(step, lane) => {
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
            Slot::Middle(column, row) => {
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
        match self.slot(i, i) {
            Slot::Step(step, lane) => {
                self.kept = self.kept.min(step);
                self.steps[step].own[a][a].0[lane] += value;
            }
            Slot::Middle(row, _) => self.middle[row + a][row + a] += value,
        }
    }

    /// Holds unknown `a` of node `i`: its row and column become those of the unit matrix.
    ///
    /// Call it after everything is added and before [`Banded::factor`].
    /// The solution is then the right-hand side of that unknown, and the other unknowns do not
    /// feel it. For a held value other than zero, move its column to the right-hand side first.
    pub fn pin(&mut self, i: usize, a: usize) {
        for b in 0..D {
            *self.entry(i, a, i, b) = 0.0;
        }
        for j in i.saturating_sub(2)..i {
            self.clear_row(j, i, |b| (b, a));
        }
        for j in i + 1..(i + 3).min(self.nodes) {
            self.clear_row(i, j, |b| (a, b));
        }
        *self.entry(i, a, i, a) = 1.0;
    }

    /// Clears the couplings `of(0)`, `of(1)`, ... of the unknowns of nodes `i < j`, whose place is looked for once.
    fn clear_row(&mut self, i: usize, j: usize, of: impl Fn(usize) -> (usize, usize)) {
        match self.slot(i, j) {
            Slot::Step(step, lane) => {
                self.kept = self.kept.min(step);
                let rows = &mut self.steps[step];
                let block = if j - i == 1 {
                    &mut rows.near
                } else {
                    &mut rows.far
                };
                for (a, b) in (0..D).map(of) {
                    let (row, column) = if lane == 0 { (a, b) } else { (b, a) };
                    block[row][column].0[lane] = 0.0;
                }
            }
            Slot::Middle(column, row) => {
                for (a, b) in (0..D).map(of) {
                    self.middle[row + b][column + a] = 0.0;
                }
            }
        }
    }

    /// `y = A x` with the matrix as it was added and pinned, factored or not.
    ///
    /// # Panics
    /// Unless `x` and `y` have one entry for each unknown.
    #[cfg(any(test, feature = "lab"))]
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
    pub(super) fn middle_rows(&self) -> usize {
        (self.nodes - 2 * self.steps.len()) * D
    }

    /// Where the coupling of nodes `i <= j` is kept.
    #[inline(always)]
    fn slot(&self, i: usize, j: usize) -> Slot {
        assert!(
            j < self.nodes,
            "there are {} nodes, no number {j}",
            self.nodes
        );
        let steps = self.steps.len();
        let mirrored = self.nodes - 1 - j;
        if i < steps {
            Slot::Step(i, 0)
        } else if mirrored < steps {
            Slot::Step(mirrored, 1)
        } else {
            Slot::Middle((i - steps) * D, (j - steps) * D)
        }
    }

    /// The one place where the coupling of unknown `a` of node `i` and `b` of node `j` is kept.
    fn entry(&mut self, i: usize, a: usize, j: usize, b: usize) -> &mut f64 {
        let ((i, a), (j, b)) = if (i, a) <= (j, b) {
            ((i, a), (j, b))
        } else {
            ((j, b), (i, a))
        };
        match self.slot(i, j) {
            Slot::Step(step, lane) => {
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
            Slot::Middle(column, row) => &mut self.middle[row + b][column + a],
        }
    }
}

/// Adds the products of an entry off the diagonal and of its mirror image.
#[cfg(any(test, feature = "lab"))]
fn symmetric(entry: f64, row: usize, column: usize, x: &[f64], y: &mut [f64]) {
    y[row] += entry * x[column];
    y[column] += entry * x[row];
}
