//! Natural frequencies of a wire about its present state.
//!
//! The stiffness is the central difference of the forces that time steps use, the mass is theirs.

use super::equilibrium::method;
use super::{Context, VerifyError};
use crate::math::V3;
use crate::math::align;
use crate::scene::Integrator;
use crate::system::System;
use nalgebra::{DMatrix, SymmetricEigen};
use std::f64::consts::TAU;

/// Displacement in the differences, edge lengths or rad.
const NUDGE: f64 = 1e-5;

/// Largest dense eigenvalue problem.
const MOST_PARTS: usize = 1000;

/// Forces, or torques, of a state on every part.
type Forces = Box<dyn FnMut(&mut System) -> Vec<f64>>;

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
    ctx: &Context,
    sys: &mut System,
    motion: Motion,
    count: usize,
) -> Result<Vec<f64>, VerifyError> {
    let parts: Vec<usize> = match motion {
        Motion::Along(a) => (0..sys.state.rod.nodes())
            .filter(|&i| free(sys, i, a))
            .collect(),
        Motion::Roll => (0..sys.state.rod.edges()).collect(),
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
            Motion::Along(_) => sys.state.rod.mass(&sys.model.section, i),
            Motion::Roll => sys.model.section.spin_inertia_per_length() * sys.state.rod.rest[i],
        })
        .collect();
    let mut forces: Forces = match motion {
        Motion::Along(a) if ctx.integrator == Integrator::Implicit => {
            let mut method = method(sys);
            Box::new(move |sys| along(&method.forces(sys), a))
        }
        Motion::Along(a) => Box::new(move |sys| {
            sys.evaluate(None);
            along(&sys.state.load.force, a)
        }),
        Motion::Roll if ctx.integrator == Integrator::Implicit => {
            let mut method = method(sys);
            Box::new(move |sys| method.out_of_balance(sys).1)
        }
        Motion::Roll => Box::new(|sys| {
            sys.evaluate(None);
            sys.state.load.torque.clone()
        }),
    };
    let mut scaled = DMatrix::zeros(parts.len(), parts.len());
    for (column, &i) in parts.iter().enumerate() {
        let (ahead, behind, width) = nudged(sys, motion, i, &mut forces);
        for (row, &k) in parts.iter().enumerate() {
            let stiffness = (behind[k] - ahead[k]) / width;
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
    let last = sys.state.rod.nodes() - 1;
    !(i == 0 && sys.state.support[0].hold[a] || i == last && sys.state.support[1].hold[a])
}

fn along(forces: &[V3], a: usize) -> Vec<f64> {
    forces.iter().map(|f| f[a]).collect()
}

/// Forces with part `i` a little ahead and a little behind, and the distance between the two.
fn nudged(
    sys: &mut System,
    motion: Motion,
    i: usize,
    forces: &mut Forces,
) -> (Vec<f64>, Vec<f64>, f64) {
    let mut width = 2.0 * NUDGE;
    let [ahead, behind] = [1.0, -1.0].map(|sign| match motion {
        Motion::Along(a) => {
            let before = sys.state.rod.x[i];
            let step = NUDGE * sys.state.rod.rest[i.min(sys.state.rod.edges() - 1)];
            width = 2.0 * step;
            sys.state.rod.x[i][a] += sign * step;
            let forces = forces(sys);
            sys.state.rod.x[i] = before;
            forces
        }
        Motion::Roll => {
            let before = sys.state.rod.frame[i];
            sys.state.rod.frame[i] = align(&before, &sys.state.rod.tangent(i), sign * NUDGE);
            let forces = forces(sys);
            sys.state.rod.frame[i] = before;
            forces
        }
    });
    (ahead, behind, width)
}
