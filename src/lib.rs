//! Winding of wire on a turning core: an elastic-plastic rod in frictional contact.
//!
//! The library knows the physics and the scene; it never prints and never opens a file it was
//! not handed by name in the scene. `Simulation` is the one door through which the command line
//! and the FMU drive it. SI units everywhere, see `ARCHITECTURE.md` for the map.
#![forbid(unsafe_code)]

pub mod bench;
pub mod contact;
pub mod core_shape;
pub mod feed;
pub mod freeze;
pub mod integrate;
pub mod lanes;
pub mod math;
pub mod measure;
pub mod output;
pub mod pile;
pub mod rod;
pub mod scene;
pub mod simulation;
pub mod stress;
pub mod variables;
pub mod verify;
