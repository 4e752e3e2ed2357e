//! The C types of `fmi2TypesPlatform.h` and `fmi2FunctionTypes.h`, made of the types of `libc`.
//!
//! Booleans, statuses and kinds are plain [`c_int`]. A C caller may pass any number, and a Rust
//! `bool` or `enum` with an undeclared value is undefined behaviour.
#![allow(non_camel_case_types)]

use libc::{c_char, c_double, c_int, c_uint, c_void, size_t};

/// `fmi2Component`: an opaque instance.
pub type fmi2Component = *mut c_void;
/// `fmi2ComponentEnvironment`: the importer's own pointer, passed back to it in callbacks.
pub type fmi2ComponentEnvironment = *mut c_void;
/// `fmi2FMUstate`: an opaque copy of an instance's state.
pub type fmi2FMUstate = *mut c_void;
/// `fmi2ValueReference`: the number of a variable in `modelDescription.xml`.
pub type fmi2ValueReference = c_uint;
/// `fmi2Real`: a number in the SI unit of its variable.
pub type fmi2Real = c_double;
/// `fmi2Integer`: a whole number of 32 bits.
pub type fmi2Integer = c_int;
/// `fmi2Boolean`: 0 is false, every other number is true.
pub type fmi2Boolean = c_int;
/// `fmi2String`: UTF-8 that ends with a NUL.
pub type fmi2String = *const c_char;
/// `fmi2Byte`: one byte of a serialised state.
pub type fmi2Byte = c_char;
/// `fmi2Status`: one of the numbers of [`Status`].
pub type fmi2Status = c_int;
/// `fmi2Type`: 0 is model exchange, 1 is co-simulation.
pub type fmi2Type = c_int;
/// `fmi2StatusKind`: what `fmi2GetStatus` and its kin ask for, 0 to 3.
pub type fmi2StatusKind = c_int;

/// Number of `fmi2CoSimulation`, the only interface type of this FMU.
pub(crate) const CO_SIMULATION: fmi2Type = 1;

/// Names of the `fmi2StatusKind` numbers 0 to 3.
pub(crate) const STATUS_KINDS: [&str; 4] = [
    "fmi2DoStepStatus",
    "fmi2PendingStatus",
    "fmi2LastSuccessfulTime",
    "fmi2Terminated",
];
/// Number of `fmi2LastSuccessfulTime`.
pub(crate) const LAST_SUCCESSFUL_TIME: fmi2StatusKind = 2;
/// Number of `fmi2Terminated`.
pub(crate) const TERMINATED: fmi2StatusKind = 3;

/// The result of a call, with the numbers of `fmi2Status`.
///
/// `fmi2Pending` (5) is missing: a step is complete when `fmi2DoStep` returns.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(i32)]
pub enum Status {
    /// `fmi2OK`: the call did what it is for.
    Ok = 0,
    /// `fmi2Warning`: the call did what it is for, and there is something to look at.
    Warning = 1,
    /// `fmi2Discard`: the step failed, or the value asked for is not available.
    Discard = 2,
    /// `fmi2Error`: the call was refused.
    Error = 3,
    /// `fmi2Fatal`: the instance is lost and can only be freed.
    Fatal = 4,
}

impl Status {
    /// Returns the number that C sees.
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
/// `fmi2CallbackAllocateMemory`: the importer's `calloc`, number of objects and bytes of each.
pub type fmi2CallbackAllocateMemory = unsafe extern "C" fn(size_t, size_t) -> *mut c_void;
/// `fmi2CallbackFreeMemory`: the importer's `free`.
pub type fmi2CallbackFreeMemory = unsafe extern "C" fn(*mut c_void);
/// `fmi2StepFinished`: environment and status of an asynchronous step.
pub type fmi2StepFinished = unsafe extern "C" fn(fmi2ComponentEnvironment, fmi2Status);

/// `fmi2CallbackFunctions`: what the importer offers. Every member may be NULL.
///
/// Of the functions only the logger is ever called. `modelDescription.xml` says so:
/// `canNotUseMemoryManagementFunctions` is true and `canRunAsynchronuously` is false. No memory
/// changes its owner at the boundary: instances and saved states are freed by the library's own
/// functions, strings belong to the instance.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct fmi2CallbackFunctions {
    /// Receives every message.
    pub logger: Option<fmi2CallbackLogger>,
    /// The importer's allocator, never called.
    pub allocateMemory: Option<fmi2CallbackAllocateMemory>,
    /// The counterpart of `allocateMemory`, never called.
    pub freeMemory: Option<fmi2CallbackFreeMemory>,
    /// Announces the end of an asynchronous step, never called.
    pub stepFinished: Option<fmi2StepFinished>,
    /// Passed to the logger as its first argument.
    pub componentEnvironment: fmi2ComponentEnvironment,
}
