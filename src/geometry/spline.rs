//! Frozen wire as a smooth tube: its centreline is a quadratic B-spline, C1 along the wire.
//!
//! The prisms of [`super::Tube`] have facets and mitres, on which an implicit step would rattle.
//! Here the surface is all that is one radius away from a curve with a continuous tangent, so the
//! distance of a point from it is C1 as long as the point is nearer than the centre of curvature.
//!
//! # The curve
//!
//! Node k with its neighbours gives segment k, from the middle of edge k-1 to the middle of edge k,
//! tangent to both there:
//!
//! ```text
//! C(s) = (1-s)^2/2 P[k-1] + (1/2 + s - s^2) P[k] + s^2/2 P[k+1],   0 <= s <= 1
//! ```
//!
//! It cuts corners: at node k it passes `(P[k-1] - 2 P[k] + P[k+1])/8` inside. Both ends have a
//! neighbour mirrored in them, `2 P[0] - P[1]`, which makes their segments straight, with half of
//! the range of s: the wire starts at node 0 with s = 1/2 in segment 0 and ends at node n-1 with
//! s = 1/2 in segment n-1. There are as many segments as nodes, and C' is continuous throughout.
//!
//! # Seams
//!
//! Where wire goes on as other wire, frozen wire as live wire, neither ends. Both have the edge in common that lies about
//! the seam, so both curves pass its middle in its direction, and there the one ends and the other begins. What lies
//! beyond is the other's: its foot is at the end, with [`Foot::beyond`] above zero, and it touches nothing of this one. A wire that
//! simply ended here would be a chord where it lies bent, off by an eighth of the second difference of its nodes.
//!
//! # The foot of a point p
//!
//! Half the derivative of the squared distance, g(s) = (C - p) C', is a cubic on a segment. Where it
//! goes from falling (g < 0) to rising there is a local minimum. At a joint g is the same number to
//! the bit from either side, so that a minimum belongs to one segment and to one only.

use super::grid::Grid;
use crate::math::V3;

/// Cells of the search are this many wire diameters wide. Chosen: smaller ones cost look-ups, wider
/// ones wire that is not near; 2 takes as long in a full coil and more memory.
const CELL: f64 = 3.0;

/// Most joints a foot slides over. Chosen: ten times what a start from the last step needs.
const HOPS: usize = 64;

/// A share is known when the error left is below this. Coordinates of centimetres round by 1e-18 m,
/// which on a segment of tenths of a millimetre is 1e-14 of it.
const LAST_DIGITS: f64 = 1e-13;

/// Chebyshev steps and halvings together never take longer: 52 halvings use up all digits.
const MOST_STEPS: usize = 64;

/// Frozen wire with a smooth centreline, oldest node first, core frame.
#[derive(Clone, Debug, PartialEq)]
pub struct SplineTube {
    radius: f64,
    points: Vec<V3>,
    arc: Vec<f64>,
    /// the last two nodes are those of the wire it goes on with
    goes_on: bool,
    /// all segments but the last, which changes with the next node
    grid: Grid,
}

/// Nodes of a wire on the far side of a seam that this side has as well.
const SHARED: usize = 2;

/// The point of the centreline nearest to a point p, in one passage of the wire.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Foot {
    /// segment, numbered as its middle node
    pub segment: u32,
    /// where on the segment, s of the module's formula
    pub share: f64,
    /// the foot, m
    pub point: V3,
    /// of p from the centreline, m
    pub distance: f64,
    /// unit direction from the foot to p, the gradient of the distance
    pub normal: V3,
    /// whether the wire ends here, and p may lie beyond its end
    pub at_end: bool,
    /// how far past a seam p lies, m
    pub beyond: f64,
}

impl Foot {
    /// Depth of a point in what lies within `reach` of the centreline, m; negative: it is at least so far off.
    #[inline(always)]
    pub fn depth(&self, reach: f64) -> f64 {
        let depth = reach - self.distance;
        if self.beyond > 0.0 {
            depth.min(-self.beyond)
        } else {
            depth
        }
    }
}

/// Where on a segment, or beyond which end of it, a minimum lies.
enum Lies {
    At(f64),
    Before,
    Beyond,
}

/// One segment seen from p: C(s) - p = start + s before + s^2/2 bend.
struct Piece {
    start: V3,
    before: V3,
    bend: V3,
    low: f64,
    high: f64,
    g_low: f64,
    g_high: f64,
    /// coefficients of g, constant first
    g: [f64; 4],
}

impl SplineTube {
    /// No wire yet; `radius` of the wire, m, above zero.
    pub fn new(radius: f64) -> Self {
        Self {
            radius,
            points: Vec::new(),
            arc: Vec::new(),
            goes_on: false,
            grid: Grid::new(CELL * 2.0 * radius),
        }
    }

    /// Number of its own nodes, and of segments once there are two.
    pub fn len(&self) -> usize {
        self.points.len() - self.shared()
    }

    /// Whether there is no wire.
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

    /// Its own nodes, control points of the centreline, core frame, m.
    pub fn points(&self) -> &[V3] {
        &self.points[..self.len()]
    }

    /// Control points of the centreline, those of the wire that it goes on with included, core frame, m.
    pub fn controls(&self) -> &[V3] {
        &self.points
    }

    /// Unstretched length from the clamp to each of its nodes, m.
    pub fn arc(&self) -> &[f64] {
        &self.arc[..self.len()]
    }

    /// The nodes of the wire that it goes on with, and their arc lengths, if it does.
    pub fn ahead(&self) -> Option<[(V3, f64); SHARED]> {
        let own = self.len();
        self.goes_on
            .then(|| [own, own + 1].map(|k| (self.points[k], self.arc[k])))
    }

    /// From here on the wire goes on with these nodes and arc lengths, or ends.
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

    /// Appends a node apart from the last one; `arc` grows along the wire, which goes on with nothing.
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
        let piece = self.curve().piece(segment, V3::zeros());
        let chord = piece.arm(piece.high) - piece.arm(piece.low);
        let parts = (chord.amax() / self.grid.edge()).ceil().clamp(1.0, 1024.0);
        let width = (piece.high - piece.low) / parts;
        for part in 0..parts as usize {
            let s = piece.low + width * part as f64;
            // the part lies within the triangle of its own three control points
            let (a, c) = (piece.arm(s), piece.arm(s + width));
            let b = a + piece.along(s) * (0.5 * width);
            let (low, high) = (a.inf(&b).inf(&c), a.sup(&b).sup(&c));
            change(&mut self.grid, segment as u32, low, high);
        }
    }

    /// Segments to start a foot from, ascending, one for every passage of the wire that comes
    /// within `reach` (m) of `p`: for each local minimum of the distance along the wire, its ends
    /// included. Segments whose node has an arc length above `own` (m) are left out.
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
            if self.arc_of(k) <= own && self.may_reach(k, p, reach) && self.has_foot(k, p, reach) {
                out.push(segment);
            }
        };
        self.grid.visit_near(p, reach, |segments| {
            segments.iter().for_each(|&segment| consider(segment));
        });
        if !self.goes_on {
            consider(self.points.len() as u32 - 1);
        }
        // a segment may have been met in several cells
        out.sort_unstable();
        out.dedup();
    }

    /// Arc length by which a segment is somebody's own wire or not: of its node, of the next at a seam, where the wire that goes on
    /// begins on it.
    fn arc_of(&self, segment: usize) -> f64 {
        let at_seam = self.goes_on && segment + SHARED == self.points.len();
        self.arc[segment + usize::from(at_seam)]
    }

    /// Whether a local minimum of the distance, within `reach`, lies on a segment.
    fn has_foot(&self, segment: usize, p: V3, reach: f64) -> bool {
        let piece = self.curve().piece(segment, p);
        match self.curve().settle(segment, &piece) {
            (Lies::At(s), _) => piece.arm(s).norm() <= reach,
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

    /// The foot of `p` on the passage that `start` belongs to, see [`Curve::foot`].
    #[inline]
    pub fn foot(&self, p: V3, start: u32) -> Foot {
        self.curve().foot(p, start)
    }

    /// All local minima of the distance within `reach`, by dense sampling and golden sections: the
    /// slow twin of [`Self::gather`] with [`Self::foot`].
    pub fn feet_brute(&self, p: V3, reach: f64, own: f64) -> Vec<Foot> {
        const SAMPLES: usize = 64;
        const GOLDEN: f64 = 0.618_033_988_749_894_9;
        let mut feet = Vec::new();
        if self.points.len() < 2 {
            return feet;
        }
        // t: segment plus share
        let distance = |t: f64| self.curve().piece(t as usize, p).arm(t.fract()).norm();
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
                .piece(segment, p)
                .foot(p, segment, t.fract(), at_end);
            if foot.distance <= reach && self.arc_of(segment) <= own {
                feet.push(foot);
            }
        }
        feet
    }
}

/// A centreline by its nodes, two at least, three between seams: frozen wire, or live wire as it lies now.
#[derive(Clone, Copy, Debug)]
pub struct Curve<'a> {
    /// its nodes
    pub points: &'a [V3],
    /// whether it goes on as other wire before the first segment, and from the last on
    pub seams: [bool; 2],
}

impl Curve<'_> {
    /// The foot of `p` in the passage of the wire that `start` (a segment) belongs to: downhill
    /// from there to the first local minimum of the distance.
    ///
    /// Panics with fewer than two nodes. Started from [`SplineTube::gather`]'s segments near the
    /// same p it gives that minimum; after p has moved, a minimum may have merged with
    /// its neighbour, and two starts end on one foot. After 64 joints it stops where it is.
    #[inline]
    pub fn foot(&self, p: V3, start: u32) -> Foot {
        assert!(self.points.len() > 1, "a foot needs wire to stand on");
        let [first, last] = self.ends();
        let segment = (start as usize).clamp(first, last);
        // By far the most frequent case: the foot is where it was, away from the wire's ends.
        if segment > 0 && segment + 1 < self.points.len() {
            let piece = self.inner_piece(segment, p);
            if piece.rises() {
                return piece.foot(p, segment, piece.dip(), false);
            }
        }
        self.slide(p, segment)
    }

    /// [`Self::foot`] from a segment that need not have one.
    #[inline(never)]
    fn slide(&self, p: V3, mut segment: usize) -> Foot {
        let mut piece = self.piece(segment, p);
        for _ in 0..HOPS {
            match self.settle(segment, &piece) {
                (Lies::At(s), at_end) => {
                    let foot = piece.foot(p, segment, s, at_end);
                    let beyond = if at_end {
                        self.beyond(segment, &piece, s)
                    } else {
                        0.0
                    };
                    return Foot { beyond, ..foot };
                }
                (Lies::Before, _) => segment -= 1,
                (Lies::Beyond, _) => segment += 1,
            }
            piece = self.piece(segment, p);
        }
        let s = if piece.g_low < 0.0 {
            piece.high
        } else {
            piece.low
        };
        piece.foot(p, segment, s, false)
    }

    /// The edges before and after a node; at the wire's ends the one edge there is, twice.
    #[inline(always)]
    fn edges(&self, segment: usize) -> [V3; 2] {
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
    fn piece(&self, segment: usize, p: V3) -> Piece {
        let last = self.points.len() - 1;
        if segment > 0 && segment < last {
            return self.inner_piece(segment, p);
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
        Piece {
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

    /// [`Self::piece`] of a segment that is not at an end.
    #[inline(always)]
    fn inner_piece(&self, segment: usize, p: V3) -> Piece {
        let [behind, here, ahead] = *self.points[segment - 1..]
            .first_chunk()
            .expect("an inner node has two neighbours");
        let (before, after) = (here - behind, ahead - here);
        let start = (behind + here) * 0.5 - p;
        let end = (here + ahead) * 0.5 - p;
        let bend = after - before;
        let g_low = start.dot(&before);
        Piece {
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

    /// Where the minimum of a segment lies, or which way is downhill; and whether it is an end of
    /// the wire.
    fn settle(&self, segment: usize, piece: &Piece) -> (Lies, bool) {
        match piece.minimum() {
            Lies::Before if segment == self.ends()[0] => (Lies::At(piece.low), true),
            Lies::Beyond if segment == self.ends()[1] => (Lies::At(piece.high), true),
            lies => (lies, false),
        }
    }

    /// The first and the last segment that are wire of its own.
    #[inline(always)]
    fn ends(&self) -> [usize; 2] {
        let last = self.points.len() - 1;
        [
            usize::from(self.seams[0]),
            last - usize::from(self.seams[1]),
        ]
    }

    /// How far past a seam at `share` the place lies that a segment is seen from, m.
    fn beyond(&self, segment: usize, piece: &Piece, share: f64) -> f64 {
        let [first, last] = self.ends();
        let past = if self.seams[0] && segment == first && share == piece.low {
            piece.g_low
        } else if self.seams[1] && segment == last && share == piece.high {
            -piece.g_high
        } else {
            return 0.0;
        };
        past.max(0.0) / piece.along(share).norm()
    }

    /// Nodes on which the point at `share` of a segment depends, and how much on each.
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

impl Piece {
    /// C(s) - p
    #[inline(always)]
    fn arm(&self, s: f64) -> V3 {
        self.start + (self.before + self.bend * (0.5 * s)) * s
    }

    /// C'(s)
    #[inline(always)]
    fn along(&self, s: f64) -> V3 {
        self.before + self.bend * s
    }

    #[inline(always)]
    fn g(&self, s: f64) -> f64 {
        let [a, b, c, d] = self.g;
        a + s * (b + s * (c + s * d))
    }

    /// Whether the distance falls at the start and rises at the end.
    #[inline(always)]
    fn rises(&self) -> bool {
        self.g_low < 0.0 && self.g_high >= 0.0
    }

    /// The local minimum on a segment that [`Self::rises`]; of two the nearer.
    #[inline(always)]
    fn dip(&self) -> f64 {
        match self.hump() {
            None => self.root((self.low, self.g_low), (self.high, self.g_high)),
            Some(hump) => self.nearer_dip(hump),
        }
    }

    /// The nearest local minimum on this segment, or else the way downhill.
    fn minimum(&self) -> Lies {
        match (self.g_low < 0.0, self.g_high < 0.0) {
            (true, false) => Lies::At(self.dip()),
            (false, false) => match self.hump() {
                Some([_, s]) => Lies::At(self.root((s, self.g(s)), (self.high, self.g_high))),
                None => Lies::Before,
            },
            (true, true) => match self.hump() {
                Some([s, _]) => Lies::At(self.root((self.low, self.g_low), (s, self.g(s)))),
                None => Lies::Beyond,
            },
            // A hill and no dip, since g ends up rising: down the lower side.
            (false, true) => {
                if self.arm(self.low).norm_squared() <= self.arm(self.high).norm_squared() {
                    Lies::Before
                } else {
                    Lies::Beyond
                }
            }
        }
    }

    /// The turning points of g, top and bottom, where they give it roots that its ends do not tell
    /// of: a minimum lies before the top if that is within the segment, and one after the bottom.
    #[inline(always)]
    fn hump(&self) -> Option<[f64; 2]> {
        let [a, b, c, _] = self.g;
        // The signs of the Bernstein coefficients change at least as often as that of g. As a rule
        // they never fall, and then g has one upward root at most.
        let (second, third) = (3.0 * a + b, 3.0 * a + 2.0 * b + c);
        let (third_falls, second_falls) = (third < 0.0, second < 0.0);
        // No short cuts: which half the foot is in is a coin toss, and a branch on it costs more.
        let falls = ((self.g_low >= 0.0) & second_falls)
            | (!second_falls & third_falls)
            | (!third_falls & (self.g_high < 0.0));
        if !falls {
            return None;
        }
        self.turning_points()
    }

    #[cold]
    fn turning_points(&self) -> Option<[f64; 2]> {
        let [_, b, c, d] = self.g;
        let root = c * c - 3.0 * b * d;
        if !(d > 0.0 && root > 0.0) {
            return None;
        }
        let root = root.sqrt();
        let (top, bottom) = ((-c - root) / (3.0 * d), (-c + root) / (3.0 * d));
        let within = |s: f64| s > self.low && s < self.high;
        let high_top = within(top) && self.g(top) >= 0.0;
        let low_bottom = within(bottom) && self.g(bottom) < 0.0;
        let split = match (self.g_low < 0.0, self.g_high < 0.0) {
            (true, false) => high_top && low_bottom,
            (false, false) => low_bottom,
            (true, true) => high_top,
            (false, true) => false,
        };
        split.then_some([top, bottom])
    }

    /// Of two minima on one segment the nearer.
    #[cold]
    fn nearer_dip(&self, [top, bottom]: [f64; 2]) -> f64 {
        let first = self.root((self.low, self.g_low), (top, self.g(top)));
        let second = self.root((bottom, self.g(bottom)), (self.high, self.g_high));
        if self.arm(first).norm_squared() <= self.arm(second).norm_squared() {
            first
        } else {
            second
        }
    }

    /// A root of g between `low`, where g < 0, and `high`, where g >= 0: secant, then Chebyshev's
    /// method (Newton with the curvature of g). Where one step will not do, it is held between the
    /// two by halving.
    #[inline(always)]
    fn root(&self, low: (f64, f64), high: (f64, f64)) -> f64 {
        let secant = low.0 + (high.0 - low.0) * (low.1 / (low.1 - high.1));
        let (s, rest) = self.chebyshev(secant, self.g(secant));
        if !(s >= low.0 && s <= high.0) {
            return self.root_held(low.0, high.0, secant);
        }
        if rest < LAST_DIGITS {
            s
        } else {
            self.root_held(low.0, high.0, s)
        }
    }

    #[inline(never)]
    fn root_held(&self, mut low: f64, mut high: f64, mut s: f64) -> f64 {
        for _ in 0..MOST_STEPS {
            let g = self.g(s);
            if g < 0.0 {
                low = s;
            } else {
                high = s;
            }
            let (next, rest) = self.chebyshev(s, g);
            if rest < f64::INFINITY && next >= low && next <= high {
                s = next;
                if rest < LAST_DIGITS {
                    break;
                }
            } else {
                let middle = 0.5 * (low + high);
                if middle <= low || middle >= high {
                    break;
                }
                s = middle;
            }
        }
        s
    }

    /// The next guess of a root and about how far it is off, infinitely where g falls: that way
    /// lies a maximum of the distance.
    #[inline(always)]
    fn chebyshev(&self, s: f64, g: f64) -> (f64, f64) {
        let [_, b, c, d] = self.g;
        let slope = b + s * (2.0 * c + s * (3.0 * d));
        let per_slope = 1.0 / slope;
        let newton = g * per_slope;
        let curve = (c + 3.0 * d * s) * per_slope;
        let next = s - newton * (1.0 + newton * curve);
        // what the series leaves out, its next term
        let rest = newton * newton * newton * (2.0 * curve * curve - d * per_slope);
        let rest = if slope > 0.0 {
            rest.abs()
        } else {
            f64::INFINITY
        };
        (next, rest)
    }

    /// Unit direction of the wire, away from the clamp.
    fn tangent(&self, s: f64) -> V3 {
        let along = self.along(s);
        let speed = along.norm();
        if speed > 0.0 {
            along * (1.0 / speed)
        } else {
            // the wire turns right back on itself
            self.before / self.before.norm()
        }
    }

    #[inline(always)]
    fn foot(&self, p: V3, segment: usize, s: f64, at_end: bool) -> Foot {
        let arm = self.arm(s);
        let distance = arm.norm();
        let normal = if distance > 0.0 {
            arm * (-1.0 / distance)
        } else {
            across(&self.tangent(s))
        };
        Foot {
            segment: segment as u32,
            share: s,
            point: p + arm,
            distance,
            normal,
            at_end,
            beyond: 0.0,
        }
    }
}

/// Some unit vector at right angles to a unit vector.
#[cold]
fn across(tangent: &V3) -> V3 {
    let axis = tangent.iamin();
    let mut unit = V3::zeros();
    unit[axis] = 1.0;
    tangent.cross(&unit).normalize()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const R: f64 = 0.35e-3;

    /// A helix about y with waves across, edges from 0.4 mm to `longest`.
    fn wavy(
        radius: f64,
        pitch: f64,
        wave: f64,
        longest: f64,
        phase: f64,
        turns: f64,
    ) -> SplineTube {
        let mut tube = SplineTube::new(R);
        let (mut angle, mut arc, mut node) = (0.0, 0.0, 0);
        while angle < turns * std::f64::consts::TAU {
            let around = radius + wave * libm::sin(7.3 * angle + phase);
            let y = pitch * angle / std::f64::consts::TAU + wave * libm::cos(5.1 * angle + phase);
            let point = V3::new(around * libm::cos(angle), y, around * libm::sin(angle));
            tube.push(point, arc);
            let share = 0.5 + 0.5 * libm::sin(1.7 * f64::from(node) + phase);
            let edge = 0.4e-3 + (longest - 0.4e-3) * share * share;
            angle += edge / radius;
            arc += edge;
            node += 1;
        }
        tube
    }

    fn wire() -> impl Strategy<Value = SplineTube> {
        let longest = 0.4e-3..3e-3f64;
        (
            4e-3..9e-3f64,
            0.5e-3..1.5e-3f64,
            0.0..0.3e-3f64,
            longest,
            0.0..6.3f64,
        )
            .prop_map(|(r, pitch, wave, longest, phase)| wavy(r, pitch, wave, longest, phase, 3.2))
    }

    fn tangent_at(tube: &SplineTube, foot: &Foot) -> V3 {
        let segment = foot.segment as usize;
        tube.curve().piece(segment, V3::zeros()).tangent(foot.share)
    }

    /// On the curve, at t = segment + share.
    fn on(tube: &SplineTube, t: f64) -> V3 {
        tube.curve().piece(t as usize, V3::zeros()).arm(t.fract())
    }

    fn reachable(tube: &SplineTube, share: f64) -> f64 {
        0.5 + share * (tube.len() - 1) as f64
    }

    /// Radius of curvature at t, m.
    fn bend_radius(tube: &SplineTube, t: f64) -> f64 {
        let piece = tube.curve().piece(t as usize, V3::zeros());
        let along = piece.along(t.fract());
        along.norm().powi(3) / along.cross(&piece.bend).norm()
    }

    #[test]
    fn centreline_follows_the_formula_from_end_to_end() {
        let tube = wavy(5e-3, 0.7e-3, 0.2e-3, 2e-3, 0.4, 1.0);
        let points = tube.points();
        let n = points.len();
        assert!((on(&tube, 0.5) - points[0]).norm() < 1e-17);
        assert!((on(&tube, n as f64 - 0.5) - points[n - 1]).norm() < 1e-17);
        for k in 1..n - 1 {
            for s in [0.0, 0.3, 0.9] {
                let basis = [0.5 * (1.0 - s) * (1.0 - s), 0.5 + s - s * s, 0.5 * s * s];
                let p = points[k - 1] * basis[0] + points[k] * basis[1] + points[k + 1] * basis[2];
                assert!((on(&tube, k as f64 + s) - p).norm() < 1e-17);
            }
        }
        for k in 1..n {
            // place and derivative are the same from both sides
            let (a, b) = (
                tube.curve().piece(k - 1, V3::zeros()),
                tube.curve().piece(k, V3::zeros()),
            );
            assert!((a.arm(1.0) - b.arm(0.0)).norm() < 1e-17);
            assert!((a.along(1.0) - b.along(0.0)).norm() < 1e-17);
            assert_eq!(a.g_high, b.g_low);
        }
    }

    proptest! {
        #[test]
        fn gather_and_foot_find_what_sampling_finds(
            tube in wire(),
            t in 0.0..1.0f64,
            off in (-1.0..1.0f64, -1.0..1.0f64, -1.0..1.0f64),
            reach in 0.3e-3..3e-3f64,
            own in 0.0..1.5f64,
        ) {
            let p = on(&tube, reachable(&tube, t)) + V3::new(off.0, off.1, off.2) * 2e-3;
            let own = own * tube.arc()[tube.len() - 1];
            let mut starts = Vec::new();
            tube.gather(p, reach, own, &mut starts);
            prop_assert!(starts.is_sorted_by(|a, b| a < b));
            let feet: Vec<Foot> = starts.iter().map(|&s| tube.foot(p, s)).collect();
            for (foot, &start) in feet.iter().zip(&starts) {
                prop_assert!(foot.segment == start && foot.distance <= reach);
                prop_assert!(tube.arc()[start as usize] <= own);
                // a minimum in its own right
                let t = f64::from(foot.segment) + foot.share;
                for h in [-1e-4, 1e-4] {
                    if (0.5..=tube.len() as f64 - 0.5).contains(&(t + h)) {
                        prop_assert!((on(&tube, t + h) - p).norm() >= foot.distance - 1e-15);
                    }
                }
                prop_assert!((foot.point + foot.normal * foot.distance - p).norm() < 1e-16);
                prop_assert!((tangent_at(&tube, foot).norm() - 1.0).abs() < 1e-12);
                prop_assert!(foot.at_end || foot.normal.dot(&tangent_at(&tube, foot)).abs() * foot.distance < 1e-14);
            }
            for slow in tube.feet_brute(p, reach * (1.0 - 1e-9), f64::INFINITY) {
                // which segment has a minimum at a joint is a matter of rounding
                let at_joint = (slow.share - slow.share.round()).abs() < 1e-6;
                if tube.arc()[slow.segment as usize] > own || at_joint && !slow.at_end {
                    continue;
                }
                // of two on one segment the nearer
                let found = feet.iter().any(|foot| {
                    (foot.point - slow.point).norm() < 1e-6
                        || foot.segment == slow.segment && foot.distance <= slow.distance
                });
                prop_assert!(found, "{slow:?} {feet:?}");
            }
        }

        #[test]
        fn normal_is_the_gradient_of_the_distance(
            tube in wire(),
            t in 0.0..1.0f64,
            round in 0.0..6.3f64,
            out in 0.02..0.8f64,
        ) {
            let t = reachable(&tube, t);
            let along = tube.curve().piece(t as usize, V3::zeros()).along(t.fract()).normalize();
            let side = across(&along);
            let way = side * libm::cos(round) + along.cross(&side) * libm::sin(round);
            let bend = bend_radius(&tube, t).min(bend_radius(&tube, (t - 0.5).max(0.5)))
                .min(bend_radius(&tube, (t + 0.5).min(tube.len() as f64 - 0.5)));
            let distance = out * bend.min(1.5e-3);
            let p = on(&tube, t) + way * distance;
            let foot = tube.foot(p, t as u32);
            prop_assert!((foot.distance - distance).abs() < 1e-15 || foot.distance < distance);
            let h = 1e-8;
            let slope = V3::from_fn(|axis, _| {
                let mut step = V3::zeros();
                step[axis] = h;
                let ahead = tube.foot(p + step, foot.segment).distance;
                (ahead - tube.foot(p - step, foot.segment).distance) / (2.0 * h)
            });
            // second derivatives: 1/distance across, and along the wire at most 1/(bend - distance)
            let second = 1.0 / foot.distance + 1.0 / (0.2 * bend);
            prop_assert!((slope - foot.normal).norm() < 2.0 * h * second + 1e-8);
        }

        #[test]
        fn foot_slides_over_joints_without_a_jump(
            tube in wire(),
            joint in 0.1..0.9f64,
            round in 0.0..6.3f64,
        ) {
            let joint = (joint * tube.len() as f64).floor();
            let along = tube.curve().piece(joint as usize, V3::zeros()).along(0.0).normalize();
            let side = across(&along);
            let way = side * libm::cos(round) + along.cross(&side) * libm::sin(round);
            let bend = bend_radius(&tube, joint).min(bend_radius(&tube, joint - 1e-9));
            let p = on(&tube, joint) + way * (0.5 * bend).min(0.3e-3);
            for start in [joint as u32 - 1, joint as u32] {
                let step = along * 1e-9;
                let (a, b) = (tube.foot(p - step, start), tube.foot(p + step, start));
                prop_assert_eq!(a.segment + 1, b.segment);
                prop_assert!((a.distance - b.distance).abs() < 1e-14);
                prop_assert!((a.normal - b.normal).norm() < 1e-4);
                prop_assert!((a.point - b.point).norm() < 1e-7);
                prop_assert!((tangent_at(&tube, &a) - tangent_at(&tube, &b)).norm() < 1e-4);
            }
        }

        /// Wire cut in two by a seam is the wire in one piece: one side has the foot, the other says that it is beyond.
        #[test]
        fn a_seam_does_not_show(
            tube in wire(),
            (cut, along) in (0.1..0.9f64, -2.5..2.5f64),
            off in prop::array::uniform3(-0.8..0.8f64),
        ) {
            let cut = 2 + (cut * (tube.len() - 5) as f64) as usize;
            let mut frozen = SplineTube::new(R);
            for i in 0..cut {
                frozen.push(tube.points()[i], tube.arc()[i]);
            }
            let shared = [cut, cut + 1].map(|i| (tube.points()[i], tube.arc()[i]));
            frozen.go_on(Some(shared));
            prop_assert_eq!(frozen.len(), cut);
            let live = Curve { points: &tube.points()[cut..], seams: [true, false] };
            let t = (cut as f64 + 1.0 + along).clamp(0.5, (tube.len() - 1) as f64);
            // (beyond a centre of curvature both sides may have a foot)
            let mut about = (-12..=12).map(|i| t + 0.25 * f64::from(i));
            let inside = |t: &f64| *t > 0.5 && *t < (tube.len() - 1) as f64;
            prop_assume!(about.all(|t| !inside(&t) || bend_radius(&tube, t) > 2.5 * R));
            let p = on(&tube, t) + V3::from(off) * R;
            let whole = tube.foot(p, t as u32);
            let sides = [
                frozen.foot(p, whole.segment),
                live.foot(p, whole.segment.saturating_sub(cut as u32)),
            ];
            let depth = sides.map(|foot| foot.depth(2.0 * R));
            prop_assert!(depth[0] < 0.0 || depth[1] < 0.0, "{:?}", sides);
            let most = depth[0].max(depth[1]);
            prop_assert!((most - whole.depth(2.0 * R)).abs() < 1e-12, "{:?} {:?}", sides, whole);
            // to the frozen side, from which it is looked for, it is there or not
            let mut starts = Vec::new();
            frozen.gather(p, 2.0 * R, f64::INFINITY, &mut starts);
            let found = starts.iter().any(|s| frozen.foot(p, *s).depth(2.0 * R) == depth[0]);
            prop_assert!(depth[0] < 0.0 || found, "{:?} {}", starts, depth[0]);
            frozen.go_on(None);
            prop_assert_eq!(frozen.pop(), Some((tube.points()[cut - 1], tube.arc()[cut - 1])));
        }

        #[test]
        fn popping_undoes_pushing(tube in wire(), share in 0.0..1.0f64) {
            let keep = (share * tube.len() as f64) as usize;
            let mut built = SplineTube::new(R);
            for i in 0..keep {
                built.push(tube.points()[i], tube.arc()[i]);
            }
            let mut popped = tube.clone();
            for i in (keep..tube.len()).rev() {
                prop_assert_eq!(popped.pop(), Some((tube.points()[i], tube.arc()[i])));
            }
            prop_assert_eq!(&popped, &built);
            for i in keep..tube.len() {
                popped.push(tube.points()[i], tube.arc()[i]);
            }
            prop_assert_eq!(&popped, &tube);
        }
    }

    #[test]
    fn foot_slides_to_its_minimum_from_afar() {
        let tube = wavy(20e-3, 0.7e-3, 0.0, 0.4e-3, 0.0, 1.0);
        let p = on(&tube, 100.3) * 1.02;
        let here = tube.foot(p, 100);
        for start in 50..150 {
            let foot = tube.foot(p, start);
            assert!((foot.point - here.point).norm() < 1e-14 && foot.segment == here.segment);
        }
        // too far for the number of joints: it stops on the way, and does not claim an end
        let lost = tube.foot(p, 200);
        assert!(lost.segment == 200 - HOPS as u32 && !lost.at_end);
        // a number left from a longer wire
        assert!(tube.foot(p, u32::MAX).distance > here.distance);
    }

    #[test]
    fn ends_and_short_wire() {
        let mut tube = SplineTube::new(R);
        let mut starts = vec![7];
        tube.gather(V3::zeros(), 1.0, 1.0, &mut starts);
        assert!(starts.is_empty() && tube.is_empty() && tube.pop().is_none());
        assert!(tube.feet_brute(V3::zeros(), 1.0, 1.0).is_empty());
        tube.push(V3::zeros(), 0.0);
        tube.gather(V3::zeros(), 1.0, 1.0, &mut starts);
        assert!(starts.is_empty());
        tube.push(V3::new(1e-3, 0.0, 0.0), 1e-3);
        for (x, segment, at_end, foot_x) in [
            (-1e-3, 0, true, 0.0),
            (0.2e-3, 0, false, 0.2e-3),
            (0.7e-3, 1, false, 0.7e-3),
            (3e-3, 1, true, 1e-3),
        ] {
            let p = V3::new(x, 0.5e-3, 0.0);
            tube.gather(p, 5e-3, 1.0, &mut starts);
            assert_eq!(starts, [segment]);
            for start in 0..2 {
                let foot = tube.foot(p, start);
                assert_eq!((foot.segment, foot.at_end), (segment, at_end));
                assert!((foot.point - V3::new(foot_x, 0.0, 0.0)).norm() < 1e-18);
                assert!((tangent_at(&tube, &foot) - V3::x()).norm() < 1e-15);
                assert!((foot.normal * foot.distance - (p - foot.point)).norm() < 1e-18);
            }
        }
        // on the centreline the normal is still a unit vector across the wire
        let foot = tube.foot(V3::new(0.25e-3, 0.0, 0.0), 0);
        assert!(foot.distance == 0.0 && foot.normal.dot(&tangent_at(&tube, &foot)).abs() < 1e-15);
        assert!((foot.normal.norm() - 1.0).abs() < 1e-15);
    }

    #[test]
    fn passages_side_by_side_count_each() {
        // eleven turns, pitch one diameter: a point over the middle one sees those within reach
        let tube = wavy(10e-3, 2.0 * R, 0.0, 0.4e-3, 0.0, 11.0);
        let t = 0.5 * tube.len() as f64;
        let p = on(&tube, t);
        let p = p + V3::new(p.x, 0.0, p.z).normalize() * 0.1 * R;
        let mut starts = Vec::new();
        for (reach, count) in [(0.2 * R, 1), (2.3 * R, 3), (4.3 * R, 5), (6.3 * R, 7)] {
            tube.gather(p, reach, f64::INFINITY, &mut starts);
            assert_eq!(starts.len(), count, "{starts:?}");
        }
        // wire younger than half a turn before p is left out
        let own = tube.arc()[t as usize] - 30e-3;
        tube.gather(p, 4.3 * R, own, &mut starts);
        assert_eq!(starts.len(), 2);
        // a reach past everything looks at everything
        tube.gather(p, 1.0, f64::INFINITY, &mut starts);
        assert!(starts.len() >= 11);
        tube.gather(V3::repeat(1e300), 1.0, f64::INFINITY, &mut starts);
        assert!(starts.is_empty());
    }

    #[test]
    fn beyond_the_centre_of_curvature_a_segment_gives_its_nearer_side() {
        let mut tube = SplineTube::new(R);
        let corners = [(-3.0, 9.0), (-1.0, 3.0), (0.0, 0.0), (1.0, 3.0), (3.0, 9.0)];
        for (i, (x, y)) in corners.into_iter().enumerate() {
            tube.push(V3::new(x, y, 0.0) * 1e-3, i as f64 * 3e-3);
        }
        let mut starts = Vec::new();
        for x in [-0.02e-3, 0.02e-3] {
            let p = V3::new(x, 1.3e-3, 0.0);
            assert_eq!(tube.feet_brute(p, 1e-3, 1.0).len(), 2);
            tube.gather(p, 1e-3, 1.0, &mut starts);
            assert_eq!(starts, [2]);
            let foot = tube.foot(p, 2);
            assert!(foot.point.x * x > 0.0);
            assert!((foot.normal.dot(&tangent_at(&tube, &foot))).abs() < 1e-12);
        }
    }

    #[test]
    fn folded_wire_stays_finite() {
        let mut tube = SplineTube::new(R);
        for (i, x) in [0.0, 1.0, 0.0, 1.0].into_iter().enumerate() {
            tube.push(V3::new(x, 0.0, 0.0) * 1e-3, i as f64 * 1e-3);
        }
        for x in [0.0, 0.25, 0.5, 0.75, 1.0, 2.0] {
            for start in 0..4 {
                let foot = tube.foot(V3::new(x, 0.1, 0.0) * 1e-3, start);
                assert!(
                    (tangent_at(&tube, &foot).norm() - 1.0).abs() < 1e-12,
                    "{foot:?}"
                );
                assert!((foot.normal.norm() - 1.0).abs() < 1e-12);
            }
        }
    }
}
