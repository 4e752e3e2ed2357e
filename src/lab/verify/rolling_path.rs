//! Bend and twist that yield together: wire is bent onto a circle, rolls there, and is let straight again.
//!
//! One edge between two clamps. They turn as the halves of a circle's arc do, about an axis that goes round the wire while it
//! rolls, and against each other by the twist. The roll of the edge between them is free. The bend goes along a curve in the plane of
//! curvatures, so that the return map has to follow its direction; the balance of the edge couples it with twist.

use super::equilibrium::follow_with_twist;
use super::wire::straight;
use super::{Answer, Answers, Context, VerifyError};
use crate::math::{Quat, V3};
use crate::rod::{Joint, respond_bend, respond_scalar};
use crate::system::{Support, System};

/// Edge of the kind's own set-up over the diameter: that of a wind.
const EDGE: f64 = 3.0 / 7.0;

/// Pieces of a leg, each a ramp of its own: the return map is of first order where the direction of the bend changes.
const PIECES: usize = 10;

/// Runs a case.
pub fn run(ctx: &Context) -> Result<Answers, VerifyError> {
    let curvature = ctx.positive("curvature_1_per_m")?;
    let (roll, twist) = (ctx.number("roll_rad")?, ctx.number("twist_1_per_m")?);
    let edge = ctx.spacing.unwrap_or(EDGE * ctx.section.diameter);
    let mut sys = straight(ctx.section.clone(), &[edge]);
    let base = sys.state.rod.frame[0];
    sys.state.support = [
        Support::clamped(V3::zeros(), base),
        Support::clamped(V3::x() * edge, base),
    ];
    let half = 0.5 * edge;
    // curvature, direction of the bend and twist at the ends of the three legs of the path
    let path = [
        [0.0, 0.0, 0.0],
        [curvature, 0.0, 0.0],
        [curvature, roll, twist],
        [0.0, roll, twist],
    ];
    let (mut bends, mut torques) = (Vec::new(), Vec::new());
    for leg in path.windows(2) {
        for piece in 0..PIECES {
            follow_with_twist(ctx, &mut sys, |sys, share| {
                let share = (piece as f64 + share) / PIECES as f64;
                let at = |k: usize| leg[0][k] + share * (leg[1][k] - leg[0][k]);
                let turn = between(at(0) * half, at(1), at(2) * half);
                sys.state.support[0].frame = Some(base * turn.conjugate());
                sys.state.support[1].frame = Some(base * turn);
            })?;
        }
        let (bend, torque) = at_first(&sys);
        bends.extend(bend);
        torques.push(torque);
    }
    Ok(vec![
        ("bend_moment_Nm", Answer::List(bends)),
        ("torque_Nm", Answer::List(torques)),
    ])
}

/// The turn of a joint with this angle of bend about an axis at `direction` in the half-way frame, and this twist, all in rad.
fn between(bend: f64, direction: f64, twist: f64) -> Quat {
    let half = Quat::new(libm::cos(0.25 * twist), 0.0, 0.0, libm::sin(0.25 * twist));
    let s = libm::sin(0.5 * bend);
    let swing = Quat::new(
        libm::cos(0.5 * bend),
        s * libm::cos(direction),
        s * libm::sin(direction),
        0.0,
    );
    half * swing * half
}

/// Bending moment (two components) and torque of the joint in the first clamp, N m.
fn at_first(sys: &System) -> ([f64; 2], f64) {
    let rod = &sys.state.rod;
    let lv = rod.voronoi(0);
    let Some(clamp) = sys.clamp_frame(0) else {
        return ([f64::NAN; 2], f64::NAN);
    };
    let joint = Joint::between(&clamp, &rod.frame[0]);
    let (m, _, _) = respond_bend(
        &sys.model.laws.bend,
        &rod.bend[0],
        joint.bend.map(|b| b / lv),
    );
    let (t, _, _) = respond_scalar(&sys.model.laws.twist, &rod.twist[0], joint.twist / lv);
    (m, t)
}
