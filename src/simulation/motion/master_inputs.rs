//! Inputs that a master gives, and what they mean for nozzle and tensioner.

use crate::scene::Scene;
use crate::signals::Inputs;
use crate::simulation::SimError;
use serde::{Deserialize, Serialize};

/// Inputs of a communication step as they were given.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(in crate::simulation) struct MasterInputs {
    /// at its start
    start: Inputs,
    /// at its end
    end: Inputs,
    /// its length, s; 0 for the start of the run
    dt: f64,
}

impl MasterInputs {
    /// A step of `dt`, s, from `inputs` on at `rates`, per s.
    pub(in crate::simulation) fn new(inputs: Inputs, rates: &Inputs, dt: f64) -> Self {
        Self {
            start: inputs,
            end: inputs.after(rates, dt),
            dt,
        }
    }

    /// These inputs with what was given at the end for the pull of the tensioner.
    pub(in crate::simulation) fn pull_of(&self, inputs: Inputs) -> Inputs {
        Inputs {
            tension_setpoint: self.end.tension_setpoint,
            brake_torque: self.end.brake_torque,
            ..inputs
        }
    }

    /// Whether it is one at all; bytes from elsewhere may say anything.
    pub(in crate::simulation) fn is_sound(&self) -> bool {
        let sound = |inputs: &Inputs| check_finite(inputs, 0.0).is_ok();
        sound(&self.start) && sound(&self.end) && self.dt.is_finite() && self.dt >= 0.0
    }

    /// Rate of an input that is `now` and for which none was given, per s: that between the last two values.
    fn rate_to(&self, now: f64, input: impl Fn(&Inputs) -> f64) -> f64 {
        if self.dt > 0.0 {
            (now - input(&self.start)) / self.dt
        } else {
            0.0
        }
    }
}

/// Inputs with all that holds the tensioner back in `tension_setpoint`: the brake holds by its largest torque at most.
pub(in crate::simulation) fn with_brake(scene: &Scene, inputs: Inputs) -> Inputs {
    let torque = inputs.brake_torque.min(scene.tensioner.most_torque());
    adding(scene, inputs, torque)
}

/// The same of the `rates` of these inputs, per s, over a step of `dt`, s.
///
/// A brake may come to its largest torque, or back from it, within the step. It then pulls evenly from what it holds by at the start
/// to what it holds by at the end.
fn rates_with_brake(scene: &Scene, inputs: &Inputs, rates: Inputs, dt: f64) -> Inputs {
    let most = scene.tensioner.most_torque();
    let end = inputs.after(&rates, dt).brake_torque;
    let rate = if dt > 0.0 && inputs.brake_torque.max(end) > most {
        (end.min(most) - inputs.brake_torque.min(most)) / dt
    } else {
        rates.brake_torque
    };
    adding(scene, rates, rate)
}

fn adding(scene: &Scene, inputs: Inputs, brake: f64) -> Inputs {
    Inputs {
        tension_setpoint: inputs.tension_setpoint + brake / scene.tensioner.radius,
        brake_torque: 0.0,
        ..inputs
    }
}

/// Inputs and rates of a step of `dt`, s, as the winding takes them, where those of the step `before` are known.
pub(in crate::simulation) fn as_meant(
    scene: &Scene,
    inputs: Inputs,
    mut rates: Inputs,
    dt: f64,
    before: Option<&MasterInputs>,
) -> (Inputs, Inputs) {
    if let Some(before) = before.filter(|_| scene.nozzle.position_at_start) {
        let go_on = |place: fn(&Inputs) -> f64, rate: &mut f64| {
            if *rate == 0.0 {
                *rate = before.rate_to(place(&inputs), place);
            }
        };
        go_on(|i| i.nozzle_position, &mut rates.nozzle_position);
        go_on(|i| i.nozzle_offset_x, &mut rates.nozzle_offset_x);
        go_on(|i| i.nozzle_offset_z, &mut rates.nozzle_offset_z);
    }
    for rate in [
        &mut rates.spindle_speed,
        &mut rates.nozzle_position,
        &mut rates.tension_setpoint,
        &mut rates.nozzle_offset_x,
        &mut rates.nozzle_offset_z,
        &mut rates.brake_torque,
        &mut rates.tensioner_damping,
    ] {
        if *rate == Inputs::STILL {
            *rate = 0.0;
        }
    }
    (
        with_brake(scene, inputs),
        rates_with_brake(scene, &inputs, rates, dt),
    )
}

pub(in crate::simulation) fn check_finite(inputs: &Inputs, time: f64) -> Result<(), SimError> {
    for (name, value) in [
        ("spindle_speed", inputs.spindle_speed),
        ("nozzle_position", inputs.nozzle_position),
        ("tension_setpoint", inputs.tension_setpoint),
        ("nozzle_offset_x", inputs.nozzle_offset_x),
        ("nozzle_offset_z", inputs.nozzle_offset_z),
        ("brake_torque", inputs.brake_torque),
        ("tensioner_damping", inputs.tensioner_damping),
    ] {
        if !value.is_finite() {
            return Err(SimError {
                time,
                node: None,
                reason: format!("input {name} = {value}; allowed: a finite number"),
            });
        }
    }
    for (name, value, unit) in [
        ("tension_setpoint", inputs.tension_setpoint, "N"),
        ("brake_torque", inputs.brake_torque, "N.m"),
        ("tensioner_damping", inputs.tensioner_damping, "N.s/m"),
    ] {
        if value < 0.0 {
            return Err(SimError {
                time,
                node: None,
                reason: format!("input {name} = {value} {unit}; allowed: 0 {unit} or more"),
            });
        }
    }
    Ok(())
}
