//! Where the value of a leaf came from.

use serde::{Deserialize, Serialize};
use std::fmt;

/// Where a value came from.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Origin {
    /// the default of the program
    #[default]
    Default,
    /// a scene file or packed scene
    File {
        /// name as the user knows it
        file: Box<str>,
        /// line from 1, where known
        line: Option<usize>,
    },
    /// set by name: `--set`, or a parameter of the FMU
    Set,
    /// the default of the program, under a scene that leaves it out
    LeftOut {
        /// name of the scene as the user knows it
        file: Box<str>,
    },
}

impl fmt::Display for Origin {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Default => f.write_str("default scene"),
            Self::File {
                file,
                line: Some(line),
            } => write!(f, "{file}:{line}"),
            Self::File { file, line: None } => f.write_str(file),
            Self::Set => f.write_str("set by name"),
            Self::LeftOut { file } => write!(f, "{file}, by default"),
        }
    }
}
