//! A case, how it ended, and the numbers on its way.

mod bobbin;
mod layers;
mod measures;
mod mesh;
mod outcome;
mod prism;
mod stl_text;

pub use bobbin::Bobbin;
pub use layers::Layers;
pub use measures::Measures;
pub use mesh::Mesh;
pub use outcome::{Invariant, Outcome, Verdict};
pub use prism::Prism;

use crate::scene::{Scene, SceneError};
use crate::settings::{NozzleFollows, SceneSettings};
use crate::signals::Inputs;

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

/// The scene of these settings. Where no law leads the nozzle, it follows the inputs of the case.
pub fn built(settings: &SceneSettings) -> Result<Scene, SceneError> {
    let follows = match settings.traverse.mode.as_str() {
        "by-angle" => NozzleFollows::Input,
        _ => NozzleFollows::Law,
    };
    settings.build_for(follows).map(|(scene, _)| scene)
}
