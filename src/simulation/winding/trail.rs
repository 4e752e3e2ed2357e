//! What single steps of the method did, for a judge who compares runs (feature `lab`).

use crate::contact::TouchMark;
use crate::integrate::SolverStatistics;

/// What one step of the method did. Runs that do the same in each of their steps are a smooth function of their inputs, but for
/// what Newton's method leaves.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StepTrail {
    /// contact points that touch at its end
    pub touching: Vec<TouchMark>,
    /// those of them that slide
    pub sliding: Vec<TouchMark>,
    /// places in the wire that yielded: in bending, twist and stretch
    pub yielding: [Vec<usize>; 3],
    /// live nodes at its end
    pub nodes: usize,
    /// what the method took for it: of all counts those of this step
    pub taken: SolverStatistics,
}
