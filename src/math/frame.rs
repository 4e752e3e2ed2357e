//! Unit quaternions as frames: rotation, transport along a direction, composition from angles.
//!
//! A frame's body z axis is the direction of an edge (the paper's zeta axis).

use super::vector::{Quat, V3};

/// The relative quaternion of two edge frames at a joint with these angles, rad: what
/// `rod::Joint::between` takes apart again.
pub fn relative(bend: [f64; 2], twist: f64) -> Quat {
    let phi = (bend[0] * bend[0] + bend[1] * bend[1]).sqrt();
    let (sp, cp) = (libm::sin(0.5 * phi), libm::cos(0.5 * phi));
    let (st, ct) = (libm::sin(0.5 * twist), libm::cos(0.5 * twist));
    let k = if phi > 1e-9 { sp / phi } else { 0.5 };
    Quat::new(cp * ct, k * bend[0], k * bend[1], cp * st)
}

/// Rotates a vector from the body frame of `q` to the frame `q` is given in.
#[inline]
pub fn rotate(q: &Quat, a: &V3) -> V3 {
    let v = V3::new(q.i, q.j, q.k);
    let t = 2.0 * v.cross(a);
    a + t * q.w + v.cross(&t)
}

/// Rotates a vector into the body frame of `q`.
#[inline]
pub fn rotate_back(q: &Quat, a: &V3) -> V3 {
    let v = V3::new(q.i, q.j, q.k);
    let t = 2.0 * a.cross(&v);
    a + t * q.w + t.cross(&v)
}

/// Turns frame `q` the shortest way until its z axis is the unit vector `t`, then by `roll`, rad,
/// about it.
///
/// This keeps the paper's constraint, zeta parallel to the straight spring, exactly, and carries
/// the frame along by parallel transport in time. `t` must not be opposite to the z axis of `q`.
#[inline]
pub fn align(q: &Quat, t: &V3, roll: f64) -> Quat {
    let b = rotate_back(q, t);
    let half = 0.5 * roll;
    let (c, s) = if half.abs() < 1e-3 {
        let h2 = half * half;
        (
            1.0 - 0.5 * h2 + h2 * h2 * (1.0 / 24.0),
            half * (1.0 - h2 * (1.0 / 6.0) + h2 * h2 * (1.0 / 120.0)),
        )
    } else {
        (libm::cos(half), libm::sin(half))
    };
    // swing from z to b in the body frame, (1 + b.z, -b.y, b.x, 0),
    // then a roll about z, (c, 0, 0, s)
    let w = 1.0 + b.z;
    let turn = Quat::new(w * c, b.x * s - b.y * c, b.x * c + b.y * s, w * s);
    let r = q * turn;
    r * (1.0 / r.norm())
}

/// A frame whose z axis is the unit vector `t`, its roll chosen by parallel transport from `like`,
/// or from the identity.
pub fn frame_along(t: &V3, like: Option<&Quat>) -> Quat {
    let base = like.copied().unwrap_or_else(Quat::identity);
    if rotate(&base, &V3::z()).dot(t) < -0.999 {
        // half a turn about body x first: the shortest way is not defined for opposite vectors
        return align(&(base * Quat::new(0.0, 1.0, 0.0, 0.0)), t, 0.0);
    }
    align(&base, t, 0.0)
}

/// Rotation about +y by `angle`, rad, as a quaternion.
pub fn turn_about_y(angle: f64) -> Quat {
    Quat::new(libm::cos(0.5 * angle), 0.0, libm::sin(0.5 * angle), 0.0)
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

    proptest! {
        #[test]
        fn align_keeps_z_on_the_edge(a in prop::array::uniform4(-1.0..1.0f64), t in prop::array::uniform3(-1.0..1.0f64), roll in -1e-2..1e-2f64) {
            prop_assume!(a.iter().map(|x| x * x).sum::<f64>() > 0.1);
            let t = V3::from(t);
            prop_assume!(t.norm() > 0.1);
            let t = t.normalize();
            let q = quat(a);
            prop_assume!(rotate(&q, &V3::z()).dot(&t) > -0.99);
            let r = align(&q, &t, roll);
            prop_assert!((rotate(&r, &V3::z()) - t).norm() < 1e-12);
            prop_assert!((r.norm() - 1.0).abs() < 1e-14);
            // the swing part has no component about z: the twist between both frames is the roll
            let relative = q.conjugate() * r;
            let twist = 2.0 * (relative.k / relative.w).atan();
            prop_assert!((twist - roll).abs() < 1e-10);
        }
    }

    /// Eq. 1 of the paper, mended: `q'' = Q^T alpha / 2 - |q'|^2 q` with the body acceleration
    /// alpha. The frames here follow a prescribed motion; the second difference must agree.
    #[test]
    fn aligned_frames_obey_the_mended_equation_of_motion() {
        // an edge turning about a slanted axis while it spins about itself
        let w0 = V3::new(0.4, -0.2, 0.1);
        let spin = |t: f64| 0.7 * t + 0.2 * t * t;
        let dir = |t: f64| {
            let q = turn(w0.normalize(), w0.norm() * t);
            rotate(&q, &V3::new(0.2, 0.5, 0.8).normalize())
        };
        let n = 2000;
        let dt = 1e-4;
        let mut q = frame_along(&dir(0.0), None);
        let mut track = vec![q];
        for i in 0..n {
            let t1 = (i + 1) as f64 * dt;
            q = align(&q, &dir(t1), spin(t1) - spin(t1 - dt));
            if q.dot(track.last().expect("track starts with one frame")) < 0.0 {
                q = -q;
            }
            track.push(q);
        }
        // body rates by central differences over a wider stencil, then alpha from their change
        let m = 50;
        let h = m as f64 * dt;
        let mid = n / 2;
        let rate = |i: usize| {
            let d = (track[i + m] - track[i - m]) / (2.0 * h);
            let o = track[i].conjugate() * d * 2.0;
            V3::new(o.i, o.j, o.k)
        };
        let alpha = (rate(mid + m) - rate(mid - m)) / (2.0 * h);
        let q0 = track[mid];
        let qd = (track[mid + m] - track[mid - m]) / (2.0 * h);
        let qdd = (track[mid + m] + track[mid - m] - q0 * 2.0) / (h * h);
        let rhs = q0 * Quat::new(0.0, alpha.x, alpha.y, alpha.z) * 0.5 - q0 * qd.norm_squared();
        assert!(
            (qdd - rhs).norm() < 2e-4 * (1.0 + qdd.norm()),
            "{qdd:?} {rhs:?}"
        );
        // as published (no factor 1/2) it does not hold
        let published = q0 * Quat::new(0.0, alpha.x, alpha.y, alpha.z) - q0 * qd.norm_squared();
        assert!((qdd - published).norm() > 0.02);
    }
}
