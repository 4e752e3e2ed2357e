//! Which pieces of a long wire pass through which cell of a uniform grid.
//!
//! A query looks at the cells round a point, so its cost depends on how densely the wire is laid
//! there and not on how much there is. Pieces come and go at the wire's end like
//! on a stack; then a piece is the last entry of each of its cells.

use crate::math::V3;
use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};

type Cell = [i32; 3];

/// Spreads the coordinates of cells; the same on every machine and in every run.
#[derive(Clone, Copy, Debug, Default)]
struct Spread(u64);

impl Hasher for Spread {
    fn finish(&self) -> u64 {
        self.0
    }

    fn write(&mut self, bytes: &[u8]) {
        for chunk in bytes.chunks(8) {
            let mut word = [0; 8];
            word[..chunk.len()].copy_from_slice(chunk);
            // an odd number near 2^64 over the golden ratio, and its high bits back down
            let mixed = (self.0 ^ u64::from_le_bytes(word)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
            self.0 = mixed ^ (mixed >> 29);
        }
    }
}

/// Pieces by cell, both in ascending order.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Grid {
    /// edge of a cell, m
    edge: f64,
    cells: HashMap<Cell, Vec<u32>, BuildHasherDefault<Spread>>,
}

impl Grid {
    /// A grid without pieces, of cubic cells of `edge` (m).
    pub(super) fn new(edge: f64) -> Self {
        assert!(
            edge > 0.0 && edge.is_finite(),
            "a cell of {edge} m has no inside"
        );
        Self {
            edge,
            cells: HashMap::default(),
        }
    }

    /// Edge of a cell, m.
    pub(super) fn edge(&self) -> f64 {
        self.edge
    }

    /// The cell of a point; the outermost for points two billion cells away.
    fn cell(&self, p: V3) -> Cell {
        [p.x, p.y, p.z].map(|v| (v / self.edge).floor() as i32)
    }

    /// Enters `piece`, higher than all before, into the cells that the box from `low` to `high`
    /// meets and that do not have it yet.
    pub(super) fn add(&mut self, piece: u32, low: V3, high: V3) {
        for_cells_between(self.cell(low), self.cell(high), |cell| {
            let pieces = self.cells.entry(cell).or_default();
            if pieces.last() != Some(&piece) {
                pieces.push(piece);
            }
        });
    }

    /// Takes `piece`, the highest, out of the cells of a box.
    pub(super) fn remove(&mut self, piece: u32, low: V3, high: V3) {
        for_cells_between(self.cell(low), self.cell(high), |cell| {
            if let Some(pieces) = self.cells.get_mut(&cell)
                && pieces.last() == Some(&piece)
            {
                pieces.pop();
                if pieces.is_empty() {
                    self.cells.remove(&cell);
                }
            }
        });
    }

    /// Calls `visit` with the pieces of each cell within `reach` of `p` along every axis, in no
    /// order; a piece shows up once for each of its cells.
    pub(super) fn visit_near(&self, p: V3, reach: f64, mut visit: impl FnMut(&[u32])) {
        let low = self.cell(p - V3::repeat(reach));
        let high = self.cell(p + V3::repeat(reach));
        if low.iter().zip(&high).any(|(l, h)| l > h) {
            return;
        }
        let wide = |axis: usize| (i64::from(high[axis]) - i64::from(low[axis])) as f64 + 1.0;
        if wide(0) * wide(1) * wide(2) > self.cells.len() as f64 {
            // More of them than there are cells: a reach beyond the whole coil.
            for (cell, pieces) in &self.cells {
                if (0..3).all(|axis| (low[axis]..=high[axis]).contains(&cell[axis])) {
                    visit(pieces);
                }
            }
            return;
        }
        for_cells_between(low, high, |cell| {
            if let Some(pieces) = self.cells.get(&cell) {
                visit(pieces);
            }
        });
    }
}

/// Calls `visit` with each cell from `low` to `high`.
#[inline(always)]
fn for_cells_between(low: Cell, high: Cell, mut visit: impl FnMut(Cell)) {
    for x in low[0]..=high[0] {
        for y in low[1]..=high[1] {
            for z in low[2]..=high[2] {
                visit([x, y, z]);
            }
        }
    }
}
