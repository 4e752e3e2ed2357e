//! Wire stays out of wire: every live node against all wire half a turn or more behind it, whatever the method's own
//! search found. Beside the axis half a turn is no length of wire, and what is nearer along it than the tightest bend does not count.
//!
//! The wire behind is passed in chunks, each in a ball; a ball that a node is far from is passed over.

use super::broken::{Broken, Found};
use crate::lab::stress::{Invariant, Measures};
use crate::math::{Spin, V3, polar_angle, wrap_to_pi};
use crate::simulation::Simulation;
use std::f64::consts::{PI, TAU};

/// Wire may be deeper in wire by this share of the diameter. There its centreline lies in the surface of the other.
const CROSSED: f64 = 0.5;
/// By what share of the diameter a chord may miss its curve.
const STRAIGHT: f64 = 0.02;
/// Length of wire, in diameters, in which it cannot come back to itself: half a circle of touching wire.
const TIGHTEST: f64 = 0.5 * PI;
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
    /// length along the chords from its end, m
    arc: Vec<f64>,
    /// centre and radius of the ball round each chunk, m
    balls: Vec<(V3, f64)>,
}

impl Behind {
    fn new(nodes: Vec<V3>) -> Self {
        let (mut turned, mut arc) = (vec![0.0], vec![0.0]);
        for (k, pair) in nodes.windows(2).enumerate() {
            let step = wrap_to_pi(polar_angle(pair[1]) - polar_angle(pair[0]));
            turned.push(turned[k] + step);
            arc.push(arc[k] + (pair[1] - pair[0]).norm());
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
            arc,
            balls,
        }
    }

    /// How many turns, in rad, node `j` lies behind node `i`, where that is another passage of wire of this `diameter`, m.
    fn behind(&self, i: usize, j: usize, diameter: f64) -> Option<f64> {
        let behind = (self.turned[i] - self.turned[j]).abs();
        let is_other = behind >= PI && self.arc[i] - self.arc[j] >= TIGHTEST * diameter;
        is_other.then_some(behind)
    }

    /// Distance (m) of `p`, which lies at node `i`, from the wire half a turn or more behind that node, and how many turns
    /// behind; `None` if it is farther than the `diameter`, m.
    fn nearest(&self, i: usize, p: V3, diameter: f64) -> Option<(f64, f64)> {
        let mut found = None;
        let mut best = diameter;
        for (chunk, (centre, radius)) in self.balls.iter().enumerate() {
            let first = chunk * CHUNK;
            if first >= i || (p - centre).norm() > radius + best {
                continue;
            }
            for j in first.max(1)..(first + CHUNK).min(i) {
                let Some(behind) = self.behind(i, j, diameter) else {
                    continue;
                };
                let distance = self.distance_to_piece(p, j, diameter);
                if distance < best {
                    best = distance;
                    found = Some((distance, behind / TAU));
                }
            }
        }
        found
    }

    /// Distance (m) of `p` from the curve of the wire at node `j`, as chords that miss it by next to nothing of a `diameter`, m.
    ///
    /// On a sharp corner one chord for all of it would be off by more than a diameter.
    fn distance_to_piece(&self, p: V3, j: usize, diameter: f64) -> f64 {
        let (a, b) = (
            (self.nodes[j - 1] + self.nodes[j]) * 0.5,
            (self.nodes[j] + self.nodes[j + 1]) * 0.5,
        );
        let bulge = self.nodes[j] * 2.0 - a - b;
        let pieces = (0.25 * bulge.norm() / (STRAIGHT * diameter)).sqrt().ceil();
        let at = |share: f64| a + (b - a) * share + bulge * (share * (1.0 - share));
        let count = pieces.max(1.0) as usize;
        let end = |k: usize| at(k as f64 / count as f64);
        let distances = (0..count).map(|k| distance_to_segment(p, end(k), end(k + 1)));
        distances.fold(f64::INFINITY, f64::min)
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
    fn nearest(wire: &Behind, i: usize, p: V3, diameter: f64) -> Option<f64> {
        let all = (1..i)
            .filter(|j| wire.behind(i, *j, diameter).is_some())
            .map(|j| wire.distance_to_piece(p, j, diameter));
        let least = all.fold(f64::INFINITY, f64::min);
        (least < diameter).then_some(least)
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

    /// Wire round a sharp corner in long edges was a chord, and wire beside it counted as in it.
    #[test]
    fn wire_round_a_corner_is_a_curve() {
        let [a, corner, b] = [[0.0, 8.0], [0.0, 0.0], [8.0, 0.0]].map(|[x, z]| V3::new(x, 0.0, z));
        let wire = Behind::new(vec![a, corner, b]);
        for share in [0.1, 0.3, 0.5] {
            let (first, last) = ((a + corner) * 0.5, (corner + b) * 0.5);
            let on = first
                .lerp(&corner, share)
                .lerp(&corner.lerp(&last, share), share);
            assert!(wire.distance_to_piece(on, 1, 1.0) < STRAIGHT, "{share}");
        }
    }

    /// Wire that had slipped off the core ran past the axis, half a turn in half a diameter, and counted as in itself.
    #[test]
    fn wire_past_the_axis_is_not_in_itself() {
        let past = |k: i32| {
            let x = 0.1 * f64::from(k);
            V3::new(x, 20.0, 0.02 - 0.2 * x * x)
        };
        let bowed = Behind::new((-40..40).map(past).collect());
        assert!(bowed.turned[46] - bowed.turned[34] < -PI);
        let bend = |k: i32| {
            let a = 0.1 * f64::from(k);
            V3::new(0.3 * libm::cos(a), 20.0, 0.3 * libm::sin(a))
        };
        // (the tightest bend that does count is one of less than the wire's own width)
        let curled = Behind::new((0..80).map(bend).collect());
        for i in 1..79 {
            assert_eq!(bowed.nearest(i, bowed.nodes[i], 1.0), None, "{i}");
        }
        assert!(curled.nearest(78, curled.nodes[78], 1.0).is_some());
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
