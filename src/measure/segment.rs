//! The wire between two settled nodes.

use super::node::{Node, SettledNode};
use crate::math::V3;

/// The wire between two settled nodes, straight in everything that is known of it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Segment {
    start: Node,
    end: Node,
}

impl Segment {
    pub(super) fn new(start: Node, end: Node) -> Self {
        Self { start, end }
    }

    /// The wire at a winding angle, rad. Flange and tension are those that its ends tell for it.
    pub(super) fn at(&self, angle: f64) -> SettledNode {
        let (start, end) = (&self.start.settled, &self.end.settled);
        let span = self.end.angle - self.start.angle;
        let share = if span > 0.0 {
            ((angle - self.start.angle) / span).clamp(0.0, 1.0)
        } else {
            1.0
        };
        let between = |a: f64, b: f64| a + share * (b - a);
        SettledNode {
            position: start.position + self.way() * share,
            arc: between(start.arc, end.arc),
            height: between(start.height, end.height),
            flange: end.flange,
            plastic_strain: between(start.plastic_strain, end.plastic_strain),
            tension: start.tension,
            time: between(start.time, end.time),
        }
    }

    /// From one end to the other, m.
    pub(super) fn way(&self) -> V3 {
        self.end.settled.position - self.start.settled.position
    }

    /// By how much the far end stands higher, m.
    pub(super) fn rise(&self) -> f64 {
        self.end.settled.height - self.start.settled.height
    }

    /// Where the face of the flange beside it lies along y, m.
    pub(super) fn flange_face(&self) -> Option<f64> {
        let end = &self.end.settled;
        end.flange.map(|way| end.position.y + way)
    }
}
