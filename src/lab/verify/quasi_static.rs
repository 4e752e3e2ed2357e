//! Rest by the steps that wind: loads rise slowly, the wire follows in time and comes to rest under drag.

use super::bench::Stepper;
use super::{Context, VerifyError};
use crate::integrate::{Implicit, Scheme};
use crate::lab::statics::out_of_balance;
use crate::math::V3;
use crate::system::System;
use std::f64::consts::PI;

/// Least parts of a ramp. Supports move evenly within them, loads and directions jump from one to the next. Wire that hardens
/// little yields by what it swings beyond such a jump. With 200 parts, curvatures at rest are off by up to 30 %.
const PARTS: f64 = 1000.0;
/// Most parts of a ramp: steps so short get nowhere.
const MOST_PARTS: f64 = 1e7;
/// Time of a ramp in units of `L^2 sqrt(m / EI)`, a sixth of the period of a cantilever. Drag keeps yielding wire behind its
/// loads and bends it more where it is held: by 4 % of the least curvature of thick wire with a quarter of this time.
const RAMP: f64 = 48.0;
/// Time between two looks for rest, in the same unit.
const LOOK: f64 = 12.0;
/// Shortest unit, s: a short piece is bent in the time that a wind takes to bend wire over a corner.
const SHORTEST: f64 = 2e-3;
/// Drag in the inverse of that unit: close to what lets the slowest bending mode of a cantilever creep in fastest.
const DRAG: f64 = 7.0;
/// Shortest and longest step of a wind, s.
const BRIEFEST: f64 = 1e-9;
const LONGEST: f64 = 0.1;
/// Looks for rest before it is given up.
const PATIENCE: usize = 20;
/// Speed that counts as rest, as a share of the tolerance over the unit of time.
const RESTS: f64 = 0.02;

/// Largest force out of balance at rest over the loads. A step is done when nothing moves by more than a share of the tolerance,
/// and stiff wire may be far from balance then. It takes a few more steps of smaller tolerances, in which next to nothing moves.
const IMBALANCE: f64 = 1e-4;
/// The same over `EI / L^2`, which counts where nothing loads the wire any more.
const IMBALANCE_FREE: f64 = 1e-6;
/// Roundings of a place that a tension may be off by: those of the two ends of an edge, for the edges on both sides of a node.
const ROUNDINGS: f64 = 4.0;

/// Whether the forces on every node balance, as far as rounding of their places lets them.
fn balanced(sys: &System) -> Result<bool, VerifyError> {
    let (worst, load) = out_of_balance(sys)?;
    let (rest, section) = (&sys.state.rod.rest, &sys.model.section);
    let length: f64 = rest.iter().sum();
    let shortest = rest.iter().copied().fold(f64::INFINITY, f64::min);
    let free = IMBALANCE_FREE * section.ei / (length * length);
    let rounding = ROUNDINGS * f64::EPSILON * section.ea * length / shortest;
    Ok(worst <= (IMBALANCE * load).max(free).max(rounding))
}

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
    ///
    /// A part is as long as the step that the method takes. Small tolerances then see small jumps and not a swing after each.
    pub(super) fn follow(
        &mut self,
        sys: &mut System,
        mut apply: impl FnMut(&mut System, f64),
    ) -> Result<(), VerifyError> {
        let ramp = RAMP * self.unit;
        let longest = ramp / PARTS;
        let (mut done, mut part) = (0.0, longest);
        while done < ramp {
            part = part.min(ramp - done);
            if part < 1e-9 * longest {
                break;
            }
            let share = 0.5 - 0.5 * libm::cos(PI * (done + part) / ramp);
            let before = sys.state.support.map(|s| s.point);
            apply(sys, share);
            let after = sys.state.support.map(|s| s.point);
            for (end, support) in sys.state.support.iter_mut().enumerate() {
                support.velocity = (after[end] - before[end]) / part;
                support.point = before[end];
            }
            let steps = self.step.through(sys, part, part)?;
            for (end, support) in sys.state.support.iter_mut().enumerate() {
                support.velocity = V3::zeros();
                support.point = after[end];
            }
            done += part;
            part = match steps {
                1 => (2.0 * part).min(longest),
                _ => (part / steps as f64).max(ramp / MOST_PARTS),
            };
        }
        apply(sys, 1.0);
        self.rest(sys)
    }

    /// Goes on until nothing moves.
    pub(super) fn rest(&mut self, sys: &mut System) -> Result<(), VerifyError> {
        let most = RESTS * self.tolerance / self.unit;
        let mut last = f64::INFINITY;
        for _ in 0..PATIENCE {
            self.step.through(sys, LOOK * self.unit, self.unit)?;
            let fastest = sys.state.rod.v.iter().map(V3::norm).fold(0.0, f64::max);
            if fastest < most && balanced(sys)? {
                return Ok(());
            }
            // what no longer slows down is what the last steps left undone
            if fastest < most || fastest > 0.5 * last {
                self.step.tighten();
            }
            last = fastest;
        }
        Err(VerifyError::NoAnswer(format!(
            "the wire did not come to rest within {} s",
            PATIENCE as f64 * LOOK * self.unit
        )))
    }
}
