//! Derivatives with respect to time: of inputs, for the next step, and of outputs.

use super::{Instance, find, write_input, wrong_type};
use crate::lifecycle::State;
use crate::refusal::Refusal;
use coilwind::signals::{Inputs, Outputs};
use coilwind::variables::{Access, Causality, Value};

impl Instance {
    /// `fmi2SetRealInputDerivatives`: all of them or none; they hold for the next step.
    pub(crate) fn set_input_derivatives(
        &mut self,
        references: &[u32],
        orders: &[i32],
        values: &[f64],
    ) -> Result<(), Refusal> {
        for ((reference, order), value) in references.iter().zip(orders).zip(values) {
            let variable = find::<f64>(*reference)?;
            let name = variable.name;
            if variable.causality != Causality::Input {
                return Err(no_derivative(
                    name,
                    *order,
                    "only inputs have one to be set",
                ));
            }
            if *order != 1 {
                return Err(no_derivative(name, *order, "inputs change evenly, order 1"));
            }
            if !value.is_finite() {
                let value = *value;
                return Err(Refusal::DerivativeNotFinite { name, value });
            }
        }
        for (reference, value) in references.iter().zip(values) {
            match self
                .run
                .as_mut()
                .filter(|_| self.state == State::StepComplete)
            {
                Some(run) => write_input(&mut run.rates, *reference, *value),
                None => {
                    self.start_rates.insert(*reference, *value);
                    self.run = None;
                }
            }
        }
        Ok(())
    }

    /// `fmi2GetRealOutputDerivatives`
    pub(crate) fn output_derivatives(
        &mut self,
        references: &[u32],
        orders: &[i32],
    ) -> Result<Vec<f64>, Refusal> {
        let run = self.start()?;
        let both = references.iter().zip(orders);
        both.map(|(reference, order)| {
            let variable = find::<f64>(*reference)?;
            match (variable.access, order) {
                (Access::Output(get), 1) => match get(run.simulation.output_rates()) {
                    Value::Real(rate) => Ok(rate),
                    _ => Err(wrong_type::<f64>(variable)),
                },
                (Access::Output(_), _) => {
                    Err(no_derivative(variable.name, *order, "outputs have order 1"))
                }
                _ => Err(no_derivative(variable.name, *order, "it is no output")),
            }
        })
        .collect()
    }
}

impl Instance {
    /// `fmi2GetDirectionalDerivative`: of outputs by inputs, over the solver's next step.
    pub(crate) fn directional_derivative(
        &mut self,
        unknowns: &[u32],
        knowns: &[u32],
        changes: &[f64],
    ) -> Result<Vec<f64>, Refusal> {
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
                return Err(Refusal::DerivativeNotFinite { name, value });
            }
            // a known that is named twice counts twice
            let sum = get(&direction) + change;
            write_input(&mut direction, *reference, sum);
        }
        let mut asked = Vec::with_capacity(unknowns.len());
        for reference in unknowns {
            let variable = find::<f64>(*reference)?;
            match variable.access {
                Access::Output(get) => asked.push((variable, get)),
                _ => return Err(no_derivative(variable.name, 1, "unknowns are outputs")),
            }
        }
        if asked.is_empty() || direction == Inputs::HELD {
            return Ok(vec![0.0; asked.len()]);
        }
        let run = self.start()?;
        let slopes = run.simulation.sensitivities(run.inputs);
        let slopes = slopes.map_err(Refusal::NoTangent)?;
        let along = [
            direction.spindle_speed,
            direction.nozzle_position,
            direction.tension_setpoint,
        ];
        let of = |(variable, get): (_, fn(&Outputs) -> Value)| {
            let mut sum = 0.0;
            for (slope, change) in slopes.iter().zip(along) {
                match get(slope) {
                    Value::Real(x) => sum += x * change,
                    _ => return Err(wrong_type::<f64>(variable)),
                }
            }
            Ok(sum)
        };
        asked.into_iter().map(of).collect()
    }
}

fn no_derivative(name: &'static str, order: i32, reason: &'static str) -> Refusal {
    Refusal::NoDerivative {
        name,
        order,
        reason,
    }
}

/// Inputs stay in their ranges until the end of the step; where they change evenly, both ends tell.
pub(super) fn check_way(inputs: &Inputs, rates: &Inputs, step: f64) -> Result<(), Refusal> {
    let end = inputs.after(rates, step);
    for variable in coilwind_model_description::variables() {
        let Access::Input { get, .. } = variable.access else {
            continue;
        };
        let value = get(&end);
        if get(rates) != 0.0 && !variable.admits(&Value::Real(value)) {
            return Err(Refusal::LeavesRange {
                name: variable.name,
                value,
                allowed: variable.allowed(),
            });
        }
    }
    Ok(())
}
