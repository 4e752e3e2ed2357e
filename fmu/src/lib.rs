//! FMI 2.0 for co-simulation: the C boundary of coilwind, and the only crate with `unsafe`.
//!
//! `exports` holds the C functions, a few lines each: pointers are read in `pointers`, the call
//! runs inside `guard`, which asks `lifecycle` whether it is allowed, catches panics and
//! delivers messages through `logger`. Everything behind that is safe: `instance` with its
//! `parameters` and `clock`, and `state`, a copy of it.
//!
//! # Invariants
//!
//! * A refused call returns `fmi2Error`, says why, and leaves the instance as it was.
//! * No panic crosses the boundary; after one the instance is fatal and can only be freed.
//! * A saved state continues to the bit; bytes of one carry magic, version, GUID and checksum.
//! * No globals but the GUID: instances share nothing and may live in different threads.
//! * The importer's logger is called when no reference into the instance is alive, so it may call
//!   back.
// The library's file name is the model identifier, which FMI wants equal in three places.
#![allow(non_snake_case)]
#![deny(unsafe_op_in_unsafe_fn, clippy::undocumented_unsafe_blocks)]

mod clock;
#[cfg(test)]
mod contract;
pub mod exports;
pub mod ffi;
mod guard;
mod instance;
mod lifecycle;
mod logger;
mod parameters;
mod pointers;
mod recording;
mod refusal;
mod resources;
#[cfg(test)]
mod saving;
mod scalar;
#[cfg(test)]
mod sequences;
mod state;
