//! Coils of nodes placed by formula.

use coilwind::math::V3;
use coilwind::measure::DefectLimits;
use coilwind::measure::{Coil, CoilSpec, Profile, SettledNode};
use std::f64::consts::{FRAC_PI_4, TAU};

pub const D: f64 = 0.7e-3;
pub const RADIUS: f64 = 10e-3;

pub fn limits() -> DefectLimits {
    DefectLimits {
        gap: 0.15,
        gap_fraction: 0.10,
        bulge_excess: 0.5,
        bulge_absolute: 0.0,
        overlap_axial: 0.9,
        overlap_height: 0.3,
        skip_angle: 1.2,
    }
}

pub fn spec() -> CoilSpec {
    CoilSpec {
        diameter: D,
        limits: limits(),
        profile: Profile::new(vec![0.0]),
        start_angle: 0.0,
        direction: 1.0,
        traverse: 1.0,
        clamp_arc: 0.0,
        corner_angle: FRAC_PI_4,
    }
}

/// Wire on a cylinder: `place` gives (y, height) at each winding angle.
pub fn on_cylinder(
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
                position: V3::new(r * libm::cos(polar), y, r * libm::sin(polar)),
                arc: angle * r,
                height,
                plastic_strain: 1e-3 * angle,
                time: angle / 30.0,
            }
        })
        .collect()
}

pub fn helix(turns: f64, pitch: f64) -> Vec<SettledNode> {
    on_cylinder(turns, 1.0, |angle| (pitch * angle / TAU, 0.0))
}

pub fn wound(spec: CoilSpec, nodes: &[SettledNode]) -> Coil {
    let mut coil = Coil::new(spec);
    for &node in nodes {
        coil.settle(node);
    }
    coil
}
