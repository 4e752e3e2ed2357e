//! The choice between unknowns: code for places, and code for places and rolls, is compiled apart.
//!
//! It is made once a step, here. Within a step everything is known to the compiler.

use super::unknowns::Unknowns;
use super::work::Work;
use super::{Implicit, StepError};
#[cfg(feature = "lab")]
use super::{Scheme, probe};
use crate::math::V3;
use crate::rod::Twist;
use crate::system::System;

/// What the method does with its work arrays, whatever the unknowns.
pub(super) trait AnyWork {
    /// See [`Implicit::step`].
    fn step(
        &mut self,
        method: &mut Implicit,
        sys: &mut System,
        most: f64,
    ) -> Result<f64, StepError>;

    /// See [`Implicit::equilibrate`]; returns the solver's steps.
    fn equilibrium(
        &mut self,
        method: &mut Implicit,
        sys: &mut System,
        moved: &[V3],
        share: f64,
    ) -> Result<usize, StepError>;

    /// See [`Implicit::out_of_balance`].
    #[cfg(feature = "lab")]
    fn out_of_balance(&mut self, sys: &mut System) -> (Vec<V3>, Vec<f64>);

    /// See [`Implicit::evaluating`].
    #[cfg(feature = "lab")]
    fn evaluating(
        &mut self,
        scheme: Scheme,
        sys: &mut System,
        h: f64,
        with: &mut dyn FnMut(&mut dyn FnMut() -> f64),
    );
}

impl<const D: usize, U: Unknowns<D>> AnyWork for Work<D, U> {
    fn step(
        &mut self,
        method: &mut Implicit,
        sys: &mut System,
        most: f64,
    ) -> Result<f64, StepError> {
        method.step_with(self, sys, most)
    }

    fn equilibrium(
        &mut self,
        method: &mut Implicit,
        sys: &mut System,
        moved: &[V3],
        share: f64,
    ) -> Result<usize, StepError> {
        method.equilibrium_with(self, sys, moved, share)
    }

    #[cfg(feature = "lab")]
    fn out_of_balance(&mut self, sys: &mut System) -> (Vec<V3>, Vec<f64>) {
        probe::out_of_balance_with(self, sys)
    }

    #[cfg(feature = "lab")]
    fn evaluating(
        &mut self,
        scheme: Scheme,
        sys: &mut System,
        h: f64,
        with: &mut dyn FnMut(&mut dyn FnMut() -> f64),
    ) {
        probe::evaluating_with(scheme, self, sys, h, with);
    }
}

impl Implicit {
    /// Runs `run` with the work arrays that go with how the system carries twist.
    pub(super) fn with_work<T>(
        &mut self,
        sys: &mut System,
        run: impl FnOnce(&mut dyn AnyWork, &mut Self, &mut System) -> T,
    ) -> T {
        // (taken out while they serve the method)
        if sys.model.twist == Twist::Off {
            let mut work = std::mem::take(&mut self.work);
            let out = run(&mut work, self, sys);
            self.work = work;
            out
        } else {
            let mut work = std::mem::take(&mut self.twisted);
            let out = run(&mut work, self, sys);
            self.twisted = work;
            out
        }
    }
}
