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
    /// their derivatives in the first step.
    ///
    /// # Errors
    ///
    /// [`Error::Start`] if the scene has no valid start.
    pub(super) fn start(
        scene: &Scene,
        mut inputs: Inputs,
        values: &InputValues,
        rates: &InputValues,
    ) -> Result<Self, Error> {
        for (reference, value) in values {
            write_input(&mut inputs, *reference, *value);
        }
        let mut simulation = Simulation::starting_with(scene, inputs).map_err(Error::Start)?;
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

    /// Checks that the inputs stay in their ranges over a step of `step` s. They change evenly, so
    /// that both ends tell.
    ///
    /// # Errors
    ///
    /// [`Error::LeavesRange`] for the first input that does not.
    pub(super) fn check_inputs(&self, step: f64) -> Result<(), Error> {
        let end = self.inputs.after(&self.rates, step);
        for variable in coilwind_model_description::variables() {
            let Access::Input { get, .. } = variable.access else {
                continue;
            };
            let value = get(&end);
            if get(&self.rates) != 0.0 && !variable.admits(&Value::Real(value)) {
                return Err(Error::LeavesRange {
                    name: variable.name,
                    value,
                    allowed: variable.allowed(),
                });
            }
        }
        Ok(())
    }
}

/// Writes one input, given by value reference. Other variables are left alone.
pub(super) fn write_input(inputs: &mut Inputs, reference: u32, value: f64) {
    if let Some(Access::Input { set, .. }) = by_reference(reference).map(|row| row.access) {
        set(inputs, value);
    }
}
