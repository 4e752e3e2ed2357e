//! The rod in vector form, for the implicit solver: energy, gradient and Gauss-Newton Hessian.
//!
//! The same energy as [`super::forces`] without twist, written in edge vectors instead of frames.
//! The curvature of a joint is the turning angle between its edges about their common normal, over
//! the Voronoi length. Plastic curvature enters as a [vector](SetCurvature) that turns along with the
//! wire. The Hessian leaves out the second derivative of the angle (Gauss-Newton): what is left is
//! positive semidefinite whatever the moment. Curvature binormal and its derivative after Bergou
//! et al., *Discrete Elastic Rods*, 2008; the angle itself in place of twice its tangent.

use super::plasticity::{Bend, Law, Scalar, respond_bend, respond_scalar};
use super::yield_branch::YieldBranch;
use crate::math::V3;

#[cfg(any(test, feature = "lab"))]
mod bent;
mod set_curvature;

#[cfg(any(test, feature = "lab"))]
pub use bent::{Bent, Symmetric, add_square, bent};
pub use set_curvature::SetCurvature;

/// Smallest `1 + cos` of a turning angle: just short of a complete fold.
pub(super) const FOLD: f64 = 1e-6;

/// Below this square of `tan(angle / 2)` the series of [`angle_over_tangent`] hold to 1e-16.
pub(super) const SERIES: f64 = 0.012;
/// Terms of the series of [`angle_over_tangent`], by powers of the squared tangent.
pub(super) const TERMS: [f64; 8] = [
    1.0,
    -1.0 / 3.0,
    1.0 / 5.0,
    -1.0 / 7.0,
    1.0 / 9.0,
    -1.0 / 11.0,
    1.0 / 13.0,
    -1.0 / 15.0,
];
/// Terms of the series of its derivative.
pub(super) const SLOPE_TERMS: [f64; 7] = [
    -1.0 / 12.0,
    2.0 / 20.0,
    -3.0 / 28.0,
    4.0 / 36.0,
    -5.0 / 44.0,
    6.0 / 52.0,
    -7.0 / 60.0,
];

/// Tension, stiffness and energy of an edge at a given length, with the plastic stretch of the last
/// accepted instant.
#[derive(Clone, Copy, Debug, Default)]
pub struct Stretched {
    /// tension, N
    pub tension: f64,
    /// its derivative with respect to the length, N/m
    pub stiffness: f64,
    /// energy whose derivative with respect to the length is the tension, J
    pub energy: f64,
}

/// Tension of an edge of unstretched length `rest` (m) at `length` (m).
///
/// The branch, elastic or yielding, is that at the length `expected` (m), where an iteration may
/// know it better than at its iterate.
#[inline(always)]
pub fn stretched(law: &Law, state: &Scalar, rest: f64, length: f64, expected: f64) -> Stretched {
    let promised = law.modulus * (expected / rest - 1.0 - state.strain);
    if promised.abs() <= law.limit + state.rise {
        let tension = law.modulus * (length / rest - 1.0 - state.strain);
        return Stretched {
            tension,
            stiffness: law.modulus / rest,
            energy: 0.5 * tension * tension / law.modulus * rest,
        };
    }
    let (tension, next, work) = respond_scalar(law, state, length / rest - 1.0);
    let yields = work > 0.0;
    let tangent = if yields {
        law.tangent(next.rise)
    } else {
        law.modulus
    };
    Stretched {
        tension,
        stiffness: tangent / rest,
        energy: (0.5 * tension * tension / law.modulus + work) * rest,
    }
}

/// Moment, energy per length, stiffness along and across the moment, its direction (none where that
/// does not matter).
#[inline(always)]
pub(super) fn respond(law: &Law, trial: V3, rise: f64) -> (V3, f64, f64, f64, V3) {
    let n2 = trial.norm_squared();
    let limit = law.limit + rise;
    if n2 <= limit * limit {
        let e = 0.5 * n2 / law.modulus;
        let n = n2.sqrt();
        let dir = if YieldBranch::matters(law, n, rise) {
            trial * (1.0 / n)
        } else {
            V3::zeros()
        };
        return (trial, e, law.modulus, law.modulus, dir);
    }
    let n = n2.sqrt();
    let state = Bend {
        curvature: [0.0; 2],
        rise,
    };
    let (m, next, work) = respond_bend(law, &state, [n / law.modulus, 0.0]);
    let dir = trial / n;
    let along = law.tangent(next.rise);
    (
        dir * m[0],
        0.5 * m[0] * m[0] / law.modulus + work,
        along,
        law.modulus * m[0] / n,
        dir,
    )
}

/// Turning angle between two unit directions, rad, as a vector along their common normal.
#[inline]
pub fn turning(t: [&V3; 2]) -> V3 {
    let chi = (1.0 + t[0].dot(t[1])).max(FOLD);
    let kb = t[0].cross(t[1]) * (2.0 / chi);
    kb * angle_over_tangent(kb.norm_squared()).0
}

/// Turning angle over `y = 2 tan(angle / 2)`, and the derivative of that ratio by `y^2`.
#[inline]
pub(super) fn angle_over_tangent(y2: f64) -> (f64, f64) {
    let z2 = 0.25 * y2;
    if z2 < SERIES {
        let sum = |terms: &[f64]| terms.iter().rev().fold(0.0, |sum, c| sum * z2 + c);
        (sum(&TERMS), sum(&SLOPE_TERMS))
    } else {
        let z = z2.sqrt();
        let s = libm::atan(z) / z;
        (s, 0.125 * (1.0 / (1.0 + z2) - s) / z2)
    }
}
