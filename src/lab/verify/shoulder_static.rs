//! Where a wire on the shoulder of the previous turn begins to slide down.
//!
//! A straight piece is put on a straight frozen wire, loaded, and watched: sliding or not is what
//! the friction law makes of it. Bisection over the start offset.

use super::bench::{Bench, law};
use super::{Answer, Answers, Context, VerifyError};

/// Bisections of the range of offsets, 3.8 r.
const HALVINGS: usize = 17;

/// A piece that has come this far, in wire radii, slides; a bristle yields by 1e-5.
const SLIDES: f64 = 1e-2;

/// Time it has for that, in `sqrt(m' r / q)`: 0.1 % beyond the angle of friction are enough.
const PATIENCE: f64 = 10.0;

/// Runs a case.
pub fn run(ctx: &Context) -> Result<Answers, VerifyError> {
    let (mu, sideways) = (ctx.number("mu")?, ctx.number("lam")?);
    let r = ctx.section.radius();
    let (mut stays, mut slides) = (-1.9 * r, 1.9 * r);
    for _ in 0..HALVINGS {
        let offset = 0.5 * (stays + slides);
        if slides_down(ctx, offset, mu, sideways)? {
            slides = offset;
        } else {
            stays = offset;
        }
    }
    Ok(vec![(
        "slides_down_beyond_offset_m",
        Answer::Number(0.5 * (stays + slides)),
    )])
}

/// Whether the piece let go at this offset moves away from its neighbour.
fn slides_down(ctx: &Context, offset: f64, mu: f64, sideways: f64) -> Result<bool, VerifyError> {
    let r = ctx.section.radius();
    let above = (4.0 * r * r - offset * offset).sqrt();
    let mut bench = Bench::new(ctx, &[0.0], offset, above, sideways, law(1e10, 1.0, mu))?;
    bench.apply_load()?;
    let mut left = PATIENCE;
    while left > 0.0 {
        bench.run(0.25)?;
        left -= 0.25;
        let moved = bench.centre().y - offset;
        if moved.abs() > SLIDES * r {
            return Ok(moved > 0.0);
        }
    }
    Ok(false)
}
