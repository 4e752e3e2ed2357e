//! `summary.json`, complete or absent.

use super::{OutputError, write_whole};
use serde::Serialize;
use std::io::Write;
use std::path::Path;

/// Writes `value` as indented JSON, by [`write_whole`], and waits until it is on the disk.
pub fn write_summary(path: &Path, value: &impl Serialize) -> Result<(), OutputError> {
    write_whole(path, |file| {
        serde_json::to_writer_pretty(&mut *file, value).map_err(|source| OutputError::Json {
            path: path.to_owned(),
            source,
        })?;
        let end = file.write_all(b"\n").and_then(|()| file.flush());
        end.and_then(|()| file.get_ref().sync_all())
            .map_err(OutputError::io(path))
    })
}
