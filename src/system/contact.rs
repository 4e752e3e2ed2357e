//! What the wire touches and by which method: chosen once, when the system is set up.

use crate::contact::{
    ContactLaw, LineContact, LineModel, LineScratch, LineState, NodalContact, NodalModel,
    NodalScratch, NodalState,
};
use crate::geometry::Tube;
use serde::{Deserialize, Serialize};

/// How the wire touches core, frozen wire and itself.
#[derive(Clone, Debug, Default)]
pub enum ContactModel {
    /// there is nothing to touch
    #[default]
    None,
    /// at the nodes, against the core's mesh: the paper's method
    Nodal(NodalModel),
    /// along the wire's smooth centreline: the production method
    Line(LineModel),
}

/// What contact of either kind remembers.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub enum ContactState {
    /// there is nothing to touch
    #[default]
    None,
    /// at the nodes
    Nodal(Box<NodalState>),
    /// along the wire
    Line(Box<LineState>),
}

/// What contact of either kind works with.
#[derive(Clone, Debug, Default)]
pub(crate) enum ContactScratch {
    #[default]
    None,
    Nodal(NodalScratch),
    Line(Box<LineScratch>),
}

impl ContactModel {
    /// Contact along the wire, if it is of that kind.
    pub fn as_line(&self) -> Option<&LineModel> {
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
            Self::Nodal(nodal) => Some(&mut nodal.law),
            Self::Line(line) => Some(&mut line.law),
        }
    }
}

impl ContactState {
    /// Contact along the wire, if it is of that kind.
    #[inline]
    pub fn as_line(&self) -> Option<&LineState> {
        match self {
            Self::Line(line) => Some(line),
            Self::None | Self::Nodal(_) => None,
        }
    }

    /// Contact along the wire, if it is of that kind.
    #[inline]
    pub fn as_line_mut(&mut self) -> Option<&mut LineState> {
        match self {
            Self::Line(line) => Some(line),
            Self::None | Self::Nodal(_) => None,
        }
    }

    /// Contact at the nodes, if it is of that kind.
    pub fn as_nodal(&self) -> Option<&NodalState> {
        match self {
            Self::Nodal(nodal) => Some(nodal),
            Self::None | Self::Line(_) => None,
        }
    }

    /// Contact at the nodes, if it is of that kind.
    pub(super) fn as_nodal_mut(&mut self) -> Option<&mut NodalState> {
        match self {
            Self::Nodal(nodal) => Some(nodal),
            Self::None | Self::Line(_) => None,
        }
    }

    /// Becomes a copy of another state, in the room that this one has.
    pub(super) fn copy_from(&mut self, other: &Self) {
        match (self, other) {
            (Self::Line(to), Self::Line(from)) => to.copy_from(from),
            (to, from) => *to = from.clone(),
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

    /// Whether live wire may touch live wire.
    pub fn watches_live_wire(&self) -> bool {
        match self {
            Self::None => false,
            Self::Nodal(nodal) => nodal.live.is_some(),
            Self::Line(line) => line.self_contact.is_some(),
        }
    }
}

impl ContactScratch {
    /// Serves the contact of another system from now on.
    pub(super) fn serve(&mut self, other: &Self) {
        match (self, other) {
            (Self::Line(to), Self::Line(from)) => to.serve(from),
            (to, from) => *to = from.clone(),
        }
    }
}

/// Contact along the wire as one, if it is of that kind.
#[inline]
pub(crate) fn line_contact<'a>(
    model: &'a ContactModel,
    state: &'a mut ContactState,
    scratch: &'a mut ContactScratch,
) -> Option<LineContact<'a>> {
    match (model, state, scratch) {
        (ContactModel::Line(model), ContactState::Line(state), ContactScratch::Line(scratch)) => {
            Some(LineContact {
                model,
                state,
                scratch,
            })
        }
        _ => None,
    }
}

/// Contact at the nodes as one, if it is of that kind, with the wire `frozen`.
pub(super) fn nodal_contact<'a>(
    model: &'a ContactModel,
    state: &'a mut ContactState,
    frozen: &'a Tube,
    scratch: &'a mut ContactScratch,
) -> Option<NodalContact<'a>> {
    match (model, state, scratch) {
        (
            ContactModel::Nodal(model),
            ContactState::Nodal(state),
            ContactScratch::Nodal(scratch),
        ) => Some(NodalContact {
            model,
            state,
            frozen,
            scratch,
        }),
        _ => None,
    }
}
