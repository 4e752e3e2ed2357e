//! A cantilever bent far by a dead force across its tip.
//!
//! Clamped along +x at the origin, the force along +y. No yield: the curvatures pass its limit.

use super::equilibrium::follow;
use super::wire::{angle, clamp_along_x, curvature, straight};
use super::{Answer, Answers, Context, VerifyError};
use crate::math::V3;

/// Tip, its angle and the moment in the clamp.
pub fn run(ctx: &Context) -> Result<Answers, VerifyError> {
    let (alpha, length) = (ctx.number("alpha")?, ctx.positive("L_m")?);
    let section = ctx.elastic();
    let force = alpha * section.ei / (length * length);
    // the bent part at the clamp is about L / sqrt(alpha) long
    let n = ctx.edges(length, length / (150.0 * alpha.abs().sqrt().max(1.0)))?;
    let mut sys = straight(section, &vec![length / n as f64; n]);
    sys.state.support[0] = clamp_along_x(V3::zeros());
    follow(ctx, &mut sys, |sys, share| {
        sys.model.loads.nodal = vec![(n, V3::new(0.0, force * share, 0.0))];
    })?;
    let tip = sys.state.rod.x[n];
    // curvature falls to 0 at the tip: a quarter of its value one node before, over half an edge
    let tip_angle = angle(&sys, n - 1) + curvature(&sys, n - 1) * 0.125 * sys.state.rod.rest[n - 1];
    Ok(vec![
        ("extensible_tip_x_m", Answer::Number(tip.x)),
        ("extensible_tip_y_m", Answer::Number(tip.y)),
        ("extensible_tip_angle_rad", Answer::Number(tip_angle)),
        (
            "clamp_moment_Nm",
            Answer::Number(-sys.state.load.clamp_moment[0].z),
        ),
    ])
}
