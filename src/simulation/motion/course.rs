//! The motion of the machine from one instant on: as a master gives it, until it says otherwise, or a stretch of the scene's own.

use super::master_inputs::check_finite;
use super::nozzle_place::OFFSET_ROUNDING;
use crate::signals::Inputs;
use crate::simulation::winding::ROUNDING;
use crate::system::{Drive, NozzleDrive};
use serde::{Deserialize, Serialize};

/// Even acceleration of the spindle and, along the core's axis, of the nozzle, an even way of the nozzle aside, and an even change of the
/// set tension, from `start` on.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(in crate::simulation) struct Course {
    /// time of the run at which a master began it, s
    pub(in crate::simulation) begun: f64,
    /// time of the run at which its inputs are as said here, s
    start: f64,
    /// speed, nozzle position and offsets, and set tension then
    inputs: Inputs,
    /// their rates then, per s
    rates: Inputs,
    /// of the nozzle along the axis, m/s2
    acceleration: f64,
    source: Source,
    /// when the nozzle's way has its next corner, or a stretch of the scene's own motion ends, s; none for what a master gives, and
    /// for a nozzle by law whose place on it has not been looked up
    until: Option<f64>,
    /// when a master that changes its inputs in even intervals changes them next, s
    next: Option<f64>,
}

/// Where a motion comes from.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
enum Source {
    /// the inputs of a master
    Master,
    /// the inputs of a master, and the scene's law for the nozzle
    MasterAndLaw,
    /// the scene's own motion
    Scene,
}

/// A communication step as a master gives it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::simulation) struct Given {
    /// time of the run at which it begins, s
    pub(in crate::simulation) start: f64,
    /// its length, s
    pub(in crate::simulation) dt: f64,
    /// speed and set tension at its start, and where the nozzle is then
    pub(super) inputs: Inputs,
    /// rates of speed and set tension, and the mean velocities of the nozzle, per s
    pub(in crate::simulation) rates: Inputs,
}

/// By how much inputs may differ and still be those of a course.
#[derive(Clone, Copy, Debug)]
pub(in crate::simulation) struct Likeness {
    /// of the wire, m
    pub(in crate::simulation) way: f64,
    /// of the nozzle, m
    pub(in crate::simulation) nozzle: f64,
    /// farthest wire from the core's axis, m
    pub(in crate::simulation) lever: f64,
    /// of the set tension, N
    pub(in crate::simulation) tension: f64,
}

impl Given {
    /// A step of `dt`, s, from `start` with `inputs` and their `rates`, by which the nozzle goes evenly from where it is by the inputs
    /// `now` to where its inputs are at the end. It is `distance`, m, from the axis without offsets.
    pub(in crate::simulation) fn new(
        start: f64,
        inputs: Inputs,
        rates: Inputs,
        dt: f64,
        (now, distance): (&Inputs, f64),
    ) -> Self {
        let end = inputs.after(&rates, dt);
        let aside = |from: f64, to: f64| match (to - from).abs() <= OFFSET_ROUNDING * distance {
            true => 0.0,
            false => (to - from) / dt,
        };
        Self {
            start,
            dt,
            inputs: Inputs {
                nozzle_position: now.nozzle_position,
                nozzle_offset_x: now.nozzle_offset_x,
                nozzle_offset_z: now.nozzle_offset_z,
                ..inputs
            },
            rates: Inputs {
                nozzle_position: (end.nozzle_position - now.nozzle_position) / dt,
                nozzle_offset_x: aside(now.nozzle_offset_x, end.nozzle_offset_x),
                nozzle_offset_z: aside(now.nozzle_offset_z, end.nozzle_offset_z),
                ..rates
            },
        }
    }

    fn at(&self, time: f64) -> Inputs {
        self.inputs.after(&self.rates, time - self.start)
    }
}

impl Course {
    /// What the inputs of a step are taken to go on as, when its nozzle went at `before` (m/s) for some time (s). The nozzle of
    /// a spindle that speeds up does so too, as far as the means over both steps tell.
    pub(in crate::simulation) fn from(given: &Given, before: Option<(f64, f64)>) -> Self {
        let acceleration = match before {
            Some((velocity, dt)) if given.rates.spindle_speed != 0.0 => {
                (given.rates.nozzle_position - velocity) / (0.5 * (given.dt + dt))
            }
            _ => 0.0,
        };
        let mut rates = given.rates;
        rates.nozzle_position -= 0.5 * acceleration * given.dt;
        Self {
            begun: given.start,
            start: given.start,
            inputs: given.inputs,
            rates,
            acceleration,
            source: Source::Master,
            until: None,
            next: None,
        }
    }

    /// The same with the nozzle on the scene's law, wherever that has it.
    pub(in crate::simulation) fn by_law(self) -> Self {
        Self {
            source: Source::MasterAndLaw,
            ..self
        }
    }

    /// The same from `time`, s, on, when the nozzle is at `nozzle`, m, and goes with the core by the `part` of its law.
    pub(super) fn along(self, part: &Drive, time: f64, nozzle: f64) -> Self {
        let travel = part.travel().unwrap_or(0.0);
        let mut now = self.at(time);
        now.nozzle_position = nozzle;
        Self {
            start: time,
            inputs: now,
            rates: Inputs {
                nozzle_position: travel * now.spindle_speed,
                ..self.rates
            },
            acceleration: travel * self.rates.spindle_speed,
            until: Some(time + part.duration),
            ..self
        }
    }

    /// The same, which goes on for as long as the one before, s, if a master changes its inputs in even intervals.
    pub(in crate::simulation) fn as_long_as(self, before: f64) -> Self {
        Self {
            next: Some(self.begun + before),
            ..self
        }
    }

    /// The stretch of the scene's own motion that begins at `start`, s, as `drive` has it, with the inputs as they are `now`. It ends
    /// where the `end` of that motion, s, is still to come and comes first.
    pub(in crate::simulation) fn of_scene(
        drive: &Drive,
        start: f64,
        end: f64,
        now: Inputs,
    ) -> Self {
        let travel = drive.travel().unwrap_or(0.0);
        let until = start + drive.duration;
        let is_over = end - start <= ROUNDING * end;
        Self {
            begun: start,
            start,
            inputs: Inputs {
                spindle_speed: drive.speed,
                ..now
            },
            rates: Inputs {
                spindle_speed: drive.acceleration,
                nozzle_position: travel * drive.speed,
                ..Inputs::HELD
            },
            acceleration: travel * drive.acceleration,
            source: Source::Scene,
            until: Some(if is_over { until } else { until.min(end) }),
            next: None,
        }
    }

    /// Whether it is a stretch of the scene's own motion.
    pub(in crate::simulation) fn is_of_scene(&self) -> bool {
        self.source == Source::Scene
    }

    /// Whether the nozzle follows the scene's law in it.
    pub(in crate::simulation) fn is_by_law(&self) -> bool {
        self.source == Source::MasterAndLaw
    }

    /// Whether it says nothing of the motion from `time`, s, on.
    pub(in crate::simulation) fn ends_by(&self, time: f64) -> bool {
        match self.until {
            Some(until) => until - time <= ROUNDING * time,
            None => self.is_by_law(),
        }
    }

    /// How much of it is left at `time`, s.
    fn left(&self, time: f64) -> f64 {
        self.until.map_or(f64::INFINITY, |until| until - time)
    }

    /// How far a step may go from `time` on, s: to its end, and to where the inputs may change.
    pub(in crate::simulation) fn ahead_of(&self, time: f64) -> f64 {
        let change = self.next.map(|next| next - time);
        let change = change.filter(|left| *left > ROUNDING * time);
        self.left(time).min(change.unwrap_or(f64::INFINITY))
    }

    /// Speed, nozzle position and offsets, and set tension at `time`, s.
    pub(in crate::simulation) fn at(&self, time: f64) -> Inputs {
        let gone = time - self.start;
        let mut inputs = self.inputs.after(&self.rates, gone);
        inputs.nozzle_position += 0.5 * self.acceleration * gone * gone;
        inputs
    }

    /// The motion over `duration`, s, from `time`, s, on.
    pub(in crate::simulation) fn drive(&self, time: f64, duration: f64) -> Drive {
        let inputs = self.at(time);
        let middle = time + 0.5 * duration - self.start;
        Drive {
            duration,
            speed: inputs.spindle_speed,
            acceleration: self.rates.spindle_speed,
            nozzle: NozzleDrive::Even(self.rates.nozzle_position + self.acceleration * middle),
            aside: [self.rates.nozzle_offset_x, self.rates.nozzle_offset_z],
            tension: inputs.tension_setpoint,
            tension_rate: self.rates.tension_setpoint,
        }
    }

    /// Angle that the spindle turns by from one time to another, s, in rad.
    pub(in crate::simulation) fn turned(&self, from: f64, to: f64) -> f64 {
        let half = 0.5 * (to - from);
        self.at(from + half).spindle_speed * (to - from)
    }

    /// Whether it is a motion at all; bytes from elsewhere may say anything.
    pub(in crate::simulation) fn is_sound(&self) -> bool {
        let held = Inputs {
            tension_setpoint: 0.0,
            ..self.rates
        };
        self.start.is_finite()
            && self.begun.is_finite()
            && self.until.is_none_or(|until| until > self.start)
            && (self.until.is_some() || !self.is_of_scene())
            && self.next.is_none_or(|next| next > self.begun)
            && self.acceleration.is_finite()
            && self.rates.tension_setpoint.is_finite()
            && check_finite(&self.inputs, 0.0).is_ok()
            && check_finite(&held, 0.0).is_ok()
    }

    /// Whether nothing moves or changes.
    pub(in crate::simulation) fn is_still(&self) -> bool {
        self.inputs.spindle_speed == 0.0 && self.rates == Inputs::HELD && self.acceleration == 0.0
    }

    /// Whether a step is this course gone on, at its end and, with the inputs going on from there, until `until`, s.
    pub(in crate::simulation) fn goes_on_as(
        &self,
        given: &Given,
        until: f64,
        alike: &Likeness,
    ) -> bool {
        if self.is_of_scene() {
            return false;
        }
        let (start, end) = (given.start, given.start + given.dt);
        let nozzle = [start, end].map(|time| {
            let (here, there) = (self.at(time), given.at(time));
            let along = here.nozzle_position - there.nozzle_position;
            let aside = libm::hypot(
                here.nozzle_offset_x - there.nozzle_offset_x,
                here.nozzle_offset_z - there.nozzle_offset_z,
            );
            (self.is_by_law() || along.abs() <= alike.nozzle) && aside <= alike.nozzle
        });
        let [slow, fast] = [start, until].map(|time| {
            let apart = self.at(time).spindle_speed - given.at(time).spindle_speed;
            alike.lever * (apart * (until - start)).abs() <= alike.way
        });
        let tension = [start, until].map(|time| {
            let apart = self.at(time).tension_setpoint - given.at(time).tension_setpoint;
            apart.abs() <= alike.tension
        });
        nozzle == [true; 2] && tension == [true; 2] && slow && fast
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    const ALIKE: Likeness = Likeness {
        way: 1e-12,
        nozzle: 1e-9,
        lever: 0.06,
        tension: 1e-6,
    };

    fn inputs(speed: f64, nozzle: f64) -> Inputs {
        Inputs {
            spindle_speed: speed,
            nozzle_position: nozzle,
            tension_setpoint: 15.0,
            ..Inputs::HELD
        }
    }

    /// A step at whose start the nozzle is at `nozzle`, m, and has no offsets.
    fn given(start: f64, inputs: Inputs, rates: Inputs, dt: f64, nozzle: f64) -> Given {
        let now = Inputs {
            nozzle_position: nozzle,
            ..Inputs::HELD
        };
        Given::new(start, inputs, rates, dt, (&now, 0.06))
    }

    #[test]
    fn even_motion_told_in_pieces_is_one_course() {
        let (dt, speed, travel) = (1e-4, 30.0, 0.7e-3 / 0.2);
        let y = |t: f64| 1e-3 + travel * (t - 0.1);
        let step = |t: f64| given(t, inputs(speed, y(t + dt)), Inputs::HELD, dt, y(t));
        let first = Course::from(&step(0.1), None);
        for k in 1..1000 {
            let t = 0.1 + f64::from(k) * dt;
            assert!(first.goes_on_as(&step(t), t + 3.0 * dt, &ALIKE), "{k}");
        }
    }

    /// A nozzle that goes with a spindle which speeds up is told its place at the end of each step.
    #[test]
    fn a_ramp_told_in_pieces_is_one_course_from_the_second_on() {
        let (dt, rate, travel) = (2e-5, 300.0, 0.7e-3 / TAU);
        let rates = Inputs {
            spindle_speed: rate,
            ..Inputs::HELD
        };
        let y = |t: f64| travel * 0.5 * rate * t * t;
        let step = |k: u32| {
            let t = f64::from(k) * dt;
            let mut end = inputs(rate * t, y(t + dt));
            end.spindle_speed = rate * t;
            given(t, end, rates, dt, y(t))
        };
        let before = (step(7).rates.nozzle_position, dt);
        let course = Course::from(&step(8), Some(before));
        for k in 9..500 {
            let end = step(k).start + 3.0 * dt;
            assert!(course.goes_on_as(&step(k), end, &ALIKE), "{k}");
        }
        let end = step(500);
        let mean = course.drive(end.start, dt).nozzle;
        let NozzleDrive::Even(velocity) = mean else {
            panic!("{mean:?}")
        };
        assert!((velocity - end.rates.nozzle_position).abs() < 1e-9);
    }

    #[test]
    fn another_speed_place_or_tension_is_another_course() {
        let dt = 1e-4;
        let step = |t, inputs, rates| given(t, inputs, rates, dt, 0.0);
        let first = Course::from(&step(0.0, inputs(30.0, 0.0), Inputs::HELD), None);
        let differs = |other: Inputs, rates: Inputs| {
            !first.goes_on_as(&step(dt, other, rates), 3.0 * dt, &ALIKE)
        };
        assert!(!differs(inputs(30.0, 0.0), Inputs::HELD));
        assert!(differs(inputs(30.0 + 1e-6, 0.0), Inputs::HELD));
        assert!(differs(inputs(30.0, 1e-8), Inputs::HELD));
        let pull = Inputs {
            tension_setpoint: 15.001,
            ..inputs(30.0, 0.0)
        };
        assert!(differs(pull, Inputs::HELD));
        let faster = Inputs {
            spindle_speed: 1.0,
            ..Inputs::HELD
        };
        assert!(differs(inputs(30.0, 0.0), faster));
        // as fast on the mean, and not in between
        let swings = Inputs {
            spindle_speed: 2.0 / dt,
            ..Inputs::HELD
        };
        assert!(differs(inputs(30.0 - 2.0, 0.0), swings));
    }

    #[test]
    fn a_ramp_turns_as_its_mean() {
        let rates = Inputs {
            spindle_speed: 1000.0,
            ..Inputs::HELD
        };
        let ramp = Course::from(&given(0.0, inputs(10.0, 0.0), rates, 1e-3, 0.0), None);
        assert!((ramp.turned(0.0, 0.1) - (1.0 + 5.0)).abs() < 1e-12);
        assert_eq!(ramp.drive(0.01, 1.0).speed, 20.0);
    }
}
