//! Files that a run leaves behind: tables, summary, three-dimensional coil and its picture.
//!
//! Everything here is written from finished results; nothing is read back into a computation.

mod camera;
mod history;
mod picture;
mod raster;
mod report;
mod results;
mod shade;
mod summary;
mod tables;
mod tube;
mod vtk_xml;
mod vtp;
mod whole;

pub use history::{History, Mark};
pub use picture::{Colouring, CoreMesh, Picture, render, render_png};
pub use report::{READ, ReportError, WOUND_WITH, missing_files, write_report};
pub use results::{Ending, RESULTS, Snapshot, write_results};
pub use summary::write_summary;
pub use tables::{write_defects, write_stations, write_turns};
pub use tube::{TubeMesh, tube_mesh};
pub use vtp::{WireFields, write_core_vtp, write_frame, write_series, write_vtp};
pub use whole::{PARTIAL, write_whole, write_whole_bytes};

use std::path::{Path, PathBuf};

/// A file could not be written.
#[derive(Debug, thiserror::Error)]
pub enum OutputError {
    /// the operating system refused
    #[error("cannot write {}: {source}", path.display())]
    Io {
        /// file that was to be written
        path: PathBuf,
        /// what the system said
        source: std::io::Error,
    },
    /// a table could not be encoded
    #[error("cannot write table {}: {source}", path.display())]
    Csv {
        /// file that was to be written
        path: PathBuf,
        /// what the encoder said
        source: csv::Error,
    },
    /// the summary could not be encoded
    #[error("cannot write {}: {source}", path.display())]
    Json {
        /// file that was to be written
        path: PathBuf,
        /// what the encoder said
        source: serde_json::Error,
    },
    /// the picture could not be encoded
    #[error("cannot write picture {}: {source}", path.display())]
    Image {
        /// file that was to be written
        path: PathBuf,
        /// what the encoder said
        source: png::EncodingError,
    },
    /// arrays that belong together differ in length
    #[error("cannot write {}: {name} has {got} values for {expected} nodes", path.display())]
    Length {
        /// file that was to be written
        path: PathBuf,
        /// the array
        name: &'static str,
        /// its length
        got: usize,
        /// the length of the wire
        expected: usize,
    },
    /// a triangle names a vertex that does not exist
    #[error("cannot write {}: triangle {triangle} names a vertex beyond {vertices}", path.display())]
    Mesh {
        /// file that was to be written
        path: PathBuf,
        /// the triangle, from 0
        triangle: usize,
        /// number of vertices
        vertices: usize,
    },
}

impl OutputError {
    pub(crate) fn io(path: &Path) -> impl FnOnce(std::io::Error) -> Self {
        move |source| Self::Io {
            path: path.to_owned(),
            source,
        }
    }
}
