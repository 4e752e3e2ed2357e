//! Commands that messages name, as a shell takes them.

use std::fmt::Display;
use std::path::Path;

/// A word as a shell takes it: in quotes where it has anything that means something to a shell.
pub(super) fn quoted(word: impl Display) -> String {
    let word = word.to_string();
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_=:./,+".contains(c);
    match !word.is_empty() && word.chars().all(plain) {
        true => word,
        false => format!("'{}'", word.replace('\'', r"'\''")),
    }
}

/// The command that goes on with the run in a folder.
pub(super) fn resume_command(directory: impl Display) -> String {
    format!("coilwind run --resume {}", quoted(directory))
}

/// What winds the scene of a folder again, from its start.
pub(super) fn begin_again(directory: &Path) -> String {
    let scene = quoted(directory.join("scene.toml").display());
    let place = quoted(directory.display());
    format!("begin again with: coilwind run {scene} --out {place} --force")
}
