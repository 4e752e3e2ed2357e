//! Static equilibrium: by static solves of the production method, by the steps that wind, or by the forces of the
//! explicit steps.

use super::case::no_answer;
use super::quasi_static::QuasiStatic;
use super::{Context, VerifyError};
use crate::integrate::{Implicit, Scheme};
use crate::lab::statics::{Limits, ramp, relax};
use crate::rod::Twist;
use crate::scene::Integrator;
use crate::system::System;

/// Ten times the update over the wire's length at which a static solve is done; what is left after it
/// is smaller still.
const TOLERANCE: f64 = 1e-10;

/// What a problem asks of the solver.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Needs {
    /// a plane wire: twist does nothing
    Plane,
    /// a plane wire that dead couples roll up, which nothing but the plane holds
    HeldPlane,
    /// a wire whose rolls matter
    Rolls,
}

/// Follows equilibrium while `apply` brings loads and supports from share 0 to share 1; without twist,
/// which does nothing in a plane.
pub(super) fn follow(
    ctx: &Context,
    sys: &mut System,
    apply: impl FnMut(&mut System, f64),
) -> Result<(), VerifyError> {
    follow_as(ctx, sys, Needs::Plane, apply)
}

/// The same for a wire in the x-y plane that dead couples roll up: twist is off, which holds a real
/// wire in that plane.
pub(super) fn follow_in_plane(
    ctx: &Context,
    sys: &mut System,
    apply: impl FnMut(&mut System, f64),
) -> Result<(), VerifyError> {
    follow_as(ctx, sys, Needs::HeldPlane, apply)
}

/// The same with twist.
pub(super) fn follow_with_twist(
    ctx: &Context,
    sys: &mut System,
    apply: impl FnMut(&mut System, f64),
) -> Result<(), VerifyError> {
    follow_as(ctx, sys, Needs::Rolls, apply)
}

fn follow_as(
    ctx: &Context,
    sys: &mut System,
    needs: Needs,
    apply: impl FnMut(&mut System, f64),
) -> Result<(), VerifyError> {
    if ctx.integrator != Integrator::Implicit {
        ramp(sys, &Limits::default(), apply)?;
        return Ok(());
    }
    sys.model.twist = twist(ctx, sys, needs);
    if ctx.winds() {
        return QuasiStatic::new(ctx, sys, needs == Needs::HeldPlane).follow(sys, apply);
    }
    let mut method = method(sys);
    method.flat = needs == Needs::HeldPlane;
    method.follow(sys, apply).map_err(no_answer)
}

/// Moves to equilibrium under the present loads and supports, with twist.
pub(super) fn settle_with_twist(ctx: &Context, sys: &mut System) -> Result<(), VerifyError> {
    if ctx.integrator != Integrator::Implicit {
        relax(sys, &Limits::default())?;
        return Ok(());
    }
    sys.model.twist = twist(ctx, sys, Needs::Rolls);
    if ctx.winds() {
        return QuasiStatic::new(ctx, sys, false).rest(sys);
    }
    method(sys).equilibrate(sys).map_err(no_answer)
}

/// How twist is carried: a wind carries that of wire that can yield, and of elastic wire none.
fn twist(ctx: &Context, sys: &System, needs: Needs) -> Twist {
    let section = &sys.model.section;
    let yields = section.m_y.is_finite() || section.t_y.is_finite();
    let carried = match needs {
        Needs::Rolls => true,
        Needs::Plane => ctx.winds() && yields,
        Needs::HeldPlane => false,
    };
    if carried {
        Twist::QuasiStatic
    } else {
        Twist::Off
    }
}

/// The production method as static solves use it.
pub(super) fn method(sys: &System) -> Implicit {
    let length: f64 = sys.state.rod.rest.iter().sum();
    // bounds of the step mean nothing here
    Implicit::new(Scheme::Bdf2, TOLERANCE * length, 1e-9, 1.0)
}
