//! Winding of wire on a turning core: an elastic-plastic rod in frictional contact.
//!
//! The library knows the physics and the scene; it never prints and never opens a file it was
//! not handed by name in the scene. `Simulation` is the one door through which the command line
//! and the FMU drive it. SI units everywhere, see `ARCHITECTURE.md` for the map.
#![forbid(unsafe_code)]

pub mod contact;
pub mod feed;
pub mod geometry;
pub mod integrate;
#[cfg(feature = "lab")]
pub mod lab;
pub mod linalg;
pub mod math;
pub mod measure;
pub mod output;
pub mod rod;
pub mod scene;
pub mod settings;
pub mod signals;
pub mod simulation;
pub mod system;
pub mod variables;
