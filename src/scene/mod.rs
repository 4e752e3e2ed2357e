//! The immutable description of a run, in SI units.
//!
//! [`SceneSettings`] holds the leaves as the user gives them (defaults, then a TOML file or a
//! packed scene, then single values); its `build` validates them into a [`Scene`], which
//! everything else reads.

mod allowed;
mod angle_table;
mod assign;
mod build;
mod checks;
mod clamp_places;
mod description;
mod error;
mod extent;
mod features;
mod file;
mod first_turn;
mod follow_on;
mod foreign_table;
mod free_trail;
mod impossible;
mod key;
mod layer_starts;
mod material;
mod nozzle_body;
mod nozzle_law;
mod nozzle_plan;
mod nozzle_trail;
mod problems;
mod saved;
mod spacing;
mod speed_law;
mod spindle_plan;
mod stress_strain;
mod warnings;
mod without_effect;
mod write;

pub use crate::rod::{Bilinear, Hardening, Pieces, RoundLaws, Section, Twist};
pub use description::{
    Core, Decision, Features, Flange, Integrator, LiveContact, Preset, Scene, Solver, Window,
};
pub use error::{SceneError, Warning};
pub use file::packed_names;
pub use foreign_table::{WITH_COMMAS, foreign_separator};
pub(crate) use impossible::si;
pub use key::{assignment, refuse_repeated, unit_suffixes};
pub use nozzle_law::{NozzleLaw, Piece};
#[cfg(feature = "lab")]
pub(crate) use spacing::spacing_at_edge;
pub use speed_law::{SpeedLaw, Stretch};

#[cfg(doc)]
use crate::settings::SceneSettings;
