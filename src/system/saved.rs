//! A system as a saved state holds it: its [`State`] and what contact remembers.

use super::contact_model::SavedContact;
use super::{State, System};
use serde::{Deserialize, Serialize};

/// What a saved state holds of a [`System`].
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct SavedSystem {
    state: State,
    contact: SavedContact,
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
}
