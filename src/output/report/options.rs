//! The options of a run that are no part of its scene, and what it read, as the head of its `scene.toml` has them.

use std::fs;
use std::path::Path;

/// Begins the line that has them.
pub const WOUND_WITH: &str = "# wound with:";

/// Begins the line that has the checksums of the files that a run read.
pub const READ: &str = "# read:";

/// An option with a value that decides which coil is wound.
pub(super) struct CoilOption {
    pub(super) name: &'static str,
    pub(super) meaning: &'static str,
    /// of its value; empty for a text
    pub(super) unit: &'static str,
}

const INPUTS: &str = "--inputs";
const STOP_TIME: &str = "--stop-time";

/// All such options.
pub(super) const OF_COIL: [CoilOption; 3] = [
    CoilOption {
        name: INPUTS,
        meaning: "file of the sampled inputs",
        unit: "",
    },
    CoilOption {
        name: "--step",
        meaning: "communication step of the inputs",
        unit: "s",
    },
    CoilOption {
        name: STOP_TIME,
        meaning: "simulated time at which to stop",
        unit: "s",
    },
];

/// The checksum of a file that the run in a folder read, by the name of its key or option; none where it is not known.
pub(super) fn checksum(directory: &Path, name: &str) -> Option<String> {
    let text = fs::read_to_string(directory.join("scene.toml")).ok()?;
    let read = text
        .lines()
        .take(2)
        .find_map(|line| line.strip_prefix(READ))?;
    let of_name = |word: &str| Some(word.strip_prefix(name)?.strip_prefix('=')?.to_owned());
    words(read).iter().find_map(|word| of_name(word))
}

/// The options of a run, word by word.
#[derive(Default)]
pub(super) struct Options(Vec<String>);

impl Options {
    /// Those of the run in a folder; none where it has no scene.
    pub(super) fn read(directory: &Path) -> Self {
        let text = fs::read_to_string(directory.join("scene.toml")).unwrap_or_default();
        let first = text.lines().next().unwrap_or_default();
        Self(words(first.strip_prefix(WOUND_WITH).unwrap_or_default()))
    }

    /// What was given for an option.
    pub(super) fn value(&self, name: &str) -> Option<&str> {
        let place = self.0.iter().position(|word| word == name)?;
        self.0.get(place + 1).map(String::as_str)
    }

    /// How far a run was wound that ended as it was to end, after so much simulated time, s.
    pub(super) fn wound_to(&self, simulated: f64) -> String {
        if let Some(text) = self.value(STOP_TIME)
            && let Ok(stop) = text.parse::<f64>()
            // Points of time are sums of steps.
            && simulated >= stop * (1.0 - 1e-9)
        {
            return format!("wound until {STOP_TIME} {text} s");
        }
        match self.value(INPUTS) {
            Some(_) => "wound to the end of its inputs".to_owned(),
            None => "wound to its end".to_owned(),
        }
    }
}

/// The words of a line as a shell takes them, of which some are in single quotes.
fn words(line: &str) -> Vec<String> {
    let mut words = Vec::new();
    let mut word: Option<String> = None;
    let mut quoted = false;
    let mut chars = line.chars();
    while let Some(c) = chars.next() {
        match c {
            '\'' => {
                quoted = !quoted;
                word.get_or_insert_default();
            }
            ' ' if !quoted => words.extend(word.take()),
            '\\' if !quoted => word.get_or_insert_default().extend(chars.next()),
            c => word.get_or_insert_default().push(c),
        }
    }
    words.extend(word);
    words
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_those_of_a_shell() {
        let line = r" --inputs '/my runs/it'\''s.csv' --step 0.5";
        assert_eq!(
            words(line),
            ["--inputs", "/my runs/it's.csv", "--step", "0.5"]
        );
        assert!(words("").is_empty());
    }
}
