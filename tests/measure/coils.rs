//! Coils made on paper: helices on a cylinder and what is known of them beforehand.

use coilwind::math::V3;
use coilwind::measure::{Coil, CoilSpec, DefectLimits, Profile, SettledNode};
use coilwind::settings::SceneSettings;
use std::f64::consts::{FRAC_PI_4, TAU};

pub(crate) const D: f64 = 0.7e-3;
pub(crate) const RADIUS: f64 = 10e-3;
/// Tension of the wire, N.
pub(crate) const PULL: f64 = 15.0;

pub(crate) fn limits() -> DefectLimits {
    SceneSettings::default().defects
}

pub(crate) fn spec() -> CoilSpec {
    CoilSpec {
        diameter: D,
        limits: limits(),
        profile: Profile::new(vec![0.0]),
        tension: PULL,
        jumps: [].into(),
        full: None,
        planned: None,
        layer_starts: [].into(),
        crossover: None,
        start_angle: 0.0,
        direction: 1.0,
        traverse: 1.0,
        clamp_arc: 0.0,
        corner_angle: FRAC_PI_4,
    }
}

/// Wire on a cylinder: `place` gives (y, height) at each winding angle.
pub(crate) fn on_cylinder(
    turns: f64,
    direction: f64,
    place: impl Fn(f64) -> (f64, f64),
) -> Vec<SettledNode> {
    let step = 0.4e-3 / RADIUS;
    (0..=(turns * TAU / step) as usize)
        .map(|node| {
            let angle = node as f64 * step;
            let (y, height) = place(angle);
            let r = RADIUS + D / 2.0 + height;
            let polar = direction * angle;
            SettledNode {
                flange: None,
                position: V3::new(r * libm::cos(polar), y, r * libm::sin(polar)),
                arc: angle * r,
                height,
                plastic_strain: 1e-5 * angle,
                tension: PULL,
                time: angle / 30.0,
            }
        })
        .collect()
}

pub(crate) fn helix(turns: f64, pitch: f64) -> Vec<SettledNode> {
    on_cylinder(turns, 1.0, |angle| (pitch * angle / TAU, 0.0))
}

pub(crate) fn wound(spec: CoilSpec, nodes: &[SettledNode]) -> Coil {
    let mut coil = Coil::new(spec);
    for &node in nodes {
        coil.settle(node);
    }
    coil
}

/// Distance of neighbouring turns of a helix that advances `pitch` per length `around`.
pub(crate) fn developed_distance(pitch: f64, around: f64) -> f64 {
    pitch * around / (pitch * pitch + around * around).sqrt()
}

/// Three turns with a gap in the second, a turn that rides up, and a traverse that turns back.
pub(crate) fn eventful() -> Vec<SettledNode> {
    on_cylinder(4.3, 1.0, |angle| match angle / TAU {
        turn if turn < 1.4 => (D * turn, 0.0),
        turn if turn < 2.2 => (D * turn + 0.3 * D, 0.0),
        turn if turn < 2.6 => (D * (turn - 0.7), 0.9 * D),
        turn => (D * turn, 0.2 * D),
    })
}
