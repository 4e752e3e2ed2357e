//! Work arrays of the system, which outlive no step.

use crate::rod::Forces;

/// What a step works with. It is never saved, and a copy of it is empty.
#[derive(Debug, Default)]
pub(crate) struct Scratch {
    /// joints of the whole wire at once
    pub(crate) forces: Forces,
    /// how far velocities lie behind positions while forces are evaluated, s; 0 between steps
    pub(crate) velocity_lag: f64,
}

impl Clone for Scratch {
    fn clone(&self) -> Self {
        Self::default()
    }
}
