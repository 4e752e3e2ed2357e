//! Static equilibrium of a system: Newton's method on the forces that the time steps use.
//!
//! Unknowns are node positions and the roll of each edge since its frame was taken over. A node's
//! force depends on two neighbours either way. Central differences of `System::evaluate` over
//! every fifth node therefore give the whole tangent in 40 evaluations, whatever the length. The
//! tangent is solved as a band. Following the motion with artificial damping needs as many steps
//! as the ratio of highest to lowest frequency, 1e6 for a hanging wire. Plastic state moves on
//! only where an increment has converged, so that iterates cannot leave false yielding behind.

mod balance;
mod band;
mod error;
mod newton;
mod plastic_tangent;
mod tangent;
#[cfg(test)]
mod tests;
mod unknowns;

use crate::math::V3;
use crate::system::System;
use balance::Balance;
pub use error::RelaxError;
use newton::newton_step;
use unknowns::{PER_NODE, advance, at_supports, support_places};

/// How closely and how long to seek equilibrium.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// out-of-balance force over the largest load or reaction
    pub tolerance: f64,
    /// Newton steps for one increment
    pub iterations: usize,
    /// share of the load in the first increment of a ramp
    pub first: f64,
    /// largest share of the load in one increment
    pub largest: f64,
    /// share below which a ramp gives up
    pub smallest: f64,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            tolerance: 1e-9,
            iterations: 20,
            first: 0.1,
            largest: 0.25,
            smallest: 1e-5,
        }
    }
}

/// How equilibrium was reached.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Relaxed {
    /// Newton steps in all
    pub iterations: usize,
    /// load increments
    pub increments: usize,
    /// out-of-balance force left over the largest load or reaction
    pub residual: f64,
}

/// Newton steps up to which an increment was quick, and what happens to the next one.
const QUICK: usize = 7;
const GROWTH: f64 = 1.4;
const SHRINK: f64 = 0.5;

/// Largest force out of balance of a wire whose forces are those of its present place, and the size of its loads, N.
pub(crate) fn out_of_balance(sys: &System) -> Result<(f64, f64), RelaxError> {
    Ok((Balance::largest(sys), Balance::of(sys)?.load()))
}

/// Moves `sys` to equilibrium under its present loads and supports, and commits it.
///
/// Velocities and spins become zero. Held coordinates may start away from their supports: they go
/// there with the rest of the wire.
pub fn relax(sys: &mut System, limits: &Limits) -> Result<Relaxed, RelaxError> {
    sys.state.rod.v.fill(V3::zeros());
    sys.state.rod.spin.fill(0.0);
    sys.state.roll.clear();
    sys.state.roll.resize(sys.state.rod.edges(), 0.0);
    let target = support_places(sys);
    sys.evaluate(None);
    let mut iterations = 0;
    loop {
        let balance = Balance::of(sys)?;
        let residual = balance.worst(sys);
        if balance.holds(sys, limits.tolerance) && at_supports(sys, &target) {
            sys.evaluate(Some(0.0));
            return Ok(Relaxed {
                iterations,
                increments: 1,
                residual,
            });
        }
        if iterations == limits.iterations {
            return Err(RelaxError::NotConverged {
                share: 1.0,
                residual,
                iterations,
            });
        }
        iterations += 1;
        newton_step(sys, &target)?;
    }
}

/// Follows equilibrium while `apply` sets loads and supports to a share of their final values.
///
/// The share grows from 0 to 1. Its increments shrink where Newton's method fails and grow where it
/// converges quickly.
pub fn ramp(
    sys: &mut System,
    limits: &Limits,
    mut apply: impl FnMut(&mut System, f64),
) -> Result<Relaxed, RelaxError> {
    let (mut at, mut step) = (0.0, limits.first);
    let mut total = Relaxed {
        iterations: 0,
        increments: 0,
        residual: 0.0,
    };
    // how the wire moved in the last increment, and the share of the load that did it
    let mut trend: Option<(Vec<f64>, f64)> = None;
    while at < 1.0 {
        let to = if at + step > 1.0 - 1e-9 {
            1.0
        } else {
            at + step
        };
        let before = sys.clone();
        apply(sys, to);
        if let Some((moved, share)) = &trend {
            carry_on(sys, moved, (to - at) / share);
        }
        match relax(sys, limits) {
            Ok(done) => {
                let mut moved = vec![0.0; PER_NODE * sys.state.rod.nodes()];
                for (i, (x, x0)) in sys.state.rod.x.iter().zip(&before.state.rod.x).enumerate() {
                    moved[PER_NODE * i..PER_NODE * i + 3].copy_from_slice((x - x0).as_slice());
                }
                trend = Some((moved, to - at));
                at = to;
                total.iterations += done.iterations;
                total.increments += 1;
                total.residual = done.residual;
                if done.iterations <= QUICK {
                    step = (GROWTH * step).min(limits.largest);
                }
            }
            Err(error) => {
                *sys = before;
                step *= SHRINK;
                if step < limits.smallest {
                    return Err(error.at_share(to));
                }
            }
        }
    }
    Ok(total)
}

/// A first guess: the wire goes on as it went before.
fn carry_on(sys: &mut System, moved: &[f64], share: f64) {
    sys.state.roll.clear();
    sys.state.roll.resize(sys.state.rod.edges(), 0.0);
    let start = (sys.state.rod.x.clone(), sys.state.roll.clone());
    advance(sys, &start, moved, share, None);
}
