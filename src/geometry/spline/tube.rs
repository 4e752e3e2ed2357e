//! Frozen wire that grows and shrinks by nodes, with a search for the segments near a point.

use super::curve::Curve;
use super::segment::{Foot, Lies};
use crate::geometry::grid::Grid;
use crate::math::V3;

/// Cells of the search are this many wire diameters wide. Chosen: smaller ones cost look-ups, wider
/// ones wire that is not near; 2 takes as long in a full coil and more memory.
const CELL: f64 = 3.0;

/// Nodes beyond a seam that this side holds as well.
const SHARED: usize = 2;

/// Frozen wire with a smooth centreline, oldest node first, core frame.
#[derive(Clone, Debug, PartialEq)]
pub struct SplineTube {
    radius: f64,
    points: Vec<V3>,
    arc: Vec<f64>,
    /// whether the last two nodes belong to wire beyond a seam
    goes_on: bool,
    /// all segments but the last, which changes with the next node
    grid: Grid,
}

impl SplineTube {
    /// A tube without wire; `radius` of the wire, m, above zero.
    pub fn new(radius: f64) -> Self {
        Self {
            radius,
            points: Vec::new(),
            arc: Vec::new(),
            goes_on: false,
            grid: Grid::new(CELL * 2.0 * radius),
        }
    }

    /// Number of nodes, those shared over a seam left out; also of segments, once there are two.
    pub fn len(&self) -> usize {
        self.points.len() - self.shared()
    }

    /// Whether there is no wire.
    #[cfg(any(test, feature = "lab"))]
    pub fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    fn shared(&self) -> usize {
        if self.goes_on { SHARED } else { 0 }
    }

    /// Radius of the wire, m.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Nodes, those shared over a seam left out: control points of the centreline, core frame, m.
    #[cfg(any(test, feature = "lab"))]
    pub fn points(&self) -> &[V3] {
        &self.points[..self.len()]
    }

    /// All control points of the centreline, those shared over a seam included, core frame, m.
    pub fn controls(&self) -> &[V3] {
        &self.points
    }

    /// Unstretched length from the clamp to each of [`Self::points`], m.
    #[cfg(any(test, feature = "lab"))]
    pub fn arc(&self) -> &[f64] {
        &self.arc[..self.len()]
    }

    /// Positions (core frame, m) and arc lengths (m) of the nodes beyond the seam; `None` where the
    /// wire ends.
    pub fn ahead(&self) -> Option<[(V3, f64); SHARED]> {
        let own = self.len();
        self.goes_on
            .then(|| [own, own + 1].map(|k| (self.points[k], self.arc[k])))
    }

    /// Sets the nodes beyond the seam by position (core frame, m) and arc length (m); `None` ends
    /// the wire.
    pub fn go_on(&mut self, ahead: Option<[(V3, f64); SHARED]>) {
        for _ in 0..self.shared() {
            self.goes_on = false;
            self.pop();
        }
        if self.points.is_empty() {
            return;
        }
        for (point, arc) in ahead.into_iter().flatten() {
            self.push(point, arc);
        }
        self.goes_on = ahead.is_some();
    }

    /// Appends a node at `point` (core frame, m), apart from the last one, with `arc` (m) not below
    /// the last. The wire must have no seam.
    pub fn push(&mut self, point: V3, arc: f64) {
        debug_assert!(!self.goes_on, "the wire goes on with other wire");
        debug_assert!(self.points.last() != Some(&point), "wire of no length");
        debug_assert!(self.arc.last().is_none_or(|&last| last <= arc));
        self.points.push(point);
        self.arc.push(arc);
        if self.points.len() > 1 {
            let full = self.points.len() - 2;
            self.for_boxes(full, Grid::add);
        }
    }

    /// Takes the last node off again, with its arc length; the tube is then as before its push.
    pub fn pop(&mut self) -> Option<(V3, f64)> {
        debug_assert!(!self.goes_on, "the wire goes on with other wire");
        if self.points.len() > 1 {
            let full = self.points.len() - 2;
            self.for_boxes(full, Grid::remove);
        }
        self.points.pop().zip(self.arc.pop())
    }

    /// Hands the boxes round a segment, each about a cell wide, to the grid.
    fn for_boxes(&mut self, segment: usize, mut change: impl FnMut(&mut Grid, u32, V3, V3)) {
        let view = self.curve().view(segment, V3::zeros());
        let chord = view.arm(view.high) - view.arm(view.low);
        let parts = (chord.amax() / self.grid.edge()).ceil().clamp(1.0, 1024.0);
        let width = (view.high - view.low) / parts;
        for part in 0..parts as usize {
            let s = view.low + width * part as f64;
            // the part lies within the triangle of its own three control points
            let (a, c) = (view.arm(s), view.arm(s + width));
            let b = a + view.along(s) * (0.5 * width);
            let (low, high) = (a.inf(&b).inf(&c), a.sup(&b).sup(&c));
            change(&mut self.grid, segment as u32, low, high);
        }
    }

    /// Segments to start a foot from, ascending, one for every passage of the wire that comes
    /// within `reach` (m) of `p` (core frame, m). Each local minimum of the distance along the
    /// wire counts as one, its ends included. Segments whose node has an arc length above `own` (m) are left out.
    ///
    /// `out` is emptied first; nothing else is allocated. Two minima on one segment, which need p
    /// beyond its centre of curvature, count as one.
    pub fn gather(&self, p: V3, reach: f64, own: f64, out: &mut Vec<u32>) {
        out.clear();
        if self.points.len() < 2 {
            return;
        }
        let mut consider = |segment: u32| {
            let k = segment as usize;
            if self.arc_of(k) <= own && self.may_reach(k, p, reach) {
                out.push(segment);
            }
        };
        self.grid.visit_near(p, reach, |segments| {
            segments.iter().for_each(|&segment| consider(segment));
        });
        if !self.goes_on {
            consider(self.points.len() as u32 - 1);
        }
        // a segment may have been met in several cells; what follows is the dear part
        out.sort_unstable();
        out.dedup();
        out.retain(|&segment| self.has_foot(segment as usize, p, reach));
    }

    /// Arc length of a segment, m: that of its node, or at a seam that of the next node, where the
    /// following wire begins.
    fn arc_of(&self, segment: usize) -> f64 {
        let at_seam = self.goes_on && segment + SHARED == self.points.len();
        self.arc[segment + usize::from(at_seam)]
    }

    /// Whether a local minimum of the distance, within `reach`, lies on a segment.
    fn has_foot(&self, segment: usize, p: V3, reach: f64) -> bool {
        let view = self.curve().view(segment, p);
        match self.curve().locate(segment, &view) {
            (Lies::At(s), _) => view.arm(s).norm() <= reach,
            _ => false,
        }
    }

    /// Whether a segment could come within `reach` of `p`, at little cost: it stays within half of
    /// the longer of its edges from its node.
    #[inline(always)]
    fn may_reach(&self, segment: usize, p: V3, reach: f64) -> bool {
        let [before, after] = self.curve().edges(segment);
        let half_sq = 0.25 * before.norm_squared().max(after.norm_squared());
        // (reach + half)^2 is at most twice the sum of the squares, with some room for rounding
        (self.points[segment] - p).norm_squared() <= 2.001 * (reach * reach + half_sq)
    }

    /// The centreline.
    #[inline(always)]
    pub fn curve(&self) -> Curve<'_> {
        Curve {
            points: &self.points,
            seams: [false, self.goes_on],
        }
    }

    /// The foot of `p` (core frame, m) on the passage that `start` belongs to, by [`Curve::foot`].
    #[inline]
    pub fn foot(&self, p: V3, start: u32) -> Foot {
        self.curve().foot(p, start)
    }

    /// All local minima of the distance within `reach`, by dense sampling and golden sections: the
    /// slow twin of [`Self::gather`] with [`Self::foot`].
    #[cfg(test)]
    pub fn feet_brute(&self, p: V3, reach: f64, own: f64) -> Vec<Foot> {
        const SAMPLES: usize = 64;
        const GOLDEN: f64 = 0.618_033_988_749_894_9;
        let mut feet = Vec::new();
        if self.points.len() < 2 {
            return feet;
        }
        // t: segment plus share
        let distance = |t: f64| self.curve().view(t as usize, p).arm(t.fract()).norm();
        let first = SAMPLES / 2;
        let half = if self.goes_on { 0 } else { SAMPLES / 2 };
        let last = (self.points.len() - 1) * SAMPLES + half;
        let t_of = |i: usize| i as f64 / SAMPLES as f64;
        for i in first..=last {
            let here = distance(t_of(i));
            let lower_before = i > first && distance(t_of(i - 1)) <= here;
            let lower_after = i < last && distance(t_of(i + 1)) < here;
            if lower_before || lower_after {
                continue;
            }
            let (mut a, mut b) = (t_of(i.max(first + 1) - 1), t_of((i + 1).min(last)));
            for _ in 0..60 {
                let (c, d) = (b - (b - a) * GOLDEN, a + (b - a) * GOLDEN);
                if distance(c) <= distance(d) {
                    b = d;
                } else {
                    a = c;
                }
            }
            let t = 0.5 * (a + b);
            let segment = t as usize;
            let at_end = b <= t_of(first) + 1e-9 || a >= t_of(last) - 1e-9;
            let foot = self
                .curve()
                .view(segment, p)
                .foot(p, segment, t.fract(), at_end);
            if foot.distance <= reach && self.arc_of(segment) <= own {
                feet.push(foot);
            }
        }
        feet
    }
}
