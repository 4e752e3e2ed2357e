//! A step of the method that reaches beyond the communication point, and what is read between its ends.

use crate::math::wrap_to_pi;
use crate::signals::Outputs;
use crate::simulation::motion::Course;
use crate::simulation::{SimError, Winding};
use std::sync::Arc;

/// A winding one step of the method ahead, along a course that may turn out to be another.
#[derive(Clone, Debug)]
pub(in crate::simulation) struct Ahead {
    pub(super) winding: Arc<Winding>,
    /// what the inputs were taken to go on as
    pub(in crate::simulation) course: Course,
    /// whether the step was the first along its course
    pub(in crate::simulation) first: bool,
}

impl Ahead {
    /// Lets a copy of a winding take a step along the course.
    ///
    /// # Errors
    ///
    /// If the method finds no step; the winding that comes with the reason stands where it gave up.
    pub(in crate::simulation) fn of(
        mut copy: Arc<Winding>,
        course: Course,
        first: bool,
    ) -> Result<Self, (Arc<Winding>, SimError)> {
        let winding = Arc::make_mut(&mut copy);
        winding.run.events.clear();
        let stepped = winding.step_along(&course, first);
        match stepped {
            Ok(()) => Ok(Self {
                winding: copy,
                course,
                first,
            }),
            Err(error) => Err((copy, error)),
        }
    }
}

impl Winding {
    /// Takes a step of the method along `course`, however long, and reads the outputs at its end.
    ///
    /// # Errors
    ///
    /// If the method finds no step.
    pub(super) fn step_along(&mut self, course: &Course, first: bool) -> Result<(), SimError> {
        self.take_course(course, first);
        self.reset_extremes();
        let most = course.ahead_of(self.run.time).min(self.longest_return());
        let most = most.min(self.clear_of_circle(course));
        self.step(most)?;
        (self.run.time, self.run.time_lost) = (self.sys.state.time, 0.0);
        // (the step has taken along what shorter ones before it left)
        self.run.owed = 0.0;
        self.update_outputs();
        Ok(())
    }

    /// Whether nothing moves, and nothing will along `course`.
    ///
    /// What has passed since the winding's time is gone through along the course before, and may bring it to rest under the tension of
    /// that one.
    pub(super) fn rests_along(&self, course: &Course) -> bool {
        self.is_quiescent() && self.is_left_alone_by(course)
    }

    fn is_left_alone_by(&self, course: &Course) -> bool {
        course.is_still() && course.at(self.run.time).tension_setpoint == self.sys.state.set_tension
    }

    fn take_course(&mut self, course: &Course, first: bool) {
        let drive = course.drive(self.run.time, self.stepper.next());
        if !self.is_left_alone_by(course) {
            self.run.quiet = 0.0;
        }
        self.run.acceleration = drive.acceleration;
        if first {
            self.begin_drive(&drive);
        } else {
            let now = course.at(self.run.time);
            self.sys.continue_drive(&drive, now.nozzle_position);
            self.put_aside(&now);
        }
    }

    /// How long the nozzle may go along `course` in one step, s, until it would meet the core or wire on it.
    fn clear_of_circle(&self, course: &Course) -> f64 {
        let reach = self.stepper.next();
        if course.drive(self.run.time, reach).aside == [0.0; 2] {
            return f64::INFINITY;
        }
        let end = course.at(self.run.time + reach);
        self.meets_circle(&end)
            .map_or(f64::INFINITY, |share| share * reach)
    }
}

/// Outputs a `share` of the way from one end of a step to the other: what follows the wire goes evenly, what is counted is that
/// of the start. The tension rings from step to step, so that a parabola through three ends is off by as much as a line through two.
///
/// The spindle has turned by `angle`, rad, there, and winds towards positive angles or negative ones (`winds`, 1 or -1).
pub(super) fn between(
    [start, end]: [&Outputs; 2],
    share: f64,
    (angle, winds): (f64, f64),
) -> Outputs {
    let even = |a: f64, b: f64| a + share * (b - a);
    let (a, b) = (start.smooth(), end.smooth());
    let between = start.with_smooth(std::array::from_fn(|k| even(a[k], b[k])));
    // Where wire lands on the next corner, its place goes far in a step: it goes round with core and wire all the same.
    let polar = |o: &Outputs| libm::atan2(o.layon_z, o.layon_x);
    let off = |o: &Outputs| polar(o) + o.spindle_angle - winds * o.layon_angle;
    let apart = share * wrap_to_pi(off(end) - off(start));
    let there = off(start) + apart + winds * between.layon_angle - angle;
    let radius = libm::hypot(between.layon_x, between.layon_z);
    // The next layer begins where the step ends.
    let since = between.turns_wound - start.turns_wound;
    Outputs {
        layon_x: radius * libm::cos(there),
        layon_z: radius * libm::sin(there),
        turn_in_layer: (start.turn_in_layer + since).max(0.0),
        ..between
    }
}
