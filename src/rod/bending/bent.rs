//! One joint that bends: the slow twin of [`BendingJoints`](crate::rod::BendingJoints), for tests.

use super::set_curvature::{half_way, spin_per_way};
use super::{FOLD, angle_over_tangent, respond};
use crate::math::{Block, V3, add_outer};
use crate::rod::plasticity::Law;
use crate::rod::yield_branch::YieldBranch;

/// Energy of a joint between two edges, and its derivatives by the edge vectors before and after
/// it.
///
/// For a joint with twist ([`crate::rod::twisted()`]) the part without rolls.
#[derive(Clone, Copy, Debug)]
pub struct Bent {
    /// energy, J
    pub energy: f64,
    /// gradient by the edge vector before the joint, N
    pub before: V3,
    /// gradient by the edge vector after the joint, N
    pub after: V3,
    /// Gauss-Newton Hessian, before-before and after-after, N/m
    pub own: [Symmetric; 2],
    /// Gauss-Newton Hessian, rows before, columns after, N/m
    pub cross: Block,
    /// set where the law may change its branch
    pub yield_branch: Option<YieldBranch>,
}

/// Bending of a joint between two edges without twist.
///
/// The edges have the unit directions `t` and the inverse lengths `il`, 1/m. The plastic curvature
/// `set` is a vector, 1/m, in the frame of `t`. It turns [along with the wire](super::SetCurvature).
/// The yield moment has risen by `rise`, N m. The Voronoi length is `lv`, m.
#[inline]
pub fn bent(law: &Law, set: &V3, rise: f64, lv: f64, t: [&V3; 2], il: [f64; 2]) -> Bent {
    let chi = (1.0 + t[0].dot(t[1])).max(FOLD);
    let f = 2.0 / chi;
    let kb = t[0].cross(t[1]) * f;
    let (s, s1) = angle_over_tangent(kb.norm_squared());
    let inv = 1.0 / lv;
    let trial = (kb * (s * inv) - set) * law.modulus;
    // moment and tangent, both of the angle
    let (moment, energy, along, across, dir) = respond(law, trial, rise);
    let near = dir != V3::zeros();
    let stiffness = along * inv;
    let (energy, c_across, c_along) = (energy * lv, across * inv, (along - across) * inv);
    // in terms of the curvature binormal: angle = s(kb^2) kb
    let kb2 = kb.norm_squared();
    let turn = |a: &V3| a * s + kb * (2.0 * s1 * kb.dot(a));
    let g = turn(&moment);
    let t_sum = (t[0] + t[1]) * (0.5 * f);
    let kg = t_sum * kb.dot(&g);
    // the plastic curvature turns too
    let (per_way, middle) = (spin_per_way(t), half_way(t));
    let spin = |v: &V3| per_way * (middle.dot(&kb.cross(v)) * s);
    let before = (t[1].cross(&g) * f - kg - spin(&moment)) * il[0];
    let after = (t[0].cross(&g) * -f - kg + spin(&moment)) * il[1];
    // S (c I + (c' - c) d d^T) S with S = s I + 2 s' kb kb^T is c1 I + c2 kb kb^T + c3 (S d)(S d)^T
    let c1 = s * s * c_across;
    let c2 = 4.0 * s1 * (s + s1 * kb2) * c_across;
    // gradients G = (+-f [t]x - kb ts^T) / l of the binormal, transposed, on kb and on S d
    let a = [kb.cross(t[1]), kb.cross(t[0])];
    let on = |v: &V3, cross: [V3; 2]| {
        let kv = kb.dot(v);
        [
            (cross[0] * -f - t_sum * kv) * il[0],
            (cross[1] * f - t_sum * kv) * il[1],
        ]
    };
    let u = on(&kb, a);
    let cf = c1 * f;
    let cf2 = cf * f;
    let ck = c1 * kb2;
    // across the plane of the edges the plastic curvature keeps up with the angle but for s, where the angle turns by s f
    let less = -0.25 * c1;
    let scale = [il[0] * il[0], il[0] * il[1], il[1] * il[1]];
    let mut own = [[0.0; 6]; 2];
    for (k, (other, sign)) in [(t[1], cf), (t[0], -cf)].into_iter().enumerate() {
        let s = scale[2 * k];
        let h = &mut own[k];
        for d in [0, 2, 5] {
            h[d] = cf2 * s;
        }
        add_square(h, other, -cf2 * s);
        let w = (a[k] * sign + t_sum * (0.5 * ck)) * s;
        add_pair(h, &w, &t_sum);
        add_square(h, &u[k], c2);
        add_square(h, &kb, less * (f + 1.0) * s);
    }
    let s = scale[1];
    let mut cross = scaled_identity(-cf2 * t[0].dot(t[1]) * s);
    add_outer(&mut cross, t[0], &(t[1] * (cf2 * s)));
    add_outer(&mut cross, &((a[0] * cf + t_sum * ck) * s), &t_sum);
    add_outer(&mut cross, &(t_sum * (-cf * s)), &a[1]);
    add_outer(&mut cross, &(u[0] * c2), &u[1]);
    add_outer(&mut cross, &(kb * (less * (f - 1.0) * s)), &kb);
    let mut yield_branch = None;
    if near {
        let d = turn(&dir);
        let mut w = on(&d, [d.cross(t[1]), d.cross(t[0])]);
        w[0] -= spin(&dir) * il[0];
        w[1] += spin(&dir) * il[1];
        yield_branch = Some(YieldBranch {
            rows: w,
            rolls: [0.0; 2],
            trial: trial.dot(&dir),
            length: lv,
            rise,
            moment: moment.dot(&dir),
            stiffness,
            branch: i8::from(along != law.modulus),
        });
        add_square(&mut own[0], &w[0], c_along);
        add_square(&mut own[1], &w[1], c_along);
        add_outer(&mut cross, &(w[0] * c_along), &w[1]);
    }
    Bent {
        energy,
        before,
        after,
        own,
        cross,
        yield_branch,
    }
}

#[inline]
fn scaled_identity(c: f64) -> Block {
    [[c, 0.0, 0.0], [0.0, c, 0.0], [0.0, 0.0, c]]
}

/// A symmetric 3 by 3 block of a Hessian by its lower half, row by row.
pub type Symmetric = [f64; 6];

/// Adds `c a a^T` to `m`.
#[inline]
pub fn add_square(m: &mut Symmetric, a: &V3, c: f64) {
    let b = a * c;
    m[0] += b.x * a.x;
    m[1] += b.y * a.x;
    m[2] += b.y * a.y;
    m[3] += b.z * a.x;
    m[4] += b.z * a.y;
    m[5] += b.z * a.z;
}

/// Adds `a b^T + b a^T`.
#[inline]
fn add_pair(m: &mut Symmetric, a: &V3, b: &V3) {
    m[0] += 2.0 * a.x * b.x;
    m[1] += a.y * b.x + b.y * a.x;
    m[2] += 2.0 * a.y * b.y;
    m[3] += a.z * b.x + b.z * a.x;
    m[4] += a.z * b.y + b.z * a.y;
    m[5] += 2.0 * a.z * b.z;
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rod::bending::{SetCurvature, stretched, turning};
    use crate::rod::plasticity::Scalar;
    use proptest::prelude::*;

    fn law(limit: f64) -> Law {
        Law::new(3.06e-3, 1.13e-4, limit, f64::INFINITY)
    }

    fn at(l: &Law, set: &V3, rise: f64, lv: f64, e: [V3; 2]) -> Bent {
        let (a, b) = (e[0].norm(), e[1].norm());
        bent(
            l,
            set,
            rise,
            lv,
            [&(e[0] / a), &(e[1] / b)],
            [1.0 / a, 1.0 / b],
        )
    }

    fn check(l: &Law, set: V3, rise: f64, e: [V3; 2]) {
        let lv = 0.5e-3;
        let t = e.map(|e| e.normalize());
        let mid = (t[0] + t[1]).try_normalize(1e-3).unwrap_or(V3::z());
        let set = set - mid * set.dot(&mid);
        let carried = SetCurvature::new(set, [&t[0], &t[1]]);
        let b = at(l, &set, rise, lv, e);
        let h = 1e-9;
        for which in 0..2 {
            for axis in [V3::x(), V3::y(), V3::z()] {
                let energy = |s: f64| {
                    let mut m = e;
                    m[which] += axis * (s * h);
                    let t = m.map(|e| e.normalize());
                    at(l, &carried.at([&t[0], &t[1]]), rise, lv, m).energy
                };
                let got = (energy(1.0) - energy(-1.0)) / (2.0 * h);
                let want = [b.before, b.after][which].dot(&axis);
                let scale = b.before.norm() + b.after.norm() + 1e-3;
                assert!((got - want).abs() < 2e-5 * scale, "{got} {want} {e:?}");
            }
        }
    }

    /// Where the moment vanishes the neglected part of the Hessian does too.
    fn check_hessian(e: [V3; 2]) {
        let l = law(f64::INFINITY);
        let lv = 0.5e-3;
        let t = [e[0].normalize(), e[1].normalize()];
        let set = turning([&t[0], &t[1]]) / lv;
        let carried = SetCurvature::new(set, [&t[0], &t[1]]);
        let b = at(&l, &set, 0.0, lv, e);
        let h = 1e-9;
        let whole = |m: &Symmetric| {
            crate::math::M3::new(m[0], m[1], m[3], m[1], m[2], m[4], m[3], m[4], m[5])
        };
        let h3 = [
            whole(&b.own[0]),
            crate::math::M3::from(b.cross).transpose(),
            whole(&b.own[1]),
        ];
        let scale = h3.iter().map(|m| m.norm()).fold(0.0, f64::max);
        for (which, axis) in [(0, 0), (0, 1), (0, 2), (1, 0), (1, 1), (1, 2)] {
            let gradient = |s: f64| {
                let mut m = e;
                m[which][axis] += s * h;
                let t = m.map(|e| e.normalize());
                let b = at(&l, &carried.at([&t[0], &t[1]]), 0.0, lv, m);
                [b.before, b.after]
            };
            let (p, n) = (gradient(1.0), gradient(-1.0));
            for row in 0..2 {
                let got = (p[row] - n[row]) / (2.0 * h);
                let want = match (row, which) {
                    (0, 0) => h3[0].column(axis).into_owned(),
                    (0, 1) => h3[1].column(axis).into_owned(),
                    (1, 0) => h3[1].transpose().column(axis).into_owned(),
                    _ => h3[2].column(axis).into_owned(),
                };
                assert!((got - want).norm() < 1e-5 * scale, "{got:?} {want:?}");
            }
        }
    }

    fn edge() -> impl Strategy<Value = V3> {
        (0.2..1.0f64, -1.0..1.0f64, -1.0..1.0f64).prop_map(|(x, y, z)| V3::new(x, y, z) * 5e-4)
    }

    proptest! {
        #[test]
        fn gradient_of_the_energy(a in edge(), b in edge(), set in prop::array::uniform3(-100.0..100.0f64), rise in 0.0..0.1f64) {
            check(&law(f64::INFINITY), V3::from(set), rise, [a, b]);
            check(&law(5.72e-3), V3::from(set), rise, [a, b]);
        }

        #[test]
        fn hessian_where_the_moment_vanishes(a in edge(), b in edge()) {
            check_hessian([a, b]);
        }

        #[test]
        fn angle_is_exact(angle in 1e-4..3.0f64) {
            let t = V3::new(libm::cos(angle), libm::sin(angle), 0.0);
            prop_assert!((turning([&V3::x(), &t]) - V3::z() * angle).norm() < 1e-11);
        }

        /// The tangent of the yielding law: derivative of the moment along and across it.
        #[test]
        fn algorithmic_tangent(a in 20.0..400.0f64, b in -100.0..100.0f64, rise in 0.0..2e-3f64) {
            let l = law(5.72e-3);
            let trial = V3::new(a, b, 0.0) * l.modulus;
            let (_, _, along, across, dir) = respond(&l, trial, rise);
            let h = 1e-4;
            for axis in [V3::x(), V3::y(), V3::z()] {
                let m = |s: f64| respond(&l, trial + axis * (s * h * l.modulus), rise).0;
                let got = (m(1.0) - m(-1.0)) / (2.0 * h);
                let want = axis * across + dir * ((along - across) * dir.dot(&axis));
                prop_assert!((got - want).norm() < 1e-6 * l.modulus);
            }
        }
    }

    #[test]
    fn straight_and_nearly_folded() {
        let l = 5e-4;
        check(
            &law(f64::INFINITY),
            V3::zeros(),
            0.0,
            [V3::x() * l, V3::x() * l],
        );
        check(
            &law(5.72e-3),
            V3::new(0.0, 0.0, 50.0),
            0.0,
            [V3::x() * l, V3::x() * l],
        );
        let a = 170f64.to_radians();
        check(
            &law(f64::INFINITY),
            V3::zeros(),
            0.0,
            [V3::x() * l, V3::new(a.cos(), a.sin(), 0.0) * l],
        );
        let folded = at(
            &law(f64::INFINITY),
            &V3::zeros(),
            0.0,
            l,
            [V3::x() * l, V3::x() * -l],
        );
        let all = folded
            .own
            .iter()
            .flatten()
            .chain(folded.cross.iter().flatten());
        assert!(folded.energy.is_finite() && all.copied().all(f64::is_finite));
    }

    /// A bend from virgin wire to the cap in one step: elastic, hardening and ideally plastic part.
    #[test]
    fn forces_at_the_cap_are_the_derivative_of_the_energy() {
        let l = 5e-4;
        let capped = Law::new(3.06e-3, 1.13e-4, 5.72e-3, 0.0126);
        for angle in [0.02, 0.05, 0.3] {
            let (c, s) = (libm::cos(angle), libm::sin(angle));
            let e = [V3::x() * l, V3::new(c, s * 0.8, s * 0.6) * l];
            check(&capped, V3::zeros(), 0.0, e);
            check(&capped, V3::new(0.0, 12.0, -9.0), 3e-3, e);
        }
    }

    #[test]
    fn stretch_is_the_derivative_of_its_energy() {
        let l = Law::new(48900.0, 1100.0, 38.5, f64::INFINITY);
        let state = Scalar::default();
        for length in [0.99e-3, 1.0001e-3, 1.002e-3] {
            let h = 1e-10;
            let e = |x: f64| stretched(&l, &state, 1e-3, x, x);
            let s = e(length);
            assert!(
                ((e(length + h).energy - e(length - h).energy) / (2.0 * h) - s.tension).abs()
                    < 1e-4 * s.tension.abs()
            );
            assert!(
                ((e(length + h).tension - e(length - h).tension) / (2.0 * h) / s.stiffness - 1.0)
                    .abs()
                    < 1e-5
            );
        }
    }
}
