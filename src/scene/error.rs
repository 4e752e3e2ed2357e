//! What can be wrong with a scene: always where, which key, which value, and what is allowed.
//!
//! Texts are `Box<str>`: a `Result` with five of them stays small enough to hand around.

use crate::settings::Origin;
use std::fmt;
use thiserror::Error;

/// A scene that cannot be run, and why.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum SceneError {
    /// Neither a packed scene nor a file.
    #[error(
        "no scene {name}: neither a packed scene ({packed}) nor a file{}",
        also(suggestion)
    )]
    NotFound {
        /// as given
        name: Box<str>,
        /// names of the packed scenes
        packed: Box<str>,
        /// packed scene of a similar name
        suggestion: Option<Box<str>>,
    },
    /// The file is there but cannot be read as text.
    #[error("{file}: cannot be read: {reason}")]
    Unreadable {
        /// path as given
        file: Box<str>,
        /// of the operating system
        reason: Box<str>,
    },
    /// The text is not TOML.
    #[error("{origin}: not valid TOML: {message}")]
    Syntax {
        /// file and line
        origin: Origin,
        /// of the parser
        message: Box<str>,
    },
    /// A section that scenes do not have.
    #[error(
        "{origin}: unknown section [{section}]{}; sections are {allowed}",
        also(suggestion)
    )]
    UnknownSection {
        /// file and line
        origin: Origin,
        /// as given
        section: Box<str>,
        /// nearest known section
        suggestion: Option<Box<str>>,
        /// all sections
        allowed: Box<str>,
    },
    /// A key that scenes do not have.
    #[error(
        "{origin}: unknown key {key} (value {value}){}; {allowed}",
        also(suggestion)
    )]
    UnknownKey {
        /// file and line
        origin: Origin,
        /// as given, with its section
        key: Box<str>,
        /// as given
        value: Box<str>,
        /// nearest known key, with its unit where one was given
        suggestion: Option<Box<str>>,
        /// the keys of the section
        allowed: Box<str>,
    },
    /// A known key with the unit of something else.
    #[error("{origin}: {key} = {value}: {stem} cannot have this unit; allowed are {allowed}")]
    WrongUnit {
        /// file and line
        origin: Origin,
        /// as given
        key: Box<str>,
        /// as given
        value: Box<str>,
        /// the key without unit
        stem: Box<str>,
        /// the key with each of its units
        allowed: Box<str>,
    },
    /// The same leaf given twice in one file or by name, perhaps in two units.
    #[error(
        "{origin}: {key} = {value}: {leaf} was already given as {first}; allowed is one of the two"
    )]
    Repeated {
        /// file and line
        origin: Origin,
        /// as given
        key: Box<str>,
        /// as given
        value: Box<str>,
        /// name in the variable table
        leaf: Box<str>,
        /// key that came first
        first: Box<str>,
    },
    /// A text where a number belongs, and the like.
    #[error("{origin}: {key} = {value} is {found}; allowed is {allowed}")]
    WrongType {
        /// file and line
        origin: Origin,
        /// as given
        key: Box<str>,
        /// as given
        value: Box<str>,
        /// what it is
        found: Box<str>,
        /// what the row takes
        allowed: Box<str>,
    },
    /// A value outside the range of its row.
    #[error("{origin}: {key} = {value} is out of range; allowed: {allowed}")]
    OutOfRange {
        /// file and line
        origin: Origin,
        /// as given
        key: Box<str>,
        /// as given
        value: Box<str>,
        /// range or choices
        allowed: Box<str>,
    },
    /// A value that the rest of the scene makes impossible.
    #[error("{origin}: {key} = {value} is impossible here: {reason}; allowed: {allowed}")]
    Impossible {
        /// where the value came from
        origin: Origin,
        /// name in the variable table
        key: Box<str>,
        /// in SI, with unit
        value: Box<str>,
        /// what it contradicts
        reason: Box<str>,
        /// what would do
        allowed: Box<str>,
    },
    /// No scene, and no check that says why.
    #[error("no scene can be made of these values, and no check says why: a fault of coilwind")]
    Unexplained,
    /// More than one of the above, a line each.
    #[error("{}", lines(errors))]
    Several {
        /// at least two, none of them of this kind
        errors: Vec<SceneError>,
    },
}

/// A scene that runs, but perhaps not as meant.
#[derive(Clone, Debug, PartialEq)]
pub struct Warning {
    /// where the value came from
    pub origin: Origin,
    /// name in the variable table
    pub key: &'static str,
    /// in SI, with unit
    pub value: String,
    /// what to expect
    pub message: String,
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{}: {} = {}: {}",
            self.origin, self.key, self.value, self.message
        )
    }
}

fn lines(errors: &[SceneError]) -> String {
    let lines: Vec<String> = errors.iter().map(ToString::to_string).collect();
    lines.join("\n")
}

fn also(suggestion: &Option<Box<str>>) -> String {
    suggestion
        .as_ref()
        .map(|s| format!("; did you mean {s}?"))
        .unwrap_or_default()
}
