//! Whether a case ends the same way at half the tolerance and half the spacing.

use super::case::built;
use super::invariants::judge;
use super::{Case, Outcome, Verdict};

/// How much finer: tolerance and spacing are divided by this.
const FINER: f64 = 2.0;

/// A case as it was drawn and made finer.
#[derive(Clone, Debug, PartialEq)]
pub struct Refined {
    /// at half the tolerance and half the spacing
    pub finer: Verdict,
    /// both ended the same way
    pub same_outcome: bool,
    /// both say the same of the coil, as far as both wound it
    pub same_verdict: bool,
}

/// Runs `case` finer and compares with what came of it as it was drawn. Its mesh, if it has one, is on disk.
pub fn refine(case: &Case, drawn: &Verdict) -> Result<Refined, String> {
    let scene = built(&case.settings).map_err(|e| e.to_string())?;
    let mut finer = case.clone();
    let solver = &mut finer.settings.solver;
    solver.tolerance = scene.solver.tolerance / FINER;
    solver.spacing_near = scene.solver.spacing_near / FINER;
    solver.spacing_free = scene.solver.spacing_free / FINER;
    built(&finer.settings).map_err(|e| e.to_string())?;
    let verdict = judge(&finer);
    Ok(Refined {
        same_outcome: same_way(&drawn.outcome, &verdict.outcome),
        same_verdict: drawn.measures.defects == verdict.measures.defects,
        finer: verdict,
    })
}

fn same_way(a: &Outcome, b: &Outcome) -> bool {
    match (a, b) {
        (Outcome::Completed, Outcome::Completed)
        | (Outcome::Broke { .. }, Outcome::Broke { .. })
        | (Outcome::Ended { .. }, Outcome::Ended { .. })
        | (Outcome::GaveUp { .. }, Outcome::GaveUp { .. }) => true,
        (Outcome::Invariant { what: a, .. }, Outcome::Invariant { what: b, .. }) => a == b,
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::stress::draw;

    #[test]
    fn a_case_that_ends_otherwise_is_told() {
        let mut case = draw::case(1, 4).unwrap();
        case.inputs.truncate(40);
        let drawn = judge(&case);
        let refined = refine(&case, &drawn).unwrap();
        assert!(refined.same_outcome && refined.same_verdict);
        assert!(refined.finer.measures.nodes > drawn.measures.nodes);
        let mut other = drawn;
        other.measures.defects = 4;
        other.outcome = Outcome::Broke {
            time: 0.0,
            text: String::new(),
        };
        let refined = refine(&case, &other).unwrap();
        assert!(!refined.same_outcome && !refined.same_verdict);
    }
}
