//! Exact answers against the code that winds.
//!
//! A case file names a `kind`; each kind is one file here that sets up the same rod, section,
//! contact and feed as a winding run, lets it compute, and reads the answer off it.

mod bench;
pub mod capstan;
pub mod groove_seat;
pub mod penalty_impact;
pub mod shoulder_drop;
pub mod shoulder_static;
pub mod spinning_ring;
pub mod twist_buckling;
pub mod winding_feed;

use crate::rod::Section;
use std::path::Path;

/// One case, ready to run.
#[derive(Clone, Copy, Debug)]
pub struct Context<'a> {
    /// the file's wire; elastic where the kind says so
    pub section: &'a Section,
    /// the case's `inputs`
    pub inputs: &'a serde_json::Map<String, serde_json::Value>,
    /// folder of the case file, for paths in it
    pub folder: &'a Path,
}

/// A computed quantity.
#[derive(Clone, Debug, PartialEq)]
pub enum Answer {
    /// a number
    Number(f64),
    /// a list, compared element by element
    List(Vec<f64>),
    /// a yes or no
    Flag(bool),
}

/// Computed quantities by name.
pub type Answers = Vec<(&'static str, Answer)>;

/// A case that can't be run.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum VerifyError {
    /// an input is missing or of the wrong type
    #[error("input {name}: {problem}")]
    Input {
        /// its name
        name: String,
        /// what is wrong
        problem: String,
    },
    /// the computation did not get there
    #[error("no answer: {0}")]
    NoAnswer(String),
}

impl Context<'_> {
    /// A number among the inputs.
    pub fn number(&self, name: &str) -> Result<f64, VerifyError> {
        let value = self.inputs.get(name).and_then(serde_json::Value::as_f64);
        value
            .filter(|v| v.is_finite())
            .ok_or_else(|| VerifyError::Input {
                name: name.to_owned(),
                problem: "a finite number is wanted".to_owned(),
            })
    }

    /// A text among the inputs.
    pub fn text(&self, name: &str) -> Result<&str, VerifyError> {
        self.inputs
            .get(name)
            .and_then(serde_json::Value::as_str)
            .ok_or_else(|| VerifyError::Input {
                name: name.to_owned(),
                problem: "a text is wanted".to_owned(),
            })
    }

    /// The section without yield limits.
    pub fn elastic(&self) -> Section {
        let open = f64::INFINITY;
        Section {
            n_y: open,
            m_y: open,
            t_y: open,
            moment_cap: open,
            ..self.section.clone()
        }
    }
}
