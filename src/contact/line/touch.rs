//! State of one touch of a contact point with the core or a passage of frozen wire.

use crate::contact::friction::{ContactResponse, FrictionLimit, Grip, LimitFrom, Touching, across};
use crate::contact::law::{ContactLaw, NormalLaw, TANGENTIAL_SHARE};
use crate::math::V3;
use serde::{Deserialize, Serialize};

/// State of one touch, present or possible, of a contact point; core frame.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct TouchState {
    /// segment of frozen wire, or triangle of a mesh, at which to begin the search for the closest point
    pub(super) start: u32,
    /// it touched at the last accepted instant, and `anchor` holds
    pub(super) anchored: bool,
    /// the friction anchor, m
    pub(super) anchor: V3,
    /// largest friction force
    pub(super) limit: FrictionLimit,
    /// direction of the slide in the linear system; 0: the bristle holds
    pub(super) slide: V3,
    /// unit normal towards the point
    pub(super) normal: V3,
    /// depth at the last evaluation, m; negative: a gap
    pub(super) depth: f64,
    /// depth at the last accepted instant, m; 0: it did not touch
    pub(super) depth_before: f64,
    /// speed at which it may open, m/s: what its landing gives back
    pub(super) rebound: f64,
}

impl TouchState {
    /// A touch with nothing.
    pub(super) const UNUSED: Self = Self {
        start: u32::MAX,
        anchored: false,
        anchor: V3::new(0.0, 0.0, 0.0),
        limit: FrictionLimit::ZERO,
        slide: V3::new(0.0, 0.0, 0.0),
        normal: V3::new(0.0, 0.0, 0.0),
        depth: 0.0,
        depth_before: 0.0,
        rebound: 0.0,
    };

    /// Whether the touch equals [`Self::UNUSED`] to the bit.
    pub(super) fn is_unused(&self) -> bool {
        let vectors = [self.anchor, self.slide, self.normal];
        let limit = self.limit;
        let limits = [limit.lagged, limit.accepted, limit.current];
        let depths = [self.depth, self.depth_before, self.rebound];
        let mut all = vectors.iter().flatten().chain(&limits).chain(&depths);
        self.start == Self::UNUSED.start && !self.anchored && all.all(|x| x.to_bits() == 0)
    }

    /// Adds the response of this touch, with its depth and normal, to that of its point at `p`.
    #[inline(always)]
    pub(super) fn respond(&self, p: V3, around: &Conditions, sum: &mut ContactResponse) -> Grip {
        let pressed = NormalLaw::at(self.depth, around.onset);
        sum.add_touch(&Touching {
            law: around.law,
            stiffness: around.stiffness,
            normal: self.normal,
            pressed,
            bristle: self.bristle(p, around.last),
            bristle_stiffness: around.stiffness * TANGENTIAL_SHARE,
            way: p - around.last,
            step: around.step,
            limit: self.limit,
            limit_from: around.limit_from,
            slide: self.slide,
            negligible: around.negligible,
        })
    }

    /// Stretch of the bristle of a point that went from `last` to `p`, m. A touch that begins has its anchor at `last`.
    #[inline]
    pub(super) fn bristle(&self, p: V3, last: V3) -> V3 {
        let anchor = if self.anchored { self.anchor } else { last };
        across(p - anchor, &self.normal)
    }
}

/// What the response of a point's touches depends on besides their state.
#[derive(Clone, Copy, Debug)]
pub(super) struct Conditions<'a> {
    pub(super) law: &'a ContactLaw,
    /// depth over which the normal force sets in, m
    pub(super) onset: f64,
    /// contact stiffness of the wire that the point stands for, N/m
    pub(super) stiffness: f64,
    /// time since the last accepted instant, s
    pub(super) step: f64,
    /// place of the point at the last accepted instant, m
    pub(super) last: V3,
    pub(super) limit_from: LimitFrom,
    /// friction limit up to which a prediction lets a slide turn at once, N
    pub(super) negligible: f64,
}
