//! What contact along the wire works with, and what follows from the state.

use super::near::NearPoint;
use super::point::PointState;
use crate::contact::accepted_touch::AcceptedTouch;
use crate::contact::self_contact::PairScratch;
use crate::geometry::{SplineTube, WallFoot};
use crate::math::V3;
use std::sync::Arc;

/// Work arrays of contact along the wire, and the search among frozen wire. None of it is saved.
#[derive(Clone, Debug)]
pub struct LineScratch {
    /// the frozen wire of the state, to be searched; it grows by [`super::LineContact::lay`], and copies share it until then
    pub tube: Arc<SplineTube>,
    /// work that the energy balance ascribes to touches which ended within the step, and that they did not do, J
    pub lifted: f64,
    /// the touches at the end of the step
    pub accepted: Vec<AcceptedTouch>,
    /// of the pairs of live wire
    pub pairs: PairScratch,
    /// numbers of the points that something may be near, ascending
    pub busy: Vec<u32>,
    /// places of the nodes for which they were listed, core frame, m; none: the list is not to be kept
    pub(super) listed_at: Vec<V3>,
    /// the points with surfaces near them at the last evaluation
    pub(super) near: Vec<NearPoint>,
    /// points whose surroundings this attempt at a step looked up, as they were
    pub(super) undo: Vec<(u32, PointState)>,
    /// room for the segments that a search finds
    pub(super) found: Vec<u32>,
    /// room for the walls of a concave core that a search finds
    pub(super) feet: Vec<WallFoot>,
}

impl LineScratch {
    /// Room for the contact of wire of this `radius`, m; no frozen wire.
    pub fn new(radius: f64) -> Self {
        Self {
            tube: Arc::new(SplineTube::new(radius)),
            lifted: 0.0,
            accepted: Vec::with_capacity(256),
            pairs: PairScratch::default(),
            busy: Vec::new(),
            listed_at: Vec::new(),
            near: Vec::new(),
            undo: Vec::with_capacity(256),
            found: Vec::with_capacity(64),
            feet: Vec::with_capacity(16),
        }
    }

    /// Serves the contact of another wire from now on, with the frozen wire that `other` serves.
    pub(crate) fn serve(&mut self, other: &Self) {
        let Self {
            tube,
            lifted,
            accepted,
            pairs,
            busy,
            listed_at,
            near,
            undo,
            found,
            feet,
        } = self;
        tube.clone_from(&other.tube);
        *lifted = other.lifted;
        accepted.clone_from(&other.accepted);
        pairs.clear();
        busy.clear();
        listed_at.clear();
        near.clear();
        undo.clear();
        found.clear();
        feet.clear();
    }
}
