//! Values of variables: which may be read and set when, and what a change does.

use super::Instance;
use super::run::write_input;
use crate::error::Error;
use crate::ffi::fmi2String;
use crate::lifecycle::State;
use crate::logger::c_string;
use crate::scalar::{Scalar, find, wrong_type};
use coilwind::simulation::SimError;
use coilwind::variables::{Access, Causality, Value, Variability, Variable};

/// A variable with the value that it is to have.
type Change = (&'static Variable, Value);

impl Instance {
    /// `fmi2GetReal` and its kin: one value per reference, in the units of the variables.
    ///
    /// # Errors
    ///
    /// If a reference is unknown or of another type, or if the simulation has to be made and
    /// cannot be.
    pub(crate) fn get<T: Scalar>(&mut self, references: &[u32]) -> Result<Vec<T>, Error> {
        references
            .iter()
            .map(|reference| {
                let variable = find::<T>(*reference)?;
                T::from_value(self.value(variable)?).ok_or_else(|| wrong_type::<T>(variable))
            })
            .collect()
    }

    /// `fmi2GetString`. The pointers live until the next call on this instance.
    ///
    /// # Errors
    ///
    /// As for [`Self::get`].
    pub(crate) fn get_strings(&mut self, references: &[u32]) -> Result<Vec<fmi2String>, Error> {
        let texts: Vec<String> = self.get(references)?;
        self.strings = texts.iter().map(|text| c_string(text)).collect();
        Ok(self.strings.iter().map(|text| text.as_ptr()).collect())
    }

    /// `fmi2SetReal` and its kin: sets all of the values or none.
    ///
    /// # Errors
    ///
    /// If a reference is unknown or of another type, a variable may not be set now, or a value is
    /// not allowed. An input beyond its range is held at the end of the range, with a warning.
    pub(crate) fn set<T: Scalar>(
        &mut self,
        references: &[u32],
        values: impl IntoIterator<Item = T>,
    ) -> Result<(), Error> {
        let mut held_texts = Vec::new();
        let changes = references
            .iter()
            .zip(values)
            .map(|(reference, value)| {
                let variable = find::<T>(*reference)?;
                let value = value.into_value();
                let (value, text) = held(variable, value);
                held_texts.extend(text);
                self.check(variable, &value)?;
                Ok((variable, value))
            })
            .collect::<Result<Vec<_>, Error>>()?;
        let (inputs, parameters): (Vec<_>, Vec<_>) = changes
            .into_iter()
            .partition(|change| change.0.causality == Causality::Input);
        if !parameters.is_empty() {
            self.set_parameters(&parameters)?;
        }
        self.set_inputs(&inputs);
        for text in held_texts {
            self.warn(text);
        }
        Ok(())
    }

    fn value(&mut self, variable: &Variable) -> Result<Value, Error> {
        if let Some(value) = self.parameters.get(variable) {
            return Ok(value);
        }
        let run = self.start()?;
        Ok(match variable.access {
            Access::Input { get, .. } => Value::Real(get(&run.inputs)),
            Access::Output(get) => get(run.simulation.outputs()),
            Access::Parameter { .. } | Access::Choice(_) => {
                return Err(Error::Calculated {
                    name: variable.name,
                });
            }
        })
    }

    /// Checks that a variable may be set now, and to that value.
    fn check(&self, variable: &'static Variable, value: &Value) -> Result<(), Error> {
        let name = variable.name;
        match variable.causality {
            Causality::Output | Causality::Local => return Err(Error::Calculated { name }),
            Causality::Parameter
                if variable.variability == Variability::Fixed
                    && self.state == State::StepComplete =>
            {
                return Err(Error::Fixed { name });
            }
            Causality::Parameter | Causality::Input => {}
        }
        if variable.admits(value) {
            return Ok(());
        }
        Err(Error::NotAllowed {
            name,
            value: value.clone(),
            allowed: variable.allowed(),
        })
    }

    /// Sets parameters. At a communication point the next step takes over the tunable ones, since each of them
    /// may come in a call of its own; earlier the simulation is built once more.
    fn set_parameters(&mut self, changes: &[Change]) -> Result<(), Error> {
        let parameters = self
            .parameters
            .with(changes, self.identity.resources.as_deref())?;
        if self.state != State::StepComplete {
            self.run = None;
        }
        self.parameters = parameters;
        Ok(())
    }

    /// Lets the simulation take over tunable parameters that were set since the last step.
    ///
    /// # Errors
    ///
    /// If the parameters contradict each other, or if the simulation gives up on the way to the communication point, from
    /// which on they hold.
    pub(super) fn retune(&mut self) -> Result<Result<(), SimError>, Error> {
        let Some(run) = self.run.as_mut() else {
            return Ok(Ok(()));
        };
        let (friction, defects) = self.parameters.tunable();
        let scene = run.simulation.scene();
        if scene.friction == friction && scene.defects == defects {
            return Ok(Ok(()));
        }
        let (scene, _) = self.parameters.scene()?;
        Ok(run.simulation.retune(&scene))
    }

    fn set_inputs(&mut self, changes: &[Change]) {
        if !changes.is_empty() {
            self.end_demonstration();
        }
        for (variable, value) in changes {
            let Value::Real(value) = value else { continue };
            match self
                .run
                .as_mut()
                .filter(|_| self.state == State::StepComplete)
            {
                Some(run) => write_input(&mut run.inputs, variable.reference, *value),
                None => {
                    self.start_inputs.insert(variable.reference, *value);
                    self.run = None;
                }
            }
        }
    }
}

/// Returns the value that a variable takes for `value`: an input that is a number beyond its range stays at the end of the
/// range, and a text says so.
fn held(variable: &Variable, value: Value) -> (Value, Option<String>) {
    match value {
        Value::Real(x)
            if variable.causality == Causality::Input
                && x.is_finite()
                && variable.nearest(x) != x =>
        {
            let nearest = Value::Real(variable.nearest(x));
            let text = format!(
                "{} = {value} is held at {nearest}; allowed: {}",
                variable.name,
                variable.allowed()
            );
            (nearest, Some(text))
        }
        value => (value, None),
    }
}
