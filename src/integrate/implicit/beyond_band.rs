//! What the linear system of an update holds beside its band.

use crate::contact::{Coupling, LineContact, SlipCoupling, add_couplings};

/// Couplings of live wires that touch, and slip couplings, as of the last factorisation.
#[derive(Clone, Debug, Default)]
pub(super) struct BeyondBand {
    /// couplings of live wires; symmetric
    pub(super) couplings: Vec<Coupling>,
    /// slip couplings; not symmetric
    pub(super) slips: Vec<SlipCoupling>,
    /// coordinates of the first and the last node that do not move
    pub(super) held: [[bool; 3]; 2],
}

impl BeyondBand {
    /// Takes what `line` has of it over; of the first and the last node the coordinates `held` do not move.
    pub(super) fn take(&mut self, line: Option<&LineContact<'_>>, held: [[bool; 3]; 2]) {
        self.held = held;
        self.couplings.clear();
        self.slips.clear();
        if let Some(line) = line {
            self.couplings
                .extend_from_slice(&line.scratch.pairs.couplings);
            line.list_slip_couplings(&mut self.slips);
        }
    }

    /// The product of the slip couplings with `x` from either side.
    pub(super) fn slip_square<const D: usize>(&self, x: &[f64]) -> f64 {
        self.slips.iter().map(|slip| slip.square::<D>(x)).sum()
    }

    /// Adds the product with `x` to `y`, which is zero where nothing moves and stays so.
    pub(super) fn add_product<const D: usize>(&self, x: &[f64], y: &mut [f64]) {
        add_couplings::<D>(&self.couplings, x, y);
        for slip in &self.slips {
            slip.add_product::<D>(x, y);
        }
        let last = y.len() - D;
        for (first, held) in [0, last].into_iter().zip(self.held) {
            for (y, _) in y[first..].iter_mut().zip(held).filter(|(_, held)| *held) {
                *y = 0.0;
            }
        }
    }
}
