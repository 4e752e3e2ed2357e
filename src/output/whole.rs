//! Files that are whole or absent, whatever happens while they are written.

use super::OutputError;
use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::path::Path;

/// Ending of the name of a file on its way.
pub const PARTIAL: &str = ".partial";

/// Writes a file by way of one beside it, which takes its name at the end.
///
/// A reader finds the old file or the new one, never half of it, also after a kill and on a full disk. A device is
/// written to as it is.
///
/// # Errors
/// The first of `write` or of the operating system.
pub fn write_whole(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<File>) -> Result<(), OutputError>,
) -> Result<(), OutputError> {
    let is_device = fs::metadata(path).is_ok_and(|data| !data.is_file() && !data.is_dir());
    if is_device {
        return fill(path, path, write);
    }
    let mut partial = path.as_os_str().to_owned();
    partial.push(PARTIAL);
    let partial = Path::new(&partial);
    let written = fill(partial, path, write)
        .and_then(|()| fs::rename(partial, path).map_err(OutputError::io(path)));
    if written.is_err() {
        // The first error is the one worth telling.
        let _ = fs::remove_file(partial);
    }
    written
}

/// Creates `file` and writes it; errors name `path`.
fn fill(
    file: &Path,
    path: &Path,
    write: impl FnOnce(&mut BufWriter<File>) -> Result<(), OutputError>,
) -> Result<(), OutputError> {
    let mut file = BufWriter::new(File::create(file).map_err(OutputError::io(path))?);
    write(&mut file)?;
    file.flush().map_err(OutputError::io(path))
}

/// [`write_whole`] of bytes that are there.
///
/// # Errors
/// Where the operating system refuses.
pub fn write_whole_bytes(path: &Path, bytes: impl AsRef<[u8]>) -> Result<(), OutputError> {
    write_whole(path, |file| {
        file.write_all(bytes.as_ref())
            .map_err(OutputError::io(path))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_fails_on_the_way_leaves_the_old_file_and_nothing_beside_it() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("table.csv");
        write_whole_bytes(&path, "old").unwrap();
        let failed = write_whole(&path, |file| {
            file.write_all(&[b'x'; 1 << 16]).unwrap();
            Err(OutputError::io(&path)(std::io::Error::other("full")))
        });
        assert!(failed.unwrap_err().to_string().contains("table.csv: full"));
        assert_eq!(fs::read_to_string(&path).unwrap(), "old");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
        write_whole_bytes(&path, "new").unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "new");
    }
}
