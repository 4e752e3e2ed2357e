//! Columns in which edges and joints lie, and what is put into them and taken out by number.

use crate::math::simd::Columns;
use crate::math::simd::ROWS;
use crate::math::{Quat, V3, rotate};
use crate::rod::forces::Laws;
use crate::rod::plasticity::{Bend, Scalar};
use crate::rod::twisting::Turned;

/// Columns of an edge: direction, inverse length, length, frame (i, j, k, w), detour of its
/// shortest way.
pub(super) const ALONG: usize = 0;
pub(super) const INVERSE: usize = 3;
pub(super) const LENGTH: usize = 4;
pub(super) const FRAME: usize = 5;
pub(super) const DETOUR: usize = 9;

/// Columns of an edge at the last accepted instant: frame (i, j, k, w), direction.
pub(super) const FROM: usize = 0;
pub(super) const START: usize = 4;

/// Columns of a joint's angles and what their derivative needs, see [`Joint`](crate::rod::Joint).
pub(super) const BEND: usize = 0;
pub(super) const TWIST: usize = 2;
pub(super) const W: usize = 3;
pub(super) const V: usize = 4;
pub(super) const COSINE: usize = 7;
pub(super) const G: usize = 8;
pub(super) const G1: usize = 9;

/// Columns of a joint's plastic state: set curvature, rise of the yield moment, yield moment, these
/// three of twist, Voronoi length and its inverse.
pub(super) const STATE: usize = 9;
pub(super) const SET: usize = 0;
pub(super) const RISE: usize = 2;
pub(super) const LIMIT: usize = 3;
pub(super) const TWIST_SET: usize = 4;
pub(super) const TWIST_RISE: usize = 5;
pub(super) const TWIST_LIMIT: usize = 6;
pub(super) const LV: usize = 7;
pub(super) const PER_LV: usize = 8;

/// Columns of a joint's answer: direction of the moment, moment, couple, three stiffnesses, free
/// roll, energy, see [`Answer`](crate::rod::twisting::Answer).
pub(super) const ANSWER: usize = 9;
pub(super) const DIRECTION: usize = 0;
pub(super) const PUSH: usize = 2;
pub(super) const COUPLE: usize = 3;
pub(super) const STIFF: usize = 4;
pub(super) const FREE: usize = 7;
pub(super) const ENERGY: usize = 8;

/// All edges and joints of a rod with twist, in columns.
///
/// Row `j` is edge `j` and the joint before it; the far clamp follows the last edge.
#[derive(Clone, Debug, Default)]
pub struct TwistingJoints {
    pub(super) edges: usize,
    pub(super) places: Columns<3>,
    pub(super) roll: Columns<1>,
    pub(super) from: Columns<7>,
    pub(super) edge: Columns<12>,
    pub(super) angle: Columns<10>,
    pub(super) state: Columns<STATE>,
    pub(super) answer: Columns<ANSWER>,
    /// whether a block has an angle too large for the series
    pub(super) large: Vec<bool>,
    /// whether a block has a joint that yields, or may change its branch: in bending, in twist
    pub(super) near: Vec<[bool; 2]>,
}

impl TwistingJoints {
    /// Takes over the frames and directions of all edges at the last accepted instant, and the
    /// frames of the clamps.
    pub fn begin(&mut self, frames: &[Quat], along: &[V3], clamps: [Option<Quat>; 2]) {
        self.edges = frames.len();
        let rows = self.edges + 1;
        self.places.fit(rows);
        self.roll.fit(rows);
        self.from.fit(rows);
        self.edge.fit(rows);
        self.angle.fit(rows);
        self.state.fit(rows);
        self.answer.fit(rows);
        for (j, (f, t)) in frames.iter().zip(along).enumerate() {
            for a in 0..4 {
                self.from.set(FROM + a, j, f.coords[a]);
            }
            self.from.set_vector(START, j, t);
        }
        // without a clamp there is no joint; any frame will do
        let of = |end: usize| clamps[end].unwrap_or(frames[end * (self.edges - 1)]);
        for (k, x) in clamp(&of(0)).into_iter().enumerate() {
            self.edge.set_before(k, x);
        }
        self.put_clamp(&of(1));
    }

    pub(super) fn put_clamp(&mut self, frame: &Quat) {
        for (k, x) in clamp(frame).into_iter().enumerate() {
            self.edge.set(k, self.edges, x);
        }
    }

    /// Unit direction of edge `j`.
    pub(super) fn along(&self, j: usize) -> V3 {
        self.edge.vector(ALONG, j)
    }

    /// Frame of edge `j`; the far clamp's after the last.
    pub(super) fn frame(&self, j: usize) -> Quat {
        quaternion(|a| self.edge.get(FRAME + a, j))
    }

    /// Frame of the clamp before the first edge.
    pub(super) fn frame_before(&self) -> Quat {
        quaternion(|a| self.edge.blocks()[0].before(FRAME + a))
    }

    /// Edge `j` as [`twisted`](crate::rod::twisted()) takes it.
    pub fn turned(&self, j: usize) -> Turned {
        let detour = self.edge.vector(DETOUR, j);
        Turned::known(
            self.frame(j),
            self.along(j),
            self.edge.get(INVERSE, j),
            detour,
        )
    }

    /// Takes over the plastic state of the joints from `first` to `last`; other joints carry no
    /// moment.
    ///
    /// `length` gives the Voronoi length of a joint, m, and the factor on its set curvature and
    /// twist.
    pub fn lay(
        &mut self,
        laws: &Laws,
        (bend, twist): (&[Bend], &[Scalar]),
        [first, last]: [usize; 2],
        length: impl Fn(usize) -> (f64, f64),
    ) {
        for j in 0..=self.edges {
            let (state, row) = (&mut self.state.blocks_mut()[j / ROWS], j % ROWS);
            let mut put = |values: [f64; STATE]| {
                for (k, x) in values.into_iter().enumerate() {
                    state.set(k, row, x);
                }
            };
            if j < first || j > last {
                put([0.0; STATE]);
                continue;
            }
            let (bend, twist, (lv, share)) = (&bend[j], &twist[j], length(j));
            put([
                bend.curvature[0] * share,
                bend.curvature[1] * share,
                bend.rise,
                laws.bend.limit + bend.rise,
                twist.strain * share,
                twist.rise,
                laws.twist.limit + twist.rise,
                lv,
                1.0 / lv,
            ]);
        }
    }
}

/// Columns of a clamp as an edge.
fn clamp(frame: &Quat) -> [f64; 12] {
    let mut all = [0.0; 12];
    all[ALONG..ALONG + 3].copy_from_slice(rotate(frame, &V3::z()).as_slice());
    all[FRAME..FRAME + 4].copy_from_slice(frame.coords.as_slice());
    all
}

pub(super) fn quaternion(of: impl Fn(usize) -> f64) -> Quat {
    Quat::from_vector(nalgebra::Vector4::new(of(0), of(1), of(2), of(3)))
}
