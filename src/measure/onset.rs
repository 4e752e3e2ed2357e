//! Where the step of the wire to its next row began.

/// A stretch of wire beside a flange that was seen for what it is by wire laid after it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Onset {
    /// what the wire was about
    pub(super) kind: OnsetKind,
    /// its first station
    pub(super) station: usize,
    /// the station with which it was certain
    pub(super) certain: usize,
}

/// What wire that rises beside a flange is about.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum OnsetKind {
    /// a step to the next row, which began before it was certain
    Step,
    /// it was pressed up there, came down to its row again, and never left it
    PressedUp,
}
