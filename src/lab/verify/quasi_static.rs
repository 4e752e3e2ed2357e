//! Rest by the steps that wind: loads rise slowly, the wire follows in time and comes to rest under drag.

use super::bench::Stepper;
use super::{Context, VerifyError};
use crate::integrate::{Implicit, Scheme};
use crate::math::V3;
use crate::system::System;
use std::f64::consts::PI;

/// Parts of a ramp; supports move evenly within them, loads and directions jump from one to the next. Wire that hardens
/// little yields by what it swings beyond such a jump: with 200 parts, curvatures at rest are off by up to 30 %.
const PARTS: usize = 1000;
/// Time of a ramp in units of `L^2 sqrt(m / EI)`, a sixth of the period of a cantilever.
const RAMP: f64 = 12.0;
/// Shortest unit, s: a short piece is bent in the time that a wind takes to bend wire over a corner.
const SHORTEST: f64 = 2e-3;
/// Drag in the inverse of that unit: close to what lets the slowest bending mode of a cantilever creep in fastest.
const DRAG: f64 = 7.0;
/// Shortest and longest step of a wind, s.
const BRIEFEST: f64 = 1e-9;
const LONGEST: f64 = 0.1;
/// Longest wait for rest, in ramps.
const PATIENCE: usize = 20;
/// Speed that counts as rest, as a share of the tolerance over the unit of time.
const RESTS: f64 = 0.02;

/// The wind's own steps on their way to rest.
pub(super) struct QuasiStatic {
    step: Stepper,
    unit: f64,
    tolerance: f64,
}

impl QuasiStatic {
    /// Steps of a wind for this wire.
    ///
    /// `flat` keeps every node where it is along z.
    pub(super) fn new(ctx: &Context, sys: &mut System, flat: bool) -> Self {
        let section = &sys.model.section;
        let length: f64 = sys.state.rod.rest.iter().sum();
        let unit = |ei: f64| length * length * (section.mass_per_length() / ei).sqrt();
        let yields = section.m_y.is_finite();
        // elastic parts must not swing beyond what they are pressed to, and yielding ones need their time
        let softest = if yields { section.ei_p } else { section.ei };
        sys.model.loads.drag = DRAG / unit(section.ei).max(SHORTEST);
        let unit = unit(softest).max(SHORTEST);
        sys.state.past.forget();
        sys.refresh();
        let mut step = Implicit::new(Scheme::Bdf2, ctx.tolerance, BRIEFEST, LONGEST);
        step.flat = flat;
        Self {
            step: Stepper::Implicit(Box::new(step)),
            unit,
            tolerance: ctx.tolerance,
        }
    }

    /// Brings loads and supports from share 0 to share 1, smoothly, and waits for rest.
    pub(super) fn follow(
        &mut self,
        sys: &mut System,
        mut apply: impl FnMut(&mut System, f64),
    ) -> Result<(), VerifyError> {
        let part = RAMP * self.unit / PARTS as f64;
        for i in 1..=PARTS {
            let share = 0.5 - 0.5 * libm::cos(PI * i as f64 / PARTS as f64);
            let before = sys.state.support.map(|s| s.point);
            apply(sys, share);
            let after = sys.state.support.map(|s| s.point);
            for (end, support) in sys.state.support.iter_mut().enumerate() {
                support.velocity = (after[end] - before[end]) / part;
                support.point = before[end];
            }
            self.step.through(sys, part, part)?;
            for (end, support) in sys.state.support.iter_mut().enumerate() {
                support.velocity = V3::zeros();
                support.point = after[end];
            }
        }
        self.rest(sys)
    }

    /// Goes on until nothing moves.
    pub(super) fn rest(&mut self, sys: &mut System) -> Result<(), VerifyError> {
        let most = RESTS * self.tolerance / self.unit;
        for _ in 0..PATIENCE {
            self.step.through(sys, RAMP * self.unit, self.unit)?;
            let fastest = sys.state.rod.v.iter().map(V3::norm).fold(0.0, f64::max);
            if fastest < most {
                return Ok(());
            }
        }
        Err(VerifyError::NoAnswer(format!(
            "the wire did not come to rest within {} s",
            PATIENCE as f64 * RAMP * self.unit
        )))
    }
}
