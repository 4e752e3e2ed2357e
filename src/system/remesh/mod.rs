//! Changes of the wire between steps: halving and joining edges, letting settled wire go and taking
//! it back.
//!
//! A change is a value that says all there is to know about it. Every part of the system that has an entry a node or
//! an edge follows it by [`Remesh`], so that the arrays stay of one length.

mod freeze;
mod merge;
mod parts;
mod split;
mod thaw;

pub(super) use merge::Merge;
pub(super) use split::Split;
pub(super) use thaw::Thaw;

use super::System;
use crate::contact::ContactPoint;

/// A part of the system with entries a node or an edge.
pub(super) trait Remesh {
    /// An edge was split in two.
    fn split(&mut self, split: &Split);

    /// An inner node was taken out and its edges joined.
    fn merge(&mut self, merge: &Merge);

    /// The first `count` nodes left, each with the edge after it.
    fn remove_front(&mut self, count: usize);

    /// Frozen nodes came back at the front, each with the edge after it.
    fn insert_front(&mut self, thaw: &Thaw);
}

impl System {
    /// Brings the forces in line with a changed mesh; what the change itself cost is a line of its own in the energy
    /// balance. The residual was `unexplained` (J) before.
    ///
    /// The moment on the core stays what it was, since a change of the mesh is no motion. Nothing has balanced the forces of the
    /// new nodes and points yet; what they would add to it the core holds. Otherwise they would go with the core's way over the
    /// next step in the work on the wire, and not in that of the spindle.
    pub fn follow_mesh(&mut self, unexplained: f64) {
        let torque = self.state.torque_on_core;
        self.refresh();
        if self.model.is_for_implicit_steps() {
            if self.state.turning.is_some() {
                self.state.unbalanced += torque - self.state.torque_on_core;
            }
            self.state.torque_on_core = torque;
        }
        self.state.balance.remeshing += self.energy_residual(None) - unexplained;
    }

    /// Counts wire that came where a chord became an arc, or went where an arc became a chord, m, as fed; no pull changes.
    fn count_as_fed(&mut self, wire: f64) {
        if let Some(f) = &mut self.state.feed {
            f.shift(wire);
        }
        self.state.past.shift_feed(wire);
        self.state.joined_away -= wire;
    }

    /// The wire's spline runs elsewhere round a node that came or went: the points of the nodes `first` to `last` and of the edges
    /// between them move along with their anchors.
    fn carry_points(&mut self, first: usize, last: usize) {
        let Some(line) = self.state.contact.as_line_mut() else {
            return;
        };
        let q = &self.state.past.q[0];
        if q.len() != self.state.rod.nodes() {
            return;
        }
        let numbers = ContactPoint::Node(first).number()..=ContactPoint::Node(last).number();
        let of_points = 1..2 * (q.len() - 1);
        for number in numbers.filter(|number| of_points.contains(number)) {
            line.carry(number, ContactPoint::of_number(number).place(q));
        }
    }

    /// The parts that follow a change of the wire.
    fn parts(&mut self) -> [&mut dyn Remesh; 4] {
        [
            &mut self.state.rod,
            &mut self.state.roll,
            &mut self.state.contact,
            &mut self.state.past,
        ]
    }
}
