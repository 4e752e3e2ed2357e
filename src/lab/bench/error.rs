//! Why a benchmark gives no line.

use super::problem::Problem;
use crate::scene::SceneError;
use crate::simulation::SimError;
use thiserror::Error;

/// What keeps a benchmark from giving a line.
#[derive(Debug, Error)]
pub enum BenchError {
    /// An option that the problem does not take, or not with this value.
    #[error("bench {problem}: {option}: {reason}; allowed: {allowed}")]
    Option {
        /// as printed
        problem: Problem,
        /// with its value
        option: String,
        /// what is wrong
        reason: String,
        /// what would do
        allowed: String,
    },
    /// The scene is wrong.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The scene is valid but a run of it cannot start.
    #[error("bench {problem}: cannot start: {reason}")]
    Start {
        /// as printed
        problem: Problem,
        /// why
        reason: SimError,
    },
    /// A file of converged runs that cannot be read, understood or written.
    #[error("{file}: {reason}")]
    File {
        /// path
        file: String,
        /// what is wrong
        reason: String,
    },
}
