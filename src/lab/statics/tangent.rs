//! The stiffness of the whole wire by central differences of its forces.

use super::band::Band;
use super::plastic_tangent;
use super::unknowns::{PER_NODE, residual};
use crate::system::System;

/// Farthest unknown that a force depends on: the last coordinate of the node two further on.
const HALF_BAND: usize = 2 * PER_NODE + 2;
/// Nodes this far apart share no force.
const COLOURS: usize = 5;
/// Displacement in the central differences, in edge lengths; rad for the roll.
const NUDGE: f64 = 1e-5;

/// Minus the derivative of [`residual`] with respect to positions and rolls (times edge length).
pub(super) fn tangent(sys: &mut System) -> Band {
    let nodes = sys.state.rod.nodes();
    let size = PER_NODE * nodes;
    let mut band = Band::new(size, HALF_BAND);
    // a law with a kink has no difference quotient: go round it with the elastic law at the same
    // forces, and take off afterwards what the yielding joints lack of it
    let flows = plastic_tangent::Flows::of(sys);
    let plastic = flows.hide(sys);
    let (x, roll) = (sys.state.rod.x.clone(), sys.state.roll.clone());
    let nudge: Vec<f64> = (0..nodes)
        .map(|i| {
            let after = sys.state.rod.rest.get(i).copied().unwrap_or(f64::INFINITY);
            let before = if i > 0 {
                sys.state.rod.rest[i - 1]
            } else {
                f64::INFINITY
            };
            NUDGE * after.min(before)
        })
        .collect();
    for colour in 0..COLOURS {
        for a in 0..PER_NODE {
            let mut sides = [Vec::new(), Vec::new()];
            for (side, sign) in [(0, 1.0), (1, -1.0)] {
                for i in (colour..nodes).step_by(COLOURS) {
                    if a < 3 {
                        sys.state.rod.x[i][a] = x[i][a] + sign * nudge[i];
                    } else if i + 1 < nodes {
                        sys.state.roll[i] = roll[i] + sign * NUDGE;
                    }
                }
                sys.evaluate(None);
                sides[side] = residual(sys);
                sys.state.rod.x.copy_from_slice(&x);
                sys.state.roll.copy_from_slice(&roll);
            }
            for i in (colour..nodes).step_by(COLOURS) {
                let width = match (a < 3, i + 1 < nodes) {
                    (true, _) => 2.0 * nudge[i],
                    (false, true) => 2.0 * NUDGE * sys.state.rod.rest[i],
                    (false, false) => continue,
                };
                let column = PER_NODE * i + a;
                let from = column.saturating_sub(HALF_BAND);
                for row in from..(column + HALF_BAND + 1).min(size) {
                    // the band is a little wider than the reach of a node: leave the others alone
                    let node = row / PER_NODE;
                    if node + 2 >= i && node <= i + 2 {
                        *band.at(row, column) = (sides[1][row] - sides[0][row]) / width;
                    }
                }
            }
        }
    }
    plastic.restore(sys);
    flows.soften(sys, &mut band);
    band
}
