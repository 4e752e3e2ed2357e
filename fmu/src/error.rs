//! Every reason why a call fails: the status that the importer gets and the text in its log.

use crate::ffi::Status;
use coilwind::output::OutputError;
use coilwind::scene::SceneError;
use coilwind::simulation::{RestoreError, SimError};
use coilwind::variables::Value;
use coilwind_model_description::{Category, DescriptionError};
use std::path::PathBuf;

/// Reason why a call failed. The instance is as it was before the call unless the variant says
/// otherwise.
#[derive(Debug, thiserror::Error)]
pub(crate) enum Error {
    /// An argument is NULL where data is needed.
    #[error("{argument} is NULL, but this call needs data there")]
    Null {
        /// Name of the argument.
        argument: &'static str,
    },
    /// A string is not UTF-8.
    #[error("{argument} is not UTF-8, the encoding of every FMI string")]
    Encoding {
        /// Name of the argument.
        argument: &'static str,
    },
    /// `fmi2Instantiate` got an empty name.
    #[error("instanceName is empty; give the instance a name")]
    NoName,
    /// The library belongs to another description.
    #[error(
        "fmuGUID {given} is not {expected}, the one in this library's modelDescription.xml; \
         use both from the same FMU"
    )]
    Guid {
        /// The importer's GUID.
        given: String,
        /// The library's GUID.
        expected: &'static str,
    },
    /// The importer asked for model exchange.
    #[error("fmuType {given}: this FMU is for co-simulation (1) only")]
    InterfaceType {
        /// The importer's `fmi2Type`.
        given: i32,
    },
    /// The library cannot describe itself, so it has no GUID to compare.
    #[error("modelDescription.xml: {0}")]
    Description(#[from] DescriptionError),
    /// No variable has that reference.
    #[error("no variable in modelDescription.xml has value reference {reference}")]
    UnknownReference {
        /// The importer's value reference.
        reference: u32,
    },
    /// The variable has another type than the function.
    #[error("{name} has type {declared}, the call is for {asked}; use the function for {declared}")]
    WrongType {
        /// Name of the variable.
        name: &'static str,
        /// Type of the variable.
        declared: &'static str,
        /// Type that the function is for.
        asked: &'static str,
    },
    /// The importer tried to set a result.
    #[error("{name} is calculated and cannot be set")]
    Calculated {
        /// Name of the variable.
        name: &'static str,
    },
    /// The importer tried to set a fixed parameter after the start.
    #[error(
        "{name} is fixed and cannot be set after fmi2ExitInitializationMode; \
         set it earlier, after fmi2Reset if need be"
    )]
    Fixed {
        /// Name of the parameter.
        name: &'static str,
    },
    /// A value is not finite, outside the declared limits or not among the choices.
    #[error("{name} = {value} is not allowed: {allowed}")]
    NotAllowed {
        /// Name of the variable.
        name: &'static str,
        /// The importer's value, in the unit of the variable.
        value: Value,
        /// What the variable allows, in words.
        allowed: String,
    },
    /// A parameter is not valid, or the scene made of all of them is not.
    #[error("{0}")]
    Scene(Box<SceneError>),
    /// A file is in none of the places where it may be.
    #[error("{name} = {file} is no file{}", looked_in(places))]
    NoFile {
        /// Name of the parameter.
        name: &'static str,
        /// The importer's name of the file.
        file: String,
        /// The folders that were looked in, in words.
        places: String,
    },
    /// The scene has no valid start.
    #[error("start: {0}")]
    Start(SimError),
    /// The solver gave up. The instance is in the step-failed state, at the time reached.
    #[error(
        "step from {from} s by {step} s failed: {reason}; last successful time {reached} s, \
         turn {turn:.3}, core at {:.1} deg; to go on, restore a saved state or call fmi2Reset",
        angle.to_degrees()
    )]
    StepFailed {
        /// Start of the step, s.
        from: f64,
        /// Length of the step, s.
        step: f64,
        /// Last time that the solver reached, s.
        reached: f64,
        /// Turns wound at that time.
        turn: f64,
        /// Spindle angle at that time, rad.
        angle: f64,
        /// What stopped the solver.
        reason: SimError,
    },
    /// The solver computed an output that is not finite. The instance is in the step-failed state.
    #[error(
        "{name} = {value} after the step to {time} s; \
         to go on, restore a saved state or call fmi2Reset"
    )]
    NotANumber {
        /// Name of the output.
        name: &'static str,
        /// Its value, in the unit of the output.
        value: f64,
        /// End of the step, s.
        time: f64,
    },
    /// The tolerance of the experiment is not one.
    #[error("tolerance = {value} is not allowed: a finite number above 0")]
    Tolerance {
        /// The importer's tolerance.
        value: f64,
    },
    /// The variable has no derivative of that order.
    #[error("derivative of order {order} of {name}: {reason}")]
    NoDerivative {
        /// Name of the variable.
        name: &'static str,
        /// The importer's order.
        order: i32,
        /// What is available instead.
        reason: &'static str,
    },
    /// No step near the one that the directional derivatives belong to has a solution.
    #[error("directional derivative: {0}")]
    NoTangent(SimError),
    /// Directional derivatives are those of the last step, which failed.
    #[error(
        "directional derivatives are those of the last communication step, and that failed; \
         set a saved state or call fmi2Reset"
    )]
    NoLastStep,
    /// The importer's derivative is not finite.
    #[error("derivative of {name} = {value} is not a finite number")]
    DerivativeNotFinite {
        /// Name of the variable.
        name: &'static str,
        /// The importer's value, in the unit of the variable per s where it is one by time.
        value: f64,
    },
    /// The bytes are not a saved state, or not one of this FMU.
    #[error("serializedState: {0}")]
    Bytes(#[from] BytesError),
    /// A simulation cannot be written to bytes or made from them.
    #[error("state: {0}")]
    State(#[from] RestoreError),
    /// The importer's buffer is shorter than `fmi2SerializedFMUstateSize` said.
    #[error("size = {size}, but the state takes {needed} bytes; ask fmi2SerializedFMUstateSize")]
    Buffer {
        /// Bytes of the buffer.
        size: usize,
        /// Bytes of the state.
        needed: usize,
    },
    /// A time or a step size is not valid.
    #[error("{0}")]
    Time(#[from] TimeError),
    /// The log category is not declared.
    #[error(
        "log category {name} is not declared; \
         modelDescription.xml lists the names under LogCategories"
    )]
    UnknownCategory {
        /// The importer's name.
        name: String,
    },
    /// The XML declares the function as unsupported.
    #[error("not supported: modelDescription.xml says {capability}")]
    Unsupported {
        /// The attribute of `CoSimulation` and its value.
        capability: &'static str,
    },
    /// The status exists for asynchronous steps only. The importer gets `fmi2Discard`.
    #[error("{kind} is not available: steps are never pending")]
    NoStatus {
        /// Name or number of the status kind.
        kind: String,
    },
}

impl Error {
    /// Returns the status of the call and the log category of its message.
    pub(crate) fn status(&self) -> (Status, Category) {
        match self {
            Self::NoStatus { .. } | Self::StepFailed { .. } => (Status::Discard, Category::Discard),
            _ => (Status::Error, Category::Error),
        }
    }
}

// A scene error is much larger than the others. Boxed it does not enlarge every result.
impl From<SceneError> for Error {
    fn from(error: SceneError) -> Self {
        Self::Scene(Box::new(error))
    }
}

/// Why a time or a step size is not valid. All times are in s.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub(crate) enum TimeError {
    /// The number is NaN or infinite.
    #[error("{what} = {value} is not a finite number")]
    NotFinite {
        /// Name of the argument.
        what: &'static str,
        /// The importer's value.
        value: f64,
    },
    /// The experiment ends before it starts.
    #[error("stopTime = {stop} s is not after startTime = {start} s")]
    Backwards {
        /// `startTime`
        start: f64,
        /// `stopTime`
        stop: f64,
    },
    /// The step is zero or negative.
    #[error("communicationStepSize = {step} s must be above 0")]
    NoStep {
        /// `communicationStepSize`
        step: f64,
    },
    /// The sum of time and step is the time itself.
    #[error("communicationStepSize = {step:e} s is lost in rounding at {time} s; make it longer")]
    TooSmall {
        /// `communicationStepSize`
        step: f64,
        /// `currentCommunicationPoint`
        time: f64,
    },
    /// Nothing that an input is changed by in so short a step has a finite rate.
    #[error("communicationStepSize = {step:e} s is too short; allowed: {shortest:e} s or more")]
    TooShort {
        /// `communicationStepSize`
        step: f64,
        /// Shortest step that is allowed.
        shortest: f64,
    },
    /// The step does not begin where the last one ended.
    #[error(
        "currentCommunicationPoint = {given} s, but the last step ended at {expected} s; \
         continue there"
    )]
    Elsewhere {
        /// `currentCommunicationPoint`
        given: f64,
        /// End of the last step.
        expected: f64,
    },
    /// The step ends after the experiment.
    #[error("step would end at {end} s, after stopTime = {stop} s; make it shorter")]
    PastStop {
        /// End of the step.
        end: f64,
        /// `stopTime`
        stop: f64,
    },
}

/// Why bytes are not a saved state of this FMU.
#[derive(Debug, thiserror::Error)]
pub(crate) enum BytesError {
    /// The bytes begin with another magic or are too short for a header.
    #[error("these {size} bytes are not a state of this FMU")]
    Foreign {
        /// Number of bytes.
        size: usize,
    },
    /// The bytes have another version of the format.
    #[error(
        "the state is of version {found}, this FMU reads version {expected}; \
         use the FMU that wrote it"
    )]
    Version {
        /// Version of the bytes.
        found: u32,
        /// Version of this library.
        expected: u32,
    },
    /// An FMU with other variables wrote the bytes.
    #[error("the state is of the FMU {found}, this one is {expected}; use the FMU that wrote it")]
    Guid {
        /// GUID in the bytes.
        found: String,
        /// GUID of this library.
        expected: &'static str,
    },
    /// The end is missing.
    #[error("the state takes {needed} bytes, {size} are there; pass all of them")]
    Truncated {
        /// Number of bytes that are there.
        size: usize,
        /// Number of bytes that the header announces, itself included.
        needed: u64,
    },
    /// There is something else behind the state.
    #[error(
        "the state takes {needed} of {size} bytes, and the others are not zero; pass the state as it was written"
    )]
    Longer {
        /// Number of bytes that are there.
        size: usize,
        /// Number of bytes that the header announces, itself included.
        needed: u64,
    },
    /// The checksum does not fit.
    #[error("the state is damaged: its checksum is wrong; use another copy")]
    Damaged,
    /// The bytes can be decoded, but no instance is ever in such a state.
    #[error("the state contradicts itself: {0}")]
    Impossible(&'static str),
    /// The state cannot be encoded or the bytes cannot be decoded.
    #[error("the state cannot be read: {0}")]
    Code(#[from] postcard::Error),
}

/// Why a file in `output.directory` could not be written. The run goes on without it.
#[derive(Debug, thiserror::Error)]
pub(crate) enum RecordError {
    /// The folder cannot be made, or the scene cannot be written to it.
    #[error("cannot write {}: {source}", path.display())]
    Folder {
        /// The folder or the file.
        path: PathBuf,
        /// What the operating system says.
        source: std::io::Error,
    },
    /// A result file cannot be written.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// The core's surface, which the picture shows, cannot be made.
    #[error(transparent)]
    Core(#[from] SimError),
}

/// The end of a message about a file that is missing: where it was looked for, unless its path is absolute.
fn looked_in(places: &str) -> String {
    match places {
        "" => String::new(),
        places => format!("; looked in {places}"),
    }
}
