//! Explicit steps, and how long one may be.

mod rk4;
mod stability;
mod verlet;

pub use stability::{RK4_LIMIT, VERLET_LIMIT, highest_frequency, longest_step};
pub use verlet::shift_velocities;

use crate::system::System;

/// Which explicit method.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExplicitMethod {
    /// classical Runge-Kutta of order four
    Rk4,
    /// velocity Verlet in staggered form
    Verlet,
}

impl ExplicitMethod {
    /// Stability limit on an undamped oscillation: step times angular frequency.
    pub fn limit(self) -> f64 {
        match self {
            Self::Rk4 => RK4_LIMIT,
            Self::Verlet => VERLET_LIMIT,
        }
    }
}

/// An explicit method with its work arrays.
#[derive(Debug)]
pub struct Explicit {
    method: ExplicitMethod,
    stages: rk4::Stages,
}

/// A copy has the method and empty work arrays.
impl Clone for Explicit {
    fn clone(&self) -> Self {
        Self::new(self.method)
    }
}

impl Explicit {
    /// The method with empty work arrays.
    pub fn new(method: ExplicitMethod) -> Self {
        Self {
            method,
            stages: rk4::Stages::default(),
        }
    }

    /// Which method it is.
    pub fn method(&self) -> ExplicitMethod {
        self.method
    }

    /// Advances by `dt`, s. Forces must be evaluated on entry ([`System::evaluate`]) and are on exit.
    pub fn step(&mut self, sys: &mut System, dt: f64) {
        match self.method {
            ExplicitMethod::Rk4 => rk4::step(sys, &mut self.stages, dt),
            ExplicitMethod::Verlet => verlet::step(sys, dt),
        }
    }
}
