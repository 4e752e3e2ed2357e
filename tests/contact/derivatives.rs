//! Energy, gradient and Hessian of a contact point's push by finite differences, with friction limits
//! held as the line search sees them.

use crate::parts::Parts;
use coilwind::contact::{ContactLaw, ContactResponse, LimitFrom};
use coilwind::geometry::{Flanges, Shape};
use coilwind::math::V3;
use proptest::prelude::*;

const STIFFNESS: f64 = 1e10;
const LENGTH: f64 = 0.5e-3;
const RADIUS: f64 = 0.35e-3;
const STEP: f64 = 1e-5;
const MU: f64 = 0.2;
/// Stiffness of what the point stands for, N/m, and the share of it along the surface (Mindlin).
const K: f64 = STIFFNESS * LENGTH;
const ALONG: f64 = 2.0 * (1.0 - 0.34) / (2.0 - 0.34);
/// Share of a sliding bristle's missing stiffness that the Hessian leaves in while its limit is held.
const ALONG_SLIDE: f64 = 0.9;
/// Step of the differences, m: depths are some um, the wire's radius is 350 um.
const H: f64 = 1e-10;

fn contact(mu: f64) -> Parts {
    let law = ContactLaw {
        stiffness: STIFFNESS,
        damping_ratio: 0.0,
        mu_static: mu,
        mu_kinetic: mu,
        slip_speed: 1.0,
    };
    let shape = Shape::RoundedBox {
        half_x: 6e-3,
        half_z: 10e-3,
        half_y: 8e-3,
        corner_radius: 2e-3,
    };
    let mut line = Parts::new(shape.clone(), law, RADIUS, 1);
    line.model.flanges = Some(Flanges {
        core: shape,
        half_inner: 7e-3,
        height: 4e-3,
        thickness: 1e-3,
        edge_radius: 0.3e-3,
    });
    // one turn round a cylinder far off the box, edges of 0.8 mm
    for i in 0..40 {
        let a = 0.1 * f64::from(i);
        let p = V3::new(60e-3 + 8e-3 * libm::cos(a), 1e-4 * a, 8e-3 * libm::sin(a));
        line.contact().lay(p, 0.8e-3 * f64::from(i));
    }
    line
}

/// Surfaces to touch: flat, corner arc, flange, frozen wire.
#[derive(Clone, Copy, Debug)]
enum On {
    Flat,
    Corner,
    Flange,
    Wire,
}

/// A place at which the point just touches, the way out, and one along.
fn ground(on: On, at: f64) -> [V3; 3] {
    match on {
        On::Flat => [
            V3::new(6e-3 + RADIUS, 5e-3 * (at - 0.5), 3e-3 * at),
            V3::x(),
            V3::new(0.0, 0.6, 0.8),
        ],
        On::Corner => {
            let a = 0.2 + 1.1 * at;
            let out = V3::new(libm::cos(a), 0.0, libm::sin(a));
            let axis = V3::new(4e-3, 5e-3 * (at - 0.5), 8e-3);
            [axis + out * (2e-3 + RADIUS), out, V3::y()]
        }
        On::Flange => [
            V3::new(8e-3, RADIUS - 7e-3, 3e-3 * at),
            V3::y(),
            V3::new(0.8, 0.0, 0.6),
        ],
        On::Wire => {
            let line = contact(0.0);
            let (a, b) = (0.3 + 3.0 * at, 6.2 * at);
            let round = V3::new(libm::cos(a), 0.0, libm::sin(a));
            let out = round * libm::cos(b) + V3::y() * libm::sin(b);
            let foot = line.scratch.tube.foot(
                V3::x() * 60e-3 + round * 8e-3 + out * 2.0 * RADIUS,
                (10.0 * a) as u32,
            );
            let p = foot.point + foot.normal * (2.0 * RADIUS);
            let along = round.cross(&V3::y());
            let along = along - foot.normal * along.dot(&foot.normal);
            [p, foot.normal, along.normalize()]
        }
    }
}

/// Any of these surfaces.
fn on() -> impl Strategy<Value = On> {
    prop_oneof![
        Just(On::Flat),
        Just(On::Corner),
        Just(On::Flange),
        Just(On::Wire)
    ]
}

fn at(line: &mut Parts, p: V3) -> ContactResponse {
    line.contact()
        .push(0, p, || LENGTH, || f64::INFINITY, STEP)
        .unwrap_or_default()
}

/// A point that was committed at depth `before` (m, 0: never), is then at `p`, its limit held.
fn held(mu: f64, [q, out, _]: [V3; 3], before: f64, p: V3) -> Parts {
    let mut line = contact(mu);
    let start = q - out * before + out * if before > 0.0 { 0.0 } else { 1e-6 };
    line.state.place(0, start);
    if before > 0.0 {
        line.contact()
            .commit(0, start, || LENGTH, || f64::INFINITY, STEP);
    }
    // an iterate that is accepted leaves its limit behind
    at(&mut line, p);
    line.state.renew_limits();
    line.state.limit_from = LimitFrom::Lagged;
    line
}

/// Differences of the energy and of the gradient.
fn differences(line: &mut Parts, p: V3) -> (V3, [V3; 3]) {
    let step = |a: usize| V3::ith(a, H);
    let mut pushes = [0, 1, 2].map(|a| [at(line, p + step(a)), at(line, p - step(a))]);
    let slope = V3::from_fn(|a, _| (pushes[a][0].energy - pushes[a][1].energy) / (2.0 * H));
    let rows = pushes
        .each_mut()
        .map(|[a, b]| (a.gradient - b.gradient) / (2.0 * H));
    (slope, rows)
}

fn times(m: &coilwind::rod::Block, v: V3) -> V3 {
    V3::from_fn(|r, _| m[r][0] * v.x + m[r][1] * v.y + m[r][2] * v.z)
}

proptest! {
    /// Exact on a flat. On a bend the normal turns with the point, and with it the plane of the
    /// bristle; that part is left out, friction times the way from the anchor along the normal over the radius.
    #[test]
    fn gradient_is_that_of_the_energy_with_limits_held(
        on in on(),
        place in 0.0..1.0f64,
        before in prop_oneof![Just(0.0), 0.2e-6..30e-6f64],
        depth in 0.3e-6..30e-6f64,
        slide in -8e-6..8e-6f64,
        round in 0.0..6.3f64,
        mu in prop_oneof![Just(0.0), 0.05..0.4f64],
    ) {
        let g = ground(on, place);
        let [q, out, along] = g;
        let way = along * libm::cos(round) + out.cross(&along) * libm::sin(round);
        let p = q - out * depth + way * slide;
        let mut line = held(mu, g, before, p);
        let push = at(&mut line, p);
        prop_assert!(push.energy > 0.0 && push.energy == push.energy_lagged);
        let (slope, _) = differences(&mut line, p);
        // the energy's third derivative is k/onset, rounding 1e-16 of it over the step
        let noise = K * H * H / 1e-5 + 1e-15 * push.energy / H + 1e-6 * push.gradient.norm();
        let (way_in, bend) = (depth + before + 1e-6, 2.0 * RADIUS - depth);
        let stuck = K * ALONG * slide.abs() * (1.0 + way_in / bend);
        let friction = stuck.min(1.01 * mu * push.gradient.norm());
        let turning = friction * way_in / bend;
        let off = (slope - push.gradient).norm();
        prop_assert!(off < 1.01 * turning + noise, "{off} {turning} {noise}");
    }

    /// On a flat Hessian and slip coupling together are the gradient's derivative, whether the bristle sticks or gives way.
    /// Where the friction limit is held, the Hessian alone keeps a tenth of the stiffness along the slide.
    #[test]
    fn hessian_and_slip_coupling_on_a_flat(
        place in 0.0..1.0f64, before in prop_oneof![Just(0.0), 0.2e-6..30e-6f64],
        depth in 0.3e-6..30e-6f64, slide in 5e-8..8e-6f64, round in 0.0..6.3f64, follows in proptest::bool::ANY,
    ) {
        let g = ground(On::Flat, place);
        let [q, out, along] = g;
        let way = along * libm::cos(round) + out.cross(&along) * libm::sin(round);
        let p = q - out * depth + way * slide;
        let mut line = held(MU, g, before, p);
        if follows {
            // the coefficient is that of the slide at `p`, whatever it is at the places of the differences
            line.model.law.mu_static = 1.5 * MU;
            line.state.limit_from = LimitFrom::Slide;
            at(&mut line, p);
            line.state.limit_from = LimitFrom::NormalForce;
        }
        let push = at(&mut line, p);
        let (_, rows) = differences(&mut line, p);
        let across = out.cross(&way);
        let normal = push.gradient.dot(&out).abs();
        let mu = if follows { line.model.law.mu(slide / STEP) } else { MU };
        let limit = mu * normal;
        let sticks = K * ALONG * slide < limit;
        prop_assume!((K * ALONG * slide / limit - 1.0).abs() > 1e-3 && (depth / 1e-5 - 1.0).abs() > 1e-3);
        let noise = 1e-5 * K;
        for v in [out, across, way] {
            let exact = rows[0] * v.x + rows[1] * v.y + rows[2] * v.z;
            let mut kept = V3::zeros();
            if !sticks && !follows && v == way {
                kept = way * ((1.0 - ALONG_SLIDE) * limit / slide);
            }
            let off = times(&push.hessian, v) + times(&push.slip_coupling, v) - exact - kept;
            prop_assert!(off.norm() < noise, "{sticks} {v} off by {off} of {}", K);
        }
        prop_assert_eq!(times(&push.slip_coupling, out).norm() > 0.0, follows && !sticks);
    }

    /// Off a flat the Hessian leaves out the normal's turning: force over radius, which pulls on the
    /// update as a pressed column does. It falls below what is exact only inside a bend of wire, by
    /// force over that bend's radius, and stays positive.
    #[test]
    fn hessian_leaves_out_only_the_turning_of_the_normal(
        on in on(), place in 0.0..1.0f64, depth in 0.3e-6..30e-6f64,
        v in (-1.0..1.0f64, -1.0..1.0f64, -1.0..1.0f64),
    ) {
        let g = ground(on, place);
        let [q, out, _] = g;
        let p = q - out * depth;
        let mut line = held(0.0, g, 0.0, p);
        let push = at(&mut line, p);
        let (_, rows) = differences(&mut line, p);
        let v = V3::new(v.0, v.1, v.2);
        let exact = V3::from_fn(|a, _| rows[a].dot(&v));
        let left_out = (times(&push.hessian, v) - exact).dot(&v);
        let noise = 1e-6 * K * v.norm_squared();
        prop_assume!((depth / 1e-5 - 1.0).abs() > 1e-3);
        let force = push.gradient.norm();
        prop_assert!(left_out > -force / 7e-3 * v.norm_squared() - noise);
        prop_assert!(left_out < force / (2.0 * RADIUS - depth) * v.norm_squared() + noise);
        prop_assert!(times(&push.hessian, v).dot(&v) >= -1e-12 * K * v.norm_squared());
    }
}

/// The nearest surface alone left wire in the corner to rattle between both.
#[test]
fn wire_in_the_corner_is_pushed_by_core_and_flange() {
    let corner = V3::new(6e-3 + RADIUS, 7e-3 - RADIUS, 1e-3);
    for [into_core, into_flange] in [[2e-6, 3e-6], [20e-6, 1e-6], [5e-6, -1e-6]] {
        let inwards = V3::new(-into_core, into_flange, 0.0);
        let both = at(&mut contact(0.0), corner + inwards);
        let core = at(&mut contact(0.0), corner + V3::new(-into_core, -1e-3, 0.0));
        let flange = at(&mut contact(0.0), corner + V3::new(1e-3, into_flange, 0.0));
        assert!(core.energy > 0.0 && (flange.energy > 0.0) == (into_flange > 0.0));
        let off = (both.energy - core.energy - flange.energy).abs();
        assert!(off <= 1e-12 * both.energy, "{off}");
        let off = both.gradient - core.gradient - flange.gradient;
        assert!(off.norm() <= 1e-12 * both.gradient.norm(), "{off}");
    }
}

/// A guess may lie deep in what it touches, and an update lead out of it; without the touch the next update may lead
/// nowhere. Then the push at the guess counts again, or the guess would stand as the solution.
#[test]
fn a_look_ahead_comes_back() {
    for on in [On::Flat, On::Corner, On::Flange, On::Wire] {
        let mut line = contact(MU);
        let [place, out, _] = ground(on, 0.4);
        let p = place - out * 60e-6;
        line.contact().begin();
        line.state.limit_from = LimitFrom::Lagged;
        let push = line.contact().push(1, p, || LENGTH, || f64::INFINITY, STEP);
        let push = push.expect("it touches");
        line.state.limit_from = LimitFrom::Slide;
        let (mut gradient, mut hessian) = (push.gradient, push.hessian);
        let mut look = |way: V3| {
            line.contact().predict(
                STEP,
                (way.norm(), 1.0),
                |_| way,
                |_, more, change| {
                    gradient += change;
                    for (row, more) in hessian.iter_mut().zip(more) {
                        for (x, y) in row.iter_mut().zip(more) {
                            *x += y;
                        }
                    }
                },
            );
            (
                gradient.norm(),
                hessian
                    .as_flattened()
                    .iter()
                    .fold(0.0, |s: f64, x| s.max(x.abs())),
            )
        };
        let (g, h) = look(V3::zeros());
        assert!(g > 0.9 * K * 59e-6 && h > 0.4 * K, "{on:?}");
        let (g, h) = look(out * 100e-6);
        assert!(g < 1e-6 * K * 59e-6 && h < 1e-6 * K, "{on:?}");
        let (g, h) = look(V3::zeros());
        assert!(g > 0.9 * K * 59e-6 && h > 0.4 * K, "{on:?}: {g} {h}");
    }
}

/// The ground's slide turns: its bristle is stretched along it at the iterate, and an update leads far to the other side of the anchor.
/// Looks along the update, then along one that leaves the bristle stretched the other way by `beyond` (m). Tells whether
/// each look changed the model, and how stiff that became along the surface, N/m.
fn turning_slide(depth: f64, beyond: f64) -> [(bool, f64); 2] {
    let ground @ [place, out, along] = ground(On::Flat, 0.4);
    let p = place - out * depth + along * 1e-6;
    let mut line = held(MU, ground, depth, p);
    line.state.limit_from = LimitFrom::Slide;
    line.contact().begin();
    let mut hessian = at(&mut line, p).hessian;
    [-5e-6, -1e-6 - beyond].map(|by| {
        let way = along * by;
        let look = (way.norm(), 1.0);
        let changed = line.contact().predict(
            STEP,
            look,
            |_| way,
            |_, more, _| {
                for (row, more) in hessian.iter_mut().zip(more) {
                    for (x, y) in row.iter_mut().zip(more) {
                        *x += y;
                    }
                }
            },
        );
        (changed, times(&hessian, along).dot(&along))
    })
}

/// A bristle held to turn its slide could promise any force below what a pressed touch may be wrong by. A row of lightly pressed ones
/// held the wire, and each update let go of the first two or three: solves ended without an answer.
#[test]
fn a_bristle_is_held_by_no_more_than_twice_its_limit() {
    let depth = 0.05e-6;
    let [(turns, stiff), (lets_go, soft)] = turning_slide(depth, 5e-9);
    assert!(turns && stiff > 0.9 * ALONG * K, "{stiff}");
    assert!(lets_go && soft < 0.1 * ALONG * K, "{soft}");
    // within the limit it stays
    let [(turns, stiff), (lets_go, still)] = turning_slide(depth, 1e-10);
    assert!(turns && !lets_go && stiff == still, "{stiff} {still}");
}

/// Beside a flange wire is a picometre deep in it or not, and bristles there held the wire until their look came.
#[test]
fn a_bristle_that_holds_nothing_lets_go_at_once() {
    let [(_, stiff), (_, still)] = turning_slide(1e-12, 1e-9);
    assert!(stiff < 1e-3 * K && still < 1e-3 * K, "{stiff} {still}");
}
