//! Makes a case that fails as small and as plain as it gets while it fails in the same way.

use super::case::built;
use super::invariants::judge;
use super::{Case, Outcome, Verdict};
use crate::settings::SceneSettings;

/// Runs that one case may be worth.
const RUNS: usize = 40;

/// A smaller case with the same trouble, its verdict, and how many runs that took.
///
/// First the inputs are cut behind the failure. Then each group of settings goes back to its
/// default, and each input is held, where the trouble stays.
pub fn shrink(case: &Case, verdict: &Verdict) -> (Case, Verdict, usize) {
    let mut best = Best {
        case: case.clone(),
        verdict: verdict.clone(),
        runs: 0,
    };
    best.cut();
    for change in CHANGES {
        best.attempt(change);
    }
    best.cut();
    (best.case, best.verdict, best.runs)
}

struct Best {
    case: Case,
    verdict: Verdict,
    runs: usize,
}

impl Best {
    /// Leaves out the inputs after the failure.
    fn cut(&mut self) {
        let time = match &self.verdict.outcome {
            Outcome::GaveUp { time, .. } | Outcome::Invariant { time, .. } => *time,
            Outcome::Completed | Outcome::Broke { .. } | Outcome::Ended { .. } => return,
        };
        let needed = (time / self.case.step).ceil() as usize + 2;
        if needed < self.case.inputs.len() {
            self.attempt(|case| case.inputs.truncate(needed));
        }
    }

    /// Keeps a change if the trouble stays.
    fn attempt(&mut self, change: impl Fn(&mut Case)) {
        let mut case = self.case.clone();
        change(&mut case);
        if case == self.case || self.runs == RUNS || built(&case.settings).is_err() {
            return;
        }
        self.runs += 1;
        let verdict = judge(&case);
        if verdict.outcome.same_trouble(&self.verdict.outcome) {
            (self.case, self.verdict) = (case, verdict);
        }
    }
}

/// Sets some leaves to what they are by default.
macro_rules! default {
    ($($section:ident . $leaf:ident),*) => {
        |case: &mut Case| {
            let plain = SceneSettings::default();
            $(case.settings.$section.$leaf = plain.$section.$leaf.clone();)*
        }
    };
}

/// From what explains least to what explains most.
const CHANGES: &[fn(&mut Case)] = &[
    |case| case.settings.freeze = SceneSettings::default().freeze,
    |case| case.settings.contact = SceneSettings::default().contact,
    default!(tensioner.line_length, tensioner.line_damping_ratio),
    default!(tensioner.mass),
    default!(nozzle.exit_friction),
    default!(solver.twist),
    |case| case.settings.solver.twist = "off".to_owned(),
    default!(solver.tolerance),
    default!(solver.spacing_near, solver.spacing_free),
    default!(wire.yield_stress, wire.flow_stress),
    default!(wire.elastic, wire.strength),
    |case| case.settings.friction = SceneSettings::default().friction,
    |case| {
        (
            case.settings.friction.static_,
            case.settings.friction.kinetic,
        ) = (0.0, 0.0)
    },
    |case| hold(case, |i, first| i.tension_setpoint = first.tension_setpoint),
    |case| hold(case, |i, first| i.nozzle_position = first.nozzle_position),
    |case| {
        let top = case
            .inputs
            .iter()
            .map(|i| i.spindle_speed)
            .fold(0.0, f64::max);
        hold(case, |i, _| i.spindle_speed = top);
    },
    |case| {
        // in the middle of the core, straight in front
        let first = case.inputs[0].nozzle_position;
        for i in &mut case.inputs {
            i.nozzle_position -= first;
        }
        (case.settings.start.clamp_y, case.settings.nozzle.y_start) = (0.0, 0.0);
    },
    default!(core.length_y),
    default!(core.width_x, core.height_z),
    default!(nozzle.distance),
    |case| {
        // a mesh may not be to blame: a cylinder of its size
        if let Some(mesh) = case.mesh.take() {
            case.settings.core.shape = "cylinder".to_owned();
            case.settings.core.radius = mesh.barrel();
            case.settings.core.file.clear();
        }
    },
    |case| {
        // every other point, twice as far apart
        case.step *= 2.0;
        let every_other: Vec<_> = case.inputs.iter().step_by(2).copied().collect();
        case.inputs = every_other;
    },
];

fn hold(case: &mut Case, set: impl Fn(&mut crate::signals::Inputs, &crate::signals::Inputs)) {
    let first = case.inputs[0];
    for i in &mut case.inputs {
        set(i, &first);
    }
}
