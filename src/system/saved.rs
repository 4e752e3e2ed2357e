//! A system as a saved state holds it: its [`State`] and what contact remembers.

use super::{ContactModel, State, System};
use crate::contact::{LiveContact, SavedContacts, SavedLine, Wire, restore_tube};
use crate::geometry::FrozenNode;
use serde::{Deserialize, Serialize};

/// What a saved state holds of a [`System`].
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct SavedSystem {
    state: State,
    contact: SavedContact,
}

/// What a saved state holds of contact and frozen wire.
#[derive(Debug, Serialize, Deserialize)]
struct SavedContact {
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

impl System {
    /// What a saved state has to hold.
    pub(crate) fn saved(&self) -> SavedSystem {
        SavedSystem {
            state: self.state.clone(),
            contact: self.saved_contact(),
        }
    }

    /// Takes a saved state over in a fresh system of the same scene.
    ///
    /// Fails with what is impossible about it; the system is then useless.
    pub(crate) fn restore(&mut self, saved: SavedSystem) -> Result<(), &'static str> {
        saved.state.check()?;
        if self.model.feed.is_some() != saved.state.feed.is_some() {
            return Err("a feed is there in one of scene and state only");
        }
        self.restore_contact(saved.contact, saved.state.rod.nodes())?;
        self.state = saved.state;
        Ok(())
    }

    fn saved_contact(&self) -> SavedContact {
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
    fn restore_contact(&mut self, saved: SavedContact, nodes: usize) -> Result<(), &'static str> {
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
