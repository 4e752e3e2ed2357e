//! Conjugate gradients for the few couplings that no band holds, the band as preconditioner.
//!
//! The banded part contains both partners' own shares of every pair, the couplings only what
//! lies between them, so the sum is positive semidefinite and the preconditioner is its upper bound.

use super::beyond_band::BeyondBand;
use crate::contact::add_couplings;
use crate::linalg::Banded;

/// Residual, in the norm of the preconditioner, at which an update is good enough: Newton's method needs no more.
const CLOSE: f64 = 1e-2;
/// Steps at most; one per coupling is enough in exact arithmetic.
const MOST_STEPS: usize = 60;

/// Vectors of the iteration.
#[derive(Clone, Debug, Default)]
pub(super) struct Scratch {
    x: Vec<f64>,
    p: Vec<f64>,
    z: Vec<f64>,
    y: Vec<f64>,
    banded: Vec<f64>,
    pub(super) cg_iterations: u64,
}

/// Solves (banded + couplings) x = b in place; `matrix` is factored.
#[inline(never)]
pub(super) fn solve<const D: usize>(
    matrix: &Banded<D>,
    beyond: &BeyondBand,
    b: &mut [f64],
    s: &mut Scratch,
) {
    let n = b.len();
    for v in [&mut s.x, &mut s.p, &mut s.z, &mut s.y, &mut s.banded] {
        v.clear();
        v.resize(n, 0.0);
    }
    s.z.copy_from_slice(b);
    matrix.solve(&mut s.z);
    s.p.copy_from_slice(&s.z);
    // the banded part times p follows from the residuals that p is made of
    s.banded.copy_from_slice(b);
    let mut rz = dot(b, &s.z);
    let stop = rz * CLOSE * CLOSE;
    for _ in 0..MOST_STEPS {
        s.y.copy_from_slice(&s.banded);
        add_couplings::<D>(&beyond.couplings, &s.p, &mut s.y);
        for (end, first) in [(0, 0), (1, n - D)] {
            for a in 0..3 {
                if beyond.held[end][a] {
                    s.y[first + a] = s.p[first + a];
                }
            }
        }
        s.cg_iterations += 1;
        let curvature = dot(&s.p, &s.y);
        if curvature <= 0.0 || rz <= 0.0 {
            break;
        }
        let alpha = rz / curvature;
        for k in 0..n {
            s.x[k] += alpha * s.p[k];
            b[k] -= alpha * s.y[k];
        }
        s.z.copy_from_slice(b);
        matrix.solve(&mut s.z);
        let next = dot(b, &s.z);
        if next <= stop {
            break;
        }
        let beta = next / rz;
        rz = next;
        for k in 0..n {
            s.p[k] = s.z[k] + beta * s.p[k];
            s.banded[k] = b[k] + beta * s.banded[k];
        }
    }
    b.copy_from_slice(&s.x);
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}
