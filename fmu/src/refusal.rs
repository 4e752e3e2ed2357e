//! Why a call is not served: what the importer gets as status and reads in its log.

use crate::clock::TimeError;
use crate::ffi::Status;
use crate::state::BytesError;
use coilwind::scene::SceneError;
use coilwind::simulation::{RestoreError, SimError};
use coilwind::variables::Value;
use coilwind_model_description::{Category, DescriptionError};

/// Reason of a call that did not succeed; the instance is as it was unless said otherwise.
#[derive(Debug, thiserror::Error)]
pub(crate) enum Refusal {
    /// an argument is NULL where data is needed
    #[error("{argument} is NULL")]
    Null { argument: &'static str },
    /// a string is not UTF-8
    #[error("{argument} is not UTF-8")]
    Encoding { argument: &'static str },
    /// `fmi2Instantiate` without a name
    #[error("instanceName is empty")]
    NoName,
    /// the library belongs to another description
    #[error("fmuGUID {given} is not {expected}, the one in this library's modelDescription.xml")]
    Guid {
        given: String,
        expected: &'static str,
    },
    /// model exchange
    #[error("fmuType {given}: this FMU is for co-simulation (1) only")]
    InterfaceType { given: i32 },
    /// the library cannot describe itself
    #[error("modelDescription.xml: {0}")]
    Description(#[from] DescriptionError),
    /// no variable has that reference
    #[error("no variable has value reference {reference}")]
    UnknownReference { reference: u32 },
    /// the variable has another type than the function
    #[error("{name} has type {declared}, the call is for {asked}")]
    WrongType {
        name: &'static str,
        declared: &'static str,
        asked: &'static str,
    },
    /// results cannot be written
    #[error("{name} is calculated and cannot be set")]
    Calculated { name: &'static str },
    /// a fixed parameter after the start
    #[error("{name} is fixed and cannot be set after fmi2ExitInitializationMode")]
    Fixed { name: &'static str },
    /// NaN, infinite, outside the declared limits or not among the choices
    #[error("{name} = {value} is not allowed: {allowed}")]
    NotAllowed {
        name: &'static str,
        value: Value,
        allowed: String,
    },
    /// a parameter or the scene made of all of them is not valid
    #[error("{0}")]
    Scene(Box<SceneError>),
    /// the scene has no valid start
    #[error("start: {0}")]
    Start(SimError),
    /// the solver gave up: the instance is in the step-failed state
    #[error(
        "step from {from} s by {step} s failed: {reason}; last successful time {reached} s, turn {turn:.3}, core at {:.1} deg",
        angle.to_degrees()
    )]
    StepFailed {
        from: f64,
        step: f64,
        reached: f64,
        turn: f64,
        angle: f64,
        reason: SimError,
    },
    /// an input would leave its range on the way
    #[error("{name} would be {value} at the end of the step: {allowed}")]
    LeavesRange {
        name: &'static str,
        value: f64,
        allowed: String,
    },
    /// no derivative of that order, or of that variable
    #[error("derivative of order {order} of {name}: {reason}")]
    NoDerivative {
        name: &'static str,
        order: i32,
        reason: &'static str,
    },
    /// the step that the derivatives belong to cannot be solved
    #[error("directional derivative: {0}")]
    NoTangent(SimError),
    /// a derivative that is not a number
    #[error("derivative of {name} = {value} is not a finite number")]
    DerivativeNotFinite { name: &'static str, value: f64 },
    /// bytes that are no saved state, or not one for here
    #[error("serializedState: {0}")]
    Bytes(#[from] BytesError),
    /// a state cannot be written or has nothing to be read from
    #[error("state: {0}")]
    State(#[from] RestoreError),
    /// the importer's buffer is shorter than announced by `fmi2SerializedFMUstateSize`
    #[error("size = {size}, but the state takes {needed} bytes")]
    Buffer { size: usize, needed: usize },
    /// a time or step that makes no sense
    #[error("{0}")]
    Time(#[from] TimeError),
    /// not a declared category
    #[error("log category {name} is not declared")]
    UnknownCategory { name: String },
    /// declared unsupported in the XML
    #[error("not supported: modelDescription.xml says {capability}")]
    Unsupported { capability: &'static str },
    /// a status that a synchronous FMU does not have
    #[error("{kind} is not available: steps are never pending")]
    NoStatus { kind: String },
    /// the solver handed over a number that is none: the instance is in the step-failed state
    #[error("{name} = {value} after the step to {time} s")]
    NotANumber {
        name: &'static str,
        value: f64,
        time: f64,
    },
}

impl Refusal {
    /// Status and category of the message.
    pub(crate) fn status(&self) -> (Status, Category) {
        match self {
            Refusal::NoStatus { .. } | Refusal::StepFailed { .. } => {
                (Status::Discard, Category::Discard)
            }
            _ => (Status::Error, Category::Error),
        }
    }
}

// Scene errors are much larger than all others; boxed they do not weigh on every call.
impl From<SceneError> for Refusal {
    fn from(error: SceneError) -> Self {
        Self::Scene(Box::new(error))
    }
}
