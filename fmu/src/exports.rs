//! The C functions of FMI 2.0 for co-simulation, all of them.
//!
//! Each function checks its pointers, enters the guard, calls safe code and maps the result to a
//! status. Importers bind every symbol, so that a function which this FMU does not support is
//! exported as well. It returns `fmi2Error` with the reason, as `modelDescription.xml` announces.
//!
//! # Safety
//!
//! All functions rely on the promises that FMI 2.0.5 demands of an importer:
//!
//! * A component is NULL or came from `fmi2Instantiate` and was not freed.
//! * Calls on one component are not made at the same time.
//! * Arrays hold as many values as the call says.
//! * Strings end with a NUL.
//! * Callbacks stay callable until `fmi2FreeInstance`.
//!
//! NULL is answered with an error wherever data is needed.
#![allow(clippy::missing_safety_doc)]

mod common;
mod derivatives;
mod states;
mod step;
mod values;

pub use common::*;
pub use derivatives::*;
pub use states::*;
pub use step::*;
pub use values::*;
