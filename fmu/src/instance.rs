//! One instance of the FMU in safe Rust.
//!
//! This file holds what an instance consists of. What the FMI functions do to it stands in
//! `phases`, `values`, `step`, `demonstration`, `derivatives` and `restore`.

mod demonstration;
mod derivatives;
mod files;
mod phases;
mod restore;
mod run;
mod step;
mod values;

use crate::clock::Clock;
use crate::error::Error;
use crate::ffi;
use crate::lifecycle::State;
use crate::logger::Filter;
use crate::message::Message;
use crate::parameters::Parameters;
use crate::resources;
use coilwind_model_description::guid;
pub(crate) use run::LastStep;
use run::{InputValues, Run};
use std::ffi::CString;
use std::path::PathBuf;

/// What stays the same when an instance is reset.
#[derive(Clone, Debug)]
struct Identity {
    resources: Option<PathBuf>,
    logging_on: bool,
}

/// An FMU instance between two calls.
#[derive(Debug)]
pub(crate) struct Instance {
    identity: Identity,
    state: State,
    clock: Clock,
    parameters: Parameters,
    /// Inputs that the importer set before the start.
    start_inputs: InputValues,
    /// Derivatives of inputs that the importer set before the start, per s.
    start_rates: InputValues,
    /// Whether the FMU demonstrates the scene's motion; decided where the start ends.
    demonstrates: bool,
    /// The simulation. Initialization mode makes it when a value of it is first needed, and drops
    /// it when a variable is set there.
    ///
    /// Boxed, because a simulation is large and every move of the instance would copy it.
    run: Option<Box<Run>>,
    /// What the scene of `run` warns of, which is told once, where the start ends. None where a restored state brought the run.
    of_scene: Option<Vec<Message>>,
    /// Strings that the last call handed out.
    strings: Vec<CString>,
    filter: Filter,
    /// Messages of the present call.
    messages: Vec<Message>,
    /// Whether the present call was served otherwise than asked for, and the importer is to know.
    warned: bool,
}

impl Instance {
    /// `fmi2Instantiate`. `location` is the URI of the resources, if the importer gave one.
    ///
    /// # Errors
    ///
    /// If the name is empty, the interface type is not co-simulation, or the GUID is not that of
    /// this library.
    pub(crate) fn new(
        name: &str,
        interface_type: i32,
        given_guid: &str,
        location: Option<&str>,
        logging_on: bool,
    ) -> Result<Self, Error> {
        if name.is_empty() {
            return Err(Error::NoName);
        }
        if interface_type != ffi::CO_SIMULATION {
            return Err(Error::InterfaceType {
                given: interface_type,
            });
        }
        let expected = guid()?;
        if given_guid != expected {
            return Err(Error::Guid {
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
            start_inputs: InputValues::new(),
            start_rates: InputValues::new(),
            demonstrates: false,
            run: None,
            of_scene: None,
            strings: Vec::new(),
            filter: Filter::new(identity.logging_on),
            messages: Vec::new(),
            warned: false,
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

    /// Returns an instance in a state that no call has led to.
    #[cfg(test)]
    pub(crate) fn planted(state: State) -> Self {
        Self {
            state,
            ..Self::for_tests()
        }
    }

    /// Returns the state between calls.
    pub(crate) fn state(&self) -> State {
        self.state
    }

    /// Begins a call. Strings that an earlier call handed out end their life here.
    pub(crate) fn begin_call(&mut self) {
        self.strings.clear();
        self.warned = false;
    }

    /// Tells whether the present call returns a warning.
    pub(crate) fn has_warned(&self) -> bool {
        self.warned
    }

    /// Serves the present call otherwise than asked for: says how, and lets the call return a warning.
    fn warn(&mut self, text: impl std::fmt::Display) {
        self.messages.push(Message::warning(text));
        self.warned = true;
    }

    /// Ends a call and returns those of its messages that the importer wants.
    pub(crate) fn end_call(&mut self) -> Vec<Message> {
        let messages = std::mem::take(&mut self.messages);
        messages
            .into_iter()
            .filter(|message| self.filter.passes(message))
            .collect()
    }

    /// Tells whether the importer wants a message.
    pub(crate) fn wants(&self, message: &Message) -> bool {
        self.filter.passes(message)
    }

    /// Marks the instance as lost after a panic.
    pub(crate) fn lose(&mut self) {
        self.state = State::Fatal;
    }

    /// `fmi2SetDebugLogging`
    ///
    /// # Errors
    ///
    /// [`Error::UnknownCategory`] if a name is not declared. The filter then stays as it is.
    pub(crate) fn set_debug_logging(&mut self, on: bool, names: &[String]) -> Result<(), Error> {
        self.filter = Filter::with(on, names)?;
        Ok(())
    }

    /// Returns the simulation. Makes it from the present parameters and inputs if there is none.
    ///
    /// # Errors
    ///
    /// If the scene is not valid or has no valid start.
    fn start(&mut self) -> Result<&mut Run, Error> {
        let run = match self.run.take() {
            Some(run) => run,
            None => {
                self.parameters
                    .find_files(self.identity.resources.as_deref())?;
                let (scene, warnings) = self.parameters.scene()?;
                let inputs = scene.start_inputs();
                let by_law = self.parameters.settings().nozzle_follows_law();
                let run = Run::start(
                    &scene,
                    by_law,
                    inputs,
                    &self.start_inputs,
                    &self.start_rates,
                )?;
                self.of_scene = Some(warnings.iter().map(Message::warning).collect());
                Box::new(run)
            }
        };
        Ok(self.run.insert(run).as_mut())
    }
}
