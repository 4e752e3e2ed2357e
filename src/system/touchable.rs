//! What the wire of a system can touch: core and frozen wire.

use super::{ContactModel, System};
use crate::contact::far;
use crate::geometry::{FrozenNode, Surface, Tube};
use std::sync::Arc;

impl System {
    /// The core's mesh, if there is a core that has one.
    pub fn core_surface(&self) -> Option<&Arc<Surface>> {
        match (&self.contact, &self.frozen_wire) {
            (ContactModel::Nodal(nodal), _) => Some(&nodal.contacts.surface),
            (_, frozen) => frozen.as_ref().map(|f| &f.surface),
        }
    }

    /// Frozen wire as nodes on the core, if it is kept.
    pub fn frozen_tube(&self) -> Option<&Tube> {
        match (&self.contact, &self.frozen_wire) {
            (ContactModel::Nodal(nodal), _) => Some(&nodal.contacts.tube),
            (_, frozen) => frozen.as_ref().map(|f| &f.tube),
        }
    }

    /// A distance from the origin far outside of what wire can lie on, m, if there is a core with a mesh.
    pub(crate) fn far(&self) -> Option<f64> {
        self.core_surface()
            .map(|core| far(core, self.model.section.radius()))
    }

    fn frozen_tube_mut(&mut self) -> Option<&mut Tube> {
        match (&mut self.contact, &mut self.frozen_wire) {
            (ContactModel::Nodal(nodal), _) => Some(&mut nodal.contacts.tube),
            (_, frozen) => frozen.as_mut().map(|f| &mut f.tube),
        }
    }

    /// Adds a node to what wire can touch as frozen wire.
    pub(crate) fn lay_frozen(&mut self, node: FrozenNode) {
        if let Some(line) = self.contact.as_line_mut() {
            line.lay(node.point, node.arc);
        }
        if let Some(tube) = self.frozen_tube_mut() {
            tube.push(node);
        }
    }

    /// Takes the last `count` frozen nodes away from what wire can touch.
    pub(crate) fn take_up_frozen(&mut self, count: usize) {
        for _ in 0..count {
            if let Some(line) = self.contact.as_line_mut() {
                line.tube.pop();
            }
            if let Some(tube) = self.frozen_tube_mut() {
                tube.pop();
            }
        }
    }

    /// The last `count` nodes have just been laid: contact looks up again what lies round them.
    pub(crate) fn notice_laid(&mut self, count: usize) {
        match &mut self.contact {
            ContactModel::None => {}
            ContactModel::Nodal(nodal) => nodal.contacts.forget_surroundings(),
            ContactModel::Line(line) => line.forget_near(line.tube.len() - count),
        }
    }
}
