//! Steps of the method through an interval of the machine's motion.

use super::motion_profile::ROUNDING;
use super::rates::Instant;
use super::{QUIET, SimError, Simulation, WORTH_A_STEP};
use crate::integrate::{self, Implicit};
use crate::scene::Integrator;
use crate::system::Drive;

impl Simulation {
    /// Goes through the interval of `drive` in steps that the method finds fit.
    pub(super) fn through(&mut self, drive: &Drive) -> Result<(), SimError> {
        let dt = drive.duration;
        if self.broken {
            self.turn_on(dt, drive);
            return Ok(());
        }
        if self.is_quiescent() {
            self.sys.time += dt;
            return Ok(());
        }
        if self.implicit.is_some() {
            return self.through_implicit(drive);
        }
        let (count, step) = self.divide(dt);
        for _ in 0..count {
            if self.broken {
                self.turn_on(step, drive);
                continue;
            }
            self.sys.guide_nozzle(drive, step);
            self.instant = Instant::of(self);
            self.sys.set_tension = self.sys.set_tension_after(step);
            self.explicit_step(step)?;
        }
        Ok(())
    }

    fn through_implicit(&mut self, drive: &Drive) -> Result<(), SimError> {
        let dt = drive.duration;
        let course = self.sys.nozzle_course(drive);
        let mut left = dt;
        // differences of times leave a rest that is none, in which nothing can be solved for
        while left > ROUNDING * self.sys.time.max(dt) || (left == dt && dt >= WORTH_A_STEP) {
            let next = self.implicit.as_ref().map_or(left, |m| m.next);
            if let Some(course) = &course {
                course.steer(&mut self.sys, left.min(next));
            }
            self.instant = Instant::of(self);
            let taken = self.implicit_step(left.min(self.longest_return()))?;
            left = if taken >= left { 0.0 } else { left - taken };
            if self.broken {
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
        self.implicit.is_some() && self.quiet >= 2.0 * self.policy.time
    }

    /// Longest step in which wire that goes back takes no more than a quarter of the nozzle's edge, s.
    fn longest_return(&self) -> f64 {
        match (&self.sys.feed, self.sys.rod.rest.last()) {
            (Some((_, f)), Some(rest)) if f.rate < 0.0 => 0.25 * rest / -f.rate,
            _ => f64::INFINITY,
        }
    }

    /// Takes one step of at most `most`, s; returns its length, s.
    fn implicit_step(&mut self, most: f64) -> Result<f64, SimError> {
        let Some(method) = &mut self.implicit else {
            return Ok(most);
        };
        let fixed = method.fixed;
        let tried =
            |m: &Implicit| m.statistics.steps + m.statistics.rejects + m.statistics.newton_failures;
        let before = tried(method);
        let taken = method.step(&mut self.sys, most).map_err(|e| SimError {
            time: self.sys.time,
            node: Some(e.node),
            reason: match fixed {
                Some(step) => format!(
                    "{e}; solver.step = {step:.4e} s allows no shorter one, 0 leaves it to the error"
                ),
                None => e.to_string(),
            },
        })?;
        self.work += (tried(method) - before) * self.sys.rod.nodes() as u64;
        self.last_step = taken;
        self.steps += 1;
        self.watch_tension();
        self.remesh(taken)?;
        if self.work > self.most_work {
            return Err(SimError {
                time: self.sys.time,
                node: None,
                reason: format!(
                    "the work allowed ({} node steps) is used up",
                    self.most_work
                ),
            });
        }
        let still =
            self.sys.spindle.speed == 0.0 && self.sys.rod.v.iter().all(|v| v.amax() < QUIET);
        self.quiet = if still { self.quiet + taken } else { 0.0 };
        Ok(taken)
    }

    /// Splits `dt` into the fewest equal steps within the stability limit.
    fn divide(&mut self, dt: f64) -> (u64, f64) {
        let count = (dt / self.longest_step).ceil().max(1.0);
        self.last_step = dt / count;
        (count as u64, self.last_step)
    }

    fn explicit_step(&mut self, dt: f64) -> Result<(), SimError> {
        match self.scene.solver.integrator {
            Integrator::Rk4 => integrate::rk4::step(&mut self.sys, dt),
            Integrator::Verlet => integrate::verlet::step(&mut self.sys, dt),
            // a broken wire was handled above; nothing else comes here
            Integrator::Implicit => {}
        }
        self.steps += 1;
        self.watch_tension();
        self.remesh(dt)
    }
}
