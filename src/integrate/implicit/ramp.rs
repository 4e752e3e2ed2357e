//! Equilibrium along a ramp of loads, for the laboratory.

use super::{Implicit, StepError};
use crate::math::V3;
use crate::system::System;

/// Share of a ramp in its first increment, at most, and at least.
const SHARES: [f64; 3] = [0.1, 0.25, 1e-5];
/// Solver steps up to which an increment was quick, and what happens to the next one.
const QUICK: usize = 8;
const GROWTH: f64 = 1.4;
const SHRINK: f64 = 0.5;

impl Implicit {
    /// Follows equilibrium while `apply` brings loads and supports from share 0 to share 1 of what
    /// they shall be. Increments shrink where the solve fails and grow where it is quick.
    pub fn follow(
        &mut self,
        sys: &mut System,
        mut apply: impl FnMut(&mut System, f64),
    ) -> Result<(), StepError> {
        let [mut step, largest, smallest] = SHARES;
        let mut at = 0.0;
        // how the wire moved in the last increment, and the share of the load that did it
        let mut trend: (Vec<V3>, f64) = (Vec::new(), 1.0);
        while at < 1.0 {
            let to = if at + step > 1.0 - 1e-9 {
                1.0
            } else {
                at + step
            };
            let before = sys.clone();
            apply(sys, to);
            match self.equilibrium(sys, &trend.0, (to - at) / trend.1) {
                Ok(taken) => {
                    let moved = sys
                        .state
                        .rod
                        .x
                        .iter()
                        .zip(&before.state.rod.x)
                        .map(|(x, b)| x - b);
                    trend = (moved.collect(), to - at);
                    at = to;
                    if taken <= QUICK {
                        step = (GROWTH * step).min(largest);
                    }
                }
                Err(error) => {
                    *sys = before;
                    // an increment that led astray is no guide for the next one
                    trend.0.clear();
                    step *= SHRINK;
                    if step < smallest {
                        return Err(error);
                    }
                }
            }
        }
        Ok(())
    }
}
