//! Contact along the wire as one thing: its parts, lent for as long as they are worked on.

use super::model::LineModel;
use super::scratch::LineScratch;
use super::state::LineState;
use crate::geometry::SplineTube;
use crate::math::V3;
use std::sync::Arc;

/// Contact of the implicit method: the surfaces that the wire can touch, the law, and the state of each contact point.
///
/// Points are numbered as [`ContactPoint`](crate::contact::ContactPoint) says; `k` stands for such a number. Places are
/// in the core frame.
#[derive(Debug)]
pub struct LineContact<'a> {
    /// core, law and wire
    pub model: &'a LineModel,
    /// what it remembers
    pub state: &'a mut LineState,
    /// what it works with
    pub scratch: &'a mut LineScratch,
}

impl LineContact<'_> {
    /// Adds a node at `point` (m), `arc` of unstretched wire (m) from the clamp, to the frozen wire.
    pub fn lay(&mut self, point: V3, arc: f64) {
        self.note_height(point);
        Arc::make_mut(&mut self.scratch.tube).push(point, arc);
    }

    /// Frozen wire lies no farther from the core than the highest of the nodes that its spline depends on.
    fn note_height(&mut self, point: V3) {
        let distance = self.model.shape.nearness(point).distance;
        self.state.height = self.state.height.max(distance + self.model.radius);
    }

    /// Lets the spline of the frozen wire continue into the first two live nodes: their places (m) and unstretched
    /// lengths from the clamp (m), the clamp's first. With `None` it ends, and nodes can be added or taken up.
    pub fn go_on(&mut self, ahead: Option<[(V3, f64); 2]>) {
        for (point, _) in ahead.into_iter().flatten() {
            self.note_height(point);
        }
        Arc::make_mut(&mut self.scratch.tube).go_on(ahead);
        self.state.ahead = self.scratch.tube.ahead();
        self.state.mark_seam();
    }

    /// Lays the saved frozen wire again, whose nodes have these places (m) and unstretched lengths from the clamp (m), for
    /// a state that [`LineState::check`] found possible.
    pub(crate) fn relay(&mut self, wire: impl Iterator<Item = (V3, f64)>) {
        let mut tube = SplineTube::new(self.model.radius);
        for (point, arc) in wire {
            tube.push(point, arc);
        }
        tube.go_on(self.state.ahead);
        self.scratch.tube = Arc::new(tube);
    }
}
