//! Steps of the method through an interval of the machine's motion.

#[cfg(feature = "lab")]
mod trail_keeping;
mod trouble;

use crate::integrate::Stepper;
use crate::simulation::winding::{ROUNDING, WORTH_A_STEP};
use crate::simulation::{SimError, Winding};
use crate::system::Drive;
use std::sync::atomic::Ordering::Relaxed;

/// Speed below which wire on a standing core counts as quiet, m/s.
///
/// In a second such wire moves by less than the error that one step may have.
const QUIET: f64 = 1e-6;

impl Winding {
    /// Goes through the interval of `drive` in steps that the method finds fit.
    pub(super) fn through(&mut self, drive: &Drive) -> Result<(), SimError> {
        let dt = drive.duration;
        if self.run.over {
            self.turn_on(dt, drive);
            return Ok(());
        }
        if self.is_quiescent() {
            self.sys.state.time += dt;
            return Ok(());
        }
        match self.stepper {
            Stepper::Explicit { longest, .. } => self.through_evenly(drive, longest),
            Stepper::Implicit(_) => self.through_by_error(drive),
        }
    }

    /// Goes through the interval of `drive` in the fewest equal steps that are no longer than `longest`, s.
    fn through_evenly(&mut self, drive: &Drive, longest: f64) -> Result<(), SimError> {
        let count = (drive.duration / longest).ceil().max(1.0);
        let step = drive.duration / count;
        for _ in 0..count as u64 {
            if self.run.over {
                self.turn_on(step, drive);
                continue;
            }
            self.sys.guide_nozzle(drive, step);
            self.sys.state.set_tension = self.sys.set_tension_after(step);
            self.step(step)?;
        }
        Ok(())
    }

    /// Goes through the interval of `drive` in steps whose length the method finds by their error.
    fn through_by_error(&mut self, drive: &Drive) -> Result<(), SimError> {
        let dt = drive.duration;
        let course = self.sys.nozzle_course(drive);
        let mut left = dt;
        // differences of times leave a rest that is none, in which nothing can be solved for
        while left > ROUNDING * self.sys.state.time.max(dt) || (left == dt && dt >= WORTH_A_STEP) {
            if let Some(course) = &course {
                course.steer(&mut self.sys, left.min(self.stepper.next()));
            }
            let taken = self.step(left.min(self.longest_return()))?;
            left = if taken >= left { 0.0 } else { left - taken };
            if self.run.over {
                self.turn_on(left, drive);
                break;
            }
        }
        if let Some(course) = &course {
            course.arrive(&mut self.sys);
        }
        Ok(())
    }

    /// Whether the state stays as it is until an input changes.
    ///
    /// Nothing has moved for two windows of rest detection, so all wire that may freeze has frozen, and no input
    /// has changed since. A vibration's turning point is over in a fraction of a window.
    pub(super) fn is_quiescent(&self) -> bool {
        self.stepper.is_implicit() && self.run.quiet >= 2.0 * self.run.policy.time
    }

    /// Longest step in which wire that goes back takes no more than a quarter of the nozzle's edge, s.
    pub(super) fn longest_return(&self) -> f64 {
        match (&self.sys.state.feed, self.sys.state.rod.rest.last()) {
            (Some(f), Some(rest)) if f.rate < 0.0 => 0.25 * rest / -f.rate,
            _ => f64::INFINITY,
        }
    }

    /// Takes one step of at most `most`, s, and remeshes after it; returns its length, s.
    pub(super) fn step(&mut self, most: f64) -> Result<f64, SimError> {
        if self.stop.as_ref().is_some_and(|flag| flag.load(Relaxed)) {
            return Err(SimError {
                time: self.sys.state.time,
                node: None,
                reason: "interrupted".to_owned(),
            });
        }
        let counts = self.stepper.statistics();
        #[cfg(feature = "lab")]
        let before = self.begin_trail();
        let taken = self.stepper.step(&mut self.sys, most).map_err(|e| {
            self.tell_of_failure(counts);
            SimError {
                time: self.sys.state.time,
                node: Some(e.node),
                reason: match self.stepper.fixed() {
                    Some(step) => format!(
                        "{e}; solver.step = {step:.4e} s is fixed, set it to 0 to let the solver take shorter steps"
                    ),
                    None => e.to_string(),
                },
            }
        })?;
        #[cfg(feature = "lab")]
        self.end_trail(before);
        self.run.work += (self.stepper.statistics().tried() - counts.tried())
            * self.sys.state.rod.nodes() as u64;
        self.run.last_step = taken;
        self.run.steps += 1;
        self.tell_of_trouble(counts, taken);
        self.watch_ends();
        self.watch_tension();
        self.remesh(taken)?;
        self.follow_traverse();
        self.raise_flags();
        if self.run.work > self.most_work {
            return Err(SimError {
                time: self.sys.state.time,
                node: None,
                reason: format!(
                    "the work allowed ({} steps times nodes) is used up; allow more or wind fewer turns",
                    self.most_work
                ),
            });
        }
        // a tensioner that nothing holds goes on where the wire hangs slack
        let coasts = self
            .sys
            .state
            .feed
            .is_some_and(|feed| feed.paid_rate.abs() >= QUIET);
        let still = !coasts
            && self.sys.state.spindle.speed == 0.0
            && self.sys.state.rod.v.iter().all(|v| v.amax() < QUIET);
        self.run.quiet = if still { self.run.quiet + taken } else { 0.0 };
        Ok(taken)
    }
}
