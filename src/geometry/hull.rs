//! The convex hull of a core's section, and the outline that lies everywhere as far outside of it.
//!
//! The hull is our own: forty lines, where a crate of geometry would bring others with it.

use std::f64::consts::FRAC_PI_2;

/// Corners nearer than this are one, as a share of the size of the section, and such that bend by less, rad, are none: single
/// precision in an STL file.
const SAME: f64 = 1e-6;

/// Corners of a convex section round the axis as (x, z), m, from +x towards +z.
#[derive(Clone, Debug)]
pub(crate) struct Hull {
    corners: Vec<[f64; 2]>,
}

fn cross(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

fn way(from: [f64; 2], to: [f64; 2]) -> [f64; 2] {
    [to[0] - from[0], to[1] - from[1]]
}

/// Whether the way turns left at a corner, and not just by rounding.
fn turns_left(before: [f64; 2], corner: [f64; 2], after: [f64; 2]) -> bool {
    let (a, b) = (way(before, corner), way(corner, after));
    cross(a, b) > SAME * libm::hypot(a[0], a[1]) * libm::hypot(b[0], b[1])
}

impl Hull {
    /// The hull of points as (x, z), m; none unless the axis goes through it.
    pub(crate) fn of(mut points: Vec<[f64; 2]>) -> Option<Self> {
        let size = points
            .iter()
            .flatten()
            .fold(0.0, |m: f64, c| m.max(c.abs()));
        points.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
        // lower side from low to high x, then the upper one back
        let mut corners: Vec<[f64; 2]> = Vec::new();
        let back = points.iter().rev().skip(1);
        let mut least = 1;
        for (k, &p) in points.iter().chain(back).enumerate() {
            if k == points.len() {
                least = corners.len();
            }
            while corners.len() > least
                && !turns_left(corners[corners.len() - 2], corners[corners.len() - 1], p)
            {
                corners.pop();
            }
            corners.push(p);
        }
        let apart = |a: &[f64; 2], b: &[f64; 2]| {
            let [x, z] = way(*a, *b);
            libm::hypot(x, z) > SAME * size
        };
        corners.dedup_by(|a, b| !apart(a, b));
        while corners.len() > 1 && !apart(&corners[0], &corners[corners.len() - 1]) {
            corners.pop();
        }
        let hull = Self { corners };
        let round_axis = hull.corners.len() > 2 && hull.edges().all(|[a, b]| cross(a, b) > 0.0);
        round_axis.then_some(hull)
    }

    /// Largest distance of a corner from the axis, m.
    pub(crate) fn radius(&self) -> f64 {
        let far = self.corners.iter().map(|&[x, z]| libm::hypot(x, z));
        far.fold(0.0, f64::max)
    }

    /// How far it reaches from the axis in a direction, rad from +x to +z, m.
    pub(crate) fn reach(&self, angle: f64) -> f64 {
        let (sin, cos) = libm::sincos(angle);
        let along = self.corners.iter().map(|[x, z]| cos * x + sin * z);
        along.fold(f64::NEG_INFINITY, f64::max)
    }

    /// Both ends of each edge, the edge before the first corner first.
    fn edges(&self) -> impl Iterator<Item = [[f64; 2]; 2]> {
        let before = self.corners.iter().cycle().skip(self.corners.len() - 1);
        before.zip(&self.corners).map(|(a, b)| [*a, *b])
    }

    /// The outline `out` (m) outside, arcs in chords of a `chords`th of a right angle at most; as many points for every `out`.
    ///
    /// A corner that bends by one such chord or less is one mitred point. Its share `1 / cos(turn / 2) - 1` of `out` too far
    /// outside is to fourth order that by which the chord would be inside.
    pub(crate) fn outline(&self, out: f64, chords: usize) -> Vec<[f64; 2]> {
        let normals: Vec<[f64; 2]> = self
            .edges()
            .map(|[a, b]| {
                let [x, z] = way(a, b);
                let length = libm::hypot(x, z);
                [z / length, -x / length]
            })
            .collect();
        let mut outline = Vec::new();
        for (k, &[x, z]) in self.corners.iter().enumerate() {
            let (first, next) = (normals[k], normals[(k + 1) % normals.len()]);
            let turn = libm::atan2(cross(first, next), first[0] * next[0] + first[1] * next[1]);
            let steps = ((turn / FRAC_PI_2 * chords as f64 - SAME).ceil() as usize).max(1);
            if steps == 1 {
                let mitre = out / (1.0 + first[0] * next[0] + first[1] * next[1]);
                outline.push([
                    x + mitre * (first[0] + next[0]),
                    z + mitre * (first[1] + next[1]),
                ]);
                continue;
            }
            for step in 0..=steps {
                let (sin, cos) = libm::sincos(turn * step as f64 / steps as f64);
                let normal = match step {
                    0 => first,
                    _ if step == steps => next,
                    _ => [
                        first[0] * cos - first[1] * sin,
                        first[0] * sin + first[1] * cos,
                    ],
                };
                outline.push([x + out * normal[0], z + out * normal[1]]);
            }
        }
        outline
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_lies_inside_of_a_section_does_not_count() {
        let square = [[2.0, -1.0], [2.0, 1.0], [-2.0, 1.0], [-2.0, -1.0]];
        let mut points = square.to_vec();
        points.extend([
            [0.0, 0.3],
            [2.0, 0.0],
            [1.0, 1.0],
            [2.0, 1.0 - 1e-8],
            [-2.0, 1.0],
        ]);
        let hull = Hull::of(points).expect("round the axis");
        assert_eq!(hull.corners.len(), 4, "{hull:?}");
        assert!(square.iter().all(|corner| hull.corners.contains(corner)));
        assert_eq!(hull.outline(0.0, 5).len(), hull.outline(0.5, 5).len());
        for [x, z] in hull.outline(0.5, 5) {
            let beyond = libm::hypot((x.abs() - 2.0).max(0.0), (z.abs() - 1.0).max(0.0));
            assert!((beyond - 0.5).abs() < 1e-12, "{x} {z}");
        }
    }

    /// Mitred points stand no farther outside than chords of the same turn would lie inside.
    #[test]
    fn a_hull_that_hardly_bends_has_one_point_at_each_corner() {
        let sides = 360;
        let angle = |k: usize| std::f64::consts::TAU * k as f64 / sides as f64;
        let points = (0..sides).map(|k| [libm::cos(angle(k)), libm::sin(angle(k))]);
        let hull = Hull::of(points.collect()).expect("round the axis");
        let (out, half) = (0.5, 0.5 * angle(1));
        let outline = hull.outline(out, 90);
        assert_eq!(outline.len(), sides);
        for [x, z] in outline {
            let beyond = libm::hypot(x, z) - 1.0 - out;
            let far = out * (1.0 / libm::cos(half) - 1.0);
            assert!((beyond - far).abs() < 1e-12, "{beyond}");
            assert!(far < 1.001 * out * (1.0 - libm::cos(half)), "{far}");
        }
        // with finer chords each is an arc
        assert_eq!(hull.outline(out, 180).len(), 3 * sides);
    }

    #[test]
    fn a_section_beside_the_axis_has_no_hull_round_it() {
        assert!(Hull::of(vec![[1.0, -1.0], [2.0, -1.0], [2.0, 1.0], [1.0, 1.0]]).is_none());
        assert!(Hull::of(vec![[1.0, 0.0], [-1.0, 0.0]]).is_none());
        assert!(Hull::of(Vec::new()).is_none());
    }
}
