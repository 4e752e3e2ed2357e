//! Random but valid scenes and input signals, judged by what must always hold.
//!
//! A case is drawn from a seed and a number ([`draw`]), run and judged ([`invariants`]), and made as small as it
//! gets where it fails ([`shrink`]). Nothing here depends on time or on the number of threads. The
//! files of a case ([`case_files`]) are what `coilwind run SCENE --inputs CSV --step H` takes.

mod bobbin;
pub mod case_files;
mod case_random;
pub mod draw;
pub mod invariants;
mod layers;
mod measures;
mod mesh;
mod prism;
pub mod refined;
pub mod region;
pub mod shrink;
mod signal;
mod stl_text;
mod worst;

pub use bobbin::Bobbin;
pub use layers::Layers;
pub use measures::Measures;
pub use mesh::Mesh;
pub use prism::Prism;
pub use worst::Worst;

use crate::settings::SceneSettings;
use crate::signals::Inputs;
use std::fmt;

/// What the input signals do.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// speed rises evenly and stays
    Ramp,
    /// speed jumps
    Step,
    /// every input shakes
    Noise,
    /// sudden stop, and perhaps on again
    Stop,
    /// winds back for a while
    Reverse,
    /// stops while the tensioner pulls harder
    Emergency,
    /// the nozzle jumps
    Jump,
    /// tension to zero and back
    Slack,
}

impl Kind {
    /// All of them.
    pub const ALL: [Self; 8] = [
        Self::Ramp,
        Self::Step,
        Self::Noise,
        Self::Stop,
        Self::Reverse,
        Self::Emergency,
        Self::Jump,
        Self::Slack,
    ];

    /// In words.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Ramp => "ramp",
            Self::Step => "speed steps",
            Self::Noise => "noise",
            Self::Stop => "sudden stop",
            Self::Reverse => "reversal",
            Self::Emergency => "emergency stop",
            Self::Jump => "nozzle jumps",
            Self::Slack => "tension to zero",
        }
    }
}

/// One scene with the inputs of each communication step.
#[derive(Clone, Debug, PartialEq)]
pub struct Case {
    /// of the whole run
    pub seed: u64,
    /// in it
    pub number: u64,
    /// what the signals do
    pub kind: Kind,
    /// the scene
    pub settings: SceneSettings,
    /// the mesh it winds on, if it is one
    pub mesh: Option<Mesh>,
    /// how its nozzle goes to and fro
    pub layers: Layers,
    /// communication step, s
    pub step: f64,
    /// held over step k (the nozzle arrives at its end); the last one only ends the run
    pub inputs: Vec<Inputs>,
}

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
