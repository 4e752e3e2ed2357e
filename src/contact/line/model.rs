//! What the scene gives of contact along the wire, and a run leaves as it is.

use crate::contact::friction::LimitFrom;
use crate::contact::law::ContactLaw;
use crate::contact::self_contact::PairConditions;
use crate::contact::tolerance::prediction_tolerance;
use crate::geometry::{Flanges, Nearness, Shape};
use crate::math::{V3, scaled};

/// Depth over which the normal force sets in, m, for wire of 0.7 mm. Chosen: ten times as much takes a tenth off the
/// evaluations and adds 4.5 um to the depth at rest.
const ONSET: f64 = 1e-6;

/// Core, law and wire of contact along the wire.
#[derive(Clone, Debug)]
pub struct LineModel {
    /// what wire is wound on
    pub shape: Shape,
    /// flanges beside it
    pub flanges: Option<Flanges>,
    /// the law
    pub law: ContactLaw,
    /// depth over which the normal force sets in, m
    pub onset: f64,
    /// rebound over impact speed of a landing
    pub restitution: f64,
    /// wire radius, m
    pub radius: f64,
    /// error of a contact force that an update of Newton's method may promise, as a depth, m
    pub prediction: f64,
}

impl LineModel {
    /// Contact of a wire of this `radius` (m) that does not rebound.
    pub fn new(shape: Shape, law: ContactLaw, radius: f64) -> Self {
        Self {
            prediction: prediction_tolerance(&shape, radius),
            shape,
            flanges: None,
            law,
            onset: scaled(ONSET, 2.0 * radius),
            restitution: 0.0,
            radius,
        }
    }

    /// The flange nearer to a point, core frame, m, as far as there are flanges.
    #[inline]
    pub fn flange(&self, p: V3) -> Option<Nearness> {
        self.flanges.as_ref().map(|flanges| flanges.nearness(p))
    }

    /// Signed distance of a point from core and flanges, core frame, m.
    pub fn distance(&self, p: V3) -> f64 {
        let core = self.shape.nearness(p).distance;
        self.flange(p)
            .map_or(core, |flange| flange.distance.min(core))
    }

    /// Whether core or a flange is nearer to a point, core frame, m, than `reach`.
    pub fn is_within(&self, p: V3, reach: f64) -> bool {
        self.shape.is_within(p, reach) || self.flange(p).is_some_and(|f| f.distance < reach)
    }

    /// What contact of live wire with live wire goes by, `step` (s) after the last accepted instant, and which friction limits
    /// it takes.
    pub(crate) fn of_pairs(&self, step: f64, limit_from: LimitFrom) -> PairConditions<'_> {
        PairConditions {
            law: &self.law,
            onset: self.onset,
            diameter: 2.0 * self.radius,
            prediction: self.prediction,
            step,
            limit_from,
        }
    }
}
