//! One step of Newton's method towards equilibrium.

use super::error::RelaxError;
use super::plastic_tangent;
use super::tangent::tangent;
use super::unknowns::{PER_NODE, advance, held, part, residual};
use crate::math::V3;
use crate::system::System;

/// Largest turn or stretch of an edge in one Newton step.
const LARGEST_TURN: f64 = 0.4;
/// Share of the initial work of the forces out of balance to which a step is cut back where the
/// wire yields.
const CUT: f64 = 0.5;
/// Most cuts of one step.
const MOST_CUTS: usize = 8;

/// One Newton step, shortened where an edge would turn or stretch too far or where the wire
/// yields and a shorter step does better.
pub(super) fn newton_step(sys: &mut System, target: &[V3; 2]) -> Result<(), RelaxError> {
    let nodes = sys.state.rod.nodes();
    let before = residual(sys);
    let mut step = before.clone();
    let yielding = plastic_tangent::yields(sys);
    let mut tangent = tangent(sys);
    let mut carried = false;
    for i in 0..nodes {
        for a in 0..PER_NODE {
            let k = PER_NODE * i + a;
            if a == 3 {
                if i + 1 == nodes || !sys.model.twist.is_carried() {
                    tangent.fix(k);
                    step[k] = 0.0;
                }
            } else if held(sys, i, a) {
                tangent.fix(k);
                step[k] = target[usize::from(i > 0)][a] - sys.state.rod.x[i][a];
                carried |= step[k] != 0.0;
            }
        }
    }
    tangent
        .solve(&mut step)
        .map_err(|row| RelaxError::SingularPivot {
            node: row / PER_NODE,
            share: 1.0,
        })?;
    let mut largest = 0.0_f64;
    for j in 0..nodes - 1 {
        largest = largest
            .max((part(&step, j + 1) - part(&step, j)).norm() / sys.state.rod.rest[j])
            .max(step[PER_NODE * j + 3].abs() / sys.state.rod.rest[j]);
    }
    let whole = (LARGEST_TURN / largest).min(1.0);
    if !whole.is_finite() {
        return Err(RelaxError::Broken {
            node: 0,
            share: 1.0,
        });
    }
    let start = (sys.state.rod.x.clone(), sys.state.roll.clone());
    advance(sys, &start, &step, whole, Some(target));
    sys.evaluate(None);
    // work of the forces out of balance along the step: 0 at the best share
    let work = |sys: &System| out_of_balance(sys, &residual(sys), &step);
    let gained = out_of_balance(sys, &before, &step);
    if carried || !(yielding || plastic_tangent::yields(sys)) || gained <= 0.0 {
        return Ok(());
    }
    // beyond the best share the tangent of a yielding joint has led too far: go back towards it
    let (mut low, mut high) = ((0.0, gained), (whole, work(sys)));
    for _ in 0..MOST_CUTS {
        let (share, at) = high;
        if at >= -CUT * gained {
            break;
        }
        let straight = low.0 + (share - low.0) * low.1 / (low.1 - at);
        let next = straight.clamp(low.0 + 0.1 * (share - low.0), low.0 + 0.7 * (share - low.0));
        advance(sys, &start, &step, next, Some(target));
        sys.evaluate(None);
        let found = work(sys);
        if found > CUT * gained {
            low = (next, found);
            // stay inside what is known to be too far
            let middle = 0.5 * (next + share);
            advance(sys, &start, &step, middle, Some(target));
            sys.evaluate(None);
            high = (middle, work(sys));
        } else {
            high = (next, found);
        }
    }
    Ok(())
}

/// Work of the forces `r` on the free coordinates along `step`.
fn out_of_balance(sys: &System, r: &[f64], step: &[f64]) -> f64 {
    (0..r.len())
        .filter(|k| k % PER_NODE == 3 || !held(sys, k / PER_NODE, k % PER_NODE))
        .map(|k| r[k] * step[k])
        .sum()
}
