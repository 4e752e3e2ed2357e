//! FMI 2.0 for co-simulation: the C boundary of coilwind, and the only crate with `unsafe`.
//!
//! | module | holds |
//! |---|---|
//! | [`ffi`] | the C types of the standard |
//! | [`exports`] | the C functions, a few lines each |
//! | `pointers` | all work with the importer's pointers |
//! | `guard` | the frame round every call: is it allowed, did it panic, deliver the messages |
//! | `float_control` | rounding as the solver needs it, and as the host had it |
//! | `lifecycle` | the table of calls that each state allows |
//! | `message`, `logger` | messages, the importer's filter and its callback |
//! | `error` | every reason why a call fails |
//! | `instance` | what the calls mean, in safe Rust |
//! | `parameters`, `clock`, `recording` | parts of an instance |
//! | `state` | a saved state in memory and as bytes |
//! | `saved_files` | files that a scene names: where they were saved, and are found again |
//! | `scalar`, `resources` | variables by type, the folder of the unpacked FMU |
//!
//! # Invariants
//!
//! * A refused call returns `fmi2Error`, says why, and leaves the instance as it was.
//! * No panic crosses the boundary. After one the instance is fatal and can only be freed.
//! * Results do not depend on how the host lets the processor round, and it gets its settings back.
//! * A saved state continues to the bit. Its bytes carry magic, version, GUID and checksum.
//! * The GUID is the only global. Instances share nothing and may live in different threads.
//! * The importer's logger is called when no reference into the instance is alive, so that it may
//!   call back.
//! * The importer's allocator is never called. Each side frees what it has allocated.
// The library's file name is the model identifier, which FMI wants equal in three places.
#![allow(non_snake_case)]
#![deny(unsafe_op_in_unsafe_fn, clippy::undocumented_unsafe_blocks)]

mod clock;
mod error;
pub mod exports;
pub mod ffi;
mod float_control;
mod guard;
mod instance;
mod lifecycle;
mod logger;
mod message;
mod parameters;
mod pointers;
mod recording;
mod resources;
mod saved_files;
mod scalar;
mod state;
#[cfg(test)]
mod tests;
