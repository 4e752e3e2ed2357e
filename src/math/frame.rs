//! Unit quaternions as frames: rotation, transport along a direction, composition from angles.
//!
//! A frame's body z axis is the direction of an edge (the paper's zeta axis).

use super::vector::{Quat, V3};

/// The relative quaternion that has these angles: the inverse of [`Joint::between`].
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

/// Turns frame `q` the shortest way until its z axis is the unit vector `t`, then by `roll`
/// about it (small angles: one step's spin). This keeps the paper's constraint, zeta parallel to
/// the straight spring, exactly and carries the frame along by parallel transport in time.
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
    // swing from z to b in the body frame, (1 + b.z, -b.y, b.x, 0), then a roll about z, (c, 0, 0, s)
    let w = 1.0 + b.z;
    let turn = Quat::new(w * c, b.x * s - b.y * c, b.x * c + b.y * s, w * s);
    let r = q * turn;
    r * (1.0 / r.norm())
}

/// A frame whose z axis is the unit vector `t`, its roll chosen by parallel transport from `like`.
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
