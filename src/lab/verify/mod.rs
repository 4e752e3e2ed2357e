//! Exact answers against the code that winds.
//!
//! A case file names a `kind`, and each kind is one file here. It sets up the same rod, section,
//! contact and feed as a winding run, computes, and reads the answer off the result.

mod axial_wave;
mod band;
mod bench;
mod bending_modes;
mod bulge_linear;
mod capstan;
mod case;
mod command;
mod corner_edge;
mod cyclic_bending;
mod elastica_cantilever;
mod end_couple;
mod equilibrium;
mod feed_tension;
mod file;
mod frozen_helix;
mod groove_seat;
mod grooved_capstan;
mod hanging_wire;
mod helix;
mod helix_gap;
mod inputs;
mod kinds;
mod live_pair;
mod mandrel_springback;
mod modes;
mod penalty_impact;
mod quasi_static;
mod report;
mod rolling_path;
mod shoulder_drop;
mod shoulder_static;
mod side_by_side;
mod spinning_ring;
mod square_loop;
mod torsion;
mod twist_buckling;
mod wave_damping;
mod winding_feed;
mod wire;

pub use case::{Answer, Answers, Context, Setup, VerifyError};
pub use command::{Manner, VerifyOptions, run, run_file};
pub use file::{Case, CaseFile, Check};
pub use kinds::{KINDS, Kind, Solve, WIND, Wind};
pub use report::Record;
