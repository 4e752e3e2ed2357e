//! Random but valid scenes and input signals, judged by what must always hold.
//!
//! A case is drawn from a seed and a number ([`draw`]), run and judged ([`invariants`]), and made as small as it
//! gets where it fails ([`shrink`]). Nothing here depends on time or on the number of threads. The
//! files of a case ([`case_files`]) are what `coilwind run SCENE --inputs CSV --step H` takes.

mod case;
pub mod case_files;
mod case_random;
mod coils;
pub mod draw;
pub mod invariants;
mod parts;
pub mod refined;
pub mod region;
pub mod shrink;
mod signal;
mod worst;

pub use case::{Bobbin, Case, Invariant, Kind, Layers, Measures, Mesh, Outcome, Prism, Verdict};
pub use worst::Worst;
