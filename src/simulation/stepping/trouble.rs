//! Steps of the method that were out of the ordinary.

use crate::integrate::{PATIENCE, SolverStatistics};
use crate::signals::EventKind;
use crate::simulation::Winding;

impl Winding {
    /// Tells of the step just taken, of `taken` s, if it was hard to find or is off by more than it may be; `before` are the counts
    /// from before it.
    ///
    /// Steps that were shortened for their error, or after fewer searches than the method has [`PATIENCE`] for, are ordinary and are only
    /// counted.
    pub(super) fn tell_of_trouble(&mut self, before: SolverStatistics, taken: f64) {
        let now = self.statistics();
        let in_vain = now.newton_failures - before.newton_failures;
        if now.forced > before.forced {
            let text = format!(
                "the solver took a step of {taken:.2e} s, its shortest, with an error above solver.tolerance, after {in_vain} searches in vain; what follows may be off by more than that tolerance"
            );
            self.report(EventKind::Solver, text);
        } else if in_vain >= PATIENCE {
            let text = format!(
                "the solver found a step after {in_vain} searches in vain, one of {taken:.2e} s; it meets solver.tolerance, so nothing needs to be done"
            );
            self.report(EventKind::Solver, text);
        }
    }

    /// Tells that no step was found; `before` are the counts from before it was looked for.
    pub(super) fn tell_of_failure(&mut self, before: SolverStatistics) {
        let in_vain = self.statistics().newton_failures - before.newton_failures;
        let s = if in_vain == 1 { "" } else { "es" };
        let text = format!("the solver found no step after {in_vain} search{s} in vain");
        self.report(EventKind::Solver, text);
    }
}
