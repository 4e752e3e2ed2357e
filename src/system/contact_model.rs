//! What the wire touches and by which method: chosen once, when the system is set up.

use crate::contact::{ContactLaw, Contacts, LineContact, LiveContact, NodeContact, Wire};
use crate::geometry::{Surface, Tube};
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
