//! Derivatives: of inputs and outputs by time, and of outputs by inputs.

use super::Instance;
use super::run::write_input;
use crate::error::Error;
use crate::lifecycle::State;
use crate::message::Message;
use crate::scalar::{find, wrong_type};
use coilwind::signals::{Inputs, Outputs};
use coilwind::simulation::Simulation;
use coilwind::variables::{Access, Causality, Value, Variable};

/// Share by which slopes over changes of different sizes may part before the importer is told. Chosen.
const APART: f64 = 0.1;
/// Share of an output by which the change of the inputs has to move it for its slopes to be told. A solve leaves 2e-8 m of a free span
/// of 60 mm, three hundred times as much.
const UNSEEN: f64 = 1e-9;

impl Instance {
    /// `fmi2SetRealInputDerivatives`: sets all of the derivatives or none, in the unit of each
    /// input per s. They hold for the next step.
    ///
    /// # Errors
    ///
    /// If a variable is not an input, an order is not 1, or a value is not finite.
    pub(crate) fn set_input_derivatives(
        &mut self,
        references: &[u32],
        orders: &[i32],
        values: &[f64],
    ) -> Result<(), Error> {
        for ((reference, order), value) in references.iter().zip(orders).zip(values) {
            let variable = find::<f64>(*reference)?;
            let name = variable.name;
            if variable.causality != Causality::Input {
                return Err(no_derivative(
                    name,
                    *order,
                    "only the derivatives of inputs can be set",
                ));
            }
            if *order != 1 {
                return Err(no_derivative(name, *order, "inputs change evenly, order 1"));
            }
            if !value.is_finite() {
                let value = *value;
                return Err(Error::DerivativeNotFinite { name, value });
            }
        }
        if !references.is_empty() {
            self.end_demonstration();
        }
        // (a derivative of 0 is told as well: without one, a place may go on as before)
        let told = |value: f64| if value == 0.0 { Inputs::STILL } else { value };
        for (reference, value) in references.iter().zip(values.iter().copied().map(told)) {
            match self
                .run
                .as_mut()
                .filter(|_| self.state == State::StepComplete)
            {
                Some(run) => write_input(&mut run.rates, *reference, value),
                None => {
                    self.start_rates.insert(*reference, value);
                    self.run = None;
                }
            }
        }
        Ok(())
    }

    /// `fmi2GetRealOutputDerivatives`: one value per reference, in the unit of the output per s.
    ///
    /// # Errors
    ///
    /// If a variable is not a Real output or an order is not 1.
    pub(crate) fn output_derivatives(
        &mut self,
        references: &[u32],
        orders: &[i32],
    ) -> Result<Vec<f64>, Error> {
        let run = self.start()?;
        let both = references.iter().zip(orders);
        both.map(|(reference, order)| {
            let variable = find::<f64>(*reference)?;
            match (output(variable), order) {
                (Some(get), 1) => match get(run.simulation.output_rates()) {
                    Value::Real(rate) => Ok(rate),
                    _ => Err(wrong_type::<f64>(variable)),
                },
                (Some(_), _) => Err(no_derivative(variable.name, *order, "outputs have order 1")),
                _ => Err(no_derivative(variable.name, *order, "it is not an output")),
            }
        })
        .collect()
    }

    /// `fmi2GetDirectionalDerivative` over the last communication step: the change of each unknown at its end if
    /// the knowns had been off by `changes` for all of the step, in the units of the variables. Before the first step the
    /// knowns are the inputs of the start.
    ///
    /// # Errors
    ///
    /// If an unknown is not a Real output, a known is not an input, a change is not finite, or the last step failed.
    pub(crate) fn directional_derivative(
        &mut self,
        unknowns: &[u32],
        knowns: &[u32],
        changes: &[f64],
    ) -> Result<Vec<f64>, Error> {
        let mut direction = Inputs::HELD;
        for (reference, change) in knowns.iter().zip(changes) {
            let variable = find::<f64>(*reference)?;
            let name = variable.name;
            let Access::Input { get, .. } = variable.access else {
                let reason = "knowns are inputs";
                return Err(no_derivative(name, 1, reason));
            };
            if !change.is_finite() {
                let value = *change;
                return Err(Error::DerivativeNotFinite { name, value });
            }
            // A known that is named twice counts twice.
            let sum = get(&direction) + change;
            write_input(&mut direction, *reference, sum);
        }
        if self.start()?.simulation.nozzle_follows_law() {
            direction.nozzle_position = 0.0;
        }
        let mut asked = Vec::with_capacity(unknowns.len());
        for reference in unknowns {
            let variable = find::<f64>(*reference)?;
            match output(variable) {
                Some(get) => asked.push((variable, get)),
                None => return Err(no_derivative(variable.name, 1, "unknowns are outputs")),
            }
        }
        if asked.is_empty() || direction == Inputs::HELD {
            return Ok(vec![0.0; asked.len()]);
        }
        let failed = self.state == State::StepFailed;
        let start = self.clock.experiment_time(0.0);
        let run = self.start()?;
        let simulation = &run.simulation;
        let slopes = match &run.last {
            Some(last) => {
                let (inputs, rates) = (last.inputs, last.rates);
                last.simulation
                    .step_derivative(inputs, rates, last.step, direction)
            }
            None if failed || simulation.time() > 0.0 => return Err(Error::NoLastStep),
            None => {
                Simulation::start_derivative(simulation.scene(), simulation.inputs(), direction)
            }
        };
        let slopes = slopes.map_err(Error::NoTangent)?;
        let time = start + simulation.time();
        let now = simulation.outputs();
        let (mut values, mut apart) = (Vec::with_capacity(asked.len()), Vec::new());
        for (variable, get) in asked {
            let of = |outputs| match get(outputs) {
                Value::Real(x) => Ok(x),
                _ => Err(wrong_type::<f64>(variable)),
            };
            let [value, least, most] = [of(&slopes.slopes)?, of(&slopes.least)?, of(&slopes.most)?];
            let steepest = least.abs().max(most.abs());
            let moved = steepest * slopes.change.abs();
            if most - least > APART * steepest && moved > UNSEEN * of(now)?.abs() {
                let name = variable.name;
                apart.push(format!("{name} {value:.3e} ({least:.3e} to {most:.3e})"));
            }
            values.push(value);
        }
        if !apart.is_empty() {
            let text = format!(
                "t = {time:.6} s: wire lands, slips or yields otherwise for inputs close by, and the slopes over three sizes of the change disagree: {}",
                apart.join(", ")
            );
            self.messages.push(Message::about_derivative(text));
        }
        Ok(values)
    }
}

/// How an output is read; `None` for other variables, also for results that are local.
fn output(variable: &Variable) -> Option<fn(&Outputs) -> Value> {
    match variable.access {
        Access::Output(get) if variable.causality == Causality::Output => Some(get),
        _ => None,
    }
}

fn no_derivative(name: &'static str, order: i32, reason: &'static str) -> Error {
    Error::NoDerivative {
        name,
        order,
        reason,
    }
}
