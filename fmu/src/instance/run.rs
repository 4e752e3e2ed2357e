//! The simulation of a started instance with the inputs of its next step.

use crate::error::Error;
use crate::recording::Recording;
use coilwind::scene::Scene;
use coilwind::signals::Inputs;
use coilwind::simulation::Simulation;
use coilwind::variables::{Access, Value, by_reference};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Values of inputs, or of their derivatives per s, by value reference.
pub(super) type InputValues = BTreeMap<u32, f64>;

/// The last communication step as it began, for derivatives of what it led to.
#[derive(Clone, Debug)]
pub(crate) struct LastStep {
    pub(crate) simulation: Simulation,
    /// Inputs at its start.
    pub(crate) inputs: Inputs,
    /// Their derivatives, per s.
    pub(crate) rates: Inputs,
    /// Its length, s.
    pub(crate) step: f64,
}

/// A simulation with what the importer set since its last communication point.
#[derive(Debug)]
pub(super) struct Run {
    pub(super) simulation: Simulation,
    /// Inputs at the start of the next step.
    pub(super) inputs: Inputs,
    /// Derivatives of the inputs in the next step, per s.
    pub(super) rates: Inputs,
    /// The last step, if it went through. Saved states share it.
    pub(super) last: Option<Arc<LastStep>>,
    /// Files of the run, from the first communication point on, where `output.directory` names a
    /// folder.
    pub(super) recording: Option<Recording>,
}

impl Run {
    /// Starts a scene with `inputs`, where the importer's `values` replace them and `rates` are
    /// their derivatives in the first step. The nozzle follows its input or, `by_law`, the scene's law.
    ///
    /// # Errors
    ///
    /// [`Error::Start`] if the scene has no valid start.
    pub(super) fn start(
        scene: &Scene,
        by_law: bool,
        mut inputs: Inputs,
        values: &InputValues,
        rates: &InputValues,
    ) -> Result<Self, Error> {
        for (reference, value) in values {
            write_input(&mut inputs, *reference, *value);
        }
        let simulation = match by_law {
            true => Simulation::starting_by_law(scene, inputs),
            false => Simulation::starting_with(scene, inputs),
        };
        let mut simulation = simulation.map_err(Error::Start)?;
        simulation.step_beyond(scene.solver.features.steps_beyond);
        let mut slopes = Inputs::HELD;
        for (reference, rate) in rates {
            write_input(&mut slopes, *reference, *rate);
        }
        Ok(Self {
            simulation,
            inputs,
            rates: slopes,
            last: None,
            recording: None,
        })
    }

    /// Holds inputs at the ends of their ranges that their derivatives would lead beyond within a step of `step` s, and
    /// says which. Inputs change evenly, so that the end of the step tells.
    pub(super) fn hold_inputs(&mut self, step: f64) -> Vec<String> {
        let mut held = Vec::new();
        let end = self.inputs.after(&self.rates, step);
        for variable in coilwind_model_description::variables() {
            let Access::Input { get, set } = variable.access else {
                continue;
            };
            let (rate, wanted) = (get(&self.rates), get(&end));
            if rate == 0.0 || variable.admits(&Value::Real(wanted)) {
                continue;
            }
            let from = get(&self.inputs);
            let limit = variable.nearest(wanted);
            let within = |rate: f64| variable.admits(&Value::Real(from + rate * step));
            let mut slower = (limit - from) / step;
            if !within(slower) {
                // rounding has led beyond the limit
                slower -= 2.0 * (from + slower * step - limit) / step;
            }
            set(&mut self.rates, if within(slower) { slower } else { 0.0 });
            held.push(format!(
                "{} would be {} at the end of the step and is held at {}; allowed: {}",
                variable.name,
                Value::Real(wanted),
                Value::Real(limit),
                variable.allowed()
            ));
        }
        held
    }
}

/// Writes one input, given by value reference. Other variables are left alone.
pub(super) fn write_input(inputs: &mut Inputs, reference: u32, value: f64) {
    if let Some(Access::Input { set, .. }) = by_reference(reference).map(|row| row.access) {
        set(inputs, value);
    }
}
