//! When the numbers of a run contradict each other.

use serde::{Deserialize, Serialize};
use std::fmt::{Display, Formatter, Result};

/// Energy that the balance may leave unexplained, as a share of what went through it and the work that draws in a diameter of
/// wire. That work is added because next to nothing goes through in the first steps of a run.
pub(crate) const UNEXPLAINED: f64 = 0.05;

/// Deepest contact of an accepted step, as a share of the diameter. At half a diameter the centreline lies in the surface
/// it touches: from there on the normal of a smooth surface turns round, and contact pushes the wire through.
pub(crate) const DEEPEST: f64 = 0.5;

/// What went through the energy balance up to the last communication point.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub(in crate::simulation) struct Throughput {
    /// sums of what spindle and feed did, either way, J
    pub(in crate::simulation) sum: f64,
    /// both up to now, J
    before: [f64; 2],
}

impl Throughput {
    /// Adds what spindle and feed did since the last communication point; `now` is what both did since the start, J.
    pub(in crate::simulation) fn add(&mut self, now: [f64; 2]) {
        self.sum += (0..2).map(|k| (now[k] - self.before[k]).abs()).sum::<f64>();
        self.before = now;
    }
}

/// Why the numbers of a run mean nothing, and since when.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(in crate::simulation) struct Doubt {
    /// s
    pub(in crate::simulation) time: f64,
    pub(in crate::simulation) cause: Cause,
}

#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(in crate::simulation) enum Cause {
    /// energy that the balance does not explain
    Energy {
        /// J
        unexplained: f64,
        /// of what went through it
        share: f64,
    },
    /// a contact deeper than its law holds
    Depth {
        /// m
        depth: f64,
        /// of the diameter
        share: f64,
    },
}

impl Display for Cause {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        match self {
            Self::Energy { unexplained, share } => {
                let percent = 100.0 * share;
                write!(
                    f,
                    "the energy balance leaves {unexplained:.3e} J unexplained, {percent:.0} % of what went through it"
                )?;
            }
            Self::Depth { depth, share } => {
                let mm = 1e3 * depth;
                write!(
                    f,
                    "wire was {mm:.3} mm ({share:.2} d) deep in what it touches"
                )?;
            }
        }
        write!(
            f,
            ", so what is computed from there on is not to be trusted; lower solver.tolerance, and see that no walls of a core from a file cross each other"
        )
    }
}
