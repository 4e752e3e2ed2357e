//! A joint of the rod with twist, for the implicit solver: energy, gradient and Gauss-Newton
//! Hessian.
//!
//! Energy, laws and plastic state are those of [`super::forces`]: two bending angles and a twist
//! angle between the material frames of neighbouring edges ([`Joint`]). Unknowns are the edge
//! vectors and one roll per edge. The frame of an edge is the one it had at the last accepted
//! instant, turned the shortest way onto the edge and then rolled about it. Where the edge turns by
//! `dt`, its frame turns by `t x dt + (roll + c . dt) t`: `c` is what the shortest way from a fixed
//! start adds to the shortest way from here. The Hessian is `J^T C J`, with `J` the derivative of
//! the three angles and `C` the tangents of their laws. The bending law is isotropic, so `J` may
//! take the trial moment in a frame that follows a part of the common roll of the edges. That part
//! gives a joint whose edges roll alike its exact stiffness, which is 0 for elastic wire.

use super::bending::respond;
use super::forces::Laws;
use super::joint::Joint;
use super::plasticity::{Bend, Scalar, respond_scalar};
use super::yield_branch::YieldBranch;
use crate::math::rotate;
use crate::math::{M3, Quat, V3};

#[cfg(any(test, feature = "lab"))]
mod twisted;

#[cfg(feature = "lab")]
pub use twisted::Rolled;
#[cfg(any(test, feature = "lab"))]
pub use twisted::twisted;

/// An edge and its frame at an iterate, or the frame of a clamp, which does not move.
#[derive(Clone, Copy, Debug)]
pub struct Turned {
    frame: Quat,
    /// body z of the frame
    along: V3,
    /// inverse length, 1/m; 0 for a clamp
    inverse: f64,
    /// `c` of the module's formula
    detour: V3,
}

impl Turned {
    /// An edge of unit direction `along` and inverse length `inverse` (1/m), rolled by `roll` (rad)
    /// since it had the frame `from` and the direction `start`.
    #[cfg(any(test, feature = "lab"))]
    #[inline]
    pub fn edge(from: &Quat, start: &V3, along: V3, inverse: f64, roll: f64) -> Self {
        Self {
            frame: crate::math::align(from, &along, roll),
            along,
            inverse,
            detour: along.cross(start) / (1.0 + start.dot(&along)),
        }
    }

    /// An edge whose frame and detour are known.
    pub(super) fn known(frame: Quat, along: V3, inverse: f64, detour: V3) -> Self {
        Self {
            frame,
            along,
            inverse,
            detour,
        }
    }

    /// A clamp with a frame that does not move.
    pub fn clamp(frame: Quat) -> Self {
        Self {
            frame,
            along: rotate(&frame, &V3::z()),
            inverse: 0.0,
            detour: V3::zeros(),
        }
    }

    /// Frame of the edge.
    #[cfg(test)]
    pub(super) fn frame(&self) -> Quat {
        self.frame
    }

    /// Columns: the axes of the frame.
    #[inline]
    fn frame_matrix(&self) -> M3 {
        let Quat { coords: q } = self.frame;
        let (x, y, z, w) = (q.x, q.y, q.z, q.w);
        let (x2, y2, z2) = (x + x, y + y, z + z);
        let (xx, yy, zz) = (x * x2, y * y2, z * z2);
        let (xy, xz, yz) = (x * y2, x * z2, y * z2);
        let (wx, wy, wz) = (w * x2, w * y2, w * z2);
        M3::new(
            1.0 - yy - zz,
            xy - wz,
            xz + wy,
            xy + wz,
            1.0 - xx - zz,
            yz - wx,
            xz - wy,
            yz + wx,
            1.0 - xx - yy,
        )
    }

    /// Derivative of an angle by the edge vector (1/m) and by the roll of the edge; `row` is its
    /// derivative by the rotation of the frame.
    #[inline]
    pub fn derivative(&self, row: &V3) -> (V3, f64) {
        let roll = row.dot(&self.along);
        let turn = row.cross(&self.along) + self.detour * roll;
        (turn * self.inverse, roll)
    }
}

/// Moments, stiffnesses and energy of a joint at given angles.
#[derive(Clone, Copy, Debug)]
pub(super) struct Answer {
    pub(super) energy: f64,
    /// direction of the trial moment in the mid frame
    pub(super) along: [f64; 2],
    /// moment that way, and of twist, N m
    pub(super) push: f64,
    pub(super) torque: f64,
    /// stiffness against angles along and across the moment, and of twist, N m
    pub(super) stiffness: [f64; 3],
    /// part of the common roll of the edges that the frame of the moment follows, see the module
    pub(super) free: f64,
    /// set where the law may change its branch; without derivatives of the angle
    pub(super) yield_branch: Option<YieldBranch>,
}

/// Moments, stiffnesses and energy of a joint of Voronoi length `lv` (m) at the bending angles
/// `angle` and the twist `twist_angle`, rad.
#[inline(always)]
pub(super) fn answer(
    laws: &Laws,
    bend: &Bend,
    twist: &Scalar,
    lv: f64,
    angle: [f64; 2],
    twist_angle: f64,
) -> Answer {
    let inv = 1.0 / lv;
    let elastic = |k: usize| (angle[k] * inv - bend.curvature[k]) * laws.bend.modulus;
    let trial = V3::new(elastic(0), elastic(1), 0.0);
    let (m, energy, along, across, dir) = respond(&laws.bend, trial, bend.rise);
    let (t, next, work) = respond_scalar(&laws.twist, twist, twist_angle * inv);
    let stiffness = if work > 0.0 {
        laws.twist.tangent(next.rise)
    } else {
        laws.twist.modulus
    };
    let n = trial.norm();
    let d = if n > 0.0 { trial * (1.0 / n) } else { V3::x() };
    // a joint whose edges roll alike sees its curvature turn: the energy curves by `curved (curved
    // - elastic)` there
    let curved = (angle[0] * d.x + angle[1] * d.y) * inv;
    let kept = (curved * (curved - n / laws.bend.modulus)).max(0.0).sqrt();
    let free = if n > 0.0 {
        0.5 * lv * (curved - kept.copysign(curved))
    } else {
        0.0
    };
    Answer {
        energy: (energy + 0.5 * t * t / laws.twist.modulus + work) * lv,
        along: [d.x, d.y],
        push: m.dot(&d),
        torque: t,
        stiffness: [along * inv, across * inv, stiffness * inv],
        free,
        yield_branch: (dir != V3::zeros()).then(|| YieldBranch {
            rows: [V3::zeros(); 2],
            rolls: [0.0; 2],
            trial: n,
            length: lv,
            rise: bend.rise,
            moment: m.dot(&dir),
            stiffness: along * inv,
            branch: i8::from(along != laws.bend.modulus),
        }),
    }
}

/// Derivative of the twist between two edges by their vectors and rolls.
pub(super) fn twist_by([before, after]: [&Turned; 2]) -> [(V3, f64); 2] {
    let joint = Joint::between(&before.frame, &after.frame);
    let about = before.frame_matrix() * joint.rows()[2];
    let ((w0, r0), (w1, r1)) = (before.derivative(&about), after.derivative(&about));
    [(-w0, -r0), (w1, r1)]
}
