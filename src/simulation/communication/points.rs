//! Communication points that the method's steps need not know of.
//!
//! A step costs the same however short it is. So the method steps as far as its error allows, with the inputs taken to go on as
//! they do, and communication points within a step are answered from its two ends. The winding itself stands at the end of the
//! last step that lies behind the communication point ([`Simulation::winding`]); the step beyond it is kept apart. Inputs that go
//! on otherwise drop that step, and the time that has passed since the winding's is gone through with the inputs as they were.
//! The scene's own motion never goes on otherwise; steps end where it has a kink, and at its end.

use super::ahead::Ahead;
use super::talk::{CommunicationPoint, LONGEST_WAIT};
use crate::signals::{Inputs, Outputs};
use crate::simulation::motion::{Course, Given, Likeness, MasterInputs, as_meant, check_finite};
use crate::simulation::outputs::{keep_told, rates_of};
use crate::simulation::winding::{ROUNDING, WORTH_A_STEP};
use crate::simulation::{SimError, Simulation, Winding};
use std::sync::Arc;

/// Share of the tolerance by which the wire may come out otherwise for inputs that count as gone on. Rounding does far less to
/// the inputs of a master, and a person changes them by far more.
const ALIKE: f64 = 1e-6;
/// The same for the place of the nozzle. Its way in a ramp is told in straight pieces, which part from the curve by less, and a
/// thousandth of an error moves no wire.
const NOZZLE: f64 = 1e-3;
/// Share of the tolerance by which a master that changes the tension again and again may move the wire before a step is dropped for it.
/// A solve of the method leaves as much of the tolerance unsolved.
const CORRECTION: f64 = 1e-2;
/// Communication steps above which inputs have gone on for more than one.
const MORE_THAN_ONE: f64 = 1.5;
/// Steps of the method below which a change of the inputs is worth stepping to. Chosen: four. A step beyond a change is in vain,
/// which costs a quarter more where changes are rarer.
const FEW_STEPS: f64 = 4.0;

impl Simulation {
    /// Advances by `dt`, s, with the inputs held.
    ///
    /// Spindle speed and tension hold from the start of the interval. The nozzle moves evenly and
    /// reaches its position at the end, because a jump would hit the wire.
    ///
    /// # Errors
    ///
    /// If an input or `dt` is not allowed, which changes nothing; or if the method gives up. Then the run stands where the last
    /// step ended that went through ([`Self::time`]).
    pub fn advance(&mut self, inputs: Inputs, dt: f64) -> Result<(), SimError> {
        self.advance_ramped(inputs, Inputs::HELD, dt)
    }

    /// Advances by `dt`, s, with inputs that start at `inputs` and change evenly, at `rates` per s.
    ///
    /// The nozzle moves evenly from where it is to where its input is at the end, or with the core by the scene's law
    /// ([`Self::starting_by_law`]). With `nozzle.position_at_start`, an input of its place without a rate is where it is at the start,
    /// and goes on as between the last two. Steps below a nanosecond only add up until they are worth solving for.
    ///
    /// # Errors
    ///
    /// See [`Self::advance`].
    pub fn advance_ramped(
        &mut self,
        inputs: Inputs,
        rates: Inputs,
        dt: f64,
    ) -> Result<(), SimError> {
        check_finite(&inputs, self.time())?;
        if dt.is_finite() {
            check_finite(&inputs.after(&rates, dt), self.time())?;
        }
        let given = MasterInputs::new(inputs, &rates, dt);
        let before = self.talk.given.replace(given);
        let meant = as_meant(self.scene(), inputs, rates, dt, before.as_ref());
        let gone = self.advance_as_meant(meant, dt);
        if gone.is_err() {
            self.talk.given = before;
        }
        gone
    }

    fn advance_as_meant(
        &mut self,
        (mut inputs, mut rates): (Inputs, Inputs),
        dt: f64,
    ) -> Result<(), SimError> {
        if self.now.run.nozzle_by_law {
            // (what a master says of its place is not heeded)
            inputs.nozzle_position = self.inputs().nozzle_position;
            rates.nozzle_position = 0.0;
        }
        if !self.may_step_beyond(&inputs, &rates, dt) || dt.is_nan() || dt <= 0.0 {
            return self.step_to_the_point(|winding| winding.advance_ramped(inputs, rates, dt));
        }
        check_finite(&inputs, self.time())?;
        check_finite(&inputs.after(&rates, dt), self.time())?;
        let place = (&self.inputs(), self.scene().nozzle.distance);
        let given = Given::new(self.time(), inputs, rates, dt, place);
        let goes_on = self.goes_on_as(&given, self.talk.newest(), ALIKE);
        if dt < WORTH_A_STEP && !goes_on {
            // what moves in a step that is too short to solve for moves in the next one
            self.catch_up()?;
            (self.talk.course, self.talk.travel) = (None, None);
            return self.step_to_the_point(|winding| winding.advance_ramped(inputs, rates, dt));
        }
        let before = self.talk.travel.replace((given.rates.nozzle_position, dt));
        let (told, told_tension) = (*self.outputs(), self.told_tension());
        if goes_on {
            self.talk.wait = self.talk.wait.saturating_sub(1);
        } else {
            let course = Course::from(&given, before);
            let course = match self.now.run.nozzle_by_law {
                true => course.by_law(),
                false => course,
            };
            self.change_to(course, &given)?;
        }
        if self.talk.wait > 0 {
            return self.step_to_the_point(|winding| {
                winding.advance_ramped(inputs, rates, dt)?;
                if let Some(told) = told_tension {
                    winding.run.outputs.meet_tension(told);
                }
                let both = [&told, &winding.run.outputs];
                winding.run.rates = rates_of(winding, both, dt, winding.inputs().spindle_speed);
                Ok(())
            });
        }
        self.communicate(Some(inputs.after(&rates, dt)), &told, dt)
    }

    /// Advances by `dt`, s, along the scene's own spindle ramp and traverse, which are continuous.
    ///
    /// The set tension stays what it is.
    ///
    /// # Errors
    ///
    /// See [`Self::advance`].
    pub fn advance_profile(&mut self, dt: f64) -> Result<(), SimError> {
        let of_scene = self.talk.course.is_some_and(|course| course.is_of_scene());
        if !of_scene || !self.finds_its_own_steps() {
            self.catch_up()?;
            (self.talk.course, self.talk.travel, self.talk.given) = (None, None, None);
        }
        if !self.finds_its_own_steps() || dt.is_nan() || dt <= 0.0 {
            return self.step_to_the_point(|winding| winding.advance_profile(dt));
        }
        if !of_scene {
            self.talk.course = self.now.stretch_of_scene(self.now.inputs());
        }
        let told = *self.outputs();
        self.communicate(None, &told, dt)
    }

    /// Brings the winding to the communication point, where it may be up to a step of the method behind it.
    ///
    /// # Errors
    ///
    /// If the method gives up on the way.
    pub fn catch_up(&mut self) -> Result<(), SimError> {
        if let Some(dropped) = self.ahead.take() {
            self.pool.give(dropped.winding);
        }
        let gone_along = self.talk.course;
        self.talk.turn();
        let (Some(served), Some(course)) = (self.talk.served.take(), gone_along) else {
            return Ok(());
        };
        self.talk.underway = false;
        let winding = self.pool.own(&mut self.now);
        let debt = served.time - winding.run.time;
        let gone = if debt > ROUNDING * served.time {
            winding.run.events.clear();
            winding.reset_extremes();
            let gone = winding.go_along(&course, debt);
            self.talk.events.append(&mut winding.run.events);
            gone
        } else {
            Ok(())
        };
        if gone.is_err() {
            winding.stop_short();
            return gone;
        }
        winding.sys.end_drive();
        winding.stand_at(&served);
        Ok(())
    }

    /// A copy whose winding stands at the communication point ([`Self::catch_up`]). No flag stops it on the way.
    ///
    /// # Errors
    ///
    /// If the method gives up on the way.
    pub fn caught_up(&self) -> Result<Self, SimError> {
        let mut copy = self.clone();
        if copy.time() > copy.now.run.time {
            Arc::make_mut(&mut copy.now).stop = None;
            copy.catch_up()?;
        }
        Ok(copy)
    }

    /// Lets the winding itself step to the communication point.
    fn step_to_the_point(
        &mut self,
        step: impl FnOnce(&mut Winding) -> Result<(), SimError>,
    ) -> Result<(), SimError> {
        let told = self.told_tension();
        self.catch_up()?;
        let winding = self.pool.own(&mut self.now);
        winding.run.events.clear();
        let gone = step(winding);
        if let Some(told) = told {
            winding.run.outputs.meet_tension(told);
        }
        self.talk.events.append(&mut winding.run.events);
        gone
    }

    /// The tension that was told at the last communication point, N, an end of the next step: between steps of the method it is not
    /// what the winding has there. `None` once wire has parted.
    fn told_tension(&self) -> Option<f64> {
        (!self.now.run.over).then_some(self.outputs().wire_tension)
    }

    /// Whether steps need not end at communication points, as far as inputs do not matter.
    fn finds_its_own_steps(&self) -> bool {
        let method = &self.now.stepper;
        self.steps_beyond && method.is_implicit() && method.fixed().is_none() && !self.now.run.over
    }

    /// Whether a step may reach beyond the communication point at all, when the inputs of a step of `dt`, s, change at `rates`.
    fn may_step_beyond(&self, inputs: &Inputs, rates: &Inputs, dt: f64) -> bool {
        let damped = inputs.tensioner_damping == self.inputs().tensioner_damping
            && rates.tensioner_damping == 0.0;
        let end = inputs.after(rates, dt);
        // (courses know of one damper, and of no core in their way)
        self.finds_its_own_steps() && damped && self.now.meets_circle(&end).is_none()
    }

    /// Whether a communication step goes on as `taken`, with a set tension that moves the wire by no more than a `share` of the
    /// tolerance.
    fn goes_on_as(&self, given: &Given, taken: Option<Course>, share: f64) -> bool {
        let Some(taken) = taken else {
            return false;
        };
        let end = given.start + given.dt;
        let until = self
            .ahead
            .as_ref()
            .map_or(end, |a| end.max(a.winding.run.time));
        let lever = self.now.scene.nozzle.distance;
        let tolerance = self.now.scene.solver.tolerance;
        let alike = Likeness {
            way: ALIKE * tolerance,
            nozzle: NOZZLE * tolerance,
            lever,
            tension: share * tolerance * self.now.scene.wire.ea / lever,
        };
        taken.goes_on_as(given, until, &alike)
    }

    /// Goes on along another course from the communication step `given` on.
    ///
    /// A controller changes the tension every few communication steps, mostly by little. The step under way is kept then, and the
    /// next one takes the tension up. A change that comes alone acts at once, for a master that learns from small changes.
    fn change_to(&mut self, course: Course, given: &Given) -> Result<(), SimError> {
        let before = self.talk.newest().map(|course| course.begun);
        let went_on = before.map_or(f64::INFINITY, |begun| course.begun - begun);
        let lasted = std::mem::replace(&mut self.talk.lasted, went_on);
        let little = went_on < self.now.stepper.next()
            && self.goes_on_as(given, self.talk.course, CORRECTION);
        if !self.talk.may_wait(little, self.ahead.is_some()) {
            let even = (went_on - lasted).abs() <= ROUNDING * course.begun;
            return self.turn_to(course, given.dt, even);
        }
        self.talk.wait = 0;
        if self.ahead.is_some() {
            self.talk.turned = Some(course);
            return Ok(());
        }
        self.catch_up()?;
        self.talk.course = Some(course);
        Ok(())
    }

    /// Begins another course with a communication step of `dt`, s: what has passed since the winding's time is gone through along
    /// the one before.
    ///
    /// The first step of a course that follows another ends at its communication point, for two reasons. Inputs that have just changed
    /// often change again. And what a master learns from small changes of a step is not blurred by the line between two ends.
    ///
    /// A controller is slower than the master that steps it. Where a course went on for several communication steps, and either as
    /// long as the one before (`even`) or for few steps of the method, the next is taken to go on as long. The method steps to
    /// its end then.
    fn turn_to(&mut self, course: Course, dt: f64, even: bool) -> Result<(), SimError> {
        if self.ahead.is_some() {
            self.talk.waited = (2 * self.talk.waited).clamp(1, LONGEST_WAIT);
        }
        let (mut course, went_on) = (course, self.talk.lasted);
        if went_on.is_finite() {
            self.talk.wait = self.talk.waited.max(1);
            let few = went_on < FEW_STEPS * self.now.stepper.next();
            if went_on > MORE_THAN_ONE * dt && (even || few) {
                // (without mass the tension jumps with its inputs: a line from before the change says nothing)
                let least = u32::from(self.now.scene.tensioner.mass == 0.0);
                self.talk.wait = self.talk.waited.max(least);
                course = course.as_long_as(went_on);
            }
        }
        self.catch_up()?;
        self.talk.course = Some(course);
        Ok(())
    }

    /// The course at the winding's time. Where a stretch of the scene's own motion or of the nozzle's law has ended, the next begins.
    fn course_from_here(&mut self) -> Option<Course> {
        let (course, time) = (self.talk.course?, self.now.run.time);
        if course.ends_by(time) {
            self.talk.course = match course.is_by_law() {
                true => Some(self.now.along_law(course)),
                false => self.now.stretch_of_scene(course.at(time)),
            };
        }
        self.talk.course
    }

    /// Goes on to the next communication point, `dt`, s, away, in steps that need not end there. The inputs at that point are
    /// `inputs`, or those of the course; `told` was at the last.
    fn communicate(
        &mut self,
        inputs: Option<Inputs>,
        told: &Outputs,
        dt: f64,
    ) -> Result<(), SimError> {
        let mut served = self
            .talk
            .served
            .unwrap_or_else(|| CommunicationPoint::at(&self.now));
        served.begin(dt, &self.now);
        if !self.now.run.over {
            served.outputs.meet_tension(told.wire_tension);
        }
        let point = served.time;
        let near = ROUNDING * point;
        let speed_before = served.inputs.spindle_speed;
        loop {
            if let Some(ahead) = self.ahead.take() {
                if ahead.winding.run.time > point + near {
                    self.ahead = Some(ahead);
                    break;
                }
                let behind = std::mem::replace(&mut self.now, ahead.winding);
                self.pool.give(behind);
                self.talk.events.extend_from_slice(&self.now.run.events);
                self.talk.kept();
                served.pass(&self.now);
                continue;
            }
            let Some(course) = self.course_from_here() else {
                return Ok(());
            };
            let room = point - self.now.run.time;
            if room <= near || self.now.rests_along(&course) {
                break;
            }
            if self.now.run.over {
                self.talk.served = Some(served);
                self.catch_up()?;
                let winding = self.pool.own(&mut self.now);
                let speed = winding.inputs().spindle_speed;
                winding.run.acceleration = (speed - speed_before) / dt;
                winding.let_go();
                let both = [told, &winding.run.outputs];
                winding.run.rates = rates_of(winding, both, dt, speed);
                return Ok(());
            }
            let first = !std::mem::replace(&mut self.talk.underway, true);
            let stepped = if self.now.stepper.next() > room {
                self.step_ahead(course, first)
            } else {
                let winding = self.pool.own(&mut self.now);
                winding.run.events.clear();
                let stepped = winding.step_along(&course, first);
                self.talk.events.extend_from_slice(&winding.run.events);
                served.pass(winding);
                stepped
            };
            if let Err(error) = stepped {
                let winding = self.pool.own(&mut self.now);
                winding.stop_short();
                (self.talk.served, self.talk.course) = (None, None);
                return Err(error);
            }
        }
        let Some(course) = self.talk.course else {
            return Ok(());
        };
        let there = course.at(point);
        let mut inputs = inputs.unwrap_or(there);
        if course.is_by_law() {
            inputs.nozzle_position = there.nozzle_position;
        }
        let end = self.ahead.as_ref().map(|ahead| &*ahead.winding);
        let acceleration = (inputs.spindle_speed - speed_before) / dt;
        served.read(&self.now, end, &course, (inputs, acceleration));
        let both = [told, &served.outputs];
        served.rates = rates_of(&self.now, both, dt, inputs.spindle_speed);
        self.talk.served = Some(served);
        Ok(())
    }

    fn step_ahead(&mut self, course: Course, first: bool) -> Result<(), SimError> {
        match Ahead::of(self.pool.copy(&self.now), course, first) {
            Ok(ahead) => {
                self.ahead = Some(ahead);
                Ok(())
            }
            Err((winding, error)) => {
                self.now = winding;
                self.talk.events.extend_from_slice(&self.now.run.events);
                Err(error)
            }
        }
    }
}

impl Winding {
    /// Goes along `course` for `duration`, s, and no farther.
    fn go_along(&mut self, course: &Course, duration: f64) -> Result<(), SimError> {
        if course.is_of_scene() {
            return self.go_along_scene(duration);
        }
        let drive = course.drive(self.run.time, duration);
        match course.is_by_law() {
            true => self.follow_by_law(&drive),
            false => self.go_through(&drive),
        }
    }

    /// Goes along the scene's own motion for `duration`, s, and no farther.
    fn go_along_scene(&mut self, duration: f64) -> Result<(), SimError> {
        let (profile, start) = (self.motion_profile.clone(), self.run.time);
        let mut drives = profile.drives(start, start + duration, self.sys.state.set_tension);
        drives.try_for_each(|drive| self.go_through(&drive))
    }

    /// The scene's own motion from the winding's time to its next kink or its end, where the inputs are those of `now`.
    fn stretch_of_scene(&self, now: Inputs) -> Option<Course> {
        let (profile, time) = (&self.motion_profile, self.run.time);
        let tension = self.sys.state.set_tension;
        let drive = profile.drives(time, f64::INFINITY, tension).next()?;
        Some(Course::of_scene(&drive, time, profile.end(), now))
    }

    /// Takes a communication point for the present instant.
    fn stand_at(&mut self, point: &CommunicationPoint) {
        (self.run.time, self.run.time_lost) = (point.time, point.time_lost);
        self.sys.state.spindle.speed = point.inputs.spindle_speed;
        self.sys.state.set_tension = point.inputs.tension_setpoint;
        self.sys.state.support[1].point.y = point.inputs.nozzle_position;
        self.put_aside(&point.inputs);
        self.update_at_point();
        let mut told = *point;
        told.outputs.meet_tension(self.run.outputs.wire_tension);
        keep_told(&mut self.run.outputs, &told.outputs);
        self.run.rates = point.rates;
    }
}
