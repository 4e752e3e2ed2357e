//! Derivatives of the outputs by the inputs, for importers that solve loops or linearise.

use super::door::check_finite;
use super::{SimError, Simulation};
use crate::integrate::{OutputSensitivity, Stepper};
use crate::math::V3;
use crate::math::{polar_angle, wrap_to_pi};
use crate::signals::{Inputs, Outputs};
use std::f64::consts::TAU;

/// Move of the node at lift-off over its distance from the axis that the derivative of its angle is taken over.
const TURN: f64 = 1e-6;

impl Simulation {
    /// Derivatives of the outputs one step ahead with respect to `inputs` held over that step: spindle speed, nozzle
    /// position and set tension, in this order.
    ///
    /// An input acts over time: at the very instant at which it changes no output does. So the step is the next that the
    /// solver would take, or as long as the last communication step if that was shorter. The solver solves it on trial and hands
    /// over its tangent; the run stays as it is. Measures of settled wire change only when wire comes to rest and have 0;
    /// extremes of the tension are none of the end of a step and have 0 too. Only the implicit method has a tangent.
    pub fn sensitivities(&mut self, inputs: Inputs) -> Result<[Outputs; 3], SimError> {
        check_finite(&inputs, self.run.time)?;
        let lift = self.lift_off();
        let Stepper::Implicit(method) = &mut self.stepper else {
            return Err(SimError {
                time: self.run.time,
                node: None,
                reason: "only solver.integrator = implicit has derivatives by the inputs"
                    .to_owned(),
            });
        };
        let mut h = method.fixed.unwrap_or(method.next);
        if self.run.last_span > 0.0 {
            h = h.min(self.run.last_span);
        }
        if self.run.broken {
            let turning = Outputs {
                spindle_angle: h,
                ..Outputs::default()
            };
            return Ok([turning, Outputs::default(), Outputs::default()]);
        }
        let sys = &mut self.sys;
        let kept = (sys.state.spindle, sys.state.support, sys.state.set_tension);
        sys.state.spindle.speed = inputs.spindle_speed;
        sys.state.support[1].point.y = inputs.nozzle_position;
        sys.state.set_tension = inputs.tension_setpoint;
        let tangent = method.tangent(sys, h, lift);
        (sys.state.spindle, sys.state.support, sys.state.set_tension) = kept;
        let (there, slopes) = tangent.map_err(|e| SimError {
            time: self.run.time,
            node: Some(e.node),
            reason: e.to_string(),
        })?;
        let direction = self.coil.spec().direction;
        Ok(slopes.map(|slope| outputs_of(&slope, there.lift, direction)))
    }
}

fn outputs_of(slope: &OutputSensitivity, lift: V3, direction: f64) -> Outputs {
    let way = slope.lift.norm();
    let turned = if way > 0.0 {
        let by = TURN * lift.norm() / way;
        let polar = |by: f64| polar_angle(lift + slope.lift * by);
        direction * wrap_to_pi(polar(by) - polar(-by)) / (2.0 * by)
    } else {
        0.0
    };
    Outputs {
        wire_tension: slope.tension,
        spindle_torque: slope.torque,
        fed_length: slope.fed,
        feed_speed: slope.feed_speed,
        free_length: slope.free_length,
        layon_position: slope.lift.y,
        layon_angle: turned,
        turns_wound: turned / TAU,
        spindle_angle: slope.angle,
        ..Outputs::default()
    }
}
