//! Why a search for equilibrium fails.

/// Why no equilibrium was found.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum RelaxError {
    /// The iterations ran out.
    #[error(
        "no equilibrium at {share} of the load: out of balance by {residual} of it after {iterations} iterations"
    )]
    NotConverged {
        /// share of the load, 1 unless ramped
        share: f64,
        /// relative out-of-balance force
        residual: f64,
        /// Newton steps taken
        iterations: usize,
    },
    /// Nothing holds this part of the wire.
    #[error("nothing holds node {node} at {share} of the load")]
    SingularPivot {
        /// first node without stiffness
        node: usize,
        /// share of the load, 1 unless ramped
        share: f64,
    },
    /// A force is not a number.
    #[error("the forces broke down at node {node} at {share} of the load")]
    Broken {
        /// first bad node
        node: usize,
        /// share of the load, 1 unless ramped
        share: f64,
    },
}

impl RelaxError {
    pub(super) fn at_share(self, share: f64) -> Self {
        match self {
            Self::NotConverged {
                residual,
                iterations,
                ..
            } => Self::NotConverged {
                share,
                residual,
                iterations,
            },
            Self::SingularPivot { node, .. } => Self::SingularPivot { node, share },
            Self::Broken { node, .. } => Self::Broken { node, share },
        }
    }
}
