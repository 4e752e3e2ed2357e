//! Gradients and Hessians of joints from their answers, for as many joints at once as the machine
//! can.

use super::layout::*;
use crate::math::simd::{Lanes, Lanes3, RowBlock};
use crate::rod::batch::{
    CROSS, GRADIENT, JOINT, LEAD, LEAD_ROLL, OWN, ROLL_OWN, ROLL_WITH, TORQUE,
};
use pulp::Simd;

/// An edge as the third pass sees it.
struct Side<S: Simd> {
    along: Lanes3<S>,
    inverse: Lanes<S>,
    detour: Lanes3<S>,
}

impl<S: Simd> Side<S> {
    #[inline(always)]
    fn load(edge: &RowBlock<12>, simd: S, first: usize, offset: usize) -> Self {
        Self {
            along: edge.load3(simd, ALONG, first, offset),
            inverse: edge.load(simd, INVERSE, first, offset),
            detour: edge.load3(simd, DETOUR, first, offset),
        }
    }

    /// Derivative of an angle by edge vector and roll, see
    /// [`Turned::derivative`](crate::rod::Turned::derivative).
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
pub(super) fn joints<S: Simd, const HESSIAN: bool>(
    simd: S,
    (edge, angle, law): (&RowBlock<12>, &RowBlock<10>, &RowBlock<ANSWER>),
    j: usize,
    out: &mut RowBlock<JOINT>,
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
