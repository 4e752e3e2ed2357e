//! Bending to a mandrel and letting go.
//!
//! A short wire, clamped at one end; the other end's direction is turned until the wire has the
//! mandrel's curvature all along, then the couple that holds it is taken off.

use super::equilibrium::follow;
use super::wire::{clamp_along_x, curvature, heading, moment, straight};
use super::{Answer, Answers, Context, VerifyError};
use crate::math::V3;
use crate::system::Support;

/// Edges of the piece and turn of each, rad.
const EDGES: usize = 10;
const TURN_PER_EDGE: f64 = 0.05;

/// Moment round the mandrel and the curvature that stays.
pub fn run(ctx: &Context) -> Result<Answers, VerifyError> {
    let radius = ctx.positive("R_m")? + ctx.section.radius();
    let edge = ctx.spacing.unwrap_or(TURN_PER_EDGE * radius);
    let turn = EDGES as f64 * edge / radius;
    let mut sys = straight(ctx.section.clone(), &[edge; EDGES]);
    sys.state.support[0] = clamp_along_x(V3::zeros());
    follow(ctx, &mut sys, |sys, share| {
        sys.state.support[1] = Support {
            frame: Some(heading(turn * share)),
            ..Support::free()
        };
    })?;
    let loaded = moment(&sys, EDGES / 2);
    // Not at once: wire that swings beyond its rest may yield once more.
    sys.state.support[1] = Support::free();
    let couple = V3::z() * loaded;
    follow(ctx, &mut sys, |sys, share| {
        sys.model.loads.moments = vec![(EDGES - 1, couple * (1.0 - share))];
    })?;
    Ok(vec![
        ("moment_loaded_Nm", Answer::Number(loaded)),
        (
            "residual_curvature_isotropic_1_per_m",
            Answer::Number(curvature(&sys, EDGES / 2)),
        ),
    ])
}
