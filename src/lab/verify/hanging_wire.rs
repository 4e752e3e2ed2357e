//! A wire hung between two level clamps that hold its ends horizontal.
//!
//! It starts straight, gets its weight, and then one clamp comes in until the span is right.

use super::equilibrium::follow;
use super::wire::{clamp_along_x, moment, straight};
use super::{Answer, Answers, Context, VerifyError};
use crate::math::V3;

/// Standard gravity, m/s^2.
const GRAVITY: f64 = 9.80665;

/// Horizontal force, sag and the two moments.
pub fn run(ctx: &Context) -> Result<Answers, VerifyError> {
    let (span, length) = (ctx.positive("span_m")?, ctx.positive("length_m")?);
    if length <= span {
        return Err(VerifyError::Input {
            name: "length_m".to_owned(),
            problem: format!("{length}: it has to be more than the span"),
        });
    }
    let section = ctx.elastic();
    // the parabola's sag and pull give the length over which the clamps bend the wire
    let sag = (0.375 * span * (length - span)).sqrt();
    let pull = section.mass_per_length() * GRAVITY * span * span / (8.0 * sag);
    let layer = (section.ei / pull).sqrt();
    let n = ctx.free_edges(length, (length / 200.0).min(layer / 15.0))?;
    let mut sys = straight(section, &vec![length / n as f64; n]);
    sys.state.support = [clamp_along_x(V3::zeros()), clamp_along_x(V3::x() * length)];
    follow(ctx, &mut sys, |sys, share| {
        sys.model.loads.gravity = V3::new(0.0, -GRAVITY * share, 0.0);
    })?;
    follow(ctx, &mut sys, |sys, share| {
        sys.state.support[1].point.x = length + share * (span - length);
    })?;
    let mid = sys.state.rod.x[n / 2];
    Ok(vec![
        ("H_N", Answer::Number(-sys.state.load.force[n].x)),
        ("sag_m", Answer::Number(-mid.y)),
        ("mid_moment_Nm", Answer::Number(moment(&sys, n / 2))),
        (
            "end_moment_Nm",
            Answer::Number(-sys.state.load.clamp_moment[0].z),
        ),
    ])
}
