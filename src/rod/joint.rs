//! How two neighbouring edge frames stand to each other: two bending angles and a twist angle.
//!
//! Each edge carries a unit quaternion whose body z axis is the edge direction (the paper's
//! zeta axis). The relative quaternion of two edges splits into a swing, which takes one
//! direction to the other along the shortest way, and a twist about z. The swing angle is the
//! turning angle itself, exact on an arc and bounded at a fold; its axis, seen half-way through
//! the twist, gives two bending components that neither edge prefers. The moment is the exact
//! derivative of the energy, whatever the plastic state.

use crate::math::{Quat, V3, relative, rotate};

/// Bending and twist angle between two edge frames, and what their derivative needs.
#[derive(Clone, Copy, Debug)]
pub struct Joint {
    /// turning angle times its axis in the mid frame, rad
    pub bend: [f64; 2],
    /// twist angle, rad, in (-pi, pi]
    pub twist: f64,
    w: f64,
    v: V3,
    /// cosine of half the turning angle
    c: f64,
    /// turning angle over the sine of its half
    g: f64,
    /// derivative of `g`, see [`Joint::moment`]
    g1: f64,
}

impl Joint {
    /// Below this squared half-angle sine the series of the turning angle hold to 1e-13.
    pub(super) const SERIES: f64 = 0.04;
    /// Series of the angle over the sine of its half, by powers of the sine squared.
    pub(super) const ANGLE: [f64; 8] = [
        2.0,
        1.0 / 3.0,
        3.0 / 20.0,
        5.0 / 56.0,
        35.0 / 576.0,
        63.0 / 1408.0,
        231.0 / 6656.0,
        143.0 / 5120.0,
    ];
    /// Series of the slope of that ratio.
    pub(super) const ANGLE_SLOPE: [f64; 7] = [
        -4.0 / 3.0,
        -2.0 / 5.0,
        -3.0 / 14.0,
        -5.0 / 36.0,
        -35.0 / 352.0,
        -63.0 / 832.0,
        -77.0 / 1280.0,
    ];
    /// Below this tangent of half the twist its series holds to 1e-13.
    pub(super) const TWIST_SERIES: f64 = 0.1;
    /// Series of the twist over that tangent, by powers of the tangent squared.
    pub(super) const TWIST: [f64; 6] = [
        2.0,
        -2.0 / 3.0,
        2.0 / 5.0,
        -2.0 / 7.0,
        2.0 / 9.0,
        -2.0 / 11.0,
    ];

    /// The series `g` and `g1` at this turning angle.
    pub(super) fn series(&self) -> [f64; 2] {
        [self.g, self.g1]
    }

    /// Angles between the frames of two edges, `prev` on the clamp side.
    #[inline]
    pub fn between(prev: &Quat, next: &Quat) -> Self {
        let rel = prev.conjugate() * next;
        // q and -q are one rotation; the half with w > 0 has the twist within half a turn
        let sign = if rel.w < 0.0 { -1.0 } else { 1.0 };
        let (w, x, y, z) = (sign * rel.w, sign * rel.i, sign * rel.j, sign * rel.k);
        let s2 = x * x + y * y;
        let c = (w * w + z * z).sqrt();
        let (g, g1) = if s2 < Self::SERIES {
            (series(&Self::ANGLE, s2), series(&Self::ANGLE_SLOPE, s2))
        } else {
            let s = s2.sqrt();
            let g = 2.0 * libm::atan2(s, c) / s;
            (g, (2.0 * c - g) / s2)
        };
        let ratio = if w > 0.0 { z / w } else { f64::INFINITY };
        let twist = if ratio.abs() < Self::TWIST_SERIES {
            ratio * series(&Self::TWIST, ratio * ratio)
        } else {
            2.0 * libm::atan2(z, w)
        };
        Self {
            bend: [g * x, g * y],
            twist,
            w,
            v: V3::new(x, y, z),
            c,
            g,
            g1,
        }
    }

    /// Derivatives of `bend[0]`, `bend[1]` and `twist` with respect to a rotation of the edge after
    /// the joint, in the frame of the edge before it.
    ///
    /// With the relative quaternion `(w, x, y, z)` an angle `a` has the derivative
    /// `(w grad a - v da/dw + v x grad a) / 2`; for these angles nearly all of it cancels.
    #[inline]
    pub fn rows(&self) -> [V3; 3] {
        let (w, v) = (self.w, self.v);
        let (p, q) = (w * v.x - v.z * v.y, w * v.y + v.z * v.x);
        let inv_c = 1.0 / self.c;
        let k = 0.5 * self.g1 + inv_c;
        let g = 0.5 * self.g;
        let (kx, ky, inv_c2) = (k * v.x, k * v.y, inv_c * inv_c);
        [
            V3::new(g * w + kx * p, g * v.z + kx * q, -g * v.y),
            V3::new(ky * p - g * v.z, g * w + ky * q, g * v.x),
            V3::new(q * inv_c2, -p * inv_c2, 1.0),
        ]
    }

    /// Moment that the joint passes from the edge before it to the edge after it, in the frame
    /// of the edge before, N m: the energy changes by it times the relative rotation.
    ///
    /// `m` is the derivative of the energy with respect to `bend`, `t` to `twist`.
    #[inline]
    pub fn moment(&self, m: [f64; 2], t: f64) -> V3 {
        let rows = self.rows();
        rows[0] * m[0] + rows[1] * m[1] + rows[2] * t
    }
}

/// A vector with components `k` in the frame half-way between the frames of two edges.
pub fn mid_frame_vector(p: &Quat, n: &Quat, k: [f64; 2]) -> V3 {
    let joint = Joint::between(p, n);
    let half = relative([0.5 * joint.bend[0], 0.5 * joint.bend[1]], 0.0);
    let (s, c) = (libm::sin(0.25 * joint.twist), libm::cos(0.25 * joint.twist));
    let mid = p * Quat::new(c, 0.0, 0.0, s) * half;
    rotate(&mid, &V3::new(k[0], k[1], 0.0))
}

/// A polynomial by its coefficients.
#[inline(always)]
fn series<const N: usize>(terms: &[f64; N], x: f64) -> f64 {
    let mut sum = x * terms[N - 1];
    for t in terms[1..N - 1].iter().rev() {
        sum = x * (sum + t);
    }
    sum + terms[0]
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn quat(a: [f64; 4]) -> Quat {
        let q = Quat::new(a[0], a[1], a[2], a[3]);
        q / q.norm()
    }

    fn turn(axis: V3, angle: f64) -> Quat {
        let v = axis * (0.5 * angle).sin();
        Quat::new((0.5 * angle).cos(), v.x, v.y, v.z)
    }

    fn energy(p: &Quat, n: &Quat, coef: [f64; 5]) -> f64 {
        // any smooth function of the angles, bending not parallel to its moment
        let j = Joint::between(p, n);
        let [b1, b2] = j.bend;
        0.5 * coef[0] * (b1 - coef[3]).powi(2)
            + 0.5 * coef[1] * (b2 - coef[4]).powi(2)
            + 0.5 * coef[2] * j.twist * j.twist
    }

    fn check_moment(p: Quat, n: Quat, coef: [f64; 5]) {
        let j = Joint::between(&p, &n);
        let m = [
            coef[0] * (j.bend[0] - coef[3]),
            coef[1] * (j.bend[1] - coef[4]),
        ];
        let moment = rotate(&p, &j.moment(m, coef[2] * j.twist));
        let h = 1e-6;
        for axis in [V3::x(), V3::y(), V3::z()] {
            let de =
                energy(&p, &(turn(axis, h) * n), coef) - energy(&p, &(turn(axis, -h) * n), coef);
            let got = de / (2.0 * h);
            assert!(
                (got - moment.dot(&axis)).abs() < 1e-7 * (1.0 + moment.norm()),
                "{got} {moment:?}"
            );
            let de =
                energy(&(turn(axis, h) * p), &n, coef) - energy(&(turn(axis, -h) * p), &n, coef);
            assert!((de / (2.0 * h) + moment.dot(&axis)).abs() < 1e-7 * (1.0 + moment.norm()));
        }
    }

    proptest! {
        #[test]
        fn moment_is_the_derivative(a in prop::array::uniform4(-1.0..1.0f64), bend in prop::array::uniform2(-1.5..1.5f64),
            twist in -1.5..1.5f64, coef in prop::array::uniform5(-1.0..1.0f64)) {
            prop_assume!(a.iter().map(|x| x * x).sum::<f64>() > 0.1);
            let p = quat(a);
            check_moment(p, p * relative(bend, twist), coef);
        }

        #[test]
        fn small_angles_too(bend in prop::array::uniform2(-1e-3..1e-3f64), twist in -1e-3..1e-3f64, coef in prop::array::uniform5(-1.0..1.0f64)) {
            let p = quat([0.3, -0.5, 0.7, 0.2]);
            check_moment(p, p * relative(bend, twist), coef);
        }

        #[test]
        fn relative_is_the_inverse(bend in prop::array::uniform2(-1.5..1.5f64), twist in -2.0..2.0f64) {
            let p = quat([0.3, -0.5, 0.7, 0.2]);
            let j = Joint::between(&p, &(p * relative(bend, twist)));
            prop_assert!((j.bend[0] - bend[0]).abs() + (j.bend[1] - bend[1]).abs() + (j.twist - twist).abs() < 1e-11);
        }
    }

    #[test]
    fn straight_and_folded_joints_are_finite() {
        let p = quat([0.9, 0.1, -0.3, 0.2]);
        check_moment(p, p, [1.0, 2.0, 3.0, 0.1, -0.2]);
        let j = Joint::between(&p, &(p * relative([3.1, 0.0], 0.0)));
        assert!((j.bend[0] - 3.1).abs() < 1e-12);
        assert!(j.moment([1.0, 0.5], 0.2).norm().is_finite());
    }
}
