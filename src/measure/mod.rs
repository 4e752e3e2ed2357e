//! What the settled wire looks like: gap, overlap and bulge per turn and polar angle.
//!
//! Works on the centreline in the core frame, where settled wire is at rest. A *turn* is 2 pi of
//! polar angle from the clamp, on the wire and not of the spindle. The turns are sampled at
//! [`STATIONS_PER_TURN`] fixed polar angles, so that the same place of two turns, and of two runs,
//! can be compared one to one.
//!
//! [`Coil`] takes nodes one by one as wire comes to rest and gives them back in reverse order when
//! the spindle reverses. Whatever it knows after a node is stored with that node, so giving nodes
//! back is truncation and leaves exactly what was there before.

mod at_rest;
mod below;
mod buckets;
mod climb;
mod coil;
mod contour;
mod crossover;
mod defect;
mod empty_place;
mod end;
mod judge;
mod jumps;
mod layer_start;
mod marks;
mod neighbour;
mod node;
mod on_turn;
mod onset;
mod passes;
mod planned_start;
mod plumb;
mod profile;
mod row;
mod runs;
mod segment;
mod signs;
mod state;
mod station;
mod support;
mod turn;
mod words;

pub(crate) use coil::SavedCoil;
pub use coil::{Coil, CoilSpec};
pub use contour::LayerContour;
pub use crossover::Crossover;
pub use defect::{BulgeLimit, Defect, DefectFlags, DefectKind, DefectLimits, DefectPlace};
pub(crate) use defect::{KINDS, MEASURED};
pub(crate) use marks::CountedRun;
pub use node::{SettledNode, added_by_stretch};
pub(crate) use on_turn::OnTurn;
pub use planned_start::LayerStart;
pub use profile::Profile;
pub use state::Worst;
pub use station::{Neighbour, Station};
pub(crate) use turn::ALIGNED_RMS;
pub use turn::{TurnMeasures, Verdict};
pub use words::{
    UNJUDGED, interrupted, left_out, reasons, reasons_doubted, reasons_unjudged, unfinished,
};

/// Polar stations per turn, one per degree.
///
/// Equal polar angles are dense on a long face and sparse on a short one and at corners. One per
/// degree gives the 12 x 30 mm core 29 on each short face and 11 on each 2 mm corner, where the
/// measures ask for at least 10 and 3.
pub const STATIONS_PER_TURN: usize = 360;

/// Polar angle between stations, rad.
pub const STATION_STEP: f64 = std::f64::consts::TAU / STATIONS_PER_TURN as f64;
