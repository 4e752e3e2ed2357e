//! Static equilibrium: by the production method, or by the forces of the explicit steps.

use super::{Context, VerifyError};
use crate::integrate;
use crate::integrate::{Implicit, Scheme};
use crate::lab::statics::{Limits, ramp, relax};
use crate::rod::Twist;
use crate::scene::Integrator;
use crate::system::System;

/// Ten times the update over the wire's length at which a static solve is done; what is left after it
/// is smaller still.
const TOLERANCE: f64 = 1e-10;

/// Follows equilibrium while `apply` brings loads and supports from share 0 to share 1; without twist,
/// which does nothing in a plane.
pub(super) fn follow(
    ctx: &Context,
    sys: &mut System,
    apply: impl FnMut(&mut System, f64),
) -> Result<(), VerifyError> {
    if ctx.integrator == Integrator::Implicit {
        sys.model.twist = Twist::Off;
        return method(sys).follow(sys, apply).map_err(no_answer);
    }
    ramp(sys, &Limits::default(), apply)?;
    Ok(())
}

/// The same for a wire in the x-y plane that dead couples roll up: twist is off, which holds a real
/// wire in that plane.
pub(super) fn follow_in_plane(
    ctx: &Context,
    sys: &mut System,
    apply: impl FnMut(&mut System, f64),
) -> Result<(), VerifyError> {
    if ctx.integrator != Integrator::Implicit {
        return follow(ctx, sys, apply);
    }
    sys.model.twist = Twist::Off;
    let mut method = method(sys);
    method.flat = true;
    method.follow(sys, apply).map_err(no_answer)
}

/// The same with twist.
pub(super) fn follow_with_twist(
    ctx: &Context,
    sys: &mut System,
    apply: impl FnMut(&mut System, f64),
) -> Result<(), VerifyError> {
    if ctx.integrator == Integrator::Implicit {
        sys.model.twist = Twist::QuasiStatic;
        return method(sys).follow(sys, apply).map_err(no_answer);
    }
    follow(ctx, sys, apply)
}

/// Moves to equilibrium under the present loads and supports; without twist, see [`follow`].
pub(super) fn settle(ctx: &Context, sys: &mut System) -> Result<(), VerifyError> {
    if ctx.integrator == Integrator::Implicit {
        sys.model.twist = Twist::Off;
        return method(sys).equilibrate(sys).map_err(no_answer);
    }
    relax(sys, &Limits::default())?;
    Ok(())
}

/// The same with twist.
pub(super) fn settle_with_twist(ctx: &Context, sys: &mut System) -> Result<(), VerifyError> {
    if ctx.integrator == Integrator::Implicit {
        sys.model.twist = Twist::QuasiStatic;
        return method(sys).equilibrate(sys).map_err(no_answer);
    }
    settle(ctx, sys)
}

/// The production method as static solves use it.
pub(super) fn method(sys: &System) -> Implicit {
    let length: f64 = sys.state.rod.rest.iter().sum();
    // bounds of the step mean nothing here
    Implicit::new(Scheme::Bdf2, TOLERANCE * length, 1e-9, 1.0)
}

/// A step or solve that gave up.
pub(super) fn no_answer(e: integrate::StepError) -> VerifyError {
    VerifyError::NoAnswer(e.to_string())
}
