//! Passes over all edges, all angles and the answers of all joints that do not yield.

use super::layout::*;
use crate::math::simd::{Lanes, Lanes3, ROWS, WithSimd};
use crate::rod::batch::series;
use crate::rod::forces::Laws;
use crate::rod::joint::Joint;
use crate::rod::yield_branch::FAR;
use pulp::Simd;

/// First pass: directions, lengths and frames of the edges.
pub(super) struct Edges<'a>(pub(super) &'a mut TwistingJoints);

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
pub(super) struct Angles<'a>(pub(super) &'a mut TwistingJoints);

impl WithSimd for Angles<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let b = self.0;
        let blocks = b.edge.blocks().iter().zip(b.angle.blocks_mut());
        b.large.clear();
        for (edge, angle) in blocks {
            let mut large = Lanes::splat(simd, 0.0);
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
                let small = s2.all(Joint::SERIES).above(s2);
                let small = small * (w * Joint::TWIST_SERIES).above(z.abs());
                large += w.all(1.0) - small;
            }
            b.large.push(large.most() > 0.0);
        }
    }
}

/// Answers of joints that do not yield, see [`answer`](crate::rod::twisting::answer).
pub(super) struct Elastic<'a>(pub(super) &'a mut TwistingJoints, pub(super) &'a Laws);

impl WithSimd for Elastic<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self(all, laws) = self;
        let (bending, twisting) = (laws.bend.modulus, laws.twist.modulus);
        let (per_bending, per_twisting) = (1.0 / bending, 1.0 / twisting);
        let joints = all.angle.blocks().iter().zip(all.state.blocks());
        all.near.clear();
        for ((angle, state), out) in joints.zip(all.answer.blocks_mut()) {
            let (mut bent, mut twisted) = (Lanes::splat(simd, 0.0), Lanes::splat(simd, 0.0));
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
                bent += n.above(state.load(simd, LIMIT, j, 1) * FAR);
                twisted += couple
                    .abs()
                    .above(state.load(simd, TWIST_LIMIT, j, 1) * FAR);
            }
            all.near.push([bent.most() > 0.0, twisted.most() > 0.0]);
        }
    }
}
