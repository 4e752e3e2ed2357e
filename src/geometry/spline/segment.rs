//! The point of one segment of the centreline nearest to a given point: the roots of a cubic.

use crate::math::V3;

/// A share is known when the error left is below this. Coordinates of centimetres round by 1e-18 m,
/// which on a segment of tenths of a millimetre is 1e-14 of it.
const LAST_DIGITS: f64 = 1e-13;

/// Chebyshev steps and halvings together never take longer: 52 halvings use up all digits.
const MOST_STEPS: usize = 64;

/// The point of the centreline nearest to a point p, in one passage of the wire.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Foot {
    /// segment, numbered as its middle node
    pub segment: u32,
    /// where on the segment: `s` of the formula of the curve
    pub share: f64,
    /// the foot, m, in the frame of the curve
    pub point: V3,
    /// distance of p from the centreline, m
    pub distance: f64,
    /// unit direction from the foot to p, the gradient of the distance
    pub normal: V3,
    /// whether the wire ends here, and p may lie beyond its end
    pub at_end: bool,
    /// how far past a seam p lies, m
    pub beyond: f64,
}

impl Foot {
    /// Depth of the point p in the tube of radius `reach` (m) about the centreline, m.
    ///
    /// Negative outside; beyond a seam at most minus the distance past it.
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
pub(super) enum Lies {
    At(f64),
    Before,
    Beyond,
}

/// One segment as a cubic problem for a point p: C(s) - p = start + s before + s^2/2 bend.
///
/// `low` and `high` bound the share that is wire; `g_low` and `g_high` are g = (C - p) C' there.
pub(super) struct SegmentView {
    pub(super) start: V3,
    pub(super) before: V3,
    pub(super) bend: V3,
    pub(super) low: f64,
    pub(super) high: f64,
    pub(super) g_low: f64,
    pub(super) g_high: f64,
    /// coefficients of g, constant first
    pub(super) g: [f64; 4],
}

impl SegmentView {
    /// C(s) - p
    #[inline(always)]
    pub(super) fn arm(&self, s: f64) -> V3 {
        self.start + (self.before + self.bend * (0.5 * s)) * s
    }

    /// C'(s)
    #[inline(always)]
    pub(super) fn along(&self, s: f64) -> V3 {
        self.before + self.bend * s
    }

    #[inline(always)]
    fn g(&self, s: f64) -> f64 {
        let [a, b, c, d] = self.g;
        a + s * (b + s * (c + s * d))
    }

    /// Whether the distance falls at the start and rises at the end.
    #[inline(always)]
    pub(super) fn rises(&self) -> bool {
        self.g_low < 0.0 && self.g_high >= 0.0
    }

    /// The local minimum on a segment that [`Self::rises`]; of two the nearer.
    #[inline(always)]
    pub(super) fn dip(&self) -> f64 {
        match self.hump() {
            None => self.root((self.low, self.g_low), (self.high, self.g_high)),
            Some(hump) => self.nearer_dip(hump),
        }
    }

    /// The nearest local minimum on this segment, or else the way downhill.
    pub(super) fn minimum(&self) -> Lies {
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
    pub(super) fn tangent(&self, s: f64) -> V3 {
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
    pub(super) fn foot(&self, p: V3, segment: usize, s: f64, at_end: bool) -> Foot {
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
pub(super) fn across(tangent: &V3) -> V3 {
    let axis = tangent.iamin();
    let mut unit = V3::zeros();
    unit[axis] = 1.0;
    tangent.cross(&unit).normalize()
}
