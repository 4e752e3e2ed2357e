//! A wire drawn round the four frictionless edges of a square, with yield.
//!
//! By symmetry half a side is enough. At the edge the wire goes through the corner at 45 degrees;
//! at mid-side it is parallel to the side and under the tension T. The wire starts straight and
//! the direction at the edge turns. The wire slides over its edges, so its length is unknown: it is
//! the one that gives the half side.

use super::corner_edge::{GROWTH, SHARPEST_TURN, bending_only, sharpest, yielded_layer};
use super::equilibrium::follow;
use super::wire::{clamp_along_x, curvature, graded, heading, straight};
use super::{Answer, Answers, Context, VerifyError};
use crate::math::V3;
use crate::system::{Support, System};
use std::f64::consts::FRAC_PI_4;

/// Curvatures, bulge and the force on an edge.
pub fn run(ctx: &Context) -> Result<Answers, VerifyError> {
    let (pull, side) = (ctx.positive("T_N")?, ctx.positive("side_m")?);
    let half = 0.5 * side;
    let (mut low, mut high) = (half, 1.1 * half);
    let mut at_low = drawn(ctx, pull, low)?.1 - half;
    let (mut sys, mut reach) = drawn(ctx, pull, high)?;
    // secant; the span grows almost in proportion to the length
    for _ in 0..20 {
        let off = reach - half;
        if off.abs() < 1e-9 * half {
            break;
        }
        let slope = (off - at_low) / (high - low);
        (low, at_low) = (high, off);
        high -= off / slope;
        if high.is_nan() || high <= 0.0 {
            break;
        }
        (sys, reach) = drawn(ctx, pull, high)?;
    }
    let miss = (reach - half).abs();
    if miss.is_nan() || miss > 1e-6 * half {
        return Err(VerifyError::NoAnswer(format!(
            "no length of wire spans the side: {reach} m instead of {half} m"
        )));
    }
    let n = sys.state.rod.edges();
    let edge = sys.state.load.force[0];
    let through = V3::new(libm::cos(FRAC_PI_4), libm::sin(FRAC_PI_4), 0.0);
    // the other half mirrors this one, so the parts along the wire cancel
    let edge_force = 2.0 * (edge - through * edge.dot(&through)).norm();
    Ok(vec![
        ("mid_curvature_1_per_m", Answer::Number(-curvature(&sys, n))),
        (
            "edge_curvature_1_per_m",
            Answer::Number(-curvature(&sys, 0)),
        ),
        ("bulge_m", Answer::Number(sys.state.rod.x[n].y)),
        ("edge_force_N", Answer::Number(edge_force)),
    ])
}

/// Half a side of wire of this length, drawn, and how far along the side it reaches, m.
fn drawn(ctx: &Context, pull: f64, length: f64) -> Result<(System, f64), VerifyError> {
    let section = bending_only(ctx);
    let layer = (section.ei / pull).sqrt();
    // bent evenly all along or sharply at the edge
    let most = sharpest(&section, pull, FRAC_PI_4) + FRAC_PI_4 / length;
    let coarsest = (length / 60.0).min(layer / 10.0);
    let finest = ctx.spacing_at_edge(&section, pull, FRAC_PI_4).unwrap_or(
        (SHARPEST_TURN / most)
            .min(coarsest)
            .min(yielded_layer(&section, pull) / 20.0),
    );
    let rest = graded(length, finest, GROWTH, coarsest.max(finest));
    let n = rest.len();
    let mut sys = straight(section, &rest);
    sys.state.support = [
        clamp_along_x(V3::zeros()),
        Support {
            hold: [false, false, true],
            ..clamp_along_x(V3::zeros())
        },
    ];
    follow(ctx, &mut sys, |sys, share| {
        sys.model.loads.nodal = vec![(n, V3::x() * (pull * share))];
    })?;
    follow(ctx, &mut sys, |sys, share| {
        sys.state.support[0].frame = Some(heading(FRAC_PI_4 * share));
    })?;
    let reach = sys.state.rod.x[n].x;
    Ok((sys, reach))
}
