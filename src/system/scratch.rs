//! Work arrays of the system, and what follows from its state.

use super::ContactScratch;
use crate::rod::Forces;

/// What a step works with. It is never saved: work arrays outlive no step, and the search among frozen wire is made
/// again from the state.
#[derive(Debug, Default)]
pub(crate) struct Scratch {
    /// joints of the whole wire at once
    pub(crate) forces: Forces,
    /// how far velocities lie behind positions while forces are evaluated, s; 0 between steps
    pub(crate) velocity_lag: f64,
    /// of contact
    pub(crate) contact: ContactScratch,
}

impl Clone for Scratch {
    fn clone(&self) -> Self {
        Self {
            contact: self.contact.clone(),
            ..Self::default()
        }
    }
}
