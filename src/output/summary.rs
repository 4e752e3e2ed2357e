//! `summary.json`, complete or absent.

use super::OutputError;
use serde::Serialize;
use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::path::Path;

/// Writes `value` as indented JSON.
///
/// The text goes to a file beside `path` that is renamed at the end. A reader finds the old summary
/// or the new one, never half of it, even when the run is stopped while writing.
pub fn write_summary(path: &Path, value: &impl Serialize) -> Result<(), OutputError> {
    let mut partial = path.as_os_str().to_owned();
    partial.push(".partial");
    let partial = Path::new(&partial);
    let written = write_json(partial, value)
        .and_then(|()| fs::rename(partial, path).map_err(OutputError::io(path)));
    if written.is_err() {
        // The first error is the one worth telling.
        let _ = fs::remove_file(partial);
    }
    written
}

fn write_json(path: &Path, value: &impl Serialize) -> Result<(), OutputError> {
    let mut file = BufWriter::new(File::create(path).map_err(OutputError::io(path))?);
    serde_json::to_writer_pretty(&mut file, value).map_err(|source| OutputError::Json {
        path: path.to_owned(),
        source,
    })?;
    file.write_all(b"\n").map_err(OutputError::io(path))?;
    let file = file
        .into_inner()
        .map_err(|e| OutputError::io(path)(e.into_error()))?;
    file.sync_all().map_err(OutputError::io(path))
}
