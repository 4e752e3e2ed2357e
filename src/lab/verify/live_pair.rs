//! Live wire on live wire: one turn pressed on the turn before it, and drawn along it.
//!
//! Three turns of a helix on a cylinder, a diameter apart, under tension: the first is frozen, two are live. A dead load along the
//! axis, but across the wire, presses the last turn on the one before, and that one harder on the frozen wire. Then the far end is drawn along the wire
//! until all of the last turn slides, on the core and on its neighbour. Coulomb's friction of both gives
//! `dT/ds = mu (q + T/a)`, so that `T + q a` grows by `exp(mu phi)`.

use super::equilibrium::follow;
use super::{Answer, Answers, Context, VerifyError};
use crate::contact::LineModel;
use crate::geometry::{FrozenNode, Shape};
use crate::math::{V3, frame_along};
use crate::rod::Rod;
use crate::scene::Integrator;
use crate::system::{Support, System};
use std::f64::consts::TAU;

/// Frozen wire, turns: a little more than one.
const FROZEN: f64 = 1.2;
/// Load of the turn between over that of the last one: it must not slide.
const BETWEEN: f64 = 3.0;
/// Part of the last turn, from its start and to its end, that the ends do not shape.
const INNER: [f64; 2] = [0.25, 0.75];

/// Stiffness of a wind, N/m^2.
const STIFFNESS: f64 = 1e10;

/// Runs a case.
pub fn run(ctx: &Context) -> Result<Answers, VerifyError> {
    let (radius, press) = (ctx.positive("R_m")?, ctx.positive("press_N_per_m")?);
    let (mu, drawn) = (ctx.number("mu")?, ctx.number("drawn_m")?);
    let Some(spacing) = ctx
        .spacing
        .filter(|_| ctx.integrator == Integrator::Implicit)
    else {
        return Err(VerifyError::NoAnswer(
            "the spheres of the explicit method do not lie on each other evenly".to_owned(),
        ));
    };
    let round = (TAU * (radius + ctx.section.radius()) / spacing).ceil();
    ctx.few_enough(2.0 * round)?;
    let mut sys = stack(ctx, (radius, ctx.positive("T0_N")?), spacing, mu);
    let edges = sys.state.rod.edges();
    let start = sys.state.rod.x.clone();
    follow(ctx, &mut sys, |sys, share| {
        sys.model.loads.nodal = (1..edges)
            .map(|i| {
                let load = if 2 * i > edges { 1.0 } else { BETWEEN };
                let q = load * press * share * sys.state.rod.voronoi(i);
                (i, across(&start, i) * -q)
            })
            .collect();
    })?;
    let end = sys.state.support[1].point;
    let tangent = sys.clamp_direction(1).unwrap_or_else(V3::x);
    follow(ctx, &mut sys, |sys, share| {
        sys.state.support[1].point = end + tangent * (drawn * share);
    })?;
    let at = |share: f64| (edges as f64 * 0.5 * (1.0 + share)) as usize;
    let (a, b) = (at(INNER[0]), at(INNER[1]));
    let x = &sys.state.rod.x;
    // tension is that of an edge, whose middle lies half-way between the angles of its nodes
    let angle: f64 = (a..b)
        .map(|j| 0.5 * (turned(x, j) + turned(x, j + 1)))
        .sum();
    let axis = radius + sys.model.section.radius();
    let grown = |j: usize| sys.state.load.tension[j] + press * axis;
    let now = over_turn_before(x, at(0.5));
    Ok(vec![
        (
            "approach_m",
            Answer::Number(over_turn_before(&start, at(0.5)) - now),
        ),
        (
            "slip_exponent",
            Answer::Number(libm::log(grown(b) / grown(a)) / angle),
        ),
    ])
}

/// The axis across the wire at node `i`: a load along the axis itself would draw wire along its helix.
fn across(x: &[V3], i: usize) -> V3 {
    let along = (x[i + 1] - x[i - 1]).normalize();
    (V3::y() - along * along.y).normalize()
}

/// Angle about the axis from node `j` to the next, rad.
fn turned(x: &[V3], j: usize) -> f64 {
    let (a, b) = (x[j], x[j + 1]);
    libm::atan2(a.x * b.z - a.z * b.x, a.x * b.x + a.z * b.z)
}

/// Way along the axis from the wire a turn before to node `i`, at its angle, m.
fn over_turn_before(x: &[V3], i: usize) -> f64 {
    let mut angle = 0.0;
    for j in (0..i).rev() {
        let step = turned(x, j);
        if angle + step > TAU {
            let share = (TAU - angle) / step;
            return x[i].y - (x[j + 1].y + share * (x[j].y - x[j + 1].y));
        }
        angle += step;
    }
    f64::NAN
}

/// The three turns, the last two live and clamped at both ends.
fn stack(ctx: &Context, (radius, pull): (f64, f64), spacing: f64, mu: f64) -> System {
    let section = ctx.elastic();
    let (d, r) = (section.diameter, section.radius());
    let axis = radius + r;
    // neighbouring turns a diameter apart
    let slope = d / (TAU * axis);
    let rise = d / TAU / (1.0 - slope * slope).sqrt();
    let rate = libm::hypot(axis, rise);
    let per_turn = 2 * (0.5 * TAU * rate / spacing).ceil() as usize;
    let step = TAU / per_turn as f64;
    // the spline of the nodes, which touches, passes inside of them
    let outer = axis / (0.75 + 0.25 * libm::cos(step));
    let at = |angle: f64| {
        let (s, c) = (libm::sin(angle), libm::cos(angle));
        V3::new(outer * c, rise * angle, outer * s)
    };
    let along = |angle: f64| {
        let (s, c) = (libm::sin(angle), libm::cos(angle));
        V3::new(-axis * s, rise, axis * c) / rate
    };
    let points: Vec<V3> = (0..=2 * per_turn).map(|i| at(step * i as f64)).collect();
    let end = points.len() - 1;
    let stretch = 1.0 + pull / section.ea;
    let rest = points.windows(2).map(|p| (p[1] - p[0]).norm() / stretch);
    let rod = Rod::through(&points, Some(rest.collect()));
    let frames = [rod.frame[0], rod.frame[end - 1]];
    let mut sys = System::new(section, rod);
    let core = Shape::Cylinder {
        radius,
        half_y: 10.0 * d,
    };
    let law = super::bench::law(STIFFNESS, 0.0, mu);
    sys.touch_along(LineModel::new(core, law, r));
    let frozen = (FROZEN * per_turn as f64) as usize;
    let edge = (points[1] - points[0]).norm();
    for k in (1..=frozen).rev() {
        let angle = -step * k as f64;
        sys.lay_frozen(FrozenNode {
            point: at(angle),
            frame: frame_along(&along(angle + 0.5 * step), None),
            arc: edge * (frozen - k) as f64,
            tension: 0.0,
            plastic_strain: 0.0,
            plastic_bend: 0.0,
        });
    }
    sys.state.arc0 = edge * frozen as f64;
    let angles = [0.0, step * end as f64];
    for (k, place) in [points[0], points[end]].into_iter().enumerate() {
        let frame = frame_along(&along(angles[k]), Some(&frames[k]));
        sys.state.support[k] = Support::clamped(place, frame);
    }
    sys.state.contact.watch_live_wire();
    sys.refresh();
    sys
}
