//! A long wire pulled by T at both ends over a frictionless edge, with yield.
//!
//! One half is computed, the other is its mirror image. The edge holds the first node, and the
//! mirror plane holds its direction along +x. The pull at the far end turns from +x to half the turn
//! below. The wire passes through the edge and
//! does not stretch plastically, as in the reference.

use super::equilibrium::follow;
use super::wire::{clamp_along_x, curvature, graded, moment, straight};
use super::{Answer, Answers, Context, VerifyError};
use crate::math::V3;
use crate::rod::Section;
use crate::system::System;

/// Turn of the wire per edge where it is sharpest, rad.
pub(super) const SHARPEST_TURN: f64 = 0.03;
/// Growth of the edges away from the corner.
pub(super) const GROWTH: f64 = 1.06;

/// Section with the file's bending law only.
pub(super) fn bending_only(ctx: &Context) -> Section {
    let open = f64::INFINITY;
    Section {
        n_y: open,
        t_y: open,
        ..ctx.section.clone()
    }
}

/// A bound on the curvature that a tension brings about over a turn of `psi`, 1/m: all work
/// goes into bending at the plastic rate.
pub(super) fn sharpest(section: &Section, tension: f64, psi: f64) -> f64 {
    let work = 2.0 * tension * (1.0 - libm::cos(psi));
    let elastic = (work / section.ei).sqrt();
    let yielded = section.m_y / section.ei + (work / section.ei_p.max(1e-3 * section.ei)).sqrt();
    elastic.max(yielded.min((work / section.ei_p.max(1e-3 * section.ei)).sqrt()))
}

/// Length over which tension straightens yielding wire, m.
pub(super) fn yielded_layer(section: &Section, tension: f64) -> f64 {
    (section.ei_p.max(1e-3 * section.ei) / tension).sqrt()
}

/// Curvature and moment at the edge, how far it stands off the leg, its force.
pub fn run(ctx: &Context) -> Result<Answers, VerifyError> {
    let (pull, turn) = (ctx.positive("T_N")?, ctx.number("turn_rad")?);
    let section = bending_only(ctx);
    let layer = (section.ei / pull).sqrt();
    let finest = SHARPEST_TURN / sharpest(&section, pull, 0.5 * turn);
    let finest = ctx
        .spacing_at_edge(&section, pull, 0.5 * turn)
        .unwrap_or(finest.min(yielded_layer(&section, pull) / 20.0));
    let rest = graded(12.0 * layer, finest, GROWTH, finest.max(layer / 10.0));
    let mut sys = straight(section, &rest);
    sys.state.support[0] = clamp_along_x(V3::zeros());
    let n = rest.len();
    let leg = |share: f64| {
        let psi = 0.5 * turn * share;
        V3::new(libm::cos(psi), -libm::sin(psi), 0.0)
    };
    follow(ctx, &mut sys, |sys, share| {
        sys.model.loads.nodal = vec![(n, V3::x() * (pull * share))];
    })?;
    follow(ctx, &mut sys, |sys: &mut System, share| {
        sys.model.loads.nodal = vec![(n, leg(share) * pull)];
    })?;
    let standoff = sys.state.rod.x[n].cross(&leg(1.0)).z;
    Ok(vec![
        (
            "peak_curvature_1_per_m",
            Answer::Number(-curvature(&sys, 0)),
        ),
        ("peak_moment_Nm", Answer::Number(-moment(&sys, 0))),
        ("standoff_from_leg_line_m", Answer::Number(standoff.abs())),
        // the mirrored half pushes as much
        (
            "edge_force_N",
            Answer::Number(2.0 * sys.state.load.force[0].y.abs()),
        ),
    ])
}
