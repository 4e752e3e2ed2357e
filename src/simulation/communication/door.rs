//! Steps that end at the communication point: inputs for a communication step, or the scene's own motion profile.

use crate::signals::{Inputs, Outputs};
use crate::simulation::motion::{check_finite, nozzle_of};
use crate::simulation::outputs::{raise_as, rates_of, speeds_of};
use crate::simulation::winding::WORTH_A_STEP;
use crate::simulation::{SimError, Winding};
use crate::system::{Drive, NozzleDrive};

/// Where the motion of the machine over a communication step comes from.
#[derive(Clone, Copy, Debug)]
enum StepMotion {
    /// inputs at the start of the step and their rates, per s
    Inputs { inputs: Inputs, rates: Inputs },
    /// the scene's own motion profile at this time of the run
    Profile,
}

impl Winding {
    /// See [`crate::simulation::Simulation::advance_ramped`]; steps end at the communication point.
    pub(super) fn advance_ramped(
        &mut self,
        inputs: Inputs,
        rates: Inputs,
        dt: f64,
    ) -> Result<(), SimError> {
        self.advance_by(StepMotion::Inputs { inputs, rates }, dt)
    }

    /// See [`crate::simulation::Simulation::advance_profile`].
    pub(super) fn advance_profile(&mut self, dt: f64) -> Result<(), SimError> {
        self.advance_by(StepMotion::Profile, dt)
    }

    /// Advances by `dt`, s, with this motion of the machine: the one way through a step.
    ///
    /// Where its inputs send the nozzle into the core, winding ends when it gets there.
    fn advance_by(&mut self, motion: StepMotion, dt: f64) -> Result<(), SimError> {
        self.check_step(dt)?;
        let StepMotion::Inputs { inputs, rates } = motion else {
            return self.go_by(motion, dt);
        };
        let end = inputs.after(&rates, dt);
        check_finite(&inputs, self.run.time)?;
        check_finite(&end, self.run.time)?;
        let Some(share) = self.meets_circle(&end) else {
            return self.go_by(motion, dt);
        };
        // the nozzle goes evenly from where it is to where it is sent
        let (now, [before, after]) = (self.inputs(), [share * dt, (1.0 - share) * dt]);
        let sent = |from: f64, to: f64, rate: f64| from + share * (to - from) - rate * before;
        let until = Inputs {
            nozzle_position: sent(
                now.nozzle_position,
                end.nozzle_position,
                rates.nozzle_position,
            ),
            nozzle_offset_x: sent(
                now.nozzle_offset_x,
                end.nozzle_offset_x,
                rates.nozzle_offset_x,
            ),
            nozzle_offset_z: sent(
                now.nozzle_offset_z,
                end.nozzle_offset_z,
                rates.nozzle_offset_z,
            ),
            ..inputs
        };
        let motion = |inputs: Inputs| StepMotion::Inputs { inputs, rates };
        self.go_by(motion(until), before)?;
        self.note_circle_met(&end);
        let told = self.run.outputs;
        self.go_by(motion(inputs.after(&rates, before)), after)?;
        let o = &mut self.run.outputs;
        o.wire_tension_max = o.wire_tension_max.max(told.wire_tension_max);
        o.wire_tension_min = o.wire_tension_min.min(told.wire_tension_min);
        o.meet_depth(told.penetration_max);
        raise_as(o, &told);
        Ok(())
    }

    /// Goes through a communication step of `dt`, s, and the time owed before it; updates outputs and rates.
    ///
    /// After an error the run stands at the last good instant.
    fn go_by(&mut self, motion: StepMotion, dt: f64) -> Result<(), SimError> {
        let span = self.run.owed + dt;
        if span < WORTH_A_STEP {
            self.run.owed = span;
            self.pass_time(dt);
            return Ok(());
        }
        let owed = std::mem::take(&mut self.run.owed);
        let before = self.run.outputs;
        let speed_before = self.sys.state.spindle.speed;
        if self.is_moved_by(&motion, dt) {
            self.run.quiet = 0.0;
        }
        self.reset_extremes();
        let gone = match &motion {
            StepMotion::Inputs { inputs, rates } => {
                // (its mean over the step)
                self.sys
                    .damp_tensioner(inputs.after(rates, 0.5 * dt).tensioner_damping);
                let drive = self.drive_of(*inputs, rates, [dt, span], owed);
                match self.run.nozzle_by_law {
                    true => self.follow_by_law(&drive),
                    false => self.go_through(&drive),
                }
            }
            StepMotion::Profile => {
                let start = self.run.time - owed;
                let end = self.run.time + (dt - self.run.time_lost);
                let (profile, tension) = (self.motion_profile.clone(), self.sys.state.set_tension);
                let mut drives = profile.drives(start, end, tension);
                drives.try_for_each(|drive| self.go_through(&drive))
            }
        };
        if gone.is_err() {
            self.stop_short();
            return gone;
        }
        self.sys.end_drive();
        if let StepMotion::Inputs { inputs, rates } = &motion {
            let end = inputs.after(rates, dt);
            self.sys.state.spindle.speed = end.spindle_speed;
            self.sys.state.set_tension = end.tension_setpoint;
            self.sys.damp_tensioner(end.tensioner_damping);
            self.sys.state.support[1].point = self.nozzle_at_end(&end);
        }
        self.run.acceleration = (self.sys.state.spindle.speed - speed_before) / span;
        self.pass_time(dt);
        self.update_at_point();
        let both = [&before, &self.run.outputs];
        self.run.rates = rates_of(self, both, span, self.sys.state.spindle.speed);
        Ok(())
    }

    /// Goes through the interval of one drive.
    pub(in crate::simulation) fn go_through(&mut self, drive: &Drive) -> Result<(), SimError> {
        self.begin_drive(drive);
        self.through(drive)
    }

    /// The motion by inputs over the last `span` seconds up to the end of a communication step of `dt`, s, the last of several
    /// where time is `owed`, s.
    fn drive_of(&self, inputs: Inputs, rates: &Inputs, [dt, span]: [f64; 2], owed: f64) -> Drive {
        let end = inputs.after(rates, dt);
        let start = if owed > 0.0 {
            end.after(rates, -span)
        } else {
            inputs
        };
        let way = nozzle_of(&self.scene, &end) - self.sys.state.support[1].point;
        Drive {
            duration: span,
            speed: start.spindle_speed,
            acceleration: rates.spindle_speed,
            nozzle: NozzleDrive::Even(way.y / span),
            aside: [way.x / span, way.z / span],
            tension: start.tension_setpoint,
            tension_rate: rates.tension_setpoint,
        }
    }

    /// Whether a step of `dt`, s, of this motion moves anything or changes an input.
    fn is_moved_by(&self, motion: &StepMotion, dt: f64) -> bool {
        match motion {
            StepMotion::Inputs { inputs, rates } => {
                let end = inputs.after(rates, dt);
                *rates != Inputs::HELD
                    || inputs.spindle_speed != 0.0
                    || self.nozzle_at_end(&end) != self.sys.state.support[1].point
                    || inputs.tension_setpoint != self.sys.state.set_tension
            }
            StepMotion::Profile => true,
        }
    }

    /// A communication step is a finite time of 0 or more.
    fn check_step(&self, dt: f64) -> Result<(), SimError> {
        if dt.is_finite() && dt >= 0.0 {
            return Ok(());
        }
        Err(SimError {
            time: self.run.time,
            node: None,
            reason: format!(
                "the communication step is {dt} s; allowed: a finite time of 0 s or more"
            ),
        })
    }

    /// Adds up communication steps such that millions of them lose no more than the last digit (Kahan 1965).
    fn pass_time(&mut self, dt: f64) {
        let step = dt - self.run.time_lost;
        let next = self.run.time + step;
        self.run.time_lost = (next - self.run.time) - step;
        self.run.time = next;
    }

    /// Ends a step in which the method gave up: what can be read is what was reached, or what was there before
    /// if that is no state of a wire. Rates are those of the last instant.
    pub(super) fn stop_short(&mut self) {
        let (rod, nozzle) = (&self.sys.state.rod, self.sys.state.support[1]);
        let reached = rod.x.iter().chain(&rod.v).flatten().all(|x| x.is_finite());
        self.sys.end_drive();
        self.run.rates = Outputs::default();
        if reached {
            (self.run.time, self.run.time_lost) = (self.sys.state.time, 0.0);
            self.update_at_point();
            self.run.rates = speeds_of(&self.run.outputs, self.sys.state.spindle.speed);
            self.run.rates.nozzle_y = nozzle.velocity.y;
        }
    }

    /// Brings the state to the time of the run, and the outputs with it.
    pub(super) fn update_at_point(&mut self) {
        self.sys.state.time = self.run.time;
        self.update_outputs();
    }
}
