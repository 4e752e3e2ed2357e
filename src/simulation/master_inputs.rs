//! Inputs that a master gives, and what they mean for nozzle and tensioner.

use super::door::check_finite;
use crate::scene::Scene;
use crate::signals::Inputs;
use serde::{Deserialize, Serialize};

/// Inputs of a communication step as they were given.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(super) struct MasterInputs {
    /// at its start
    start: Inputs,
    /// at its end
    end: Inputs,
    /// its length, s; 0 for the start of the run
    dt: f64,
}

impl MasterInputs {
    /// A step of `dt`, s, from `inputs` on at `rates`, per s.
    pub(super) fn new(inputs: Inputs, rates: &Inputs, dt: f64) -> Self {
        Self {
            start: inputs,
            end: inputs.after(rates, dt),
            dt,
        }
    }

    /// These inputs with what was given at the end for the pull of the tensioner.
    pub(super) fn pull_of(&self, inputs: Inputs) -> Inputs {
        Inputs {
            tension_setpoint: self.end.tension_setpoint,
            brake_torque: self.end.brake_torque,
            ..inputs
        }
    }

    /// Whether it is one at all; bytes from elsewhere may say anything.
    pub(super) fn is_sound(&self) -> bool {
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
pub(super) fn with_brake(scene: &Scene, inputs: Inputs) -> Inputs {
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
pub(super) fn as_meant(
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
