//! One instance of the FMU in safe Rust: what each FMI function means.

mod derivatives;
mod restore;

use crate::clock::Clock;
use crate::ffi::{self, Status, fmi2String};
use crate::lifecycle::State;
use crate::logger::{Filter, Message, c_string};
use crate::parameters::Parameters;
use crate::recording::{RecordError, Recording};
use crate::refusal::Refusal;
use crate::resources;
use crate::scalar::Scalar;
use coilwind::output::Ending;
use coilwind::scene::Warning;
use coilwind::simulation::{Event, EventKind, Inputs, SimError, Simulation};
use coilwind::variables::{Access, Causality, Value, Variability, Variable, by_reference};
use coilwind_model_description::{Category, guid};
use std::collections::BTreeMap;
use std::ffi::CString;
use std::path::PathBuf;
use std::time::Instant;

/// What stays the same when an instance is reset.
#[derive(Clone, Debug)]
struct Identity {
    resources: Option<PathBuf>,
    logging_on: bool,
}

/// The simulation of a started instance and the inputs of its next step.
#[derive(Debug)]
struct Run {
    simulation: Simulation,
    inputs: Inputs,
    /// derivatives of the inputs in the next step, per s
    rates: Inputs,
    /// files, from the first communication point on, where `output.directory` names a folder
    recording: Option<Recording>,
}

/// An FMU instance between two calls.
#[derive(Debug)]
pub(crate) struct Instance {
    identity: Identity,
    state: State,
    clock: Clock,
    parameters: Parameters,
    /// inputs that the importer set before the start, by reference
    start_inputs: BTreeMap<u32, f64>,
    /// their derivatives
    start_rates: BTreeMap<u32, f64>,
    /// made when first needed in initialization mode, thrown away when something is set there
    ///
    /// Boxed: a simulation is large, and every call would move it.
    run: Option<Box<Run>>,
    /// strings handed out by the last call
    strings: Vec<CString>,
    filter: Filter,
    messages: Vec<Message>,
}

impl Instance {
    /// `fmi2Instantiate`; `location` is the resource URI, if the importer gave one.
    pub(crate) fn new(
        name: &str,
        interface_type: i32,
        given_guid: &str,
        location: Option<&str>,
        logging_on: bool,
    ) -> Result<Self, Refusal> {
        if name.is_empty() {
            return Err(Refusal::NoName);
        }
        if interface_type != ffi::CO_SIMULATION {
            return Err(Refusal::InterfaceType {
                given: interface_type,
            });
        }
        let expected = guid()?;
        if given_guid != expected {
            return Err(Refusal::Guid {
                given: given_guid.to_owned(),
                expected,
            });
        }
        let resources = location.and_then(resources::directory);
        Ok(Self::fresh(Identity {
            resources,
            logging_on,
        }))
    }

    fn fresh(identity: Identity) -> Self {
        Self {
            state: State::Instantiated,
            clock: Clock::default(),
            parameters: Parameters::new(),
            start_inputs: BTreeMap::new(),
            start_rates: BTreeMap::new(),
            run: None,
            strings: Vec::new(),
            filter: Filter::new(identity.logging_on),
            messages: Vec::new(),
            identity,
        }
    }

    #[cfg(test)]
    pub(crate) fn for_tests() -> Self {
        Self::fresh(Identity {
            resources: None,
            logging_on: true,
        })
    }

    /// In a state as if the calls that lead there had been made.
    #[cfg(test)]
    pub(crate) fn planted(state: State) -> Self {
        Self {
            state,
            ..Self::for_tests()
        }
    }

    /// State between calls.
    pub(crate) fn state(&self) -> State {
        self.state
    }

    /// Strings handed out earlier end their life here.
    pub(crate) fn begin_call(&mut self) {
        self.strings.clear();
    }

    /// Messages that the importer wants of those that came up.
    pub(crate) fn end_call(&mut self) -> Vec<Message> {
        let messages = std::mem::take(&mut self.messages);
        messages
            .into_iter()
            .filter(|message| self.filter.passes(message))
            .collect()
    }

    /// Whether a message would be delivered.
    pub(crate) fn wants(&self, message: &Message) -> bool {
        self.filter.passes(message)
    }

    /// After a panic.
    pub(crate) fn lose(&mut self) {
        self.state = State::Fatal;
    }

    /// `fmi2SetDebugLogging`
    pub(crate) fn set_debug_logging(&mut self, on: bool, names: &[String]) -> Result<(), Refusal> {
        self.filter = Filter::with(on, names)?;
        Ok(())
    }

    /// `fmi2SetupExperiment`; steps control their own error, so the tolerance is not used.
    pub(crate) fn setup_experiment(
        &mut self,
        start: f64,
        stop: Option<f64>,
    ) -> Result<(), Refusal> {
        self.clock = Clock::new(start, stop)?;
        Ok(())
    }

    /// `fmi2EnterInitializationMode`; parameters may still change, so nothing is judged yet.
    pub(crate) fn enter_initialization_mode(&mut self) -> Result<(), Refusal> {
        self.state = State::Initialization;
        Ok(())
    }

    /// `fmi2ExitInitializationMode`
    pub(crate) fn exit_initialization_mode(&mut self) -> Result<(), Refusal> {
        self.start()?;
        self.record();
        self.state = State::StepComplete;
        Ok(())
    }

    /// `fmi2Terminate`
    pub(crate) fn terminate(&mut self) -> Result<(), Refusal> {
        let ending = if self.clock.is_over() {
            Ending::Done
        } else {
            Ending::Interrupted
        };
        self.finish_recording(&ending);
        self.state = State::Terminated;
        Ok(())
    }

    /// `fmi2Reset`: a fresh instance with the same name, resources and logging.
    pub(crate) fn reset(&mut self) -> Result<(), Refusal> {
        self.finish_recording(&Ending::Interrupted);
        let messages = std::mem::take(&mut self.messages);
        *self = Self {
            messages,
            ..Self::fresh(self.identity.clone())
        };
        Ok(())
    }

    /// `fmi2FreeInstance`: a run that nobody terminated leaves its results all the same.
    pub(crate) fn close(&mut self) {
        if self.state != State::Fatal {
            self.finish_recording(&Ending::Interrupted);
        }
    }

    /// `fmi2GetReal` and its kin.
    pub(crate) fn get<T: Scalar>(&mut self, references: &[u32]) -> Result<Vec<T>, Refusal> {
        references
            .iter()
            .map(|reference| {
                let variable = find::<T>(*reference)?;
                T::from_value(self.value(variable)?).ok_or_else(|| wrong_type::<T>(variable))
            })
            .collect()
    }

    /// `fmi2GetString`: the pointers live until the next call on this instance.
    pub(crate) fn get_strings(
        &mut self,
        references: &[u32],
    ) -> Result<Vec<fmi2String>, Refusal> {
        let texts: Vec<String> = self.get(references)?;
        self.strings = texts.iter().map(|text| c_string(text)).collect();
        Ok(self.strings.iter().map(|text| text.as_ptr()).collect())
    }

    /// `fmi2SetReal` and its kin: all of the values or none.
    pub(crate) fn set<T: Scalar>(
        &mut self,
        references: &[u32],
        values: impl IntoIterator<Item = T>,
    ) -> Result<(), Refusal> {
        let changes = references
            .iter()
            .zip(values)
            .map(|(reference, value)| {
                let variable = find::<T>(*reference)?;
                let value = value.into_value();
                self.check(variable, &value)?;
                Ok((variable, value))
            })
            .collect::<Result<Vec<_>, Refusal>>()?;
        let (inputs, parameters): (Vec<_>, Vec<_>) = changes
            .into_iter()
            .partition(|change| change.0.causality == Causality::Input);
        if !parameters.is_empty() {
            self.set_parameters(&parameters)?;
        }
        self.set_inputs(&inputs);
        Ok(())
    }

    /// `fmi2DoStep`
    pub(crate) fn do_step(&mut self, point: f64, step: f64) -> Result<(), Refusal> {
        let end = self.clock.end_of(point, step)?;
        let run = self.start()?;
        derivatives::check_way(&run.inputs, &run.rates, step)?;
        let began = Instant::now();
        let result = run.simulation.advance_ramped(run.inputs, run.rates, step);
        if let Some(recording) = &mut run.recording {
            recording.computed(began.elapsed());
        }
        let events = run.simulation.drain_events();
        let simulated = run.simulation.time();
        self.messages.extend(events.iter().map(message_of));
        if let Err(reason) = result {
            let reached = self.clock.experiment_time(simulated);
            return Err(self.fail(point, step, reached, reason));
        }
        // derivatives count from the beginning of a step and hold for it
        if let Some(run) = &mut self.run {
            run.inputs = run.inputs.after(&run.rates, step);
            run.rates = Inputs::HELD;
        }
        if let Err(refusal) = self.check_outputs(end) {
            let reason = refusal.to_string();
            self.finish_recording(&Ending::Failed { reason });
            return Err(refusal);
        }
        self.clock.set(end);
        self.record_row();
        Ok(())
    }

    /// `fmi2GetRealStatus`
    pub(crate) fn real_status(&self, kind: i32) -> Result<f64, Refusal> {
        match kind {
            ffi::LAST_SUCCESSFUL_TIME => Ok(self.clock.now()),
            _ => Err(no_status(kind)),
        }
    }

    /// `fmi2GetBooleanStatus`: after a failed step the run cannot go on.
    pub(crate) fn boolean_status(&self, kind: i32) -> Result<bool, Refusal> {
        match kind {
            ffi::TERMINATED => Ok(self.state == State::StepFailed),
            _ => Err(no_status(kind)),
        }
    }

    /// `fmi2GetStatus`, `fmi2GetIntegerStatus`, `fmi2GetStringStatus`: only for pending steps.
    pub(crate) fn pending_status(&self, kind: i32) -> Result<(), Refusal> {
        Err(no_status(kind))
    }

    /// Makes the simulation of the present parameters and inputs, unless it is there.
    fn start(&mut self) -> Result<&mut Run, Refusal> {
        let run = match self.run.take() {
            Some(run) => run,
            None => {
                let (scene, warnings) = self.parameters.scene()?;
                let mut inputs = self.parameters.start_inputs();
                for (reference, value) in &self.start_inputs {
                    write_input(&mut inputs, *reference, *value);
                }
                let simulation =
                    Simulation::starting_with(&scene, inputs).map_err(Refusal::Start)?;
                self.messages
                    .extend(warnings.iter().map(message_of_warning));
                let mut rates = Inputs::HELD;
                for (reference, rate) in &self.start_rates {
                    write_input(&mut rates, *reference, *rate);
                }
                Box::new(Run {
                    simulation,
                    inputs,
                    rates,
                    recording: None,
                })
            }
        };
        Ok(self.run.insert(run).as_mut())
    }

    fn value(&mut self, variable: &Variable) -> Result<Value, Refusal> {
        if let Some(value) = self.parameters.get(variable) {
            return Ok(value);
        }
        let run = self.start()?;
        Ok(match variable.access {
            Access::Input { get, .. } => Value::Real(get(&run.inputs)),
            Access::Output(get) => get(run.simulation.outputs()),
            Access::Parameter { .. } => {
                return Err(Refusal::Calculated {
                    name: variable.name,
                });
            }
        })
    }

    /// Whether a variable may be set now, to that value.
    fn check(&self, variable: &'static Variable, value: &Value) -> Result<(), Refusal> {
        let name = variable.name;
        match variable.causality {
            Causality::Output | Causality::Local => return Err(Refusal::Calculated { name }),
            Causality::Parameter
                if variable.variability == Variability::Fixed
                    && self.state == State::StepComplete =>
            {
                return Err(Refusal::Fixed { name });
            }
            Causality::Parameter | Causality::Input => {}
        }
        if variable.admits(value) {
            return Ok(());
        }
        Err(Refusal::NotAllowed {
            name,
            value: value.clone(),
            allowed: variable.allowed(),
        })
    }

    fn set_parameters(&mut self, changes: &[(&'static Variable, Value)]) -> Result<(), Refusal> {
        let parameters = self
            .parameters
            .with(changes, self.identity.resources.as_deref())?;
        if self.state == State::StepComplete {
            let (scene, _) = parameters.scene()?;
            if let Some(run) = self.run.as_mut() {
                run.simulation.retune(&scene);
            }
        } else {
            self.run = None;
        }
        self.parameters = parameters;
        Ok(())
    }

    fn set_inputs(&mut self, changes: &[(&'static Variable, Value)]) {
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

    /// Opens the files of `output.directory`, if it names a folder.
    fn record(&mut self) {
        let Some(run) = &mut self.run else { return };
        let settings = self.parameters.settings();
        if settings.output.directory.is_empty() {
            return;
        }
        match Recording::start(settings, &run.simulation) {
            Ok(recording) => run.recording = Some(recording),
            Err(reason) => self.messages.push(not_written(&reason)),
        }
        self.record_row();
    }

    /// Adds this communication point to the files.
    fn record_row(&mut self) {
        if let Some(run) = &mut self.run
            && let Some(recording) = &mut run.recording
            && let Err(reason) = recording.row(self.clock.now(), &run.simulation)
        {
            self.messages.push(not_written(&reason));
        }
    }

    /// Writes the results and closes the files; does nothing the second time.
    fn finish_recording(&mut self, ending: &Ending) {
        if let Some(run) = &mut self.run
            && let Some(recording) = run.recording.take()
            && let Err(reason) = recording.finish(&run.simulation, ending)
        {
            self.messages.push(not_written(&reason));
        }
    }

    /// The solver gave up; values of the last successful time can still be read.
    fn fail(&mut self, from: f64, step: f64, reached: f64, reason: SimError) -> Refusal {
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
        Refusal::StepFailed {
            from,
            step,
            reached,
            turn,
            angle,
            reason,
        }
    }

    /// No NaN leaves unseen.
    fn check_outputs(&mut self, time: f64) -> Result<(), Refusal> {
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
                return Err(Refusal::NotANumber {
                    name: variable.name,
                    value,
                    time,
                });
            }
        }
        Ok(())
    }
}

/// The variable of that reference, if importers may see it and it has the type of the call.
fn find<T: Scalar>(reference: u32) -> Result<&'static Variable, Refusal> {
    let variable = by_reference(reference)
        .filter(|variable| !variable.native_only)
        .ok_or(Refusal::UnknownReference { reference })?;
    if variable.kind == T::KIND {
        Ok(variable)
    } else {
        Err(wrong_type::<T>(variable))
    }
}

fn wrong_type<T: Scalar>(variable: &Variable) -> Refusal {
    Refusal::WrongType {
        name: variable.name,
        declared: variable.kind.as_str(),
        asked: T::KIND.as_str(),
    }
}

fn write_input(inputs: &mut Inputs, reference: u32, value: f64) {
    if let Some(Access::Input { set, .. }) = by_reference(reference).map(|row| row.access) {
        set(inputs, value);
    }
}

fn no_status(kind: i32) -> Refusal {
    let name = usize::try_from(kind)
        .ok()
        .and_then(|kind| ffi::STATUS_KINDS.get(kind));
    let kind = name.map_or_else(|| format!("status kind {kind}"), |name| (*name).to_owned());
    Refusal::NoStatus { kind }
}

/// An event of the simulation as the importer reads it.
fn message_of(event: &Event) -> Message {
    let (status, category) = match event.kind {
        EventKind::Turn | EventKind::Defect => (Status::Ok, Category::Events),
        // The wire is still computed, but a machine would have stopped.
        EventKind::Slack | EventKind::Break | EventKind::Solver => {
            (Status::Warning, Category::Warning)
        }
    };
    Message {
        status,
        category,
        text: event.to_string(),
    }
}

/// A scene that runs, but perhaps not as meant.
fn message_of_warning(warning: &Warning) -> Message {
    Message {
        status: Status::Warning,
        category: Category::Warning,
        text: warning.to_string(),
    }
}

/// A file that could not be written: the run itself is as good as without it.
fn not_written(reason: &RecordError) -> Message {
    Message {
        status: Status::Warning,
        category: Category::Warning,
        text: format!("output.directory: {reason}"),
    }
}
