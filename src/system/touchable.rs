//! What the wire of a system can touch: core and frozen wire.

use super::{ContactModel, ContactScratch, ContactState, System, line_contact};
use crate::contact::{
    ContactPoint, LineContact, LineModel, LineScratch, LineState, NodalModel, NodalScratch,
    NodalState, far,
};
use crate::geometry::{FrozenNode, Nearness, Shape};
use crate::math::V3;
use std::sync::Arc;

impl System {
    /// Lets the wire touch along its centreline from now on.
    pub fn touch_along(&mut self, model: LineModel) {
        let nodes = self.state.rod.nodes();
        self.state.contact = ContactState::Line(Box::new(LineState::new(nodes)));
        self.scratch.contact = ContactScratch::Line(Box::new(LineScratch::new(model.radius)));
        self.model.contact = ContactModel::Line(model);
    }

    /// Lets the wire touch at its nodes from now on.
    pub fn touch_at_nodes(&mut self, model: NodalModel) {
        let nodes = self.state.rod.nodes();
        self.state.contact = ContactState::Nodal(Box::new(NodalState::new(nodes)));
        self.scratch.contact = ContactScratch::Nodal(NodalScratch::default());
        self.model.contact = ContactModel::Nodal(model);
    }

    /// Contact along the wire as one, if it is of that kind.
    pub fn line_contact(&mut self) -> Option<LineContact<'_>> {
        line_contact(
            &self.model.contact,
            &mut self.state.contact,
            &mut self.scratch.contact,
        )
    }

    /// What contact along the wire works with, if it is of that kind.
    pub fn line_scratch(&self) -> Option<&LineScratch> {
        match &self.scratch.contact {
            ContactScratch::Line(scratch) => Some(scratch),
            ContactScratch::None | ContactScratch::Nodal(_) => None,
        }
    }

    /// A distance from the origin far outside of what wire can lie on, m, if there is a core with a mesh.
    pub(crate) fn far(&self) -> Option<f64> {
        let core = self.model.core.as_deref();
        core.map(|core| far(core, self.model.section.radius()))
    }

    /// Adds a node to what wire can touch as frozen wire.
    pub(crate) fn lay_frozen(&mut self, node: FrozenNode) {
        if let Some(mut line) = self.line_contact() {
            line.lay(node.point, node.arc);
        }
        Arc::make_mut(&mut self.state.frozen).push(node);
    }

    /// Takes the last `count` frozen nodes away from what wire can touch.
    pub(crate) fn take_up_frozen(&mut self, count: usize) {
        for _ in 0..count {
            if let ContactScratch::Line(line) = &mut self.scratch.contact {
                Arc::make_mut(&mut line.tube).pop();
            }
            Arc::make_mut(&mut self.state.frozen).pop();
        }
    }

    /// The last `count` nodes have just been laid: contact looks up again what lies round them.
    pub(crate) fn notice_laid(&mut self, count: usize) {
        if let Some(nodal) = self.state.contact.as_nodal_mut() {
            nodal.forget_surroundings();
        }
        if let Some(mut line) = self.line_contact() {
            line.forget_near(line.scratch.tube.len() - count);
        }
    }

    /// Whether node `i` touches core or frozen wire.
    pub fn touches(&self, i: usize) -> bool {
        match &self.state.contact {
            ContactState::Line(line) => line.touches(i),
            ContactState::Nodal(nodal) => nodal.nodes[i].touches(),
            ContactState::None => false,
        }
    }

    /// Where the wire touches core or frozen wire last before node `i` or there, m, of a node that [`Self::touches`]: there, or in
    /// the middle of the edge before.
    pub fn touched_place(&self, i: usize) -> V3 {
        let itself = match &self.state.contact {
            ContactState::Line(line) => line.touches_itself(i),
            _ => true,
        };
        match itself {
            true => self.centre(i),
            false => ContactPoint::Edge(i - 1).place(&self.state.rod.x),
        }
    }

    /// Whether node `i` touches core or frozen wire, a flange not counted.
    pub fn touches_wound(&self, i: usize) -> bool {
        match (&self.state.contact, &self.model.contact) {
            (ContactState::Line(line), ContactModel::Line(model)) => line.touches_wound(model, i),
            _ => self.touches(i),
        }
    }

    /// The last node that lies on live wire up to this node, or on what lies on that; this node where none does.
    pub fn carried_by(&self, node: usize) -> usize {
        match &self.state.contact {
            ContactState::Line(line) => {
                let pairs = line.self_contact.as_ref();
                pairs.map_or(node, |pairs| pairs.carried_by(node))
            }
            ContactState::Nodal(_) | ContactState::None => node,
        }
    }

    /// Whether wire may meet flanges beside what it is wound on: plates by key, or walls of a concave mesh.
    pub(crate) fn may_meet_flange(&self) -> bool {
        match &self.model.contact {
            ContactModel::Line(line) => line.flanges.is_some() || line.shape.with_walls().is_some(),
            ContactModel::Nodal(_) | ContactModel::None => false,
        }
    }

    /// Depth of node `i` in what it touches, m.
    pub fn depth(&self, i: usize) -> f64 {
        match &self.state.contact {
            ContactState::Line(line) => line.depth(i),
            ContactState::Nodal(nodal) => nodal.nodes[i].depth(),
            ContactState::None => 0.0,
        }
    }

    /// Signed distance of a point from the core, core frame, m; far away without a core.
    pub fn distance_to_core(&self, p: V3) -> f64 {
        match &self.model.contact {
            ContactModel::Line(line) => line.distance(p),
            ContactModel::Nodal(nodal) => nodal.surface.nearest(p).distance,
            ContactModel::None => f64::INFINITY,
        }
    }

    /// Whether the core is nearer to a point, core frame, m, than `reach`: less work than [`Self::distance_to_core`].
    pub(crate) fn is_near_core(&self, p: V3, reach: f64) -> bool {
        match &self.model.contact {
            ContactModel::Line(line) => line.is_within(p, reach),
            ContactModel::Nodal(nodal) => nodal.surface.is_within(p, reach),
            ContactModel::None => false,
        }
    }

    /// Signed distance of a point from the core with its gradient, core frame, m, and whether a flange by key is nearest; none
    /// without a core.
    pub(crate) fn nearness_to_core(&self, p: V3) -> Option<(Nearness, bool)> {
        match &self.model.contact {
            ContactModel::Line(line) => {
                let core = line.shape.nearness(p);
                let flange = line.flange(p).filter(|f| f.distance < core.distance);
                Some((flange.unwrap_or(core), flange.is_some()))
            }
            ContactModel::Nodal(nodal) => {
                let near = nodal.surface.nearest(p);
                let (distance, normal) = (near.distance, near.normal);
                Some((Nearness { distance, normal }, false))
            }
            ContactModel::None => None,
        }
    }

    /// Signed distance of a point from what wire is wound on, without flanges, core frame, m; none where flanges are a part of
    /// its mesh.
    pub(crate) fn distance_to_wound(&self, p: V3) -> Option<f64> {
        match &self.model.contact {
            ContactModel::Line(line) => match line.shape {
                Shape::Mesh(_) => None,
                _ => Some(line.shape.nearness(p).distance),
            },
            ContactModel::Nodal(_) | ContactModel::None => None,
        }
    }

    /// Where the wire at node `i` lies: on its smooth centreline where contact is along the wire.
    pub fn centre(&self, i: usize) -> V3 {
        let x = &self.state.rod.x;
        if self.model.contact.is_line() && i > 0 && i + 1 < x.len() {
            ContactPoint::Node(i).place(x)
        } else {
            x[i]
        }
    }
}
