//! How a case ended, and what must always hold.

use super::measures::Measures;
use std::fmt;

/// How a case ended.
#[derive(Clone, Debug, PartialEq)]
pub enum Outcome {
    /// to its end
    Completed,
    /// the wire parted
    Broke {
        /// s
        time: f64,
        /// of the event
        text: String,
    },
    /// the wire ran away from the nozzle, or something met the nozzle: what becomes of the scene, not of the solver
    Ended {
        /// s
        time: f64,
        /// of the event
        text: String,
    },
    /// the solver found no way on
    GaveUp {
        /// s
        time: f64,
        /// m of wire from the clamp, if a node is to blame
        place: Option<f64>,
        /// with its residual
        reason: String,
    },
    /// something that must always hold does not
    Invariant {
        /// s
        time: f64,
        /// which one
        what: Invariant,
        /// how far off
        text: String,
    },
}

impl Outcome {
    /// Of the same kind, so that a smaller case with it shows the same trouble.
    pub fn same_trouble(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Invariant { what: a, .. }, Self::Invariant { what: b, .. }) => a == b,
            (Self::GaveUp { .. }, Self::GaveUp { .. }) => true,
            _ => false,
        }
    }

    /// Whether it asks for an explanation.
    pub fn is_trouble(&self) -> bool {
        matches!(self, Self::GaveUp { .. } | Self::Invariant { .. })
    }
}

impl fmt::Display for Outcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Completed => f.write_str("completed"),
            Self::Broke { time, text } => write!(f, "wire broke at t = {time:.6} s: {text}"),
            Self::Ended { time, text } => write!(f, "ended at t = {time:.6} s: {text}"),
            Self::GaveUp {
                time,
                place,
                reason,
            } => {
                write!(f, "gave up at t = {time:.9} s")?;
                if let Some(place) = place {
                    write!(f, ", {:.2} mm from the clamp", place * 1e3)?;
                }
                write!(f, ": {reason}")
            }
            Self::Invariant { time, what, text } => {
                write!(f, "INVARIANT {what} at t = {time:.9} s: {text}")
            }
        }
    }
}

/// What must always hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Invariant {
    /// no panic
    Panic,
    /// every number is one
    Finite,
    /// the energy balance explains all energy
    Energy,
    /// wire stays out of the core
    Penetration,
    /// wire stays out of wire
    Crossing,
    /// friction within its limit
    Cone,
    /// wire between clamp and nozzle is what there was and what was fed
    Length,
    /// plastic work never comes back
    PlasticWork,
    /// wire is never pushed
    Tension,
    /// frozen wire stays where it is
    Frozen,
    /// friction holds its tensions
    FrozenTension,
    /// so many steps are enough
    Steps,
}

impl fmt::Display for Invariant {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Panic => "no panic",
            Self::Finite => "finite state",
            Self::Energy => "energy balance",
            Self::Penetration => "penetration",
            Self::Crossing => "wire in wire",
            Self::Cone => "friction cone",
            Self::Length => "wire length",
            Self::PlasticWork => "plastic work",
            Self::Tension => "tension",
            Self::Frozen => "frozen wire",
            Self::FrozenTension => "frozen tension",
            Self::Steps => "steps per turn",
        })
    }
}

/// What came of a case.
#[derive(Clone, Debug, PartialEq)]
pub struct Verdict {
    /// how it ended
    pub outcome: Outcome,
    /// numbers on the way
    pub measures: Measures,
}
