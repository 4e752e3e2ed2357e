//! C types of `fmi2TypesPlatform.h` and `fmi2FunctionTypes.h`.
//!
//! Booleans, statuses and kinds are plain `c_int`: a C caller may hand over any number, and a Rust
//! `bool` or `enum` with an undeclared value is undefined behaviour.
#![allow(non_camel_case_types)]

use std::ffi::{c_char, c_int, c_uint, c_void};

/// `fmi2Component`: an opaque instance.
pub type fmi2Component = *mut c_void;
/// `fmi2ComponentEnvironment`: the importer's own pointer, handed back in callbacks.
pub type fmi2ComponentEnvironment = *mut c_void;
/// `fmi2FMUstate`: an opaque copy of an instance's state.
pub type fmi2FMUstate = *mut c_void;
/// `fmi2ValueReference`.
pub type fmi2ValueReference = c_uint;
/// `fmi2Real`.
pub type fmi2Real = f64;
/// `fmi2Integer`.
pub type fmi2Integer = c_int;
/// `fmi2Boolean`: 0 is false, everything else true.
pub type fmi2Boolean = c_int;
/// `fmi2String`: UTF-8, ended by a NUL.
pub type fmi2String = *const c_char;
/// `fmi2Byte`.
pub type fmi2Byte = c_char;
/// `fmi2Status`, one of the constants of [`Status`].
pub type fmi2Status = c_int;
/// `fmi2Type`: 0 model exchange, 1 co-simulation.
pub type fmi2Type = c_int;
/// `fmi2StatusKind`, see [`STATUS_KINDS`].
pub type fmi2StatusKind = c_int;

/// `fmi2CoSimulation`, the only interface type of this FMU.
pub const CO_SIMULATION: fmi2Type = 1;

/// `fmi2StatusKind` by number.
pub const STATUS_KINDS: [&str; 4] = [
    "fmi2DoStepStatus",
    "fmi2PendingStatus",
    "fmi2LastSuccessfulTime",
    "fmi2Terminated",
];
/// Number of `fmi2LastSuccessfulTime`.
pub const LAST_SUCCESSFUL_TIME: fmi2StatusKind = 2;
/// Number of `fmi2Terminated`.
pub const TERMINATED: fmi2StatusKind = 3;

/// What a call came to; numbers of `fmi2Status`. `fmi2Pending` cannot happen here.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(i32)]
pub enum Status {
    /// `fmi2OK`
    Ok = 0,
    /// `fmi2Warning`
    Warning = 1,
    /// `fmi2Discard`
    Discard = 2,
    /// `fmi2Error`
    Error = 3,
    /// `fmi2Fatal`
    Fatal = 4,
}

impl Status {
    /// The number that C sees.
    pub fn code(self) -> fmi2Status {
        self as fmi2Status
    }
}

/// `fmi2CallbackLogger`: environment, instance name, status, category, format, arguments.
pub type fmi2CallbackLogger = unsafe extern "C" fn(
    fmi2ComponentEnvironment,
    fmi2String,
    fmi2Status,
    fmi2String,
    fmi2String,
    ...
);

/// `fmi2CallbackFunctions`; every member may be NULL.
///
/// Memory callbacks and `stepFinished` are never called
/// (`canNotUseMemoryManagementFunctions`, no asynchronous steps), so their types stay opaque.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct fmi2CallbackFunctions {
    /// where messages go
    pub logger: Option<fmi2CallbackLogger>,
    /// unused
    pub allocateMemory: *const c_void,
    /// unused
    pub freeMemory: *const c_void,
    /// unused
    pub stepFinished: *const c_void,
    /// first argument of every callback
    pub componentEnvironment: fmi2ComponentEnvironment,
}
