//! What a run remembers besides wire, coil and method.

use super::doubt::{Doubt, Throughput};
use super::freezing::{FreezePolicy, Watch};
use super::nozzle_way::Traverse;
use crate::measure::{Defect, DefectKind};
use crate::signals::{Event, Outputs};
use serde::{Deserialize, Serialize};

/// Time to which communication steps add up before the solver takes a step, s.
///
/// About the solver's shortest step for wire of 0.7 mm. In less time, wire at 5000 rpm moves by 20 nm at most, and
/// rounding errors dominate the solution.
pub(in crate::simulation) const WORTH_A_STEP: f64 = 1e-9;

/// Where the line lost its tension.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(in crate::simulation) struct SlackSince {
    /// angle of the core, rad
    pub(in crate::simulation) core: f64,
    /// s
    pub(in crate::simulation) time: f64,
    /// winding angle from the clamp up to which wire lay on the coil, rad, ...
    pub(in crate::simulation) wound: f64,
    /// ... and its place there, core frame, m
    pub(in crate::simulation) place: [f64; 3],
}

/// State of a run but for that of wire, coil and method; a saved state holds it as it is.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(in crate::simulation) struct RunState {
    pub(in crate::simulation) watch: Watch,
    pub(in crate::simulation) policy: FreezePolicy,
    /// core angle at the start, rad
    pub(in crate::simulation) angle0: f64,
    /// length of the last step of the method, s
    pub(in crate::simulation) last_step: f64,
    /// mean acceleration of the spindle over the last communication step, rad/s2
    pub(in crate::simulation) acceleration: f64,
    /// elapsed time, s
    pub(in crate::simulation) time: f64,
    /// what adding up steps has lost of `time`, s
    pub(in crate::simulation) time_lost: f64,
    /// time passed that the wire has not, see [`WORTH_A_STEP`], s
    pub(in crate::simulation) owed: f64,
    /// steps of the method
    pub(in crate::simulation) steps: u64,
    /// steps tried so far, each counted as often as it had nodes
    pub(in crate::simulation) work: u64,
    pub(in crate::simulation) outputs: Outputs,
    /// per s, see [`crate::simulation::Simulation::output_rates`]
    pub(in crate::simulation) rates: Outputs,
    /// what happened since events were last taken
    pub(in crate::simulation) events: Vec<Event>,
    /// deepest penetration of wire when it came to rest, m
    pub(in crate::simulation) rest_depth: f64,
    /// no wire moves any more: it broke, ran away, or the coil met the nozzle
    pub(in crate::simulation) over: bool,
    /// of the energy balance
    pub(in crate::simulation) throughput: Throughput,
    /// the first, which has been told
    pub(in crate::simulation) doubt: Option<Doubt>,
    /// wire was laid tighter than bulges are judged by, which has been told
    pub(in crate::simulation) told_tighter: bool,
    /// outputs have told so
    pub(in crate::simulation) told_over: bool,
    pub(in crate::simulation) was_slack: bool,
    /// from where on the line has had no tension
    pub(in crate::simulation) slack_since: Option<SlackSince>,
    /// slack and breaks, in the order of their times
    pub(in crate::simulation) faults: Vec<Defect>,
    /// turns at rest that have been told
    pub(in crate::simulation) told_turns: u32,
    /// defects of settled wire that have been told: kind, and the station from which on it counted
    pub(in crate::simulation) told_defects: Vec<(DefectKind, usize)>,
    /// unstretched wire from the clamp to the last that has lain on the coil and was not unwound, m
    pub(in crate::simulation) laid: f64,
    /// wire has slipped off an end of the core, which has been told
    pub(in crate::simulation) slipped: Option<Slip>,
    /// core angle at which the wire was last slack, rad
    pub(in crate::simulation) slack_at: Option<f64>,
    /// how long core, nozzle, tensioner and wire have been still, s
    pub(in crate::simulation) quiet: f64,
    /// what the tensioner has let go at the start, m
    pub(in crate::simulation) paid0: f64,
    /// farthest that the spindle has been from where it started, rad
    pub(in crate::simulation) farthest: f64,
    pub(in crate::simulation) traverse: Traverse,
    /// whether the nozzle follows the scene's law and not its input
    pub(in crate::simulation) nozzle_by_law: bool,
    /// tension that the quasi-static height is for, N
    pub(in crate::simulation) yardstick_tension: f64,
}

/// Where wire has slipped off the core.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(in crate::simulation) struct Slip {
    /// s
    pub(in crate::simulation) time: f64,
    /// from 1
    pub(in crate::simulation) turn: u32,
    /// end of the core along y, or outer face of its flange, m
    pub(in crate::simulation) end: f64,
}
