//! Natural frequencies of a wire about its present state.
//!
//! The stiffness is the central difference of the forces that time steps use, the mass is theirs.

use super::VerifyError;
use crate::integrate::System;
use crate::rod::align;
use nalgebra::{DMatrix, SymmetricEigen};
use std::f64::consts::TAU;

/// Displacement in the differences, edge lengths or rad.
const NUDGE: f64 = 1e-5;

/// Largest dense eigenvalue problem.
const MOST_PARTS: usize = 1000;

/// What moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Motion {
    /// every free node along one axis (0 to 2 for x to z)
    Along(usize),
    /// every edge about itself
    Roll,
}

/// The `count` lowest frequencies of a motion, Hz, ascending.
pub(super) fn lowest(
    sys: &mut System,
    motion: Motion,
    count: usize,
) -> Result<Vec<f64>, VerifyError> {
    let parts: Vec<usize> = match motion {
        Motion::Along(a) => (0..sys.rod.nodes()).filter(|&i| free(sys, i, a)).collect(),
        Motion::Roll => (0..sys.rod.edges()).collect(),
    };
    if parts.len() > MOST_PARTS {
        return Err(VerifyError::NoAnswer(format!(
            "modes of {} edges are too many, at most {MOST_PARTS}",
            parts.len()
        )));
    }
    let inertia: Vec<f64> = parts
        .iter()
        .map(|&i| match motion {
            Motion::Along(_) => sys.rod.mass(&sys.section, i),
            Motion::Roll => sys.section.spin_inertia_per_length() * sys.rod.rest[i],
        })
        .collect();
    let mut scaled = DMatrix::zeros(parts.len(), parts.len());
    for (column, &i) in parts.iter().enumerate() {
        let (ahead, behind, width) = nudged(sys, motion, i);
        for (row, &k) in parts.iter().enumerate() {
            let stiffness = (pick(&behind, motion, k) - pick(&ahead, motion, k)) / width;
            scaled[(row, column)] = stiffness / (inertia[row] * inertia[column]).sqrt();
        }
    }
    sys.evaluate(None);
    let symmetric = (&scaled + scaled.transpose()) * 0.5;
    let mut squares: Vec<f64> = SymmetricEigen::new(symmetric)
        .eigenvalues
        .iter()
        .copied()
        .collect();
    squares.sort_by(f64::total_cmp);
    squares.truncate(count);
    if squares.len() < count || !squares.iter().all(|s| *s > 0.0) {
        return Err(VerifyError::NoAnswer(
            "the wire is not stable in this state, so it has no frequency".to_owned(),
        ));
    }
    Ok(squares.iter().map(|s| s.sqrt() / TAU).collect())
}

fn free(sys: &System, i: usize, a: usize) -> bool {
    let last = sys.rod.nodes() - 1;
    !(i == 0 && sys.support[0].hold[a] || i == last && sys.support[1].hold[a])
}

/// Forces with part `i` a little ahead and a little behind, and the distance between the two.
fn nudged(sys: &mut System, motion: Motion, i: usize) -> (crate::rod::Load, crate::rod::Load, f64) {
    let mut loads = [crate::rod::Load::default(), crate::rod::Load::default()];
    let mut width = 2.0 * NUDGE;
    for (load, sign) in loads.iter_mut().zip([1.0, -1.0]) {
        match motion {
            Motion::Along(a) => {
                let before = sys.rod.x[i];
                let step = NUDGE * sys.rod.rest[i.min(sys.rod.edges() - 1)];
                width = 2.0 * step;
                sys.rod.x[i][a] += sign * step;
                sys.evaluate(None);
                sys.rod.x[i] = before;
            }
            Motion::Roll => {
                let before = sys.rod.frame[i];
                sys.rod.frame[i] = align(&before, &sys.rod.tangent(i), sign * NUDGE);
                sys.evaluate(None);
                sys.rod.frame[i] = before;
            }
        }
        load.clone_from(&sys.load);
    }
    let [ahead, behind] = loads;
    (ahead, behind, width)
}

fn pick(load: &crate::rod::Load, motion: Motion, i: usize) -> f64 {
    match motion {
        Motion::Along(a) => load.force[i][a],
        Motion::Roll => load.torque[i],
    }
}
