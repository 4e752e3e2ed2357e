//! What a run remembers besides wire, coil and method.

use super::doubt::{Doubt, Throughput};
use super::freezing::{FreezePolicy, Watch};
use super::nozzle_way::Traverse;
use crate::measure::{Defect, DefectKind};
use crate::signals::{Event, Outputs};
use serde::{Deserialize, Serialize};

/// Where the line lost its tension.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct SlackSince {
    /// angle of the core, rad
    pub(super) core: f64,
    /// s
    pub(super) time: f64,
    /// winding angle from the clamp up to which wire lay on the coil, rad, ...
    pub(super) wound: f64,
    /// ... and its place there, core frame, m
    pub(super) place: [f64; 3],
}

/// State of a run but for that of wire, coil and method; a saved state holds it as it is.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct RunState {
    pub(super) watch: Watch,
    pub(super) policy: FreezePolicy,
    /// core angle at the start, rad
    pub(super) angle0: f64,
    /// length of the last step of the method, s
    pub(super) last_step: f64,
    /// mean acceleration of the spindle over the last communication step, rad/s2
    pub(super) acceleration: f64,
    /// elapsed time, s
    pub(super) time: f64,
    /// what adding up steps has lost of `time`, s
    pub(super) time_lost: f64,
    /// time passed that the wire has not, see [`super::WORTH_A_STEP`], s
    pub(super) owed: f64,
    /// steps of the method
    pub(super) steps: u64,
    /// steps tried so far, each counted as often as it had nodes
    pub(super) work: u64,
    pub(super) outputs: Outputs,
    /// per s, see [`super::Simulation::output_rates`]
    pub(super) rates: Outputs,
    /// what happened since events were last taken
    pub(super) events: Vec<Event>,
    /// deepest penetration of wire when it came to rest, m
    pub(super) rest_depth: f64,
    /// no wire moves any more: it broke, ran away, or the coil met the nozzle
    pub(super) over: bool,
    /// of the energy balance
    pub(super) throughput: Throughput,
    /// the first, which has been told
    pub(super) doubt: Option<Doubt>,
    /// wire was laid tighter than bulges are judged by, which has been told
    pub(super) told_tighter: bool,
    /// outputs have told so
    pub(super) told_over: bool,
    pub(super) was_slack: bool,
    /// from where on the line has had no tension
    pub(super) slack_since: Option<SlackSince>,
    /// slack and breaks, in the order of their times
    pub(super) faults: Vec<Defect>,
    /// turns at rest that have been told
    pub(super) told_turns: u32,
    /// defects of settled wire that have been told: kind, and the station from which on it counted
    pub(super) told_defects: Vec<(DefectKind, usize)>,
    /// unstretched wire from the clamp to the last that has lain on the coil and was not unwound, m
    pub(super) laid: f64,
    /// wire has slipped off an end of the core, which has been told
    pub(super) slipped: Option<Slip>,
    /// core angle at which the wire was last slack, rad
    pub(super) slack_at: Option<f64>,
    /// how long core, nozzle, tensioner and wire have been still, s
    pub(super) quiet: f64,
    /// what the tensioner has let go at the start, m
    pub(super) paid0: f64,
    /// farthest that the spindle has been from where it started, rad
    pub(super) farthest: f64,
    pub(super) traverse: Traverse,
    /// whether the nozzle follows the scene's law and not its input
    pub(super) nozzle_by_law: bool,
    /// tension that the quasi-static height is for, N
    pub(super) yardstick_tension: f64,
}

/// Where wire has slipped off the core.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Slip {
    /// s
    pub(super) time: f64,
    /// from 1
    pub(super) turn: u32,
    /// end of the core along y, or outer face of its flange, m
    pub(super) end: f64,
}
