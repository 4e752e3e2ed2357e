//! Known problems against the clock: error, CPU time and effort, one line each.
//!
//! Every problem is one file that sets up the rod, the contact and the method of a winding run and
//! compares what they compute with an independent answer. That answer is a closed form, a
//! quadrature, or a converged run kept with the program. The clock runs from the wire at rest to the last step;
//! reading the scene, building the core and finding the reference are not on it.

mod converged;
mod error;
mod options;
mod p1;
mod p2;
mod p3;
mod p4;
mod p5;
mod problem;
mod record;
mod setup;
mod watch;
mod winding;

pub use converged::{Converged, Extremes, Speed, Wound};
pub use error::BenchError;
pub use options::BenchOptions;
pub use problem::{Method, Problem};
pub use record::{Details, Outcome, Record};

use crate::math::simd;

/// Runs the problem of `args` and returns its record.
///
/// A computation that fails on the way is no error here: its line says `"ok": false` and why.
pub fn run(args: &BenchOptions) -> Result<Record, BenchError> {
    args.check()?;
    if let Some(lanes) = args.lanes {
        simd::at_most(lanes);
    }
    let count = args.repeat.unwrap_or(1);
    let once = || match args.problem {
        Problem::P1 => p1::run(args),
        Problem::P2 => p2::run(args),
        Problem::P3 => p3::run(args),
        Problem::P4 => p4::run(args),
        Problem::P5 => p5::run(args),
        Problem::W => winding::run(args),
    };
    let mut outcomes = Vec::new();
    for _ in 0..count {
        outcomes.push(once()?);
    }
    Ok(Record::of(args.problem, args.method(), outcomes))
}
