//! What a check finds.

use crate::lab::stress::{Invariant, Outcome};

/// An invariant that does not hold.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Broken {
    /// which one
    pub(super) what: Invariant,
    /// how far off
    pub(super) text: String,
}

impl Broken {
    pub(super) fn new(what: Invariant, text: String) -> Self {
        Self { what, text }
    }

    pub(super) fn at(self, time: f64) -> Outcome {
        Outcome::Invariant {
            time,
            what: self.what,
            text: self.text,
        }
    }
}

/// What a check finds.
pub(super) type Found = Result<(), Broken>;
