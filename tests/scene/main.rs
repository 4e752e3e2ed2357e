//! Scene files through the front door: what is read, in which order, and what is refused.

mod choices;
mod coils;
mod common;
mod helical;
mod meshes;
mod reading;
mod refusals;
mod remedies;
mod several;
mod standing_on_the_core;
#[path = "../common/stl.rs"]
mod stl;
mod wire;
