//! Natural frequencies of a wire about its present state.
//!
//! The stiffness is the central difference of the forces that time steps use, the mass is theirs.

use super::band::Band;
use super::bench::Stepper;
use super::equilibrium::method;
use super::{Context, VerifyError};
use crate::math::V3;
use crate::math::align;
use crate::scene::Integrator;
use crate::system::System;
use std::f64::consts::TAU;

/// Displacement in the differences, edge lengths or rad.
const NUDGE: f64 = 1e-5;

/// Amplitude of a stepped mode in wire diameters, looks at it a swing, and swings.
const AMPLITUDE: f64 = 0.02;
const LOOKS: f64 = 100.0;
const SWINGS: f64 = 3.0;

/// Most parts: each is moved by itself, and all forces are looked at.
const MOST_PARTS: usize = 5000;

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

/// A mode: its frequency, Hz, and how far each part goes.
pub(super) struct Mode {
    /// frequency, Hz
    pub(super) frequency: f64,
    /// displacement of each node (or roll of each edge), 1 at most
    pub(super) shape: Vec<f64>,
}

/// The `count` lowest frequencies of a motion, Hz, ascending; in the set-up of a wind as its steps show them.
pub(super) fn lowest(
    ctx: &Context,
    sys: &mut System,
    motion: Motion,
    count: usize,
) -> Result<Vec<f64>, VerifyError> {
    let modes = modes(ctx, sys, motion, count)?;
    match motion {
        Motion::Along(axis) if ctx.winds() => {
            let seen = modes.iter().map(|mode| stepped(ctx, sys, axis, mode));
            seen.collect()
        }
        _ => Ok(modes.iter().map(|mode| mode.frequency).collect()),
    }
}

/// Frequency at which the wind's own steps let a mode swing, Hz.
///
/// Starts with the mode's velocity at the place of rest, and looks at the wire often, as an importer does who wants to see it swing.
/// Between the first and the last zero lie whole swings.
fn stepped(ctx: &Context, sys: &System, axis: usize, mode: &Mode) -> Result<f64, VerifyError> {
    let mut sys = sys.clone();
    sys.model.loads.drag = 0.0;
    let rest: Vec<f64> = sys.state.rod.x.iter().map(|x| x[axis]).collect();
    let most = AMPLITUDE * sys.model.section.diameter * TAU * mode.frequency;
    for (v, shape) in sys.state.rod.v.iter_mut().zip(&mode.shape) {
        *v = V3::zeros();
        v[axis] = most * shape;
    }
    sys.state.past.forget();
    sys.refresh();
    let dt = 1.0 / (mode.frequency * LOOKS);
    let mut step = Stepper::implicit(ctx.tolerance, dt);
    let seen = |sys: &System| -> f64 {
        let parts = sys.state.rod.x.iter().zip(&rest).zip(&mode.shape);
        parts
            .map(|((x, rest), shape)| (x[axis] - rest) * shape)
            .sum()
    };
    let (mut last, mut zeros) = (0.0, Vec::new());
    for k in 1..=((SWINGS + 1.0) * LOOKS) as usize {
        step.through(&mut sys, dt, dt)?;
        let now = seen(&sys);
        if last * now < 0.0 {
            zeros.push((k as f64 - now / (now - last)) * dt);
        }
        last = now;
    }
    let [Some(first), Some(end)] = [zeros.first(), zeros.last()] else {
        return Err(VerifyError::NoAnswer("the wire does not swing".to_owned()));
    };
    Ok(0.5 * (zeros.len() - 1) as f64 / (end - first))
}

/// The `count` lowest modes of a motion, frequencies ascending, from stiffness and mass.
fn modes(
    ctx: &Context,
    sys: &mut System,
    motion: Motion,
    count: usize,
) -> Result<Vec<Mode>, VerifyError> {
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
    let mut columns = Vec::with_capacity(parts.len());
    for (column, &i) in parts.iter().enumerate() {
        let (ahead, behind, width) = nudged(sys, motion, i, &mut forces);
        let rows = parts.iter().enumerate().map(|(row, &k)| {
            let stiffness = (behind[k] - ahead[k]) / width;
            stiffness / (inertia[row] * inertia[column]).sqrt()
        });
        columns.push(rows.collect());
    }
    sys.evaluate(None);
    let unstable = || {
        let reason = "the wire is not stable in this state, so it has no frequency";
        VerifyError::NoAnswer(reason.to_owned())
    };
    let band = Band::of(&columns);
    let found = band.lowest(count).ok_or_else(unstable)?;
    let all = sys.state.rod.nodes();
    Ok(found
        .into_iter()
        .map(|(value, vector)| {
            let mut shape = vec![0.0; all];
            for (row, &i) in parts.iter().enumerate() {
                shape[i] = vector[row] / inertia[row].sqrt();
            }
            let most = shape.iter().fold(0.0_f64, |m, s| m.max(s.abs()));
            shape.iter_mut().for_each(|s| *s /= most);
            Mode {
                frequency: value.sqrt() / TAU,
                shape,
            }
        })
        .collect())
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
