//! Friction stays within its limit: the force by the anchors and the places of the wire, against the limit by a depth that is
//! measured here.
//!
//! Nothing that the method's own friction was cut off with enters. The normal force follows from the distance to the core's
//! surface, or to the spline of the wire that is touched, of which the method gives no more than roughly where.

use super::broken::{Broken, Found};
use crate::contact::{ContactPoint, HeldBy, LineModel};
use crate::geometry::Nearness;
use crate::lab::stress::{Invariant, Measures};
use crate::math::{Spin, V3};
use crate::simulation::Simulation;

/// Friction may be above its limit by this share: the method's normal force is that of its last iterate.
const ABOVE: f64 = 1e-2;
/// A depth may be off by this share of the diameter: searches for the nearest place of a wire end there.
const OFF: f64 = 1e-7;
/// Tangential over normal stiffness of equal bodies, `2 (1 - nu) / (2 - nu)` (Mindlin 1949), copper.
const TANGENTIAL: f64 = 2.0 * (1.0 - 0.34) / (2.0 - 0.34);

/// What a point touches, and the stretch of the bristle that holds it there.
struct Held {
    point: usize,
    /// depth, m
    depth: f64,
    /// across the normal, m
    bristle: f64,
    /// frozen wire, live wire; neither is the core
    on_wire: Option<usize>,
}

pub(super) fn look(sim: &Simulation, m: &mut Measures) -> Found {
    let sys = sim.system();
    let Some(model) = sys.model.contact.as_line() else {
        return Ok(());
    };
    for held in all_held(sim) {
        let share = over_limit(model, &held);
        m.cone = m.cone.max(share);
        if let Some(kind) = held.on_wire {
            m.cone_on_wire[kind] = m.cone_on_wire[kind].max(share);
        }
        if share > 1.0 + ABOVE {
            let on = ["the core", "frozen wire", "live wire"][held.on_wire.map_or(0, |k| k + 1)];
            let text = format!(
                "friction of contact point {} on {on} is {share:.4} of its limit, {:.3e} d deep",
                held.point,
                held.depth / sys.model.section.diameter
            );
            return Err(Broken::new(Invariant::Cone, text));
        }
    }
    Ok(())
}

/// Friction over the limit of static friction; both are forces over the contact stiffness, m.
fn over_limit(model: &LineModel, held: &Held) -> f64 {
    let off = OFF * 2.0 * model.radius;
    let limit = model.law.mu_static * normal_force(held.depth + off, model.onset);
    let pull = TANGENTIAL * held.bristle;
    if pull <= TANGENTIAL * off {
        return 0.0;
    }
    pull / limit.max(f64::MIN_POSITIVE)
}

/// Normal force over contact stiffness, m: quadratic up to the depth `onset`, then linear, without a kink.
fn normal_force(depth: f64, onset: f64) -> f64 {
    if depth <= 0.0 {
        0.0
    } else if depth < onset {
        0.5 * depth * depth / onset
    } else {
        depth - 0.5 * onset
    }
}

/// How far the wall of a mesh is that `triangle` belongs to; a convex mesh is one wall.
fn near_wall(model: &LineModel, p: V3, triangle: u32) -> Nearness {
    let foot = model
        .shape
        .with_walls()
        .and_then(|s| s.wall_foot(p, triangle));
    foot.map_or_else(
        || model.shape.nearness(p),
        |foot| Nearness {
            distance: foot.distance,
            normal: foot.normal,
        },
    )
}

fn all_held(sim: &Simulation) -> Vec<Held> {
    let sys = sim.system();
    let (Some(model), Some(line), Some(scratch)) = (
        sys.model.contact.as_line(),
        sys.state.contact.as_line(),
        sys.line_scratch(),
    ) else {
        return Vec::new();
    };
    let spin = Spin::new(sys.state.spindle.angle);
    let x = &sys.state.rod.x;
    let nodes: Vec<V3> = x.iter().map(|x| spin.to_core(*x)).collect();
    let frozen = scratch.tube.controls();
    let mut all = Vec::new();
    // (what an end of the wire kept from when it was inner wire acts on nothing)
    let inner = 1..2 * sys.state.rod.edges();
    for touch in line.held().filter(|t| inner.contains(&t.point)) {
        let p = ContactPoint::of_number(touch.point).place(&nodes);
        let solid = |near: Nearness| (near.distance + model.radius, near.normal, None);
        let (distance, normal, on_wire) = match (touch.with, model.flange(p)) {
            (HeldBy::Flange, Some(flange)) => solid(flange),
            (HeldBy::Wall(triangle), _) => solid(near_wall(model, p, triangle)),
            (HeldBy::Core | HeldBy::Flange, _) => solid(model.shape.nearness(p)),
            (HeldBy::Wire(segment), _) => {
                let away = away_from_spline(frozen, segment as usize, p);
                (away.norm(), away.normalize(), Some(0))
            }
        };
        let way = p - touch.anchor;
        all.push(Held {
            point: touch.point,
            depth: 2.0 * model.radius - distance,
            bristle: (way - normal * way.dot(&normal)).norm(),
            on_wire,
        });
    }
    for pair in line.self_contact.iter().flat_map(|pairs| pairs.held()) {
        let p = ContactPoint::of_number(pair.point).place(&nodes);
        let away = away_from_spline(&nodes, pair.segment, p);
        all.push(Held {
            point: pair.point,
            depth: 2.0 * model.radius - away.norm(),
            bristle: pair.bristle.norm(),
            on_wire: Some(1),
        });
    }
    all
}

/// Way to `p` from the nearest place of a quadratic B-spline round the segment of node `near`, m: places on either half of
/// three nodes, the best of them refined.
fn away_from_spline(nodes: &[V3], near: usize, p: V3) -> V3 {
    /// nodes on either side that are looked at
    const SIDE: usize = 2;
    /// places in a segment
    const PLACES: usize = 8;
    let last = nodes.len() - 1;
    let at = |s: f64| {
        // segment i goes from the middle of the edge before node i to that of the edge after it; the ends are nodes
        let i = (s.floor() as usize).min(last);
        let t = s - i as f64;
        let (a, b) = (nodes[i.saturating_sub(1)], nodes[(i + 1).min(last)]);
        match i {
            0 => nodes[0] + (nodes[1.min(last)] - nodes[0]) * (0.5 * t),
            i if i == last => (a + nodes[i]) * 0.5 + (nodes[i] - a) * (0.5 * t),
            _ => {
                let u = 1.0 - t;
                a * (0.5 * u * u) + nodes[i] * (0.5 + u * t) + b * (0.5 * t * t)
            }
        }
    };
    let from = near.saturating_sub(SIDE) as f64;
    let to = ((near + SIDE).min(last) + 1) as f64;
    let step = 1.0 / PLACES as f64;
    let count = ((to - from) / step) as usize;
    let distance = |s: f64| (p - at(s)).norm_squared();
    let places = (0..=count).map(|k| from + step * k as f64);
    let best = places.min_by(|a, b| distance(*a).total_cmp(&distance(*b)));
    let best = best.unwrap_or(from);
    // (a third of the way is left after each look)
    let (mut low, mut high) = ((best - step).max(from), (best + step).min(to));
    for _ in 0..40 {
        let (a, b) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
        if distance(a) < distance(b) {
            high = b;
        } else {
            low = a;
        }
    }
    p - at(0.5 * (low + high))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::stress::invariants::planted;
    use std::f64::consts::FRAC_PI_2;

    #[test]
    fn the_nearest_place_of_a_circle_is_found() {
        let nodes: Vec<V3> = (0..200)
            .map(|k| {
                let a = 0.05 * f64::from(k);
                V3::new(a.cos(), 0.0, a.sin())
            })
            .collect();
        // a B-spline lies inside of its nodes
        let inside = 1.0 - (0.75 + 0.25 * 0.05_f64.cos());
        for k in 20..180 {
            let a = 0.05 * f64::from(k);
            let p = V3::new(a.cos(), 0.0, a.sin()) * 1.1 + V3::y() * 0.2;
            for near in k - 2..=k + 2 {
                let away = away_from_spline(&nodes, near as usize, p).norm();
                let exact = ((0.1 + inside).powi(2) + 0.04_f64).sqrt();
                assert!((away / exact - 1.0).abs() < 1e-9, "{away} {exact}");
            }
        }
        // beyond the end
        let p = V3::new(1.0, 0.0, -0.3);
        let away = away_from_spline(&nodes, 1, p);
        assert!((away.norm() - 0.3).abs() < 2e-3, "{}", away.norm());
        assert!(FRAC_PI_2 > away.angle(&-V3::z()));
    }

    #[test]
    fn friction_over_its_limit_is_seen() {
        let mut sim = planted::wound(1.5);
        let mut measures = Measures::default();
        assert_eq!(look(&sim, &mut measures), Ok(()));
        assert!(measures.cone > 0.0, "nothing is held by friction");
        let deepest = all_held(&sim)
            .into_iter()
            .max_by(|a, b| a.depth.total_cmp(&b.depth))
            .unwrap();
        // sideways: across the normal of the core
        let by = V3::y() * 2.0 * deepest.depth;
        let line = sim.system_mut().state.contact.as_line_mut().unwrap();
        line.stretch_bristles(deepest.point, by);
        planted::sees(look(&sim, &mut measures), Invariant::Cone);
    }

    #[test]
    fn friction_without_pressure_is_seen() {
        let mut sim = planted::wound(1.5);
        let held = all_held(&sim).into_iter();
        let held = held.filter(|h| h.point > 8).find(|h| h.bristle > 1e-9);
        let node = held.unwrap().point / 2;
        // off the core, with the bristle where it was
        let sys = sim.system_mut();
        for x in &mut sys.state.rod.x[node - 1..=node + 1] {
            *x *= 1.0 + 1e-3;
        }
        planted::sees(look(&sim, &mut Measures::default()), Invariant::Cone);
    }
}
