//! Where the step of the wire to its next row began.

/// A step to the next row that began before it was certain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Onset {
    /// the first station of the next row
    pub(super) station: usize,
    /// the station with which it was certain
    pub(super) certain: usize,
}
