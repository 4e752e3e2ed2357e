//! What the wire touches and by which method: chosen once, when the system is set up.

use crate::contact::{
    ContactLaw, Contacts, LineContact, LiveContact, NodeContact, SavedContacts, SavedLine, Wire,
    far, restore_tube,
};
use crate::geometry::{FrozenNode, Surface, Tube};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Contact of the paper's method, node by node.
#[derive(Clone, Debug)]
pub struct NodalContact {
    /// nodes against core and frozen wire
    pub contacts: Contacts,
    /// live wire against live wire, where it may meet
    pub live: Option<LiveContact>,
    /// the live wire as that contact saw it last
    pub(crate) wire: Wire,
}

/// The core's mesh and the frozen wire as nodes on it, where contact itself keeps neither.
#[derive(Clone, Debug)]
pub struct FrozenWire {
    /// the core
    pub surface: Arc<Surface>,
    /// frozen wire
    pub tube: Tube,
}

/// How the wire touches core, frozen wire and itself.
#[derive(Clone, Debug, Default)]
pub enum ContactModel {
    /// there is nothing to touch
    #[default]
    None,
    /// at the nodes, against the core's mesh: the paper's method
    Nodal(Box<NodalContact>),
    /// along the wire's smooth centreline: the production method
    Line(Box<LineContact>),
}

impl NodalContact {
    /// A node was put in the middle of edge `j`, whose halves are `half` long, m.
    pub(crate) fn split(&mut self, j: usize, half: f64) {
        self.contacts.nodes.insert(j + 1, NodeContact::new());
        if let Some(live) = &mut self.live {
            live.insert(j + 1);
            // there is none before the first evaluation
            if self.wire.length.len() > j {
                self.wire.length.insert(j + 1, half);
            }
        }
    }

    /// Node `i` was taken out.
    pub(crate) fn merge(&mut self, i: usize) {
        self.contacts.nodes.remove(i);
    }

    /// The first `count` nodes left.
    pub(crate) fn remove_front(&mut self, count: usize) {
        self.contacts.nodes.drain(..count);
        if let Some(live) = &mut self.live {
            live.remove_front(count);
            let lengths = &mut self.wire.length;
            lengths.drain(..count.min(lengths.len()));
        }
    }
}

impl ContactModel {
    /// Contact at the nodes.
    pub fn nodal(contacts: Contacts) -> Self {
        Self::Nodal(Box::new(NodalContact {
            contacts,
            live: None,
            wire: Wire::default(),
        }))
    }

    /// Contact along the wire.
    pub fn line(line: LineContact) -> Self {
        Self::Line(Box::new(line))
    }

    /// Contact at the nodes, if it is of that kind.
    pub fn as_nodal(&self) -> Option<&NodalContact> {
        match self {
            Self::Nodal(nodal) => Some(nodal),
            Self::None | Self::Line(_) => None,
        }
    }

    /// Contact along the wire, if it is of that kind.
    #[inline]
    pub fn as_line(&self) -> Option<&LineContact> {
        match self {
            Self::Line(line) => Some(line),
            Self::None | Self::Nodal(_) => None,
        }
    }

    /// Contact along the wire, if it is of that kind.
    #[inline]
    pub fn as_line_mut(&mut self) -> Option<&mut LineContact> {
        match self {
            Self::Line(line) => Some(line),
            Self::None | Self::Nodal(_) => None,
        }
    }

    /// Whether contact is along the wire.
    pub fn is_line(&self) -> bool {
        matches!(self, Self::Line(_))
    }

    /// Law of contact with core and frozen wire.
    pub fn law_mut(&mut self) -> Option<&mut ContactLaw> {
        match self {
            Self::None => None,
            Self::Nodal(nodal) => Some(&mut nodal.contacts.law),
            Self::Line(line) => Some(&mut line.law),
        }
    }

    /// From now on live wire may touch live wire.
    pub fn watch_live_wire(&mut self) {
        match self {
            Self::None => {}
            Self::Nodal(nodal) => {
                nodal.live.get_or_insert_default();
            }
            Self::Line(line) => line.watch_live_wire(),
        }
    }
}

impl super::System {
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

    /// The last `count` nodes have just been laid: contact looks up anew what lies round them.
    pub(crate) fn notice_laid(&mut self, count: usize) {
        match &mut self.contact {
            ContactModel::None => {}
            ContactModel::Nodal(nodal) => nodal.contacts.forget_surroundings(),
            ContactModel::Line(line) => line.forget_near(line.tube.len() - count),
        }
    }
}

/// What a saved state holds of contact and frozen wire.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct SavedContact {
    /// frozen wire where contact itself keeps none
    frozen: Option<Vec<FrozenNode>>,
    model: SavedModel,
}

#[derive(Debug, Serialize, Deserialize)]
enum SavedModel {
    None,
    Nodal {
        contacts: SavedContacts,
        live: Option<LiveContact>,
        wire: Wire,
    },
    Line(SavedLine),
}

impl super::System {
    pub(super) fn saved_contact(&self) -> SavedContact {
        SavedContact {
            frozen: self.frozen_wire.as_ref().map(|f| f.tube.nodes().collect()),
            model: match &self.contact {
                ContactModel::None => SavedModel::None,
                ContactModel::Nodal(nodal) => SavedModel::Nodal {
                    contacts: nodal.contacts.saved(),
                    live: nodal.live.clone(),
                    wire: nodal.wire.clone(),
                },
                ContactModel::Line(line) => SavedModel::Line(line.saved()),
            },
        }
    }

    /// Takes over what was saved of contact of a wire with so many live nodes. Fails with what is impossible about it.
    pub(super) fn restore_contact(
        &mut self,
        saved: SavedContact,
        nodes: usize,
    ) -> Result<(), &'static str> {
        let far = self.far().unwrap_or(f64::INFINITY);
        match (&mut self.frozen_wire, saved.frozen) {
            (Some(wire), Some(frozen)) => {
                wire.tube = restore_tube(frozen, wire.tube.radius(), far)?;
            }
            (None, None) => {}
            _ => return Err("frozen wire is there in one of scene and state only"),
        }
        match (&mut self.contact, saved.model) {
            (ContactModel::None, SavedModel::None) => {}
            (
                ContactModel::Nodal(nodal),
                SavedModel::Nodal {
                    contacts,
                    live,
                    wire,
                },
            ) => {
                let fits = live.as_ref().is_none_or(|l| l.fits(nodes));
                if !fits || ![0, nodes].contains(&wire.length.len()) {
                    return Err("a pair is beyond the live wire");
                }
                nodal.contacts.restore(contacts, nodes)?;
                (nodal.live, nodal.wire) = (live, wire);
            }
            (ContactModel::Line(line), SavedModel::Line(saved)) => {
                let tube = self.frozen_wire.as_ref().map(|f| &f.tube);
                let wire = tube.into_iter().flat_map(|tube| tube.nodes());
                line.restore(saved, wire.map(|node| (node.point, node.arc)), nodes, far)?;
            }
            _ => return Err("contact is of another kind in scene and state"),
        }
        Ok(())
    }
}
