//! Winding of wire on a turning core: an elastic-plastic rod in frictional contact.
//!
//! A [scene] describes wire, core, nozzle and tensioner. A [`Simulation`](simulation::Simulation) of it
//! goes forward in time under [inputs](signals::Inputs) for the spindle, the nozzle and the tensioner. It tells
//! [outputs](signals::Outputs) such as the tension at the nozzle. Wire that has come to rest is [measured](measure)
//! turn by turn: gaps, bulges, overlaps, and a verdict.
//!
//! Wind a scene and read the verdict:
//!
//! ```
//! use coilwind::settings::SceneSettings;
//! use coilwind::simulation::Simulation;
//!
//! let mut settings = SceneSettings::load("fig8")?;
//! settings.set_text("spindle.speed", "60")?;
//! settings.set_text("spindle.turns", "1.6")?;
//! settings.set_text("solver.tolerance", "2e-5")?;
//! let mut sim = Simulation::new(&settings.build()?)?;
//! let end = sim.motion_profile().end();
//! while sim.time() < end {
//!     let left = end - sim.time();
//!     sim.advance_profile(left.min(1e-3))?;
//! }
//! let turns = sim.coil().turns();
//! println!("turn 1: {}, the coil: {}", turns[0].verdict, sim.coil().verdict());
//! assert!(turns[0].settled > 0.5);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Drive it step by step, as a machine or an FMU does, and read the tension:
//!
//! ```
//! use coilwind::settings::SceneSettings;
//! use coilwind::signals::Inputs;
//! use coilwind::simulation::Simulation;
//!
//! let mut sim = Simulation::new(&SceneSettings::default().build()?)?;
//! for step in 1..=20 {
//!     let inputs = Inputs {
//!         spindle_speed: f64::from(step), // rad/s
//!         nozzle_position: 0.0,           // m
//!         tension_setpoint: 15.0,         // N
//!         ..Inputs::HELD
//!     };
//!     sim.advance(inputs, 1e-3)?;
//! }
//! let outputs = sim.outputs();
//! assert!((outputs.wire_tension - 15.0).abs() < 3.0);
//! assert!(outputs.spindle_angle > 0.2);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Modules
//!
//! These modules are promised; a change of them is told in the changelog.
//!
//! | module | holds |
//! |---|---|
//! | [`settings`] | every leaf of a scene as it is given |
//! | [`scene`] | TOML to settings to a checked, immutable scene |
//! | [`variables`] | the one table of inputs, outputs and parameters, with units and ranges |
//! | [`signals`] | inputs, outputs, events |
//! | [`simulation`] | a run: steps, outputs, saved states, summary |
//! | [`measure`] | stations and turns of settled wire, defects, verdicts |
//! | [`output`] | tables, VTK, pictures |
//!
//! [`math`] is shown because vectors and frames of the other modules come from it. The laboratory (`lab`, with
//! the feature of this name) belongs to the commands `verify`, `bench` and `stress`. All other modules are private. The
//! same feature makes them public, though hidden from these pages, so that tests and benchmarks reach the mechanics:
//! they may change at any time.
//!
//! # Errors
//!
//! * [`SceneError`](scene::SceneError): a scene that is wrong; it names file, key, value and what is allowed.
//! * [`SimError`](simulation::SimError): a run that cannot start or cannot go on, with time and node. The run stands
//!   at the end of the last step that went through.
//! * [`RestoreError`](simulation::RestoreError): bytes that are no saved state of this scene.
//! * [`OutputError`](output::OutputError): a file that could not be written.
//!
//! Nothing panics on bad input. The library writes no file but those of [`output`], reads none but those that a
//! scene names, and prints nothing.
//!
//! # Units and frames
//!
//! SI units everywhere; angles in rad. Keys of a scene file and names in
//! [`set_text`](settings::SceneSettings::set_text) may carry another unit (`wire.diameter_mm`).
//!
//! The core turns about +y. The frame of the laboratory stands still, with the nozzle on +x at a height `y` that is an
//! input. The core frame turns with the core and equals that of the laboratory at spindle angle zero of the mechanics. The
//! spindle angle of the outputs counts from the start. Settled wire, centrelines and pictures are given in the core frame.
//!
//! Wire is numbered from the clamp: node 0 is the oldest, the last node lies at the nozzle. Turn 1 begins at the clamp.
//!
//! Equal inputs on equal communication points give equal results to the bit, whatever the machine's vector width.
#![forbid(unsafe_code)]

#[cfg(not(feature = "lab"))]
pub(crate) mod contact;
#[cfg(feature = "lab")]
#[doc(hidden)]
pub mod contact;
pub(crate) mod feed;
#[cfg(not(feature = "lab"))]
pub(crate) mod geometry;
#[cfg(feature = "lab")]
#[doc(hidden)]
pub mod geometry;
#[cfg(not(feature = "lab"))]
pub(crate) mod integrate;
#[cfg(feature = "lab")]
#[doc(hidden)]
pub mod integrate;
#[cfg(feature = "lab")]
pub mod lab;
#[cfg(not(feature = "lab"))]
pub(crate) mod linalg;
#[cfg(feature = "lab")]
#[doc(hidden)]
pub mod linalg;
pub mod math;
pub mod measure;
pub mod output;
#[cfg(not(feature = "lab"))]
pub(crate) mod rod;
#[cfg(feature = "lab")]
#[doc(hidden)]
pub mod rod;
pub mod scene;
pub mod settings;
pub mod signals;
pub mod simulation;
#[cfg(not(feature = "lab"))]
pub(crate) mod system;
#[cfg(feature = "lab")]
#[doc(hidden)]
pub mod system;
pub mod variables;
