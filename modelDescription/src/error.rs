//! What can go wrong while describing and packing.

use std::path::PathBuf;

/// Why the description could not be written.
#[derive(Debug, thiserror::Error)]
pub enum DescriptionError {
    /// the XML writer failed
    #[error("writing XML: {0}")]
    Write(#[from] std::io::Error),
}

/// Why no FMU was written.
#[derive(Debug, thiserror::Error)]
pub enum PackError {
    /// no description
    #[error(transparent)]
    Description(#[from] DescriptionError),
    /// the file name does not tell the platform
    #[error("{path}: a shared library ends in .so, .dll or .dylib")]
    Platform {
        /// the library
        path: PathBuf,
    },
    /// two libraries for one platform
    #[error("{path}: a second library for {platform}")]
    Twice {
        /// the second library
        path: PathBuf,
        /// FMI name of the platform
        platform: &'static str,
    },
    /// a file could not be read or written
    #[error("{path}: {source}")]
    File {
        /// which file
        path: PathBuf,
        /// what the system says
        source: std::io::Error,
    },
    /// the archive could not be written
    #[error("{path}: {source}")]
    Archive {
        /// the FMU
        path: PathBuf,
        /// what the zip writer says
        source: zip::result::ZipError,
    },
}
