//! Whole coils: on any core, in their places, as files.

#[path = "../common/bobbin.rs"]
mod bobbin;
#[path = "../common/mod.rs"]
mod common;
mod enamel;
mod first_turn;
mod flanges_beside_a_mesh;
mod grooved_core;
mod in_its_place;
mod invariance;
mod layers;
mod output;
mod runs;
#[path = "../common/stl.rs"]
mod stl;
mod tight_corners;
mod winds_about_minus_y;
mod without_effect;
