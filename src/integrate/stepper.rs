//! The method of a run, chosen once at its start.

use super::{Explicit, ExplicitMethod, Implicit, SolverStatistics, StepError};
use crate::system::System;

/// The method that moves a system in time.
#[derive(Clone, Debug)]
pub enum Stepper {
    /// a method that takes steps of a given length
    Explicit {
        /// the method with its work arrays
        method: Explicit,
        /// longest step, s
        longest: f64,
    },
    /// the production method, which chooses its steps by their error
    Implicit(Box<Implicit>),
}

impl Stepper {
    /// Takes one step of at most `most`, s, and returns its length, s. An explicit method takes all of it.
    pub fn step(&mut self, sys: &mut System, most: f64) -> Result<f64, StepError> {
        match self {
            Self::Explicit { method, .. } => {
                method.step(sys, most);
                Ok(most)
            }
            Self::Implicit(method) => method.step(sys, most),
        }
    }

    /// Goes on as another stepper of the same method would, and keeps its own work space.
    pub fn take_over_from(&mut self, other: &Self) {
        match (self, other) {
            (Self::Implicit(to), Self::Implicit(from)) => {
                (to.next, to.wanted) = (from.next, from.wanted);
                to.statistics = from.statistics;
            }
            (to, from) => *to = from.clone(),
        }
    }

    /// Whether it is the implicit method.
    pub fn is_implicit(&self) -> bool {
        matches!(self, Self::Implicit(_))
    }

    /// Whether velocities lie half a step behind positions.
    pub fn is_staggered(&self) -> bool {
        matches!(self, Self::Explicit { method, .. } if method.method() == ExplicitMethod::Verlet)
    }

    /// What the implicit method took so far; nothing for an explicit one.
    pub fn statistics(&self) -> SolverStatistics {
        match self {
            Self::Explicit { .. } => SolverStatistics::default(),
            Self::Implicit(method) => method.statistics,
        }
    }

    /// Step that the method proposes to take next, s; the longest of an explicit one.
    pub fn next(&self) -> f64 {
        match self {
            Self::Explicit { longest, .. } => *longest,
            Self::Implicit(method) => method.next,
        }
    }

    /// Length that every step has, s, where the implicit method is told to take no other.
    pub fn fixed(&self) -> Option<f64> {
        match self {
            Self::Explicit { .. } => None,
            Self::Implicit(method) => method.fixed,
        }
    }
}
