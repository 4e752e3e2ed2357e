//! Frozen wire as a chain of cylinder meshes, in the core frame (the paper's eq. 12-15, mended).
//!
//! A segment is a prism of [`SIDES`] facets round its axis, its vertices at angles in the frame of
//! the segment (eq. 13). At a node between two segments it ends in the plane halfway between their
//! directions (eq. 14, 15 with unit directions). The cut is an ellipse. Its long axis, r over the cosine of
//! half the turning angle, lies in the plane of the bend. Projected along either segment it is the
//! circle again. The published factor, the cosine itself, would make the wire thinner at every
//! bend.
//!
//! Later wire touches the triangles with friction. A facet is found by its angle and its vertices
//! follow from the axis, so nothing of the mesh is stored. The force acts on the round wire that
//! the facet stands for, because a flat's own normal is off by up to pi/64, a fifth of the angle of
//! friction. On flats a sliding node would also take off at an edge and land again. That costs
//! speed: an eighth of the gap that a wire dropped on a shoulder leaves.

use crate::geometry::Touch;
use crate::math::{Quat, V3};
use crate::math::{rotate, rotate_back};
use serde::{Deserialize, Serialize};

/// Facets round the wire.
pub const SIDES: usize = 32;

/// Segments that share one box.
const CHUNK: usize = 32;

#[derive(Clone, Copy, Debug, PartialEq)]
struct Bounds {
    min: V3,
    max: V3,
}

impl Bounds {
    fn empty() -> Self {
        Self {
            min: V3::repeat(f64::INFINITY),
            max: V3::repeat(f64::NEG_INFINITY),
        }
    }

    fn grow(&mut self, p: V3, r: f64) {
        self.min = self.min.inf(&(p - V3::repeat(r)));
        self.max = self.max.sup(&(p + V3::repeat(r)));
    }

    fn distance(&self, p: V3) -> f64 {
        let d = (self.min - p).sup(&(p - self.max)).sup(&V3::zeros());
        d.norm()
    }
}

/// The frozen wire, oldest node first.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(from = "SavedTube", into = "SavedTube")]
pub struct Tube {
    radius: f64,
    /// node positions, core frame, m
    pub points: Vec<V3>,
    /// frame of the edge that leaves each node
    pub frames: Vec<Quat>,
    /// unstretched length from the clamp, m
    pub arc: Vec<f64>,
    /// tension of the edge leaving each node when it froze, N
    pub tension: Vec<f64>,
    /// plastic stretch of the edge leaving each node
    pub plastic_strain: Vec<f64>,
    /// plastic curvature at each node, 1/m
    pub plastic_bend: Vec<f64>,
    /// unit normal of the plane at which segments meet, zero at the ends
    mitre: Vec<V3>,
    /// cosine and sine of the vertex angles
    circle: Vec<[f64; 2]>,
    chunks: Vec<Bounds>,
}

/// State of a node that freezes, kept for when it thaws.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct FrozenNode {
    /// position, core frame, m
    pub point: V3,
    /// frame of the edge that leaves the node towards the nozzle, core frame
    pub frame: Quat,
    /// unstretched length from the clamp, m
    pub arc: f64,
    /// tension of that edge, N
    pub tension: f64,
    /// plastic stretch of that edge
    pub plastic_strain: f64,
    /// plastic curvature at the node, 1/m
    pub plastic_bend: f64,
}

/// A [`Tube`] in a saved state.
#[derive(Serialize, Deserialize)]
struct SavedTube {
    radius: f64,
    nodes: Vec<FrozenNode>,
}

impl From<Tube> for SavedTube {
    fn from(tube: Tube) -> Self {
        Self {
            radius: tube.radius,
            nodes: tube.nodes().collect(),
        }
    }
}

impl From<SavedTube> for Tube {
    fn from(saved: SavedTube) -> Self {
        let mut tube = Self::new(saved.radius);
        saved.nodes.into_iter().for_each(|node| tube.push(node));
        tube
    }
}

impl Tube {
    /// A tube without wire; `radius` of the wire, m.
    pub fn new(radius: f64) -> Self {
        Self {
            radius,
            points: Vec::new(),
            frames: Vec::new(),
            arc: Vec::new(),
            tension: Vec::new(),
            plastic_strain: Vec::new(),
            plastic_bend: Vec::new(),
            mitre: Vec::new(),
            circle: (0..SIDES)
                .map(|k| {
                    let a = std::f64::consts::TAU * k as f64 / SIDES as f64;
                    [libm::cos(a), libm::sin(a)]
                })
                .collect(),
            chunks: Vec::new(),
        }
    }

    /// Radius of the wire, m.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// The frozen nodes as they were pushed, oldest first.
    pub fn nodes(&self) -> impl Iterator<Item = FrozenNode> {
        (0..self.len()).map(|i| FrozenNode {
            point: self.points[i],
            frame: self.frames[i],
            arc: self.arc[i],
            tension: self.tension[i],
            plastic_strain: self.plastic_strain[i],
            plastic_bend: self.plastic_bend[i],
        })
    }

    /// Number of frozen nodes.
    pub fn len(&self) -> usize {
        self.points.len()
    }

    /// Whether nothing has frozen.
    #[cfg(feature = "lab")]
    pub fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// Whether the nodes follow one another along a wire, none of them `far` (m) from the origin; saved bytes may say
    /// anything.
    pub(crate) fn lies_within(&self, far: f64) -> bool {
        let near = |p: &V3| p.iter().all(|x| x.abs() < far);
        self.points.iter().all(near)
            && self.arc.iter().all(|arc| arc.is_finite())
            && self.arc.is_sorted()
            && self.points.windows(2).all(|ends| ends[0] != ends[1])
    }

    /// Appends the next node along the wire; `arc` must not fall.
    pub fn push(&mut self, node: FrozenNode) {
        self.points.push(node.point);
        self.frames.push(node.frame);
        self.arc.push(node.arc);
        self.tension.push(node.tension);
        self.plastic_strain.push(node.plastic_strain);
        self.plastic_bend.push(node.plastic_bend);
        self.mitre.push(V3::zeros());
        let n = self.points.len();
        if n > 2 {
            let before = (self.points[n - 2] - self.points[n - 3]).normalize();
            let after = (self.points[n - 1] - self.points[n - 2]).normalize();
            self.mitre[n - 2] = (before + after).normalize();
        }
        if n > 1 {
            let segment = n - 2;
            if segment.is_multiple_of(CHUNK) {
                self.chunks.push(Bounds::empty());
            }
            // a mitre reaches past the radius; twice the radius covers turning angles to 120
            // degrees
            let last = self.chunks.len() - 1;
            self.chunks[last].grow(self.points[n - 2], 2.0 * self.radius);
            self.chunks[last].grow(self.points[n - 1], 2.0 * self.radius);
        }
    }

    /// Takes the last node off again; the tube is then as before its push.
    pub fn pop(&mut self) -> Option<FrozenNode> {
        let node = FrozenNode {
            point: self.points.pop()?,
            frame: self.frames.pop()?,
            arc: self.arc.pop()?,
            tension: self.tension.pop()?,
            plastic_strain: self.plastic_strain.pop()?,
            plastic_bend: self.plastic_bend.pop()?,
        };
        self.mitre.pop();
        let n = self.points.len();
        if n > 0 {
            self.mitre[n - 1] = V3::zeros();
            // the last segment is gone: its chunk shrinks to what is left of it
            self.chunks.truncate((n - 1).div_ceil(CHUNK));
            if let Some(c) = self.chunks.len().checked_sub(1) {
                let mut bounds = Bounds::empty();
                for p in &self.points[c * CHUNK..] {
                    bounds.grow(*p, 2.0 * self.radius);
                }
                self.chunks[c] = bounds;
            }
        }
        Some(node)
    }

    /// The mesh of segment `s`, ready to give vertices.
    fn prism(&self, s: usize) -> Prism<'_> {
        let frame = &self.frames[s];
        let along = (self.points[s + 1] - self.points[s]).normalize();
        // slide along the segment until the mitre plane is met: the ellipse of eq. 14
        let slope = |node: usize| {
            let m = self.mitre[node];
            if m == V3::zeros() {
                m
            } else {
                m / along.dot(&m)
            }
        };
        Prism {
            ends: [self.points[s], self.points[s + 1]],
            slopes: [slope(s), slope(s + 1)],
            along,
            xi: rotate(frame, &V3::x()) * self.radius,
            eta: rotate(frame, &V3::y()) * self.radius,
            circle: &self.circle,
        }
    }

    /// Vertices of segment `s` at its start (`end` 0) or end (1), core frame, m.
    #[cfg(test)]
    pub fn ring(&self, s: usize, end: usize) -> Vec<V3> {
        let prism = self.prism(s);
        (0..SIDES).map(|k| prism.vertex(end, k)).collect()
    }

    /// A lower bound of the distance, m, from `p` (core frame, m) to the surface of segments that
    /// end before `arc` (m).
    pub fn clearance(&self, p: V3, arc: f64) -> f64 {
        let mut best = f64::INFINITY;
        for (c, b) in self.chunks.iter().enumerate() {
            if self.arc[c * CHUNK] > arc {
                break;
            }
            let d = b.distance(p);
            if d < best {
                if d > 4.0 * self.radius {
                    best = d;
                } else {
                    for s in self.segments_of(c) {
                        if self.arc[s + 1] <= arc {
                            best = best.min(self.axis_distance(s, p) - 1.2 * self.radius);
                        }
                    }
                }
            }
        }
        best
    }

    fn segments_of(&self, chunk: usize) -> std::ops::Range<usize> {
        chunk * CHUNK..((chunk + 1) * CHUNK).min(self.points.len() - 1)
    }

    fn axis_distance(&self, s: usize, p: V3) -> f64 {
        let (a, b) = (self.points[s], self.points[s + 1]);
        let d = b - a;
        let t = ((p - a).dot(&d) / d.norm_squared()).clamp(0.0, 1.0);
        (p - a - d * t).norm()
    }

    /// The node at or before the place of the centreline that is nearest by `distance` (m), and that distance, where it is below
    /// `reach`. Nodes and the middles between them are looked at. The distance, of a point in the core frame (m), grows by no
    /// more than the way.
    pub fn nearest_by(&self, reach: f64, distance: impl Fn(V3) -> f64) -> Option<(usize, f64)> {
        let mut best = (0, reach);
        for (c, b) in self.chunks.iter().enumerate() {
            let (centre, half) = (0.5 * (b.min + b.max), 0.5 * (b.max - b.min).norm());
            if distance(centre) - half >= best.1 {
                continue;
            }
            for s in self.segments_of(c) {
                let [from, to] = [self.points[s], self.points[s + 1]];
                for p in [from, 0.5 * (from + to), to] {
                    let here = distance(p);
                    if here < best.1 {
                        best = (s, here);
                    }
                }
            }
        }
        (best.1 < reach).then_some(best)
    }

    /// Segments whose surface is within `reach` (m) of `p` (core frame, m) and which end before
    /// `arc` (m), ascending.
    pub fn near(&self, p: V3, reach: f64, arc: f64, out: &mut Vec<u32>) {
        out.clear();
        for (c, b) in self.chunks.iter().enumerate() {
            if self.arc[c * CHUNK] > arc {
                break;
            }
            if b.distance(p) > reach {
                continue;
            }
            for s in self.segments_of(c) {
                if self.arc[s + 1] <= arc && self.axis_distance(s, p) < reach + 1.2 * self.radius {
                    out.push(s as u32);
                }
            }
        }
    }

    /// Touches of a sphere of radius `r` (m) at `p` (core frame, m) with the given segments: one
    /// for each passage of the wire (a run of consecutive segments), at the nearest point of its
    /// triangles.
    pub fn touching(&self, p: V3, r: f64, segments: &[u32], out: &mut Vec<Touch>) {
        let mut i = 0;
        while i < segments.len() {
            let mut best = (f64::INFINITY, V3::zeros());
            let mut on = 0;
            let mut end = i;
            // a gap of a few segments is still the same passage
            while end < segments.len() && (end == i || segments[end] - segments[end - 1] <= 4) {
                let s = segments[end] as usize;
                if self.axis_distance(s, p) < r + 1.2 * self.radius {
                    let before = best.0;
                    self.nearest_on_segment(s, p, &mut best);
                    if best.0 < before {
                        on = s;
                    }
                }
                end += 1;
            }
            i = end;
            if best.0 < f64::INFINITY
                && let Some(touch) = self.on_round(on, p, r, best.1)
            {
                out.push(touch);
            }
        }
    }

    /// The touch on the round wire that the triangles stand for: from the point of the axis below
    /// the nearest point `q` of segment `s`, the radius towards `p`.
    fn on_round(&self, s: usize, p: V3, r: f64, q: V3) -> Option<Touch> {
        let (a, b) = (self.points[s], self.points[s + 1]);
        let t = (b - a).normalize();
        let foot = a + t * (q - a).dot(&t);
        let out = p - foot;
        let across = out - t * out.dot(&t);
        let point = foot + across * (self.radius / across.norm());
        let away = p - point;
        let d = away.norm();
        (d < r && d > 0.0).then(|| Touch {
            normal: away / d,
            depth: r - d,
            point,
        })
    }

    fn nearest_on_segment(&self, s: usize, p: V3, best: &mut (f64, V3)) {
        let local = rotate_back(&self.frames[s], &(p - self.points[s]));
        let turn = libm::atan2(local.y, local.x) / (2.0 * std::f64::consts::PI);
        let k0 = (turn * SIDES as f64).floor() as isize;
        let prism = self.prism(s);
        for k in k0 - 1..=k0 + 1 {
            let k = k.rem_euclid(SIDES as isize) as usize;
            let k1 = (k + 1) % SIDES;
            let [a0, a1] = [prism.vertex(0, k), prism.vertex(0, k1)];
            let [b0, b1] = [prism.vertex(1, k), prism.vertex(1, k1)];
            for t in [[a0, b0, a1], [b0, b1, a1]] {
                let q = closest_point_triangle(p, &t);
                let d = (p - q).norm_squared();
                if d < best.0 {
                    *best = (d, q);
                }
            }
        }
    }
}

/// One segment between its mitre planes.
struct Prism<'a> {
    ends: [V3; 2],
    /// mitre normals over their share along the segment
    slopes: [V3; 2],
    along: V3,
    xi: V3,
    eta: V3,
    circle: &'a [[f64; 2]],
}

impl Prism<'_> {
    #[inline]
    fn vertex(&self, end: usize, k: usize) -> V3 {
        let [c, s] = self.circle[k];
        let offset = self.xi * c + self.eta * s;
        self.ends[end] + offset - self.along * offset.dot(&self.slopes[end])
    }
}

/// Point of a triangle nearest to `p` (Ericson, Real-Time Collision Detection, section 5.1.5).
fn closest_point_triangle(p: V3, t: &[V3; 3]) -> V3 {
    let [a, b, c] = *t;
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(&ap), ac.dot(&ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return a;
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(&bp), ac.dot(&bp));
    if d3 >= 0.0 && d4 <= d3 {
        return b;
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return a + ab * (d1 / (d1 - d3));
    }
    let cp = p - c;
    let (d5, d6) = (ab.dot(&cp), ac.dot(&cp));
    if d6 >= 0.0 && d5 <= d6 {
        return c;
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return a + ac * (d2 / (d2 - d6));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
        let w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return b + (c - b) * w;
    }
    let inv = 1.0 / (va + vb + vc);
    a + ab * (vb * inv) + ac * (vc * inv)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::frame_along;
    use proptest::prelude::*;

    const R: f64 = 0.35e-3;

    fn arc_tube(radius: f64, step: f64, n: usize) -> Tube {
        let mut tube = Tube::new(R);
        let mut like = None;
        for i in 0..n {
            let a = i as f64 * step / radius;
            let p = V3::new(radius * a.cos(), 0.0, radius * a.sin());
            let b = (i as f64 + 0.5) * step / radius;
            let frame = frame_along(&V3::new(-b.sin(), 0.0, b.cos()), like.as_ref());
            like = Some(frame);
            tube.push(FrozenNode {
                point: p,
                frame,
                arc: i as f64 * step,
                tension: 0.0,
                plastic_strain: 0.0,
                plastic_bend: 0.0,
            });
        }
        tube
    }

    #[test]
    fn mitre_keeps_the_wire_as_thick_as_it_is() {
        let tube = arc_tube(2.35e-3, 0.5e-3, 12);
        for node in 1..11 {
            let d = (tube.points[node + 1] - tube.points[node]).normalize();
            let before = (tube.points[node] - tube.points[node - 1]).normalize();
            for v in tube.ring(node, 0).iter().chain(&tube.ring(node - 1, 1)) {
                let o = v - tube.points[node];
                // distance from the axis of either segment is the radius
                assert!(((o - d * o.dot(&d)).norm() - R).abs() < 1e-15);
                assert!(((o - before * o.dot(&before)).norm() - R).abs() < 1e-15);
            }
            // as published (times the cosine) it would be thinner in the plane of the bend
            let cos = d.dot(&(d + before).normalize());
            assert!(R * cos * cos < R * 0.995);
        }
    }

    fn brute(tube: &Tube, p: V3) -> f64 {
        let mut best = f64::INFINITY;
        for s in 0..tube.len() - 1 {
            let (a, b) = (tube.ring(s, 0), tube.ring(s, 1));
            for k in 0..SIDES {
                let k1 = (k + 1) % SIDES;
                for t in [[a[k], b[k], a[k1]], [b[k], b[k1], a[k1]]] {
                    best = best.min((p - closest_point_triangle(p, &t)).norm());
                }
            }
        }
        best
    }

    proptest! {
        #[test]
        fn fast_search_finds_what_all_triangles_give(a in 0.3..2.2f64, out in -1.0..1.0f64, side in -1.0..1.0f64) {
            let tube = arc_tube(2.35e-3, 0.5e-3, 14);
            let along = V3::new(a.cos(), 0.0, a.sin()) * (2.35e-3 + out * 0.75e-3);
            let p = along + V3::new(0.0, side * 0.75e-3, 0.0);
            let d = brute(&tube, p);
            // inside the wire the nearest facet is not by angle; nodes never get there
            prop_assume!((p - V3::new(a.cos(), 0.0, a.sin()) * 2.35e-3).norm() > 1.2 * R);
            let (mut near, mut touches) = (Vec::new(), Vec::new());
            tube.near(p, R * 1.3, 1.0, &mut near);
            tube.touching(p, R, &near, &mut touches);
            prop_assert!(tube.clearance(p, 1.0) <= d + 1e-12);
            if d < R {
                prop_assert_eq!(touches.len(), 1);
                // the round wire stands over its facets by up to their sagitta, R (1 - cos(pi/32))
                let under = d - (R - touches[0].depth);
                prop_assert!(under > -1e-9 && under < 0.005 * R, "{under}");
                prop_assert!((touches[0].normal.norm() - 1.0).abs() < 1e-12);
            } else if d > 1.005 * R {
                prop_assert!(touches.is_empty());
            }
        }
    }

    #[test]
    fn pop_undoes_push() {
        let whole = arc_tube(2.35e-3, 0.2e-3, 70);
        for kept in [0, 1, 2, 31, 32, 33, 34, 64, 65, 66, 69] {
            let mut tube = whole.clone();
            for _ in kept..70 {
                tube.pop().expect("a node");
            }
            assert_eq!(tube, arc_tube(2.35e-3, 0.2e-3, kept), "{kept}");
        }
    }

    #[test]
    fn wire_just_left_behind_is_no_neighbour() {
        let tube = arc_tube(2.35e-3, 0.5e-3, 14);
        let p = tube.points[13] + V3::new(0.0, 0.0, 0.1e-3);
        let mut near = Vec::new();
        tube.near(p, R, tube.arc[13] - 5.0 * 2.0 * R, &mut near);
        assert!(near.is_empty());
        tube.near(p, R, 1.0, &mut near);
        assert!(!near.is_empty());
    }
}
