//! What can go wrong while describing and packing.

use std::path::PathBuf;

/// Why the description could not be written.
#[derive(Debug, thiserror::Error)]
pub enum DescriptionError {
    /// The XML writer failed.
    #[error("writing XML: {0}")]
    Write(#[from] std::io::Error),
}

/// Why no FMU was written.
#[derive(Debug, thiserror::Error)]
pub enum PackError {
    /// There is no description.
    #[error(transparent)]
    Description(#[from] DescriptionError),
    /// The extension of a library does not tell its platform.
    #[error("{path}: a shared library ends in .so, .dll or .dylib")]
    Platform {
        /// The library.
        path: PathBuf,
    },
    /// Two libraries are for the same platform.
    #[error("{path}: a second library for {platform}; pass one library per platform")]
    Twice {
        /// The second library.
        path: PathBuf,
        /// FMI's name of the platform.
        platform: &'static str,
    },
    /// A file could not be read or written.
    #[error("{path}: {source}")]
    File {
        /// The file or folder.
        path: PathBuf,
        /// What the operating system says.
        source: std::io::Error,
    },
    /// The archive could not be written.
    #[error("{path}: {source}")]
    Archive {
        /// The FMU.
        path: PathBuf,
        /// What the zip writer says.
        source: zip::result::ZipError,
    },
}

/// Why the licences could not be collected.
#[derive(Debug, thiserror::Error)]
pub enum LicenseError {
    /// The text is not what `cargo metadata` prints.
    #[error("cargo metadata: {0}")]
    Metadata(#[from] serde_json::Error),
    /// The package to start from is not in the workspace.
    #[error("cargo metadata names no package {name}")]
    NoRoot {
        /// Name of the package.
        name: String,
    },
    /// A crate has no licence file.
    #[error(
        "{package} has no licence file in {directory}; \
         name a crate that has its text in modelDescription/src/licenses.rs"
    )]
    NoText {
        /// Name and version of the crate.
        package: String,
        /// The folder of its sources.
        directory: PathBuf,
    },
    /// A licence file could not be read.
    #[error("{path}: {source}")]
    File {
        /// The file or folder.
        path: PathBuf,
        /// What the operating system says.
        source: std::io::Error,
    },
}
