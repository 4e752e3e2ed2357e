//! A case that runs, what it answers, and why it cannot.

use crate::integrate::StepError;
use crate::lab::statics::RelaxError;
use crate::rod::Section;
use crate::scene::{Integrator, spacing_at_edge};
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
    /// the method; explicit ones only where a case steps in time, statics then use their forces
    pub integrator: Integrator,
    /// node spacing where it is finest, m; `None`: what the kind finds fit
    pub spacing: Option<f64>,
    /// whether that spacing was asked for, whatever the case bends its wire to
    pub spacing_given: bool,
    /// local error that a step of the implicit method may have, m, where the kind winds as a scene does
    pub tolerance: f64,
    /// whose set-up the case takes
    pub setup: Setup,
}

/// Whose set-up a case takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Setup {
    /// the kind's own: what suits the reference best
    Own,
    /// that of a wind in the default scene: contact law, stiffness, spacing, tolerance, twist, and variable-step BDF2
    Wind,
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

/// Longest wire that a case may ask for, edges.
const MOST_EDGES: f64 = 20_000.0;

/// Spacing of the free span over that near the core in a wind.
const FREE: f64 = 8.0;

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
    /// no equilibrium
    #[error("no answer: {0}")]
    Relax(#[from] RelaxError),
    /// a case file that cannot be read
    #[error("{file}: cannot be read: {reason}")]
    Unreadable {
        /// path as given
        file: String,
        /// of the operating system
        reason: String,
    },
    /// something in a case file is not as it should be
    #[error("{file}: {key}: {problem}")]
    File {
        /// path or packed name
        file: String,
        /// where in the file
        key: String,
        /// what is wrong
        problem: String,
    },
    /// a known kind of which the files have no case
    #[error("no cases of kind {kind} in the files given")]
    NoCases {
        /// as given
        kind: String,
    },
    /// a setting that does not exist here or does not take this value
    #[error("--set {text}: {problem}")]
    Setting {
        /// as given
        text: String,
        /// what is wrong
        problem: String,
    },
}

/// A step or solve that gave up.
pub(super) fn no_answer(e: StepError) -> VerifyError {
    VerifyError::NoAnswer(e.to_string())
}

impl Context<'_> {
    /// Whether the case takes the set-up of a wind.
    pub fn winds(&self) -> bool {
        self.setup == Setup::Wind
    }

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

    /// A number above 0 among the inputs.
    pub fn positive(&self, name: &str) -> Result<f64, VerifyError> {
        let value = self.number(name)?;
        if value > 0.0 {
            return Ok(value);
        }
        Err(VerifyError::Input {
            name: name.to_owned(),
            problem: format!("{value}: a number above 0 is wanted"),
        })
    }

    /// A list of numbers among the inputs.
    pub fn numbers(&self, name: &str) -> Result<Vec<f64>, VerifyError> {
        let list = self.inputs.get(name).and_then(serde_json::Value::as_array);
        list.and_then(|l| {
            l.iter()
                .map(|v| v.as_f64().filter(|v| v.is_finite()))
                .collect()
        })
        .ok_or_else(|| VerifyError::Input {
            name: name.to_owned(),
            problem: "a list of finite numbers is wanted".to_owned(),
        })
    }

    /// Node spacing where tension draws this wire by twice the angle `half_turn` over a sharp edge, m: a wind's, as near as that asks for; `None`: what the kind
    /// finds fit.
    pub fn spacing_at_edge(&self, section: &Section, tension: f64, half_turn: f64) -> Option<f64> {
        if self.spacing_given {
            return self.spacing;
        }
        self.spacing
            .map(|near| spacing_at_edge(near, section, tension, half_turn))
    }

    /// Even number of edges for a wire of `length` whose own spacing would be `spacing`.
    pub fn edges(&self, length: f64, spacing: f64) -> Result<usize, VerifyError> {
        let pairs = 0.5 * length / self.spacing.unwrap_or(spacing);
        self.few_enough(2.0 * pairs.ceil().max(2.0))
    }

    /// So many edges, unless that is more than a case may ask for.
    pub fn few_enough(&self, edges: f64) -> Result<usize, VerifyError> {
        if edges <= MOST_EDGES {
            return Ok(edges as usize);
        }
        Err(VerifyError::NoAnswer(format!(
            "the wire would need {edges} edges, and at most {MOST_EDGES} are computed"
        )))
    }

    /// The same for wire that is far from all that it could touch: a wind has longer edges there, which grow from those
    /// near the core.
    pub fn free_edges(&self, length: f64, spacing: f64) -> Result<usize, VerifyError> {
        let of_wind = |s: f64| spacing.clamp(s, FREE * s);
        let free = Context {
            spacing: self
                .spacing
                .map(|s| if self.winds() { of_wind(s) } else { s }),
            ..*self
        };
        free.edges(length, spacing)
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
