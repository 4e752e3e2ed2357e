//! A wire let go on the shoulder of the previous turn: the gap it leaves beside it.
//!
//! It slides down the neighbour, leaves it, lands on the flat without rebound and slides to rest.
//! Nothing of this is told to it: the piece moves under its load against frozen wire and core.

use super::bench::{Bench, Stepper, law};
use super::{Answer, Answers, Context, VerifyError};
use crate::integrate::{Explicit, ExplicitMethod};
use crate::scene::Integrator;

/// Line load per depth, N/m^2, of the production method, that of a wind, and of the explicit one. Only the depth matters; softer
/// allows the strong dashpot.
const STIFFNESS: f64 = 1e10;
const SOFT: f64 = 1e9;

/// Damping ratio of contact in the explicit method: no rebound.
///
/// A critical dashpot, 1, does not rebound either, but it pulls the wire back by `e^-2` of the
/// impulse. The push makes up for that, and friction follows the push: 13.5 % too much of it in
/// the landing. The excess falls with `1 / (4 ratio^2)`.
const DAMPING: f64 = 4.0;

/// Times in `sqrt(m' r / q)`: longest wait for a start, longest run, and how often to look.
const WAIT: f64 = 5.0;
const LONGEST: f64 = 400.0;
const LOOK: f64 = 1.0;

/// Way that counts as having left the place, and as having come to rest, in wire radii.
const STARTED: f64 = 0.02;
const RESTS: f64 = 1e-5;

/// Runs a case.
pub fn run(ctx: &Context) -> Result<Answers, VerifyError> {
    let (mu, sideways) = (ctx.number("mu")?, ctx.number("lam")?);
    let section = ctx.elastic();
    let r = section.radius();
    let start = ctx.number("start_angle_deg")?.to_radians();
    let offset = 2.0 * r * libm::sin(start);
    let above = 2.0 * r * libm::cos(start);
    let mut bench = Bench::new(
        ctx,
        &[0.0],
        offset,
        above,
        sideways,
        law(
            if ctx.integrator == Integrator::Implicit {
                STIFFNESS
            } else {
                SOFT
            },
            DAMPING,
            mu,
        ),
    )?;
    // a staggered velocity is half a step old: on a curved way the dashpot takes that for a
    // departure, and pulls with damping_ratio * omega * dt / 2 of the load, here 8 %
    if let Stepper::Explicit(explicit) = &mut bench.step {
        *explicit = Explicit::new(ExplicitMethod::Rk4);
    }
    bench.apply_load()?;
    let mut time = 0.0;
    let mut last = offset;
    loop {
        bench.run(LOOK)?;
        time += LOOK;
        let at = bench.centre().y;
        let started = (at - offset).abs() > STARTED * r;
        if !started && time > WAIT {
            return Ok(vec![("sticks", Answer::Flag(true))]);
        }
        if started && (at - last).abs() < RESTS * r {
            return Ok(vec![
                ("sticks", Answer::Flag(false)),
                ("gap_m", Answer::Number(at - section.diameter)),
            ]);
        }
        if time > LONGEST {
            let v = bench.velocity();
            return Err(VerifyError::NoAnswer(format!(
                "the wire still moves at {:.3} m/s, {at:.3e} m beside its neighbour's axis",
                v.norm()
            )));
        }
        last = at;
    }
}
