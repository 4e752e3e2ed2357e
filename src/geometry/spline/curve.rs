//! The centreline as a quadratic B-spline over the nodes of a wire.

use super::segment::{Foot, Lies, SegmentView};
use crate::math::V3;

/// Most joints a foot slides over. Chosen: ten times what a start from the last step needs.
pub(super) const HOPS: usize = 64;

/// The centreline of a wire by its nodes: two at least, three between seams.
#[derive(Clone, Copy, Debug)]
pub struct Curve<'a> {
    /// nodes, oldest first, m
    pub points: &'a [V3],
    /// whether there is a seam at the first segment and at the last
    pub seams: [bool; 2],
}

impl Curve<'_> {
    /// The foot of `p` (m, frame of the nodes) in the passage of the wire that the segment `start`
    /// belongs to: the first local minimum of the distance downhill from there.
    ///
    /// Every start from [`SplineTube::gather`](super::SplineTube::gather) near the same `p` gives a
    /// minimum of its own. After `p` has moved two minima may have merged, and two starts end on
    /// one foot. After 64 joints the search stops where it is.
    ///
    /// # Panics
    /// With fewer than two nodes.
    #[inline]
    pub fn foot(&self, p: V3, start: u32) -> Foot {
        assert!(self.points.len() > 1, "a foot needs wire to stand on");
        let [first, last] = self.ends();
        let segment = (start as usize).clamp(first, last);
        // By far the most frequent case: the foot is where it was, away from the wire's ends.
        if segment > 0 && segment + 1 < self.points.len() {
            let view = self.inner_view(segment, p);
            if view.rises() {
                return view.foot(p, segment, view.dip(), false);
            }
        }
        self.slide(p, segment)
    }

    /// [`Self::foot`] from a segment that need not have one.
    #[inline(never)]
    fn slide(&self, p: V3, mut segment: usize) -> Foot {
        let mut view = self.view(segment, p);
        for _ in 0..HOPS {
            match self.locate(segment, &view) {
                (Lies::At(s), at_end) => {
                    let foot = view.foot(p, segment, s, at_end);
                    let beyond = if at_end {
                        self.beyond(segment, &view, s)
                    } else {
                        0.0
                    };
                    return Foot { beyond, ..foot };
                }
                (Lies::Before, _) => segment -= 1,
                (Lies::Beyond, _) => segment += 1,
            }
            view = self.view(segment, p);
        }
        let s = if view.g_low < 0.0 {
            view.high
        } else {
            view.low
        };
        view.foot(p, segment, s, false)
    }

    /// The edges before and after a node; at the wire's ends the one edge there is, twice.
    #[inline(always)]
    pub(super) fn edges(&self, segment: usize) -> [V3; 2] {
        let points = &self.points;
        let here = points[segment];
        if segment == 0 {
            let edge = points[1] - here;
            [edge, edge]
        } else if segment + 1 == points.len() {
            let edge = here - points[segment - 1];
            [edge, edge]
        } else {
            [here - points[segment - 1], points[segment + 1] - here]
        }
    }

    /// A segment as seen from `p`, with the range of it that is wire.
    pub(super) fn view(&self, segment: usize, p: V3) -> SegmentView {
        let last = self.points.len() - 1;
        if segment > 0 && segment < last {
            return self.inner_view(segment, p);
        }
        let here = self.points[segment];
        let [edge, _] = self.edges(segment);
        // the same operations as in the neighbour, so that g agrees at the joint
        let (start, low, g_low) = if segment == 0 {
            (here - edge * 0.5 - p, 0.5, (here - p).dot(&edge))
        } else {
            let start = (self.points[segment - 1] + here) * 0.5 - p;
            (start, 0.0, start.dot(&edge))
        };
        let (high, g_high) = if segment == last {
            (0.5, (here - p).dot(&edge))
        } else {
            let end = (here + self.points[segment + 1]) * 0.5 - p;
            (1.0, end.dot(&edge))
        };
        SegmentView {
            start,
            before: edge,
            bend: V3::zeros(),
            low,
            high,
            g_low,
            g_high,
            g: [start.dot(&edge), edge.norm_squared(), 0.0, 0.0],
        }
    }

    /// [`Self::view`] of a segment that is not at an end.
    #[inline(always)]
    fn inner_view(&self, segment: usize, p: V3) -> SegmentView {
        let [behind, here, ahead] = *self.points[segment - 1..]
            .first_chunk()
            .expect("an inner node has two neighbours");
        let (before, after) = (here - behind, ahead - here);
        let start = (behind + here) * 0.5 - p;
        let end = (here + ahead) * 0.5 - p;
        let bend = after - before;
        let g_low = start.dot(&before);
        SegmentView {
            start,
            before,
            bend,
            low: 0.0,
            high: 1.0,
            g_low,
            g_high: end.dot(&after),
            g: [
                g_low,
                before.norm_squared() + start.dot(&bend),
                1.5 * before.dot(&bend),
                0.5 * bend.norm_squared(),
            ],
        }
    }

    /// Where the minimum of a segment lies, or which way the distance falls; and whether it is an
    /// end of the wire.
    pub(super) fn locate(&self, segment: usize, view: &SegmentView) -> (Lies, bool) {
        match view.minimum() {
            Lies::Before if segment == self.ends()[0] => (Lies::At(view.low), true),
            Lies::Beyond if segment == self.ends()[1] => (Lies::At(view.high), true),
            lies => (lies, false),
        }
    }

    /// The first and the last segment on this side of the seams.
    #[inline(always)]
    fn ends(&self) -> [usize; 2] {
        let last = self.points.len() - 1;
        [
            usize::from(self.seams[0]),
            last - usize::from(self.seams[1]),
        ]
    }

    /// How far past a seam at `share` the place lies that a segment is seen from, m.
    fn beyond(&self, segment: usize, view: &SegmentView, share: f64) -> f64 {
        let [first, last] = self.ends();
        let past = if self.seams[0] && segment == first && share == view.low {
            view.g_low
        } else if self.seams[1] && segment == last && share == view.high {
            -view.g_high
        } else {
            return 0.0;
        };
        past.max(0.0) / view.along(share).norm()
    }

    /// The nodes on which the point at `share` of a segment depends, and their weights, which sum
    /// to 1.
    pub fn weights(&self, segment: usize, share: f64) -> ([usize; 3], [f64; 3]) {
        let last = self.points.len() - 1;
        let s = share;
        if segment == 0 {
            return ([0, 1, 1], [1.5 - s, s - 0.5, 0.0]);
        }
        if segment == last {
            return ([last - 1, last, last], [0.5 - s, 0.5 + s, 0.0]);
        }
        (
            [segment - 1, segment, segment + 1],
            [0.5 * (1.0 - s) * (1.0 - s), 0.5 + s - s * s, 0.5 * s * s],
        )
    }
}
