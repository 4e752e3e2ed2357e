//! The gap between the turns of a settled helix, as a wind measures it.
//!
//! Nodes of a helix on a cylinder settle one by one, a wind's spacing apart. The measure is that of a run: stations a degree apart,
//! the wire one turn back, distance of the centrelines less the diameter.

use super::{Answer, Answers, Context, VerifyError};
use crate::math::V3;
use crate::measure::{Coil, CoilSpec, SettledNode};
use crate::settings::SceneSettings;
use std::f64::consts::TAU;

/// Turns that settle; the last one is measured.
const TURNS: f64 = 3.5;
/// Spacing of the explicit method's nodes, m.
const SPACING: f64 = 0.5e-3;

/// Runs a case.
pub fn run(ctx: &Context) -> Result<Answers, VerifyError> {
    let (radius, pitch) = (ctx.positive("R_m")?, ctx.positive("pitch_m")?);
    let axis = radius + ctx.section.radius();
    let mut coil = Coil::new(CoilSpec {
        diameter: ctx.section.diameter,
        limits: SceneSettings::default().defects,
        profile: None,
        tension: 0.0,
        jumps: [].into(),
        full: None,
        planned: None,
        layer_starts: [].into(),
        crossover: None,
        start_angle: 0.0,
        direction: 1.0,
        traverse: pitch,
        clamp_arc: 0.0,
        corner_angle: 0.25 * std::f64::consts::PI,
    });
    let rise = pitch / TAU;
    let rate = libm::hypot(axis, rise);
    let spacing = ctx.spacing.unwrap_or(SPACING);
    let nodes = (TURNS * TAU * rate / spacing).ceil() as usize;
    for i in 0..=nodes {
        let angle = spacing * i as f64 / rate;
        coil.settle(SettledNode {
            flange: None,
            position: V3::new(
                axis * libm::cos(angle),
                rise * angle,
                axis * libm::sin(angle),
            ),
            arc: spacing * i as f64,
            height: 0.0,
            plastic_strain: 0.0,
            tension: 0.0,
            time: angle,
        });
    }
    let gaps: Vec<f64> = coil
        .stations()
        .filter(|s| s.measured && s.angle > TAU * (TURNS - 1.0))
        .filter_map(|s| s.neighbour.map(|n| n.gap))
        .collect();
    if gaps.is_empty() {
        return Err(VerifyError::NoAnswer(
            "no station has a neighbour".to_owned(),
        ));
    }
    let extreme = |f: fn(f64, f64) -> f64| gaps.iter().copied().fold(gaps[0], f);
    Ok(vec![
        ("gap_min_m", Answer::Number(extreme(f64::min))),
        ("gap_max_m", Answer::Number(extreme(f64::max))),
    ])
}
