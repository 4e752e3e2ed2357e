//! What several problems begin with, and how their work is counted.

use super::error::BenchError;
use super::options::BenchOptions;
use super::problem::{Method, Problem};
use crate::integrate::{
    RK4_LIMIT, SolverStatistics, VERLET_LIMIT, highest_frequency, longest_step,
};
use crate::math::V3;
use crate::math::frame_along;
use crate::rod::Twist;
use crate::rod::{Rod, Section};
use crate::scene::{Core, Scene};
use crate::settings::SceneSettings;
use crate::system::{Support, System};
use std::f64::consts::TAU;

/// Free spacing over that near the core: a power of two, since edges are halved.
pub(super) const COARSER: [f64; 2] = [8.0, 2.0];

/// The elastic wire of the paper's Table 1.
pub(super) fn elastic_wire() -> Result<Section, BenchError> {
    let mut settings = SceneSettings::default();
    settings.wire.material = "table1".to_owned();
    settings.wire.elastic = true;
    Ok(settings.build()?.wire)
}

/// Wire through these points with these unstretched lengths, clamped along +x at the first.
///
/// Without twist: the problems are plane and the implicit method has none.
pub(super) fn cantilever(section: Section, points: &[V3], rest: Vec<f64>) -> System {
    let mut rod = Rod::through(points, Some(rest));
    rod.refine_clamp();
    let mut sys = System::new(section, rod);
    sys.model.twist = Twist::Off;
    sys.state.support[0] = Support::clamped(points[0], frame_along(&V3::x(), None));
    sys.refresh();
    sys
}

/// Lengths of `count` even edges but for the first, which is as short as a clamp is exact with, m.
pub(super) fn clamped_edges(length: f64, count: usize) -> Vec<f64> {
    let h = length / (count as f64 - 1.0 + Rod::FIRST_EDGE);
    let mut rest = vec![h; count];
    rest[0] = length - h * (count as f64 - 1.0);
    rest
}

/// Points along +x from the origin with `rest` between them.
pub(super) fn along_x(rest: &[f64]) -> Vec<V3> {
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
pub(super) fn stable_step(method: Method, section: &Section, spacing: f64) -> f64 {
    let limit = match method {
        Method::Rk4 => RK4_LIMIT,
        _ => VERLET_LIMIT,
    };
    let frequency = highest_frequency(section, spacing, 0.0, false);
    longest_step(limit, frequency, 0.0, 0.0, section)
}

/// Factorisations of the implicit method, evaluations of the forces of an explicit one.
pub(super) fn iterations(method: Method, statistics: SolverStatistics, steps: u64) -> u64 {
    match method {
        Method::Implicit => statistics.solves,
        Method::Verlet => steps,
        Method::Rk4 => 4 * steps,
    }
}

/// Length round the core of a wire that lies on it, m; a mesh counts as the cylinder it sweeps.
pub(super) fn turn_length(scene: &Scene) -> Result<f64, BenchError> {
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
            let surface =
                crate::simulation::core_surface(scene).map_err(|reason| BenchError::Start {
                    problem: Problem::W,
                    reason,
                })?;
            TAU * (surface.radius_max() + r)
        }
    })
}

/// Method, spacing, step and tolerance as asked for, on top of what the scene has.
pub(super) fn solver(settings: &mut SceneSettings, args: &BenchOptions) -> Result<(), BenchError> {
    if let Some(method) = args.integrator {
        settings.solver.integrator = method.name().to_owned();
    }
    if let Some(n) = args.n {
        let turn = turn_length(&settings.build()?)?;
        let coarser = COARSER[usize::from(args.method() != Method::Implicit)];
        settings.solver.spacing_near = turn / n as f64;
        settings.solver.spacing_free = coarser * settings.solver.spacing_near;
    }
    if let Some(dt) = args.dt {
        settings.solver.step = dt;
    }
    if let Some(tol) = args.tol {
        settings.solver.tolerance = tol;
    }
    Ok(())
}
