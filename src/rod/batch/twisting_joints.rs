//! Joints of a rod with twist: what [`twisted`](crate::rod::twisted()) does for one.

use super::{
    CROSS, GRADIENT, JOINT, Joints, LEAD, LEAD_ROLL, OWN, ROLL_OWN, ROLL_WITH, TORQUE, put_places,
    series,
};
use crate::math::simd::{Block, Columns, Lanes, Lanes3, ROWS, WithSimd, run};
use crate::math::{Quat, V3};
use crate::math::{align, rotate};
use crate::rod::forces::{ForceParts, Laws, Load};
use crate::rod::joint::Joint;
use crate::rod::plasticity::{Bend, Scalar, beyond, respond_bend, respond_scalar};
use crate::rod::state::Rod;
use crate::rod::twisting::{Turned, answer, twist_by};
use crate::rod::yield_branch::{YieldBranch, YieldBranches};
use pulp::Simd;

/// Columns of an edge: direction, inverse length, length, frame (i, j, k, w), detour of its shortest way.
const ALONG: usize = 0;
const INVERSE: usize = 3;
const LENGTH: usize = 4;
const FRAME: usize = 5;
const DETOUR: usize = 9;

/// Columns of an edge at the last accepted instant: frame (i, j, k, w), direction.
const FROM: usize = 0;
const START: usize = 4;

/// Columns of a joint's angles and what their derivative needs, see [`Joint`].
const BEND: usize = 0;
const TWIST: usize = 2;
const W: usize = 3;
const V: usize = 4;
const COSINE: usize = 7;
const G: usize = 8;
const G1: usize = 9;

/// Columns of a joint's plastic state: set curvature, rise of the yield moment and that itself, the same of twist, length
/// that it stands for and its inverse.
const STATE: usize = 9;
const SET: usize = 0;
const RISE: usize = 2;
const LIMIT: usize = 3;
const TWIST_SET: usize = 4;
const TWIST_RISE: usize = 5;
const TWIST_LIMIT: usize = 6;
const LV: usize = 7;
const PER_LV: usize = 8;

/// Columns of a joint's answer: direction of the moment, moment, couple, three stiffnesses, free roll, energy, see
/// [`Answer`](crate::rod::twisting::Answer).
const ANSWER: usize = 9;
const DIRECTION: usize = 0;
const PUSH: usize = 2;
const COUPLE: usize = 3;
const STIFF: usize = 4;
const FREE: usize = 7;
const ENERGY: usize = 8;

/// Below this the sine and cosine of a roll are series, see [`align`].
const SMALL_ROLL: f64 = 2e-3;

/// All edges and joints of a rod with twist.
#[derive(Clone, Debug, Default)]
pub struct TwistingJoints {
    edges: usize,
    places: Columns<3>,
    roll: Columns<1>,
    from: Columns<7>,
    edge: Columns<12>,
    angle: Columns<10>,
    state: Columns<STATE>,
    answer: Columns<ANSWER>,
}

impl TwistingJoints {
    /// Frames and directions of all edges at the last accepted instant, and of the clamps.
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

    fn put_clamp(&mut self, frame: &Quat) {
        for (k, x) in clamp(frame).into_iter().enumerate() {
            self.edge.set(k, self.edges, x);
        }
    }

    /// Edges and angles with the nodes at `q` and edges rolled by `roll`.
    pub fn place(&mut self, q: &[V3], roll: &[f64]) {
        put_places(&mut self.places, q);
        self.roll.put(roll, |block, row, x| block.set(0, row, *x));
        // the pass over the edges goes over the far clamp's row
        let far = self.frame(self.edges);
        run(Edges(self));
        self.put_clamp(&far);
        for (j, roll) in roll.iter().enumerate() {
            if roll.abs() >= SMALL_ROLL {
                let from = quaternion(|a| self.from.get(FROM + a, j));
                let frame = align(&from, &self.along(j), *roll);
                for a in 0..4 {
                    self.edge.set(FRAME + a, j, frame.coords[a]);
                }
            }
        }
        self.edge.join();
        run(Angles(self));
        for j in 0..=self.edges {
            let (angle, row) = (&self.angle.blocks()[j / ROWS], j % ROWS);
            let (x, y, z) = (
                angle.get(V, row),
                angle.get(V + 1, row),
                angle.get(V + 2, row),
            );
            let small =
                x * x + y * y < Joint::SERIES && z.abs() < Joint::TWIST_SERIES * angle.get(W, row);
            if !small {
                self.put_large_angles(j);
            }
        }
    }

    #[cold]
    fn put_large_angles(&mut self, j: usize) {
        let before = match j {
            0 => self.frame_before(),
            _ => self.frame(j - 1),
        };
        let joint = Joint::between(&before, &self.frame(j));
        let (bend, g) = (joint.bend, joint.series());
        self.angle.set(BEND, j, bend[0]);
        self.angle.set(BEND + 1, j, bend[1]);
        self.angle.set(TWIST, j, joint.twist);
        self.angle.set(G, j, g[0]);
        self.angle.set(G1, j, g[1]);
    }

    /// Frame of edge `j`; the far clamp's after the last.
    fn frame(&self, j: usize) -> Quat {
        quaternion(|a| self.edge.get(FRAME + a, j))
    }

    /// Frame of the clamp before the first edge.
    fn frame_before(&self) -> Quat {
        quaternion(|a| self.edge.blocks()[0].before(FRAME + a))
    }

    /// Direction of edge `j`.
    #[inline]
    pub fn along(&self, j: usize) -> V3 {
        self.edge.vector(ALONG, j)
    }

    /// Length of edge `j`, m.
    #[inline]
    pub fn length(&self, j: usize) -> f64 {
        self.edge.get(LENGTH, j)
    }

    /// Inverse length of edge `j`, 1/m.
    #[inline]
    pub fn inverse(&self, j: usize) -> f64 {
        self.edge.get(INVERSE, j)
    }

    /// Edge `j` as [`twisted`](crate::rod::twisted()) takes it.
    pub fn turned(&self, j: usize) -> Turned {
        let detour = self.edge.vector(DETOUR, j);
        Turned::known(self.frame(j), self.along(j), self.inverse(j), detour)
    }

    /// Plastic state of the joints from `first` to `last`; the others are none. `length` is what each stands for, and by
    /// how much that spreads its set.
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

    /// Lets the joints answer; returns their energy. `knees`, if there, gets those that may change their branch; those of
    /// bending are for [`Joints::joints`] to complete.
    pub fn respond(&mut self, laws: &Laws, mut yield_branches: Option<&mut YieldBranches>) -> f64 {
        run(Elastic(self, laws));
        if let Some(yield_branches) = &mut yield_branches {
            self.find_twist_knees(laws, &mut yield_branches.twist);
        }
        let mut energy = 0.0;
        for block in 0..self.blocks() {
            let state = &self.state.blocks()[block];
            let angles = &self.angle.blocks()[block];
            let answers = &mut self.answer.blocks_mut()[block];
            for row in 0..ROWS.min(self.edges + 1 - block * ROWS) {
                let j = block * ROWS + row;
                let (trial, limit) = (answers.get(PUSH, row), state.get(LIMIT, row));
                let yields =
                    trial > limit || answers.get(COUPLE, row).abs() > state.get(TWIST_LIMIT, row);
                if !yields {
                    energy += answers.get(ENERGY, row);
                    let rise = state.get(RISE, row);
                    if let Some(yield_branches) = &mut yield_branches
                        && YieldBranch::matters(&laws.bend, trial, rise)
                    {
                        let length = state.get(LV, row);
                        let stiffness = answers.get(STIFF, row);
                        yield_branches.bending.push((
                            j as u32,
                            YieldBranch::elastic(trial, rise, length, stiffness),
                        ));
                    }
                    continue;
                }
                let bend = Bend {
                    curvature: [state.get(SET, row), state.get(SET + 1, row)],
                    rise: state.get(RISE, row),
                };
                let twist = Scalar {
                    strain: state.get(TWIST_SET, row),
                    rise: state.get(TWIST_RISE, row),
                };
                let angle = [angles.get(BEND, row), angles.get(BEND + 1, row)];
                let lv = state.get(LV, row);
                let one = answer(laws, &bend, &twist, lv, angle, angles.get(TWIST, row));
                energy += one.energy;
                let [stiff, across, about] = one.stiffness;
                let [x, y] = one.along;
                let all = [x, y, one.push, one.torque, stiff, across, about, one.free];
                for (k, x) in all.into_iter().enumerate() {
                    answers.set(k, row, x);
                }
                if let (Some(yield_branches), Some(yield_branch)) =
                    (&mut yield_branches, one.yield_branch)
                {
                    yield_branches.bending.push((j as u32, yield_branch));
                }
            }
        }
        energy
    }

    /// Joints that twist near to yielding or beyond it; couples are still those of joints that do not yield.
    fn find_twist_knees(&self, laws: &Laws, yield_branches: &mut Vec<(u32, YieldBranch)>) {
        let law = &laws.twist;
        for (block, (answers, state)) in
            (self.answer.blocks().iter().zip(self.state.blocks())).enumerate()
        {
            for row in 0..ROWS.min(self.edges + 1 - block * ROWS) {
                let (couple, rise) = (answers.get(COUPLE, row), state.get(TWIST_RISE, row));
                if !YieldBranch::matters(law, couple.abs(), rise) {
                    continue;
                }
                let j = block * ROWS + row;
                let before = match j {
                    0 => Turned::clamp(self.frame_before()),
                    _ => self.turned(j - 1),
                };
                let sign = 1f64.copysign(couple);
                let by = twist_by([&before, &self.turned(j)]);
                let lv = state.get(LV, row);
                let elastic = YieldBranch::elastic(couple.abs(), rise, lv, law.modulus / lv);
                let yield_branch = YieldBranch {
                    rows: by.map(|(edge, _)| edge * sign),
                    rolls: by.map(|(_, roll)| roll * sign),
                    ..elastic.at_present(law)
                };
                yield_branches.push((j as u32, yield_branch));
            }
        }
    }

    /// Lets the joints of `rod` answer for [`super::Forces`]; with `parts.commit` their plastic state and the frames move
    /// on. Moments of the clamps, stored energy and plastic work go into `load`.
    pub(super) fn settle(
        &mut self,
        rod: &mut Rod,
        laws: &Laws,
        clamp: &[Option<Quat>; 2],
        parts: ForceParts,
        load: &mut Load,
    ) {
        load.plastic = [0.0; 3];
        load.clamp_moment = [V3::zeros(); 2];
        load.stored = 0.0;
        load.beyond = 0.0;
        for j in 0..=self.edges {
            let (block, row) = (j / ROWS, j % ROWS);
            let end = (j == 0, j == self.edges);
            let was = || Joint::between(&rod.frame[j - 1], &rod.frame[j]);
            let inner = !end.0 && !end.1;
            let missing = (end.0 && clamp[0].is_none()) || (end.1 && clamp[1].is_none());
            let (mut m, mut torque) = ([0.0; 2], 0.0);
            if !missing {
                let angles = &self.angle.blocks()[block];
                let angle = [angles.get(BEND, row), angles.get(BEND + 1, row)];
                let lv = rod.voronoi(j);
                let inv = 1.0 / lv;
                let curvature = [angle[0] * inv, angle[1] * inv];
                let (moment, bend, work) = respond_bend(&laws.bend, &rod.bend[j], curvature);
                m = moment;
                load.stored += 0.5 * (m[0] * m[0] + m[1] * m[1]) / laws.bend.modulus * lv;
                if parts.commit && work > 0.0 {
                    if inner {
                        let before = was().bend.map(|angle| angle * inv);
                        let old = respond_bend(&laws.bend, &rod.bend[j], before).0;
                        let set = rod.bend[j].curvature;
                        let way = [0, 1].map(|k| bend.curvature[k] - set[k]);
                        load.beyond += beyond(old, m, way, work) * lv;
                    }
                    rod.bend[j] = bend;
                    load.plastic[0] += work * lv;
                }
                if parts.twist {
                    let rate = angles.get(TWIST, row) * inv;
                    let (t, twist, work) = respond_scalar(&laws.twist, &rod.twist[j], rate);
                    torque = t;
                    load.stored += 0.5 * t * t / laws.twist.modulus * lv;
                    if parts.commit && work > 0.0 {
                        if inner {
                            let before = was().twist * inv;
                            let old = respond_scalar(&laws.twist, &rod.twist[j], before).0;
                            let way = twist.strain - rod.twist[j].strain;
                            load.beyond += beyond([old], [t], [way], work) * lv;
                        }
                        rod.twist[j] = twist;
                        load.plastic[1] += work * lv;
                    }
                }
            }
            let answers = &mut self.answer.blocks_mut()[block];
            for (k, x) in [m[0], m[1], 1.0, torque].into_iter().enumerate() {
                answers.set(k, row, x);
            }
            if !missing && (end.0 || end.1) {
                let before = if end.0 {
                    clamp[0]
                } else {
                    Some(self.frame(j - 1))
                };
                if let Some(before) = before {
                    let joint = Joint::between(&before, &self.frame(j));
                    let moment = rotate(&before, &joint.moment(m, torque));
                    load.clamp_moment[usize::from(end.1)] = if end.0 { -moment } else { moment };
                }
            }
        }
        if parts.commit {
            for j in 0..self.edges {
                rod.frame[j] = self.frame(j);
            }
        }
    }
}

impl Joints for TwistingJoints {
    fn blocks(&self) -> usize {
        self.edge.blocks().len()
    }

    #[inline(always)]
    fn directions<S: Simd>(&self, simd: S, block: usize, first: usize) -> Lanes3<S> {
        self.edge.blocks()[block].load3(simd, ALONG, first, 1)
    }

    #[inline(always)]
    fn derive<S: Simd, const HESSIAN: bool>(
        &self,
        simd: S,
        block: usize,
        first: usize,
        _near: bool,
        out: &mut Block<JOINT>,
    ) {
        let all = (
            &self.edge.blocks()[block],
            &self.angle.blocks()[block],
            &self.answer.blocks()[block],
        );
        joints::<S, HESSIAN>(simd, all, first, out);
    }
}

/// Columns of a clamp as an edge.
fn clamp(frame: &Quat) -> [f64; 12] {
    let mut all = [0.0; 12];
    all[ALONG..ALONG + 3].copy_from_slice(rotate(frame, &V3::z()).as_slice());
    all[FRAME..FRAME + 4].copy_from_slice(frame.coords.as_slice());
    all
}

fn quaternion(of: impl Fn(usize) -> f64) -> Quat {
    Quat::from_vector(nalgebra::Vector4::new(of(0), of(1), of(2), of(3)))
}

/// First pass: directions, lengths and frames of the edges.
struct Edges<'a>(&'a mut TwistingJoints);

impl WithSimd for Edges<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let b = self.0;
        let one = Lanes::splat(simd, 1.0);
        let places = b.places.blocks().iter();
        let inputs = places.zip(b.from.blocks()).zip(b.roll.blocks());
        for (((q, before), rolls), edge) in inputs.zip(b.edge.blocks_mut()) {
            for j in (0..ROWS).step_by(Lanes::<S>::COUNT) {
                let d = q.load3(simd, 0, j, 2) - q.load3(simd, 0, j, 1);
                let length = d.dot(d).sqrt();
                let inverse = length.recip();
                let t = d * inverse;
                let from: [_; 4] = before.load_all(simd, FROM, j, 1);
                // see `align`: the direction in the body frame, then swing and roll as one turn
                let v = Lanes3::new(from[0], from[1], from[2]);
                let u = t.cross(v);
                let u = u + u;
                let body = t + u * from[3] + u.cross(v);
                let half = rolls.load(simd, 0, j, 1) * 0.5;
                let h2 = half * half;
                let c = one - h2 * 0.5 + h2 * h2 * (1.0 / 24.0);
                let s = half * (one - h2 * (one * (1.0 / 6.0) - h2 * (1.0 / 120.0)));
                let w = body.z + 1.0;
                let turn = [
                    body.x * s - body.y * c,
                    body.x * c + body.y * s,
                    w * s,
                    w * c,
                ];
                let frame = product(from, turn);
                let norm = frame[0] * frame[0]
                    + frame[1] * frame[1]
                    + frame[2] * frame[2]
                    + frame[3] * frame[3];
                let norm = norm.sqrt().recip();
                let start = before.load3(simd, START, j, 1);
                let detour = t.cross(start) * (start.dot(t) + 1.0).recip();
                edge.store3(ALONG, j, t);
                edge.store(INVERSE, j, inverse);
                edge.store(LENGTH, j, length);
                for k in 0..4 {
                    edge.store(FRAME + k, j, frame[k] * norm);
                }
                edge.store3(DETOUR, j, detour);
            }
        }
    }
}

/// Product of quaternions (i, j, k, w).
#[inline(always)]
fn product<S: Simd>(p: [Lanes<S>; 4], q: [Lanes<S>; 4]) -> [Lanes<S>; 4] {
    [
        p[3] * q[0] + p[0] * q[3] + p[1] * q[2] - p[2] * q[1],
        p[3] * q[1] - p[0] * q[2] + p[1] * q[3] + p[2] * q[0],
        p[3] * q[2] + p[0] * q[1] - p[1] * q[0] + p[2] * q[3],
        p[3] * q[3] - p[0] * q[0] - p[1] * q[1] - p[2] * q[2],
    ]
}

/// Second pass: angles of the joints, see [`Joint::between`]; large ones are put right afterwards.
struct Angles<'a>(&'a mut TwistingJoints);

impl WithSimd for Angles<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let b = self.0;
        for (edge, angle) in b.edge.blocks().iter().zip(b.angle.blocks_mut()) {
            for j in (0..ROWS).step_by(Lanes::<S>::COUNT) {
                let p: [_; 4] = edge.load_all(simd, FRAME, j, 0);
                let n = edge.load_all(simd, FRAME, j, 1);
                let [x, y, z, w] = product([-p[0], -p[1], -p[2], p[3]], n);
                let (x, y, z) = (x.with_sign_of(w), y.with_sign_of(w), z.with_sign_of(w));
                let w = w.with_sign_of(w);
                let s2 = x * x + y * y;
                let c = (w * w + z * z).sqrt();
                let g = series(&Joint::ANGLE, s2);
                let g1 = series(&Joint::ANGLE_SLOPE, s2);
                let ratio = z.over(w);
                let twist = ratio * series(&Joint::TWIST, ratio * ratio);
                angle.store(BEND, j, g * x);
                angle.store(BEND + 1, j, g * y);
                angle.store(TWIST, j, twist);
                angle.store(W, j, w);
                angle.store3(V, j, Lanes3::new(x, y, z));
                angle.store(COSINE, j, c);
                angle.store(G, j, g);
                angle.store(G1, j, g1);
            }
        }
    }
}

/// Answers of joints that do not yield, see [`answer`].
struct Elastic<'a>(&'a mut TwistingJoints, &'a Laws);

impl WithSimd for Elastic<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self(all, laws) = self;
        let (bending, twisting) = (laws.bend.modulus, laws.twist.modulus);
        let (per_bending, per_twisting) = (1.0 / bending, 1.0 / twisting);
        let joints = all.angle.blocks().iter().zip(all.state.blocks());
        for ((angle, state), out) in joints.zip(all.answer.blocks_mut()) {
            for j in (0..ROWS).step_by(Lanes::<S>::COUNT) {
                let lv = state.load(simd, LV, j, 1);
                let inv = state.load(simd, PER_LV, j, 1);
                let (a, b) = (
                    angle.load(simd, BEND, j, 1),
                    angle.load(simd, BEND + 1, j, 1),
                );
                let x = (a * inv - state.load(simd, SET, j, 1)) * bending;
                let y = (b * inv - state.load(simd, SET + 1, j, 1)) * bending;
                let twist = angle.load(simd, TWIST, j, 1) * inv;
                let couple = (twist - state.load(simd, TWIST_SET, j, 1)) * twisting;
                let n2 = x * x + y * y;
                let n = n2.sqrt();
                let per_n = n.recip();
                let (zero, one) = (n2.all(0.0), n2.all(1.0));
                let x = (x * per_n).unless_above_zero(n2, one);
                let y = (y * per_n).unless_above_zero(n2, zero);
                let curved = (a * x + b * y) * inv;
                let kept = (curved * (curved - n * per_bending)).at_least(0.0).sqrt();
                let free = (curved - kept.with_sign_of(curved)) * (lv * 0.5);
                let energy = (n2 * per_bending + couple * couple * per_twisting) * (lv * 0.5);
                out.store(DIRECTION, j, x);
                out.store(DIRECTION + 1, j, y);
                out.store(PUSH, j, n);
                out.store(COUPLE, j, couple);
                out.store(STIFF, j, inv * bending);
                out.store(STIFF + 1, j, inv * bending);
                out.store(STIFF + 2, j, inv * twisting);
                out.store(FREE, j, free);
                out.store(ENERGY, j, energy);
            }
        }
    }
}

/// An edge as the third pass sees it.
struct Side<S: Simd> {
    along: Lanes3<S>,
    inverse: Lanes<S>,
    detour: Lanes3<S>,
}

impl<S: Simd> Side<S> {
    #[inline(always)]
    fn load(edge: &Block<12>, simd: S, first: usize, offset: usize) -> Self {
        Self {
            along: edge.load3(simd, ALONG, first, offset),
            inverse: edge.load(simd, INVERSE, first, offset),
            detour: edge.load3(simd, DETOUR, first, offset),
        }
    }

    /// Derivative of an angle by edge vector and roll, see [`Turned::derivative`].
    #[inline(always)]
    fn derivative(&self, row: Lanes3<S>) -> (Lanes3<S>, Lanes<S>) {
        let roll = row.dot(self.along);
        let turn = row.cross(self.along) + self.detour * roll;
        (turn * self.inverse, roll)
    }
}

/// Derivatives of an angle by edge vectors and rolls, first edge with its sign.
#[inline(always)]
fn pair<S: Simd>(before: &Side<S>, after: &Side<S>, row: Lanes3<S>) -> [(Lanes3<S>, Lanes<S>); 2] {
    let (w0, r0) = before.derivative(row);
    [(-w0, -r0), after.derivative(row)]
}

/// Third pass: gradients and Hessians of joints from their answers.
#[inline(always)]
fn joints<S: Simd, const HESSIAN: bool>(
    simd: S,
    (edge, angle, law): (&Block<12>, &Block<10>, &Block<ANSWER>),
    j: usize,
    out: &mut Block<JOINT>,
) {
    let [bend_w, vx, vy, vz, cosine, g, g1] = angle.load_all(simd, W, j, 1);
    let [d0, d1, push, couple, c0, c1, c2, free] = law.load_all(simd, DIRECTION, j, 1);
    // see `Joint::rows`
    let (w, v) = (bend_w, Lanes3::new(vx, vy, vz));
    let (p, q) = (w * v.x - v.z * v.y, w * v.y + v.z * v.x);
    let inv_c = cosine.recip();
    let k = g1 * 0.5 + inv_c;
    let g = g * 0.5;
    let (kx, ky, inv_c2) = (k * v.x, k * v.y, inv_c * inv_c);
    let (gw, gz) = (g * w, g * v.z);
    let rows = [
        Lanes3::new(gw + kx * p, gz + kx * q, -(g * v.y)),
        Lanes3::new(ky * p - gz, gw + ky * q, g * v.x),
    ];
    let turn = matrix(edge.load_all(simd, FRAME, j, 0));
    let lead = turned(&turn, rows[0] * d0 + rows[1] * d1);
    let about = turn[0] * (q * inv_c2) - turn[1] * (p * inv_c2) + turn[2];
    let (before, after) = (Side::load(edge, simd, j, 0), Side::load(edge, simd, j, 1));
    let lead = pair(&before, &after, lead);
    let about = pair(&before, &after, about);
    for e in 0..2 {
        out.store3(GRADIENT[e], j, lead[e].0 * push + about[e].0 * couple);
        out.store(TORQUE + e, j, lead[e].1 * push + about[e].1 * couple);
    }
    if !HESSIAN {
        return;
    }
    let side = turned(&turn, rows[1] * d0 - rows[0] * d1);
    let [(w0, r0), (w1, r1)] = pair(&before, &after, side);
    let side = [
        (w0 + before.detour * (free * before.inverse), r0 + free),
        (w1 + after.detour * (free * after.inverse), r1 + free),
    ];
    for e in 0..2 {
        out.store3(LEAD[e], j, lead[e].0);
        out.store(LEAD_ROLL + e, j, lead[e].1);
    }
    // rows of the three angles, each with its stiffness
    let all = [lead, side, about];
    let c = [c0, c1, c2];
    let edge = [
        [all[0][0].0, all[1][0].0, all[2][0].0],
        [all[0][1].0, all[1][1].0, all[2][1].0],
    ];
    for e in 0..2 {
        let v = [
            edge[e][0].components(),
            edge[e][1].components(),
            edge[e][2].components(),
        ];
        let cv = [
            (edge[e][0] * c[0]).components(),
            (edge[e][1] * c[1]).components(),
            (edge[e][2] * c[2]).components(),
        ];
        let mut at = OWN[e];
        for r in 0..3 {
            for s in 0..r + 1 {
                let sum = cv[0][r] * v[0][s] + cv[1][r] * v[1][s] + cv[2][r] * v[2][s];
                out.store(at, j, sum);
                at += 1;
            }
        }
        if e == 0 {
            let v = [
                edge[1][0].components(),
                edge[1][1].components(),
                edge[1][2].components(),
            ];
            for r in 0..3 {
                for s in 0..3 {
                    let sum = cv[0][r] * v[0][s] + cv[1][r] * v[1][s] + cv[2][r] * v[2][s];
                    out.store(CROSS + 3 * r + s, j, sum);
                }
            }
        }
    }
    let r = [
        [all[0][0].1, all[0][1].1],
        [all[1][0].1, all[1][1].1],
        [all[2][0].1, all[2][1].1],
    ];
    let cr = [
        [r[0][0] * c[0], r[0][1] * c[0]],
        [r[1][0] * c[1], r[1][1] * c[1]],
        [r[2][0] * c[2], r[2][1] * c[2]],
    ];
    let which = [(0, 0), (0, 1), (1, 1)];
    for k in 0..3 {
        let (e, f) = which[k];
        let sum = cr[0][e] * r[0][f] + cr[1][e] * r[1][f] + cr[2][e] * r[2][f];
        out.store(ROLL_OWN + k, j, sum);
    }
    for e in 0..2 {
        for f in 0..2 {
            let sum = all[0][f].0 * cr[0][e] + all[1][f].0 * cr[1][e] + all[2][f].0 * cr[2][e];
            out.store3(ROLL_WITH[e][f], j, sum);
        }
    }
}

/// Product of matrices, given by their columns, with vectors.
#[inline(always)]
fn turned<S: Simd>(m: &[Lanes3<S>; 3], r: Lanes3<S>) -> Lanes3<S> {
    m[0] * r.x + m[1] * r.y + m[2] * r.z
}

/// Columns: the axes of frames (i, j, k, w).
#[inline(always)]
fn matrix<S: Simd>([x, y, z, w]: [Lanes<S>; 4]) -> [Lanes3<S>; 3] {
    let (x2, y2, z2) = (x + x, y + y, z + z);
    let (xx, yy, zz) = (x * x2, y * y2, z * z2);
    let (xy, xz, yz) = (x * y2, x * z2, y * z2);
    let (wx, wy, wz) = (w * x2, w * y2, w * z2);
    let one = x.all(1.0);
    [
        Lanes3::new(one - yy - zz, xy + wz, xz - wy),
        Lanes3::new(xy - wz, one - xx - zz, yz + wx),
        Lanes3::new(xz + wy, yz - wx, one - xx - yy),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::simd::{Width, at_most, width};
    use crate::math::{frame_along, relative};
    use crate::rod::{Section, twisted};
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::{Rng, SeedableRng};

    const LV: f64 = 0.5e-3;

    /// A crooked wire: where it was, where it is, its plastic state.
    struct Wire {
        q: Vec<V3>,
        roll: Vec<f64>,
        frames: Vec<Quat>,
        along: Vec<V3>,
        clamps: [Option<Quat>; 2],
        bend: Vec<Bend>,
        twist: Vec<Scalar>,
    }

    fn wire(seed: u64, edges: usize, crooked: f64) -> Wire {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let mut number = move || rng.next_u32() as f64 / f64::from(u32::MAX) * 2.0 - 1.0;
        let mut some = |size: f64| V3::new(number(), number(), number()) * size;
        let mut q = vec![V3::zeros()];
        let mut along = Vec::new();
        let mut frames: Vec<Quat> = Vec::new();
        let mut roll = Vec::new();
        for j in 0..edges {
            let d = V3::new(0.0, 0.0, LV) + some(crooked * LV);
            q.push(q[j] + d);
            let was = (d + some(0.1 * LV)).normalize();
            let twist = relative([0.0; 2], some(crooked).x);
            frames.push(frame_along(&was, frames.last()) * twist);
            along.push(rotate(&frames[j], &V3::z()));
            roll.push(some(if j % 5 == 0 { 0.1 } else { 1e-3 }).x);
        }
        let state = |k: V3| Bend {
            curvature: [k.x, k.y],
            rise: k.z.abs() * 1e-5,
        };
        Wire {
            clamps: [Some(frames[0]), None],
            bend: (0..=edges).map(|_| state(some(300.0))).collect(),
            twist: (0..=edges)
                .map(|_| Scalar {
                    strain: some(20.0).x,
                    rise: 0.0,
                })
                .collect(),
            q,
            roll,
            frames,
            along,
        }
    }

    fn laws() -> Laws {
        Laws::new(&Section {
            m_y: 5.72e-3,
            t_y: 6e-3,
            ..Section::table1_elastic()
        })
    }

    /// All blocks of joints.
    struct All<'a>(&'a TwistingJoints, &'a mut [(u32, YieldBranch)]);

    impl WithSimd for All<'_> {
        type Output = Vec<Block<JOINT>>;

        #[inline(always)]
        fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
            let Self(batch, mut yield_branches) = self;
            let mut all = vec![Block::default(); batch.blocks()];
            for (block, out) in all.iter_mut().enumerate() {
                batch.joints::<S, true>(simd, block, out, &mut yield_branches);
            }
            assert!(yield_branches.is_empty());
            all
        }
    }

    fn respond(w: &Wire) -> (Vec<Block<JOINT>>, f64, YieldBranches) {
        let mut batch = TwistingJoints::default();
        let mut yield_branches = YieldBranches::default();
        let edges = w.frames.len();
        batch.begin(&w.frames, &w.along, w.clamps);
        batch.place(&w.q, &w.roll);
        let state = (&w.bend[..], &w.twist[..]);
        batch.lay(&laws(), state, [0, edges - 1], |_| (LV, 1.0));
        let energy = batch.respond(&laws(), Some(&mut yield_branches));
        (
            run(All(&batch, &mut yield_branches.bending)),
            energy,
            yield_branches,
        )
    }

    fn turned(w: &Wire, j: usize) -> Turned {
        let d = w.q[j + 1] - w.q[j];
        let l = d.norm();
        Turned::edge(&w.frames[j], &w.along[j], d / l, 1.0 / l, w.roll[j])
    }

    /// The slow twin is one joint at a time.
    #[test]
    fn each_joint_is_that_of_the_rod_one_by_one() {
        for (seed, edges, crooked) in [(1, 30, 0.05), (2, 7, 0.5), (3, 1, 1.0), (4, 17, 0.9)] {
            let w = wire(seed, edges, crooked);
            let (joints, energy, yield_branches) = respond(&w);
            let mut before = w.clamps[0].map(Turned::clamp).expect("there is one");
            let (mut sum, mut count) = (0.0, 0);
            for j in 0..edges {
                let after = turned(&w, j);
                let (bend, twist) = (&w.bend[j], &w.twist[j]);
                let (bent, rolled) = twisted(&laws(), bend, twist, LV, [&before, &after]);
                before = after;
                sum += bent.energy;
                let mut pairs = Vec::new();
                let list = |at: usize, n: usize| (0..n).map(move |k| (at, k));
                let mut compare = |at: usize, want: &[f64]| {
                    let size = want.iter().fold(0.0, |s: f64, x| s.max(x.abs()));
                    for (at, k) in list(at, want.len()) {
                        pairs.push((joints[j / ROWS].get(at + k, j % ROWS), want[k], size));
                    }
                };
                for e in 0..2 {
                    compare(OWN[e], &bent.own[e]);
                    compare(GRADIENT[e], [bent.before, bent.after][e].as_slice());
                    for f in 0..2 {
                        compare(ROLL_WITH[e][f], rolled.with[e][f].as_slice());
                    }
                }
                compare(CROSS, bent.cross.as_flattened());
                compare(ROLL_OWN, &rolled.own);
                compare(TORQUE, &rolled.torque);
                if let Some(yield_branch) = bent.yield_branch {
                    let (number, own) = &yield_branches.bending[count];
                    assert_eq!(*number, j as u32);
                    count += 1;
                    for e in 0..2 {
                        let off = (own.rows[e] - yield_branch.rows[e]).norm();
                        assert!(off <= 1e-9 * yield_branch.rows[e].norm() + 1e-12);
                    }
                    pairs.push((own.moment, yield_branch.moment, yield_branch.moment));
                }
                for (got, want, size) in pairs {
                    assert!(
                        (got - want).abs() <= 1e-9 * size.abs() + 1e-14,
                        "joint {j} of {edges}: {got}, {want} one by one"
                    );
                }
            }
            assert!((energy - sum).abs() <= 1e-12 * sum.abs());
            assert_eq!(count, yield_branches.bending.len());
        }
    }

    /// Couple and stiffness of a joint near its knee of twist are those of its law, its rows those of its twist by finite
    /// differences.
    #[test]
    fn knees_of_twist_are_those_of_the_law() {
        let mut seen = [0; 2];
        for (seed, edges, crooked) in [(8, 30, 2e-3), (9, 17, 0.3)] {
            let make = || {
                let mut w = wire(seed, edges, crooked);
                w.twist.fill(Scalar::default());
                w
            };
            let w = make();
            let (_, _, yield_branches) = respond(&w);
            let twist = |w: &Wire, j: usize| {
                let before = match j {
                    0 => w.clamps[0].map(Turned::clamp).expect("there is one"),
                    _ => turned(w, j - 1),
                };
                Joint::between(&before.frame(), &turned(w, j).frame()).twist
            };
            let couple = |w: &Wire, j: usize, angle: f64| {
                respond_scalar(&laws().twist, &w.twist[j], angle / LV).0
            };
            for (j, yield_branch) in &yield_branches.twist {
                let j = *j as usize;
                let angle = twist(&w, j);
                let (own, far) = (couple(&w, j, angle), couple(&w, j, angle + 1e-7));
                let sign = own.signum();
                assert!(
                    (yield_branch.moment - own.abs()).abs() < 1e-12,
                    "{j}: {yield_branch:?}"
                );
                let stiffness = (far - own) * 1e7;
                let off = (yield_branch.stiffness - stiffness).abs();
                assert!(off < 1e-3 * stiffness, "{j}: {off} of {stiffness}");
                seen[usize::from(yield_branch.branch == 1)] += 1;
                for e in usize::from(j == 0)..2 {
                    let moved = |change: &dyn Fn(&mut Wire, f64)| {
                        let at = |by: f64| {
                            let mut w = make();
                            change(&mut w, by);
                            twist(&w, j)
                        };
                        (at(1.0) - at(-1.0)) * 0.5 * sign
                    };
                    let edge = j + e - 1;
                    let roll = moved(&|w, by| w.roll[edge] += 1e-6 * by) / 1e-6;
                    assert!(
                        (roll - yield_branch.rolls[e]).abs() < 1e-6,
                        "{j}, {e}: {roll}"
                    );
                    for a in 0..3 {
                        // an edge's vector alone: all nodes on its far side move
                        let size = 1e-6 * LV;
                        let shift = |w: &mut Wire, by: f64| {
                            w.q[edge + 1..].iter_mut().for_each(|q| q[a] += size * by);
                        };
                        let row = moved(&shift) / size;
                        let off = (row - yield_branch.rows[e][a]).abs() * LV;
                        assert!(off < 1e-6, "{j}, {e}, {a}: {off}");
                    }
                }
            }
        }
        assert!(seen[0] > 2 && seen[1] > 2, "{seen:?}");
    }

    /// As many at once as there may be: the same to the bit.
    #[test]
    fn width_is_no_matter() {
        for (seed, edges, crooked) in [(5, 30, 0.05), (6, 23, 0.7), (7, 2, 0.2)] {
            let w = wire(seed, edges, crooked);
            let mut seen = Vec::new();
            let all = [Width::One, Width::Four, Width::Eight].map(|most| {
                at_most(most);
                seen.push(width());
                let (joints, energy, _) = respond(&w);
                let mut bits = Vec::new();
                for j in 0..edges {
                    bits.extend((0..JOINT).map(|k| joints[j / ROWS].get(k, j % ROWS).to_bits()));
                }
                (bits, energy.to_bits())
            });
            at_most(Width::Four);
            assert!(all[0] == all[1] && all[1] == all[2], "widths {seen:?}");
        }
    }
}
