//! Commands that messages name, as a shell takes them.

use coilwind::output::WOUND_WITH;
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

/// What winds the scene of a folder again, from its start, with the options that it was wound with.
pub(super) fn begin_again(directory: &Path) -> String {
    let scene = quoted(directory.join(SCENE).display());
    let place = quoted(directory.display());
    let with = wound_with(directory);
    format!("begin again with: coilwind run {scene} --out {place}{with} --force")
}

/// The scene of a run in its folder.
pub(super) const SCENE: &str = "scene.toml";

/// The comment at the head of that file with these options, which are no part of the scene, a blank before each. It has its end of
/// line, and is empty where there are none.
pub(super) fn note(options: &str) -> String {
    // A name of two lines would end the comment in its middle.
    match options.is_empty() || options.contains(char::is_control) {
        true => String::new(),
        false => format!("{WOUND_WITH}{options}\n"),
    }
}

/// The options in the comment of a folder's scene, with a blank before each.
fn wound_with(directory: &Path) -> String {
    let text = std::fs::read_to_string(directory.join(SCENE)).unwrap_or_default();
    let first = text.lines().next().unwrap_or_default();
    first
        .strip_prefix(WOUND_WITH)
        .unwrap_or_default()
        .to_owned()
}
