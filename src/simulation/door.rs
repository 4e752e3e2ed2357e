//! The way in: inputs for a communication step, or the scene's own motion profile.

use super::{SimError, Simulation, WORTH_A_STEP};
use crate::integrate::SolverStatistics;
use crate::signals::{EventKind, Inputs, Outputs};
use crate::system::{Drive, NozzleDrive};

impl Simulation {
    /// Advances by `dt` with the inputs held: spindle speed and tension from now on, the nozzle
    /// moving evenly so that it reaches its position at the end (a jump would be a hammer blow).
    ///
    /// After an error the run stands where the last step ended that went through ([`Self::time`]).
    pub fn advance(&mut self, inputs: Inputs, dt: f64) -> Result<(), SimError> {
        self.advance_ramped(inputs, Inputs::HELD, dt)
    }

    /// Advances by `dt` with inputs that start at `inputs` and change evenly, at `rates` per s. The nozzle moves
    /// evenly from where it is to where its input is at the end. Steps below a nanosecond only add up until they are
    /// worth solving for.
    pub fn advance_ramped(
        &mut self,
        inputs: Inputs,
        rates: Inputs,
        dt: f64,
    ) -> Result<(), SimError> {
        let end = inputs.after(&rates, dt);
        check_finite(&inputs, self.time)?;
        check_finite(&end, self.time)?;
        let span = self.owed + dt;
        if span < WORTH_A_STEP {
            self.owed = span;
            self.pass_time(dt);
            return Ok(());
        }
        let start = if self.owed > 0.0 {
            end.after(&rates, -span)
        } else {
            inputs
        };
        self.owed = 0.0;
        self.last_span = span;
        let before = self.outputs;
        let target = end.nozzle_position;
        let travel = target - self.sys.support[1].point.y;
        if rates != Inputs::HELD
            || inputs.spindle_speed != 0.0
            || travel != 0.0
            || inputs.tension_setpoint != self.sys.set_tension
        {
            self.quiet = 0.0;
        }
        self.reset_extremes();
        let drive = Drive {
            duration: span,
            speed: start.spindle_speed,
            acceleration: rates.spindle_speed,
            nozzle: NozzleDrive::Even(travel / span),
            tension: start.tension_setpoint,
            tension_rate: rates.tension_setpoint,
        };
        self.sys.begin_drive(&drive);
        let statistics_before = self.statistics();
        let gone = self.through(&drive);
        self.tell_of_trouble(statistics_before);
        self.sys.end_drive();
        if gone.is_err() {
            self.stop_short();
            return gone;
        }
        self.sys.spindle.speed = end.spindle_speed;
        self.sys.set_tension = end.tension_setpoint;
        self.sys.support[1].point.y = target;
        self.pass_time(dt);
        self.finish();
        self.update_rates(&before, span);
        Ok(())
    }

    /// Adds up communication steps such that millions of them lose no more than the last digit (Kahan 1965).
    fn pass_time(&mut self, dt: f64) {
        let step = dt - self.time_lost;
        let next = self.time + step;
        self.time_lost = (next - self.time) - step;
        self.time = next;
    }

    /// The method gave up within a step: what can be read is what was reached, or what was there before if
    /// that is no state of a wire.
    fn stop_short(&mut self) {
        let rod = &self.sys.rod;
        if rod.x.iter().chain(&rod.v).flatten().all(|x| x.is_finite()) {
            (self.time, self.time_lost) = (self.sys.time, 0.0);
            self.finish();
        }
        self.rates = Outputs::default();
    }

    /// Says that the solver could not solve steps as long as it wanted to; being too long for the error is
    /// its daily bread.
    fn tell_of_trouble(&mut self, before: SolverStatistics) {
        let newton_failures = self.statistics().newton_failures - before.newton_failures;
        if newton_failures > 0 {
            let text = format!(
                "the solver found no solution {newton_failures} times and went on in shorter steps, the last of {:.2e} s",
                self.last_step
            );
            self.report(EventKind::Solver, text);
        }
    }

    /// Advances by `dt` along the scene's own spindle ramp and traverse, which are continuous.
    pub fn advance_profile(&mut self, dt: f64) -> Result<(), SimError> {
        self.reset_extremes();
        self.quiet = 0.0;
        let end = self.time + dt;
        let profile = self.motion_profile;
        for drive in profile.drives(self.time, end, self.sys.set_tension) {
            self.sys.begin_drive(&drive);
            self.through(&drive)?;
        }
        self.sys.end_drive();
        self.time += dt;
        self.finish();
        Ok(())
    }

    pub(super) fn finish(&mut self) {
        self.follow_traverse();
        self.sys.time = self.time;
        self.update_outputs();
    }
}

pub(super) fn check_finite(inputs: &Inputs, time: f64) -> Result<(), SimError> {
    for (name, value) in [
        ("spindle_speed", inputs.spindle_speed),
        ("nozzle_position", inputs.nozzle_position),
        ("tension_setpoint", inputs.tension_setpoint),
    ] {
        if !value.is_finite() {
            return Err(SimError {
                time,
                node: None,
                reason: format!("input {name} = {value} is not a finite number"),
            });
        }
    }
    if inputs.tension_setpoint < 0.0 {
        return Err(SimError {
            time,
            node: None,
            reason: format!(
                "input tension_setpoint = {} N must not be negative",
                inputs.tension_setpoint
            ),
        });
    }
    Ok(())
}
