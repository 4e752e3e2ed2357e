//! Why no report can be made.

use crate::output::OutputError;
use std::path::PathBuf;

/// No report can be made.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// the folder does not hold the results of a run
    #[error(
        "{} holds no results of a run ({} is missing); wind one with: coilwind run SCENE --out {}",
        directory.display(), missing, directory.display()
    )]
    NoRun {
        /// the folder
        directory: PathBuf,
        /// the file that is looked for first
        missing: &'static str,
    },
    /// a file where the folder of a run belongs
    #[error("{} is a file; name the folder of a run", path.display())]
    NoFolder {
        /// the file
        path: PathBuf,
    },
    /// a file of the run is not whole
    #[error("{} is not whole ({reason}); wind the scene again, or go on with: coilwind run --resume {}", path.display(), path.parent().unwrap_or(path).display())]
    Broken {
        /// the file
        path: PathBuf,
        /// what is wrong with it
        reason: String,
    },
    /// the page cannot be written
    #[error(transparent)]
    Output(#[from] OutputError),
}
