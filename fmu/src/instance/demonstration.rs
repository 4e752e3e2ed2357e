//! What moves the machine where the importer sets nothing: a calm motion from the scene's own profile.
//!
//! An importer that only simulates shall see a coil. One that sets anything drives the machine itself.

use super::Instance;
use super::run::Run;
use crate::ffi::Status;
use crate::message::Message;
use coilwind::settings::{SceneSettings, Spindle};
use coilwind::signals::Inputs;
use coilwind::variables::{Value, by_reference};
use coilwind_model_description::Category;
use std::f64::consts::TAU;

/// Speed of the demonstration, rad/s, where the scene's is not lower: turns lie close, and a second of
/// computing winds the coil.
const SPEED: f64 = 100.0;

impl Instance {
    /// Demonstrates the scene's motion if nothing was set to another value than that in `modelDescription.xml`.
    pub(super) fn begin_demonstration(&mut self) {
        let default = SceneSettings::default();
        let starts_so = |reference: u32, given: &Value| {
            by_reference(reference)
                .and_then(|row| row.start_in_fmu(&default))
                .as_ref()
                == Some(given)
        };
        let inputs = self.start_inputs.iter();
        let is_left = self.start_rates.is_empty()
            && self.parameters.names_no_scene()
            && inputs
                .map(|(r, x)| (*r, Value::Real(*x)))
                .all(|(r, x)| starts_so(r, &x));
        let set = self
            .parameters
            .explicit()
            .filter(|(r, x)| !starts_so(*r, x));
        let set: Vec<&str> = set
            .filter_map(|(r, _)| by_reference(r).map(|row| row.name))
            .collect();
        self.demonstrates = is_left && set.is_empty();
        let text = if self.demonstrates {
            "inputs and parameters are as in modelDescription.xml, so the FMU demonstrates: spindle and nozzle \
             follow a motion profile of its own until any input is set"
                .to_owned()
        } else if is_left && set.iter().all(|name| name.starts_with("output.")) {
            format!(
                "{} is set, so the FMU does not demonstrate: the core stands until spindle_speed is set",
                set.join(", ")
            )
        } else {
            return;
        };
        self.messages.push(Message {
            status: Status::Ok,
            category: Category::Events,
            text,
        });
    }
}

impl Instance {
    /// Leaves spindle and nozzle to the master from now on.
    pub(super) fn end_demonstration(&mut self) {
        if std::mem::take(&mut self.demonstrates) {
            self.messages.push(Message {
                status: Status::Ok,
                category: Category::Events,
                text: "an input is set, so the demonstration ends: the spindle keeps its speed and the nozzle its place until spindle_speed and \
                       nozzle_position are set"
                    .to_owned(),
            });
        }
    }
}

impl Run {
    /// Makes spindle speed and nozzle position those of the demonstration over the next `step`, s.
    ///
    /// A step over an end of a ramp changes the speed evenly by as much as the motion profile does, and turns the core as far.
    pub(super) fn demonstrate(&mut self, step: f64) {
        let scene = self.simulation.scene();
        let (spindle, per_turn) = (&scene.spindle, scene.traverse.per_turn);
        let time = self.simulation.time();
        let speed = demonstrated(spindle, time);
        let after = demonstrated(spindle, time + step);
        let mean = (turned(spindle, time + step) - turned(spindle, time)) / step;
        self.inputs.spindle_speed = mean - 0.5 * (after - speed);
        self.rates = Inputs {
            spindle_speed: (after - speed) / step,
            nozzle_position: per_turn * mean / TAU,
            tension_setpoint: 0.0,
            ..Inputs::HELD
        };
    }
}

/// Speed of the demonstration at a time of the run, s, in rad/s: as many turns as the scene's motion profile has, with its
/// ramp at both ends.
fn demonstrated(spindle: &Spindle, time: f64) -> f64 {
    let speed = spindle.speed.abs().min(SPEED);
    let ramp = 2.0 * ramp_turns(spindle) * TAU / speed;
    let share = (time / ramp).min((end(spindle) - time) / ramp);
    (speed * share.clamp(0.0, 1.0)).copysign(spindle.speed)
}

/// Angle that the demonstration has turned by at a time of the run, s, in rad.
fn turned(spindle: &Spindle, time: f64) -> f64 {
    let speed = spindle.speed.abs().min(SPEED);
    let (end, ramp) = (end(spindle), 2.0 * ramp_turns(spindle) * TAU / speed);
    let time = time.clamp(0.0, end);
    // what either ramp lacks of the full speed
    let lacks = |left: f64| 0.5 * (ramp - left).max(0.0).powi(2) / ramp.max(f64::MIN_POSITIVE);
    let up = 0.5 * ramp - lacks(time);
    let down = lacks(end - time);
    (speed * (time - up - down)).copysign(spindle.speed)
}

/// When the demonstration ends, s.
fn end(spindle: &Spindle) -> f64 {
    (spindle.turns + 2.0 * ramp_turns(spindle)) * TAU / spindle.speed.abs().min(SPEED)
}

/// Turns over which the speed rises, and falls again.
fn ramp_turns(spindle: &Spindle) -> f64 {
    spindle.ramp_turns.min(0.5 * spindle.turns)
}

#[cfg(test)]
mod tests {
    use super::*;
    use coilwind_model_description::DEFAULT_STOP_TIME;

    #[test]
    fn the_default_experiment_sees_all_of_it() {
        let scene = SceneSettings::default().build().expect("a scene");
        let spindle = &scene.spindle;
        let end = end(spindle);
        assert!(end < DEFAULT_STOP_TIME && end > 0.9 * DEFAULT_STOP_TIME);
        let step = 1e-5;
        let steps = (DEFAULT_STOP_TIME / step) as u32;
        let angle: f64 = (0..steps)
            .map(|k| step * demonstrated(spindle, f64::from(k) * step))
            .sum();
        assert!((angle / TAU - spindle.turns).abs() < 1e-4, "{angle}");
        // a few long steps turned the core less far, and one over all of it not at all
        let of_steps: f64 = (0..steps)
            .map(|k| f64::from(k) * step)
            .fold(0.0, |worst, time| {
                let sum = turned(spindle, time + step) - turned(spindle, time);
                let trapezium =
                    0.5 * step * (demonstrated(spindle, time) + demonstrated(spindle, time + step));
                worst.max((sum - trapezium).abs())
            });
        assert!(of_steps < 1e-6, "{of_steps}");
        assert!((turned(spindle, DEFAULT_STOP_TIME) / TAU - spindle.turns).abs() < 1e-9);
        assert_eq!(turned(spindle, 0.0), 0.0);
        assert_eq!(demonstrated(spindle, 0.0), 0.0);
        assert_eq!(demonstrated(spindle, DEFAULT_STOP_TIME), 0.0);
    }
}
