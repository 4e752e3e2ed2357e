//! What the scene gives of contact along the wire, and a run leaves as it is.

use crate::contact::law::ContactLaw;
use crate::geometry::Shape;

/// Depth over which the normal force sets in, m. Chosen: ten times as much takes a tenth off the evaluations and adds
/// 4.5 um to the depth at rest.
const ONSET: f64 = 1e-6;

/// Core, law and wire of contact along the wire.
#[derive(Clone, Debug)]
pub struct LineModel {
    /// the core
    pub shape: Shape,
    /// the law
    pub law: ContactLaw,
    /// depth over which the normal force sets in, m
    pub onset: f64,
    /// line load per rate of depth, N s/m^2, and as much of it along the surface as of the stiffness. The sum of
    /// spring and dashpot never pulls. 0: a landing loses what the time scheme takes from it
    pub damping: f64,
    /// wire radius, m
    pub radius: f64,
}

impl LineModel {
    /// Contact of a wire of this `radius` (m) without a dashpot.
    pub fn new(shape: Shape, law: ContactLaw, radius: f64) -> Self {
        Self {
            shape,
            law,
            onset: ONSET,
            damping: 0.0,
            radius,
        }
    }

    /// The dashpot over stiffness and step.
    #[inline(always)]
    pub(super) fn damping_over(&self, step: f64) -> f64 {
        self.damping / (self.law.stiffness * step)
    }
}
