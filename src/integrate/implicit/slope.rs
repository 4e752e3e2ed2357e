//! What an update promises for the potential.

use super::unknowns::Unknowns;
use super::work::Work;

/// Slope of the potential along an update, and what slip couplings have in it, J.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slope {
    slope: f64,
    slip: f64,
}

impl Slope {
    pub(super) fn of<const D: usize, U: Unknowns<D>>(work: &Work<D, U>) -> Self {
        let update = work.update.as_chunks::<D>().0;
        let along =
            |(g, u): ([f64; D], &[f64; D])| g.iter().zip(u).map(|(g, u)| g * u).sum::<f64>();
        Self {
            slope: work.gradients().zip(update).map(along).sum(),
            slip: work.beyond.slip_square::<D>(&work.update),
        }
    }

    /// Product of the update with the Hessian from either side, J: it and the slip couplings take the update to minus the
    /// gradient.
    pub(super) fn curvature(self) -> f64 {
        -self.slope - self.slip
    }

    /// Rise of the potential that this share of the update may bring, J.
    ///
    /// Where friction limits change along with the update, the solution is no minimum of the potential that holds them. It may
    /// rise by what gradient and Hessian promise, and as much again for what they leave out.
    pub(super) fn rise(self, share: f64) -> f64 {
        let promised = share * self.slope + 0.5 * share * share * self.curvature();
        (2.0 * promised).max(0.0)
    }
}
