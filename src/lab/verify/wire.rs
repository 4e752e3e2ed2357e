//! Straight pieces of wire to start from, and what can be read off a wire.

use crate::math::frame_along;
use crate::math::{Quat, V3};
use crate::rod::{Joint, Rod, Section, respond_bend};
use crate::system::{Support, System};

/// A straight unstretched wire from the origin along +x with these edge lengths, nothing held.
pub(super) fn straight(section: Section, rest: &[f64]) -> System {
    let mut at = 0.0;
    let mut points = vec![V3::zeros()];
    for h in rest {
        at += h;
        points.push(V3::new(at, 0.0, 0.0));
    }
    System::new(section, Rod::through(&points, Some(rest.to_vec())))
}

/// Clamp at `point` from where the wire leaves along +x.
pub(super) fn clamp_along_x(point: V3) -> Support {
    Support::clamped(point, heading(0.0))
}

/// Frame along +x turned about +z by `angle`.
pub(super) fn heading(angle: f64) -> Quat {
    let turn = Quat::new(libm::cos(0.5 * angle), 0.0, 0.0, libm::sin(0.5 * angle));
    turn * frame_along(&V3::x(), None)
}

/// Edge lengths from `finest` at the start of a wire of `length`, growing by the factor `growth`
/// up to `coarsest`.
pub(super) fn graded(length: f64, finest: f64, growth: f64, coarsest: f64) -> Vec<f64> {
    let mut rest = Vec::new();
    let (mut total, mut h) = (0.0, finest);
    while total < length {
        rest.push(h);
        total += h;
        h = (h * growth).min(coarsest);
    }
    let scale = length / total;
    rest.iter_mut().for_each(|h| *h *= scale);
    rest
}

/// The joint at node `i`; at an end only if that end is clamped.
fn joint(sys: &System, i: usize) -> Option<Joint> {
    let before = if i == 0 {
        sys.clamp_frame(0)
    } else {
        Some(sys.state.rod.frame[i - 1])
    };
    let after = if i == sys.state.rod.edges() {
        sys.clamp_frame(1)
    } else {
        Some(sys.state.rod.frame[i])
    };
    Some(Joint::between(&before?, &after?))
}

/// Direction of the wire just before and after node `i`; at an end only if that end is clamped.
fn directions(sys: &System, i: usize) -> Option<(V3, V3)> {
    let before = if i == 0 {
        sys.clamp_direction(0)
    } else {
        Some(sys.state.rod.tangent(i - 1))
    };
    let after = if i == sys.state.rod.edges() {
        sys.clamp_direction(1)
    } else {
        Some(sys.state.rod.tangent(i))
    };
    before.zip(after)
}

/// 1 or -1 as the wire at node `i` turns about +z or -z.
fn sense(sys: &System, i: usize) -> f64 {
    directions(sys, i).map_or(1.0, |(a, b)| 1.0_f64.copysign(a.cross(&b).z))
}

/// Curvature of a plane wire at node `i`, 1/m, positive about +z; 0 at an end that is not clamped.
pub(super) fn curvature(sys: &System, i: usize) -> f64 {
    joint(sys, i).map_or(0.0, |j| {
        sense(sys, i) * norm(j.bend) / sys.state.rod.voronoi(i)
    })
}

/// Moment of a plane wire at node `i` from the bending law in force there, N m.
pub(super) fn moment(sys: &System, i: usize) -> f64 {
    joint(sys, i).map_or(0.0, |j| {
        let lv = sys.state.rod.voronoi(i);
        let k = [j.bend[0] / lv, j.bend[1] / lv];
        let (m, _, _) = respond_bend(&sys.model.laws.bend, &sys.state.rod.bend[i], k);
        // unloaded past its permanent bend, the moment points against the curvature
        let along = if m[0] * k[0] + m[1] * k[1] < 0.0 {
            -1.0
        } else {
            1.0
        };
        along * sense(sys, i) * norm(m)
    })
}

fn norm(a: [f64; 2]) -> f64 {
    (a[0] * a[0] + a[1] * a[1]).sqrt()
}

/// Twist per length at node `i`, 1/m; 0 at an end that is not clamped.
pub(super) fn twist(sys: &System, i: usize) -> f64 {
    joint(sys, i).map_or(0.0, |j| j.twist / sys.state.rod.voronoi(i))
}

/// Angle of edge `j` against +x in the x-y plane, rad, counted on over full turns from edge 0.
pub(super) fn angle(sys: &System, j: usize) -> f64 {
    let heading = |e: usize| {
        let t = sys.state.rod.tangent(e);
        libm::atan2(t.y, t.x)
    };
    let mut angle = heading(0);
    for e in 1..=j {
        let turn = heading(e) - heading(e - 1);
        angle += libm::remainder(turn, std::f64::consts::TAU);
    }
    angle
}
