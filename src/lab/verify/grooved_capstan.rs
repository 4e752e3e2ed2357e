//! Elastic wire drawn through the V groove of a pulley, on both of whose walls it slips: the ratio of its end forces.
//!
//! [`super::capstan`] on a triangle mesh. Each wall presses with the line load over twice the sine of half the groove's
//! angle, so friction is that of a cylinder with the coefficient over that sine.

use super::bench::mesh;
use super::capstan::{FACETS, ratio_on};
use super::{Answers, Context, VerifyError};
use crate::geometry::Shape;
use crate::geometry::generate::grooved_pulley;
use std::sync::Arc;

/// Depth of the groove in radii of the wire, which touches at most one and a half above the bottom.
const DEPTH: f64 = 4.0;

/// Runs a case.
pub fn run(ctx: &Context) -> Result<Answers, VerifyError> {
    let angle = ctx.positive("groove_rad")?;
    ratio_on(ctx, |radius, r| {
        let bottom = radius + r - r / libm::sin(0.5 * angle);
        mesh(grooved_pulley(bottom, angle, DEPTH * r, FACETS))
            .map(|pulley| Shape::Mesh(Arc::new(pulley)))
    })
}
