//! The communication step and its statuses.

use super::Instance;
use super::run::LastStep;
use crate::error::Error;
use crate::ffi::{LAST_SUCCESSFUL_TIME, STATUS_KINDS, TERMINATED};
use crate::lifecycle::State;
use crate::message::Message;
use coilwind::output::Ending;
use coilwind::signals::Inputs;
use coilwind::simulation::SimError;
use coilwind::variables::{Access, Value};
use std::sync::Arc;
use std::time::Instant;

impl Instance {
    /// `fmi2DoStep` from communication point `point` over `step`, both in s.
    ///
    /// # Errors
    ///
    /// [`Error::Time`] and [`Error::Scene`] change nothing. [`Error::StepFailed`] and
    /// [`Error::NotANumber`] leave the instance in the step-failed state.
    pub(crate) fn do_step(&mut self, point: f64, step: f64) -> Result<(), Error> {
        let end = self.clock.end_of(point, step)?;
        let offset = self.clock.experiment_time(0.0);
        let demonstrates = self.demonstrates;
        let retuned = self.retune()?;
        for text in self.start()?.hold_inputs(step) {
            self.warn(text);
        }
        let run = self.start()?;
        if demonstrates {
            run.demonstrate(step);
        }
        let last = LastStep {
            simulation: run.simulation.clone(),
            inputs: run.inputs,
            rates: run.rates,
            step,
        };
        run.last = None;
        let began = Instant::now();
        let result =
            retuned.and_then(|()| run.simulation.advance_ramped(run.inputs, run.rates, step));
        if let Some(recording) = &mut run.recording {
            recording.computed(began.elapsed());
        }
        let events = run.simulation.drain_events();
        let simulated = run.simulation.time();
        self.messages.extend(Message::of_events(&events, offset));
        if let Err(mut reason) = result {
            reason.time += offset;
            let reached = self.clock.experiment_time(simulated);
            return Err(self.fail(point, step, reached, reason));
        }
        // A derivative counts from the start of a step and holds for that step only.
        if let Some(run) = &mut self.run {
            run.inputs = run.inputs.after(&run.rates, step);
            run.rates = Inputs::HELD;
            run.last = Some(Arc::new(last));
        }
        if let Err(error) = self.check_outputs(end) {
            let reason = error.to_string();
            self.finish_recording(&Ending::Failed { reason });
            return Err(error);
        }
        self.clock.set(end);
        self.record_row();
        Ok(())
    }

    /// `fmi2GetRealStatus`: the last successful time, s.
    ///
    /// # Errors
    ///
    /// [`Error::NoStatus`] for every other kind.
    pub(crate) fn real_status(&self, kind: i32) -> Result<f64, Error> {
        match kind {
            LAST_SUCCESSFUL_TIME => Ok(self.clock.now()),
            _ => Err(no_status(kind)),
        }
    }

    /// `fmi2GetBooleanStatus`: whether the run cannot go on, which is so after a failed step.
    ///
    /// # Errors
    ///
    /// [`Error::NoStatus`] for every kind but `fmi2Terminated`.
    pub(crate) fn boolean_status(&self, kind: i32) -> Result<bool, Error> {
        match kind {
            TERMINATED => Ok(self.state == State::StepFailed),
            _ => Err(no_status(kind)),
        }
    }

    /// `fmi2GetStatus`, `fmi2GetIntegerStatus` and `fmi2GetStringStatus`, which exist for pending
    /// steps only.
    ///
    /// # Errors
    ///
    /// [`Error::NoStatus`], always.
    pub(crate) fn pending_status(&self, kind: i32) -> Result<(), Error> {
        Err(no_status(kind))
    }

    /// Puts the instance into the step-failed state at time `reached`, s, and closes the files.
    /// Values of that time can still be read.
    fn fail(&mut self, from: f64, step: f64, reached: f64, reason: SimError) -> Error {
        self.state = State::StepFailed;
        self.clock.set(reached);
        let (turn, angle) = self.run.as_ref().map_or((0.0, 0.0), |run| {
            let o = run.simulation.outputs();
            (o.turns_wound, o.spindle_angle)
        });
        // Importers often stop here without another call.
        self.finish_recording(&Ending::Failed {
            reason: reason.to_string(),
        });
        Error::StepFailed {
            from,
            step,
            reached,
            turn,
            angle,
            reason,
        }
    }

    /// Checks that every Real output is finite after the step to `time`, s. Enters the step-failed
    /// state if one is not.
    fn check_outputs(&mut self, time: f64) -> Result<(), Error> {
        let Some(run) = self.run.as_ref() else {
            return Ok(());
        };
        for variable in coilwind_model_description::variables() {
            let Access::Output(get) = variable.access else {
                continue;
            };
            if let Value::Real(value) = get(run.simulation.outputs())
                && !value.is_finite()
            {
                self.state = State::StepFailed;
                return Err(Error::NotANumber {
                    name: variable.name,
                    value,
                    time,
                });
            }
        }
        Ok(())
    }
}

fn no_status(kind: i32) -> Error {
    let name = usize::try_from(kind)
        .ok()
        .and_then(|kind| STATUS_KINDS.get(kind));
    let kind = name.map_or_else(|| format!("status kind {kind}"), |name| (*name).to_owned());
    Error::NoStatus { kind }
}
