//! What the method reports where no step goes on.

use super::newton::NewtonFailure;

/// Failure to find a step from the present instant.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "no step of {step:.2e} s or more goes on from here: {cause} at node {node} (update {update:.2e} m)"
)]
pub struct StepError {
    /// smallest step tried, s
    pub step: f64,
    /// node that would not settle
    pub node: usize,
    /// its last update, m
    pub update: f64,
    /// what is likely to blame
    pub cause: &'static str,
}

impl StepError {
    /// Error of a solve that ended in `failure`, with the smallest step tried, s.
    pub(super) fn at(step: f64, failure: &NewtonFailure) -> Self {
        Self {
            step,
            node: failure.node,
            update: failure.update,
            cause: if failure.update.is_finite() {
                "Newton's method does not settle"
            } else {
                "a value is not finite"
            },
        }
    }
}
