//! Names in the folder of an ensemble.

use std::path::Path;

/// What an ensemble is, in its folder until all members have ended.
pub(super) const FILE: &str = "ensemble.bin";
/// Members that an ensemble may have, each in the folder of its number.
pub(super) const MOST: u32 = 1000;

/// Whether a folder holds an ensemble that could go on.
pub(super) fn is_in(directory: &Path) -> bool {
    directory.join(FILE).is_file()
}
