//! A free span under tension, bowed out by couples at its ends.
//!
//! Both ends pinned, one of them free to slide along the span and pulled by T. The reference is
//! the linear beam-column. The answer is therefore the wire's response to a small share of the
//! couple, scaled up; under the whole couple the square of the slope matters.

use super::equilibrium::follow;
use super::wire::{angle, curvature, straight};
use super::{Answer, Answers, Context, VerifyError};
use crate::math::V3;
use crate::rod::Twist;
use crate::system::Support;

/// Slope of the small response, rad: its square is the departure from the linear answer.
const SLOPE: f64 = 1e-3;

/// Bulge at the middle and slope at the end.
pub fn run(ctx: &Context) -> Result<Answers, VerifyError> {
    let (pull, span, couple) = (
        ctx.positive("T_N")?,
        ctx.positive("span_m")?,
        ctx.number("M_Nm")?,
    );
    let section = ctx.elastic();
    let layer = (section.ei / pull).sqrt();
    // largest end slope there can be: that of the span without tension
    let slope = couple.abs() * span.min(2.0 * layer) / (2.0 * section.ei);
    let share = (SLOPE / slope.max(SLOPE)).min(1.0);
    let n = ctx.edges(span, (span / 100.0).min(layer / 15.0))?;
    // the span is meant under tension
    let rest = span / (1.0 + pull / section.ea);
    let mut sys = straight(section, &vec![rest / n as f64; n]);
    sys.state.support = [
        Support::pinned(V3::zeros()),
        Support {
            hold: [false, true, true],
            ..Support::pinned(V3::zeros())
        },
    ];
    // the pinned ends leave the wire free to roll about its axis
    sys.model.twist = Twist::Off;
    follow(ctx, &mut sys, |sys, s| {
        sys.model.loads.nodal = vec![(n, V3::x() * (pull * s))];
    })?;
    follow(ctx, &mut sys, |sys, s| {
        let m = V3::z() * (couple * share * s);
        sys.model.loads.moments = vec![(0, m), (n - 1, -m)];
    })?;
    let end_slope = angle(&sys, 0) - 0.5 * curvature(&sys, 1) * sys.state.rod.rest[0];
    Ok(vec![
        ("bulge_m", Answer::Number(sys.state.rod.x[n / 2].y / share)),
        ("end_slope_rad", Answer::Number(end_slope / share)),
    ])
}
