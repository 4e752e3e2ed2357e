//! The motion that a machine gives to spindle, nozzle and tensioner over an interval.

use super::System;
use crate::math::V3;

/// Motion of the nozzle along +y over an interval, the direction of the traverse.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NozzleDrive {
    /// Constant velocity, m/s. It may differ from that of the interval before.
    Even(f64),
    /// Travel per angle of the spindle, m/rad. The motion goes on smoothly from the interval before.
    WithSpindle(f64),
}

/// Motion of spindle, nozzle and set tension over an interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drive {
    /// length of the interval, s
    pub duration: f64,
    /// speed of the spindle at its start, rad/s
    pub speed: f64,
    /// acceleration of the spindle, rad/s^2
    pub acceleration: f64,
    /// motion of the nozzle along the core axis
    pub nozzle: NozzleDrive,
    /// velocity of the nozzle along x and z, m/s
    pub aside: [f64; 2],
    /// set pull of the tensioner at the start, N
    pub tension: f64,
    /// rate of the set pull, N/s
    pub tension_rate: f64,
}

/// The line in the plane of core angle and nozzle position that a nozzle coupled to the spindle follows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct NozzleCourse {
    /// travel per core angle, m/rad
    travel: f64,
    /// nozzle position at the start of the interval, m
    position: f64,
    /// core angle at the start of the interval, rad
    angle: f64,
    /// velocity along x and z, m/s
    aside: [f64; 2],
}

impl Drive {
    /// Velocity of a nozzle that goes at this one along the core axis, m/s.
    fn velocity(&self, along: f64) -> V3 {
        let [x, z] = self.aside;
        V3::new(x, along, z)
    }

    /// Travel of the nozzle per core angle, m/rad; `None` where it moves on its own or not at all.
    pub(crate) fn travel(&self) -> Option<f64> {
        match self.nozzle {
            NozzleDrive::WithSpindle(travel) if travel != 0.0 => Some(travel),
            NozzleDrive::WithSpindle(_) | NozzleDrive::Even(_) => None,
        }
    }
}

impl System {
    /// Gives spindle, nozzle and tensioner the motion that they have at the start of `drive`.
    pub fn begin_drive(&mut self, drive: &Drive) {
        self.state.spindle.speed = drive.speed;
        self.state.spindle.acceleration = drive.acceleration;
        self.state.set_tension = drive.tension;
        self.state.set_rate = drive.tension_rate;
        match drive.nozzle {
            NozzleDrive::Even(velocity) => {
                // speeds may jump here: held nodes take theirs over before the nozzle sets off
                self.place_supports();
                self.state.support[1].velocity = drive.velocity(velocity);
            }
            // nobody steers it: it stands, whatever it did in the interval before
            NozzleDrive::WithSpindle(0.0) => self.state.support[1].velocity = drive.velocity(0.0),
            NozzleDrive::WithSpindle(_) => {}
        }
    }

    /// Gives spindle, nozzle and tensioner the motion of `drive` where they are in the middle of it, with the nozzle at
    /// `position`, m: what rounding has added up to is taken off.
    pub(crate) fn continue_drive(&mut self, drive: &Drive, position: f64) {
        self.state.spindle.speed = drive.speed;
        self.state.spindle.acceleration = drive.acceleration;
        self.state.set_tension = drive.tension;
        self.state.set_rate = drive.tension_rate;
        if let NozzleDrive::Even(velocity) = drive.nozzle {
            let nozzle = &mut self.state.support[1];
            nozzle.point.y = position;
            nozzle.velocity = drive.velocity(velocity);
        }
    }

    /// Ends the motion of nozzle and set tension and the spindle's acceleration; the spindle keeps its speed.
    pub fn end_drive(&mut self) {
        self.state.support[1].velocity = V3::zeros();
        (self.state.spindle.acceleration, self.state.set_rate) = (0.0, 0.0);
    }

    /// Gives a nozzle that is coupled to the spindle the mean velocity of the next `step`, s.
    pub(crate) fn guide_nozzle(&mut self, drive: &Drive, step: f64) {
        if let Some(travel) = drive.travel() {
            let spindle = self.state.spindle;
            let rate = (spindle.after(step).angle - spindle.angle) / step;
            self.state.support[1].velocity = drive.velocity(travel * rate);
        }
    }

    /// The course of a nozzle that `drive` couples to the spindle, from where both are now.
    pub(crate) fn nozzle_course(&self, drive: &Drive) -> Option<NozzleCourse> {
        drive.travel().map(|travel| NozzleCourse {
            travel,
            position: self.state.support[1].point.y,
            angle: self.state.spindle.angle,
            aside: drive.aside,
        })
    }
}

impl NozzleCourse {
    /// Sends the nozzle to where it has to be once the spindle has turned on for `step`, s.
    ///
    /// The step taken may be shorter than `step`. What that leaves, of second order in the spindle's
    /// acceleration, is made up for by the next call.
    pub(crate) fn steer(&self, sys: &mut System, step: f64) {
        let next = self.position + self.travel * (sys.state.spindle.after(step).angle - self.angle);
        let nozzle = &mut sys.state.support[1];
        let [x, z] = self.aside;
        nozzle.velocity = V3::new(x, (next - nozzle.point.y) / step, z);
    }

    /// Puts the nozzle where the spindle's present angle wants it.
    pub(crate) fn arrive(&self, sys: &mut System) {
        sys.state.support[1].point.y =
            self.position + self.travel * (sys.state.spindle.angle - self.angle);
    }
}
