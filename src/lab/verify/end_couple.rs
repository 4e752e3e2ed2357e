//! A cantilever rolled up by a couple at its end.

use super::equilibrium::follow_in_plane;
use super::wire::{angle, clamp_along_x, curvature, straight};
use super::{Answer, Answers, Context, VerifyError};
use crate::math::V3;
use std::f64::consts::TAU;

/// Turn per edge, rad: the polygon then misses the arc by its square over 24.
const TURN_PER_EDGE: f64 = 0.03;

/// Curvature, tip and tip angle.
pub fn run(ctx: &Context) -> Result<Answers, VerifyError> {
    let (fraction, length) = (ctx.number("fraction")?, ctx.positive("L_m")?);
    let section = ctx.elastic();
    let turn = fraction.abs() * TAU;
    let couple = V3::z() * (fraction * TAU * section.ei / length);
    let n = ctx.edges(length, length / (turn / TURN_PER_EDGE).max(50.0))?;
    let mut sys = straight(section, &vec![length / n as f64; n]);
    sys.state.support[0] = clamp_along_x(V3::zeros());
    follow_in_plane(ctx, &mut sys, |sys, share| {
        sys.model.loads.moments = vec![(n - 1, couple * share)];
    })?;
    let mean = (1..n).map(|i| curvature(&sys, i)).sum::<f64>() / (n - 1) as f64;
    let tip_angle = angle(&sys, n - 1) + 0.5 * mean * sys.state.rod.rest[n - 1];
    Ok(vec![
        ("curvature_1_per_m", Answer::Number(mean)),
        ("tip_x_m", Answer::Number(sys.state.rod.x[n].x)),
        ("tip_y_m", Answer::Number(sys.state.rod.x[n].y)),
        ("tip_angle_rad", Answer::Number(tip_angle)),
    ])
}
