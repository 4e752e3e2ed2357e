//! The moment along a path of curvatures.
//!
//! One edge held at both ends; its clamp turns to give the joint there each curvature in turn.

use super::case::no_answer;
use super::equilibrium::{follow_with_twist, method};
use super::wire::{heading, straight};
use super::{Answer, Answers, Context, VerifyError};
use crate::math::V3;
use crate::rod::Twist;
use crate::scene::Integrator;
use crate::system::{Support, System};

/// Largest angle of the joint, rad.
const WIDEST: f64 = 0.05;

/// The moments when the clamp turns slowly from one curvature to the next.
fn by_steps(ctx: &Context, mut sys: System, path: &[f64]) -> Result<Answers, VerifyError> {
    let lv = sys.state.rod.voronoi(0);
    let mut moments = Vec::with_capacity(path.len());
    let mut from = 0.0;
    for curvature in path {
        let to = -curvature * lv;
        follow_with_twist(ctx, &mut sys, |sys, share| {
            let angle = from + share * (to - from);
            sys.state.support[0].frame = Some(heading(angle));
        })?;
        moments.push(-sys.state.load.clamp_moment[0].z);
        from = to;
    }
    Ok(vec![("moment_isotropic_Nm", Answer::List(moments))])
}

/// Moments at the points of the path, each committed before the next.
pub fn run(ctx: &Context) -> Result<Answers, VerifyError> {
    let path = ctx.numbers("curvature_path_1_per_m")?;
    let sharpest = path.iter().fold(0.0_f64, |a, k| a.max(k.abs()));
    let edge = ctx.spacing.unwrap_or(2.0 * WIDEST / sharpest.max(1.0));
    let mut sys = straight(ctx.section.clone(), &[edge]);
    sys.state.support = [
        Support::pinned(V3::zeros()),
        Support::pinned(V3::x() * edge),
    ];
    if ctx.winds() {
        return by_steps(ctx, sys, &path);
    }
    let mut method = method(&sys);
    let mut moments = Vec::with_capacity(path.len());
    for curvature in path {
        // the wire leaves its clamp downwards and turns up into the edge
        let angle = -curvature * sys.state.rod.voronoi(0);
        sys.state.support[0].frame = Some(heading(angle));
        if ctx.integrator == Integrator::Implicit {
            sys.model.twist = Twist::Off;
            // before the path goes on the moment is the work of the step; the shear couple carries it
            moments.push(-method.forces(&mut sys)[1].y * edge);
            method.equilibrate(&mut sys).map_err(no_answer)?;
        } else {
            sys.evaluate(Some(0.0));
            moments.push(-sys.state.load.clamp_moment[0].z);
        }
    }
    Ok(vec![("moment_isotropic_Nm", Answer::List(moments))])
}
