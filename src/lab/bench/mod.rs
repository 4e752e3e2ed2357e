//! Known problems against the clock: error, CPU time and effort, one line each.
//!
//! Every problem is one file that sets up the rod, the contact and the method of a winding run,
//! lets it compute, and compares with an answer from elsewhere (closed form, quadrature, or a
//! converged run kept with the program). The clock runs from the wire at rest to the last step;
//! reading the scene, building the core and finding the reference are not on it.

mod args;
mod converged;
mod p1;
mod p2;
mod p3;
mod p4;
mod p5;
mod record;
mod watch;
mod winding;

pub use args::{BenchArgs, Method, Problem};
pub use converged::{Converged, Extremes, Speed};
pub use record::{Details, Outcome, Record};
pub use winding::Wound;

use crate::integrate::{
    RK4_LIMIT, SolverStatistics, VERLET_LIMIT, highest_frequency, longest_step,
};
use crate::math::V3;
use crate::math::frame_along;
use crate::math::simd;
use crate::rod::Twist;
use crate::rod::{Rod, Section};
use crate::scene::{Scene, SceneError};
use crate::settings::SceneSettings;
use crate::simulation::SimError;
use crate::system::{Support, System};
use thiserror::Error;

/// What keeps a benchmark from giving a line.
#[derive(Debug, Error)]
pub enum BenchError {
    /// An option that the problem does not take, or not with this value.
    #[error("bench {problem}: {option}: {reason}; allowed: {allowed}")]
    Option {
        /// as printed
        problem: Problem,
        /// with its value
        option: String,
        /// what is wrong
        reason: String,
        /// what would do
        allowed: String,
    },
    /// The scene is wrong.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The scene is valid but a run of it cannot start.
    #[error("bench {problem}: cannot start: {reason}")]
    Start {
        /// as printed
        problem: Problem,
        /// why
        reason: SimError,
    },
    /// A file of converged runs that cannot be read, understood or written.
    #[error("{file}: {reason}")]
    File {
        /// path
        file: String,
        /// what is wrong
        reason: String,
    },
}

/// Runs what `args` ask for and returns the line to print.
///
/// A computation that fails on the way is no error here: its line says `"ok": false` and why.
pub fn run(args: &BenchArgs) -> Result<Record, BenchError> {
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

/// The elastic wire of the paper's Table 1.
fn elastic_wire() -> Result<Section, BenchError> {
    let mut settings = SceneSettings::default();
    settings.wire.material = "table1".to_owned();
    settings.wire.elastic = true;
    Ok(settings.build()?.wire)
}

/// Wire through these points with these unstretched lengths, clamped along +x at the first.
///
/// Without twist: the problems are plane and the implicit method has none.
fn cantilever(section: Section, points: &[V3], rest: Vec<f64>) -> System {
    let mut rod = Rod::through(points, Some(rest));
    rod.refine_clamp();
    let mut sys = System::new(section, rod);
    sys.model.twist = Twist::Off;
    sys.state.support[0] = Support::clamped(points[0], frame_along(&V3::x(), None));
    sys.refresh();
    sys
}

/// Lengths of `count` even edges but for the first, which is as short as a clamp is exact with, m.
fn clamped_edges(length: f64, count: usize) -> Vec<f64> {
    let h = length / (count as f64 - 1.0 + Rod::FIRST_EDGE);
    let mut rest = vec![h; count];
    rest[0] = length - h * (count as f64 - 1.0);
    rest
}

/// Points along +x from the origin with `rest` between them.
fn along_x(rest: &[f64]) -> Vec<V3> {
    let mut x = 0.0;
    std::iter::once(0.0)
        .chain(rest.iter().map(|l| {
            x += l;
            x
        }))
        .map(|x| V3::new(x, 0.0, 0.0))
        .collect()
}

/// Longest stable step of an explicit method on free wire, s.
fn stable_step(method: Method, section: &Section, spacing: f64) -> f64 {
    let limit = match method {
        Method::Rk4 => RK4_LIMIT,
        _ => VERLET_LIMIT,
    };
    let frequency = highest_frequency(section, spacing, 0.0, false);
    longest_step(limit, frequency, 0.0, 0.0, section)
}

/// Factorisations of the implicit method, evaluations of the forces of an explicit one.
fn iterations(method: Method, statistics: SolverStatistics, steps: u64) -> u64 {
    match method {
        Method::Implicit => statistics.solves,
        Method::Verlet => steps,
        Method::Rk4 => 4 * steps,
    }
}

/// Length round the core of a wire that lies on it, m; a mesh counts as the cylinder it sweeps.
fn turn_length(scene: &Scene) -> Result<f64, BenchError> {
    use crate::scene::Core;
    use std::f64::consts::TAU;
    let r = scene.wire.radius();
    Ok(match &scene.core {
        Core::RoundedBox {
            width_x,
            height_z,
            corner_radius,
            ..
        } => 2.0 * (width_x + height_z) - 8.0 * corner_radius + TAU * (corner_radius + r),
        Core::Cylinder { radius, .. } => TAU * (radius + r),
        Core::Mesh { .. } => {
            let surface = crate::simulation::core_surface(&scene.core).map_err(|reason| {
                BenchError::Start {
                    problem: Problem::W,
                    reason,
                }
            })?;
            TAU * (surface.radius_max() + r)
        }
    })
}
