//! Files that one process holds: a plan that two commands follow would be wound twice.

use super::failure::Failure;
use std::fs::File;
use std::io::{Error, ErrorKind, Write};
use std::path::{Path, PathBuf};

/// A file that no other process holds, until this is dropped. It is never replaced by another of its name: the lock is on the file
/// and not on the name.
#[derive(Debug)]
pub(super) struct Locked {
    file: File,
    path: PathBuf,
}

/// Holds a file, empty where there was none; `None` where another process holds it.
fn create(path: &Path) -> Result<Option<Locked>, Error> {
    let mut options = File::options();
    let file = options
        .write(true)
        .create(true)
        .truncate(false)
        .open(path)?;
    Ok(locked(file, path))
}

/// Holds a file that is there; `None` where another process holds it.
fn open(path: &Path) -> Result<Option<Locked>, Error> {
    Ok(locked(File::options().write(true).open(path)?, path))
}

/// Holds a plan, empty where there was none; the error of what `goes_on` where another process follows it.
pub(super) fn begin(path: &Path, goes_on: impl FnOnce() -> Failure) -> Result<Locked, Failure> {
    let locked = create(path).map_err(|e| Failure::write(path, e))?;
    locked.ok_or_else(goes_on)
}

/// Holds a plan, if there is one; the error of what `goes_on` where another process follows it.
pub(super) fn hold(
    path: &Path,
    goes_on: impl FnOnce() -> Failure,
) -> Result<Option<Locked>, Failure> {
    match open(path) {
        Ok(locked) => locked.map(Some).ok_or_else(goes_on),
        Err(error) if matches!(error.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) => {
            Ok(None)
        }
        Err(error) => Err(Failure::write(path, error)),
    }
}

fn locked(file: File, path: &Path) -> Option<Locked> {
    // Not every file system has locks; on Windows a lock would keep readers out as well.
    let taken = cfg!(unix) && matches!(file.try_lock(), Err(std::fs::TryLockError::WouldBlock));
    let path = path.to_owned();
    // Who held it a moment ago may have removed it since.
    (!taken && is_at(&file, &path)).then_some(Locked { file, path })
}

/// Whether the name is still that of the file.
#[cfg(unix)]
fn is_at(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let number = |data: std::fs::Metadata| (data.dev(), data.ino());
    let (here, there) = (
        file.metadata().map(number),
        std::fs::metadata(path).map(number),
    );
    here.is_ok() && here.ok() == there.ok()
}

#[cfg(not(unix))]
fn is_at(_: &File, _: &Path) -> bool {
    true
}

impl Locked {
    /// Puts these bytes in the place of what the file holds, or nothing where there is no room for all.
    pub(super) fn write(&mut self, bytes: &[u8]) -> Result<(), Error> {
        // A device in place of a file is what tests put there.
        if self.file.metadata()?.is_file() {
            self.file.set_len(0)?;
        }
        let written = self.file.write_all(bytes);
        if written.is_err() {
            // (a device has no end to go back to)
            let _ = self.file.set_len(0);
        }
        written
    }

    /// Removes the file.
    pub(super) fn remove(self) -> Result<(), Error> {
        std::fs::remove_file(&self.path)
    }
}
