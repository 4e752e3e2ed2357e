//! Wire stays out of wire: every live node against all wire half a turn or more behind it, whatever the method's own
//! search found.
//!
//! The wire behind is passed in chunks, each in a ball; a ball that a node is far from is passed over.

use super::broken::{Broken, Found};
use crate::lab::stress::{Invariant, Measures};
use crate::math::{Spin, V3, polar_angle, wrap_to_pi};
use crate::simulation::Simulation;
use std::f64::consts::{PI, TAU};

/// Wire may be deeper in wire by this share of the diameter. There its centreline lies in the surface of the other.
const CROSSED: f64 = 0.5;
/// Edges in a chunk. Chosen: a quarter of a turn at most.
const CHUNK: usize = 16;

pub(super) fn look(sim: &Simulation, m: &mut Measures) -> Found {
    let sys = sim.system();
    let Some(line) = sys.line_scratch() else {
        return Ok(());
    };
    let spin = Spin::new(sys.state.spindle.angle);
    let frozen = line.tube.points();
    let live = sys.state.rod.x.iter().map(|x| spin.to_core(*x));
    let wire = Behind::new(frozen.iter().copied().chain(live).collect());
    let d = sys.model.section.diameter;
    for i in frozen.len().max(1)..wire.nodes.len() - 1 {
        let p = spin.to_core(sys.centre(i - frozen.len()));
        let Some((distance, behind)) = wire.nearest(i, p, d) else {
            continue;
        };
        let depth = d - distance;
        m.crossed = m.crossed.max(depth / d);
        if depth > CROSSED * d {
            let text = format!(
                "live node {} is {:.2} d in the wire {behind:.2} turns behind it",
                i - frozen.len(),
                depth / d,
            );
            return Err(Broken::new(Invariant::Crossing, text));
        }
    }
    Ok(())
}

/// All wire, from its clamped end on.
struct Behind {
    /// core frame, m
    nodes: Vec<V3>,
    /// polar angle along the wire from its end, rad
    turned: Vec<f64>,
    /// centre and radius of the ball round each chunk, m
    balls: Vec<(V3, f64)>,
}

impl Behind {
    fn new(nodes: Vec<V3>) -> Self {
        let mut turned = vec![0.0];
        for pair in nodes.windows(2) {
            let step = wrap_to_pi(polar_angle(pair[1]) - polar_angle(pair[0]));
            turned.push(turned[turned.len() - 1] + step);
        }
        // (pieces reach from the middle of the edge before a node to that of the edge after it)
        let ball = |first: usize| {
            let last = (first + CHUNK).min(nodes.len() - 1);
            let piece = &nodes[first.saturating_sub(1)..=last];
            let centre = (piece[0] + piece[piece.len() - 1]) * 0.5;
            let far = piece.iter().map(|p| (p - centre).norm());
            (centre, far.fold(0.0, f64::max))
        };
        let balls = (0..nodes.len()).step_by(CHUNK).map(ball).collect();
        Self {
            nodes,
            turned,
            balls,
        }
    }

    /// Distance (m) of `p`, which lies at node `i`, from the wire half a turn or more behind that node, and how many turns
    /// behind; `None` if it is farther than `reach`, m.
    fn nearest(&self, i: usize, p: V3, reach: f64) -> Option<(f64, f64)> {
        let mut found = None;
        let mut best = reach;
        for (chunk, (centre, radius)) in self.balls.iter().enumerate() {
            let first = chunk * CHUNK;
            if first >= i || (p - centre).norm() > radius + best {
                continue;
            }
            for j in first.max(1)..(first + CHUNK).min(i) {
                let behind = (self.turned[i] - self.turned[j]).abs();
                if behind < PI {
                    continue;
                }
                let (a, b) = (
                    (self.nodes[j - 1] + self.nodes[j]) * 0.5,
                    (self.nodes[j] + self.nodes[j + 1]) * 0.5,
                );
                let distance = distance_to_segment(p, a, b);
                if distance < best {
                    best = distance;
                    found = Some((distance, behind / TAU));
                }
            }
        }
        found
    }
}

/// Distance of a point from a segment, m.
fn distance_to_segment(p: V3, a: V3, b: V3) -> f64 {
    let along = b - a;
    let share = (p - a).dot(&along) / along.norm_squared().max(f64::MIN_POSITIVE);
    (p - a - along * share.clamp(0.0, 1.0)).norm()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::stress::invariants::planted;

    /// Slow twin of [`Behind::nearest`].
    fn nearest(wire: &Behind, i: usize, p: V3, reach: f64) -> Option<f64> {
        let half_a_turn = |j: &usize| (wire.turned[i] - wire.turned[*j]).abs() >= PI;
        let all = (1..i).filter(half_a_turn).map(|j| {
            let middle = |k: usize| (wire.nodes[k] + wire.nodes[k + 1]) * 0.5;
            distance_to_segment(p, middle(j - 1), middle(j))
        });
        let least = all.fold(f64::INFINITY, f64::min);
        (least < reach).then_some(least)
    }

    #[test]
    fn chunks_find_what_a_look_at_everything_finds() {
        let coil = (0..400).map(|k| {
            let a = 0.13 * f64::from(k);
            let out = 5.0 + 0.6 * (0.37 * a).sin();
            V3::new(out * a.cos(), 0.1 * (1.7 * a).sin(), out * a.sin())
        });
        let wire = Behind::new(coil.collect());
        let mut near = 0;
        for i in 1..399 {
            let quick = wire.nearest(i, wire.nodes[i], 0.5).map(|(d, _)| d);
            assert_eq!(quick, nearest(&wire, i, wire.nodes[i], 0.5));
            near += usize::from(quick.is_some());
        }
        assert!((100..390).contains(&near), "{near} near");
    }

    #[test]
    fn wire_in_wire_is_seen() {
        let mut sim = planted::wound(1.5);
        assert_eq!(look(&sim, &mut Measures::default()), Ok(()));
        let sys = sim.system();
        let spin = Spin::new(sys.state.spindle.angle);
        let frozen = sys.line_scratch().unwrap().tube.points()[2];
        // the whole of the live wire onto one place where wire lies already
        let at = spin.to_lab(frozen);
        for x in &mut sim.system_mut().state.rod.x[4..9] {
            *x = at;
        }
        planted::sees(look(&sim, &mut Measures::default()), Invariant::Crossing);
    }
}
