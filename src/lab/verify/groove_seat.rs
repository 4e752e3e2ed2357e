//! A wire in the groove between two turns, without friction: normal forces and seat.
//!
//! The wire comes down from above both turns, and is pushed aside once it lies in the groove: little would hold one that is
//! pushed while it falls.

use super::bench::{Bench, law, touch_forces};
use super::{Answer, Answers, Context, VerifyError};
use crate::math::V3;

/// Time to settle in `sqrt(m' r / q)`, and the drag in the inverse of it.
const SETTLE: f64 = 12.0;
const DRAG: f64 = 2.0;
/// Time over which the wire is pushed aside, in the same unit, and in how many parts.
const PUSHED: f64 = 12.0;
const PARTS: usize = 240;

/// Runs a case.
pub fn run(ctx: &Context) -> Result<Answers, VerifyError> {
    let (pitch, lam) = (ctx.positive("pitch_m")?, ctx.number("lam")?);
    let section = ctx.elastic();
    let places = [-0.5 * pitch, 0.5 * pitch];
    // from a diameter above the neighbours' axes, clear of both
    let mut bench = Bench::new(
        ctx,
        &places,
        0.0,
        section.diameter,
        0.0,
        law(1e10, 1.0, 0.0),
    )?;
    bench.sys.model.loads.drag = DRAG / bench.unit;
    bench.apply_load()?;
    bench.run(SETTLE)?;
    // positive lam pushes left, to -y
    for part in 1..=PARTS {
        bench.push_aside(-lam * part as f64 / PARTS as f64);
        bench.run(PUSHED / PARTS as f64)?;
    }
    bench.run(SETTLE)?;
    let (mut left, mut right) = (V3::zeros(), V3::zeros());
    for i in 0..bench.sys.state.rod.nodes() {
        for f in touch_forces(&bench.sys, i) {
            if f.y > 0.0 {
                left += f;
            } else {
                right += f;
            }
        }
    }
    let load = bench.load * bench.length();
    let seat = bench.centre();
    let speed = bench.velocity().norm() * bench.unit / section.radius();
    if seat.y.abs() > 0.5 * pitch || speed > 1e-4 {
        return Err(VerifyError::NoAnswer(format!(
            "the wire did not come to rest in the groove: {:.3e} m beside it",
            seat.y
        )));
    }
    Ok(vec![
        ("normal_left_per_q", Answer::Number(left.norm() / load)),
        ("normal_right_per_q", Answer::Number(right.norm() / load)),
        (
            "seat_height_above_wire_centres_m",
            Answer::Number(seat.z - bench.height),
        ),
    ])
}
