//! One row of the table: what a variable is, what values it takes and where it lives.

use crate::settings::SceneSettings;
use crate::signals::{Inputs, Outputs};
use serde::{Deserialize, Serialize};
use std::fmt;

/// A value of any variable, in the unit of its row.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Value {
    /// a number in SI units
    Real(f64),
    /// a whole number
    Integer(i32),
    /// yes or no
    Boolean(bool),
    /// text
    String(String),
}

impl Value {
    /// The kind of variable that takes this value.
    pub fn kind(&self) -> Kind {
        match self {
            Self::Real(_) => Kind::Real,
            Self::Integer(_) => Kind::Integer,
            Self::Boolean(_) => Kind::Boolean,
            Self::String(_) => Kind::String,
        }
    }
}

/// Numbers in the shortest form that reads back to the same bits.
impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Real(x) if *x == 0.0 || (1e-4..1e6).contains(&x.abs()) => write!(f, "{x}"),
            Self::Real(x) if x.is_finite() => write!(f, "{x:e}"),
            Self::Real(x) => write!(f, "{x}"),
            Self::Integer(i) => write!(f, "{i}"),
            Self::Boolean(b) => write!(f, "{b}"),
            Self::String(s) => f.write_str(s),
        }
    }
}

/// Type of a variable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// `f64`
    Real,
    /// `i32`
    Integer,
    /// `bool`
    Boolean,
    /// `String`
    String,
}

impl Kind {
    /// Name as FMI spells it.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Real => "Real",
            Self::Integer => "Integer",
            Self::Boolean => "Boolean",
            Self::String => "String",
        }
    }
}

/// Who writes a variable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Causality {
    /// the machine, at every communication point
    Input,
    /// the simulator
    Output,
    /// the user, before the run (or between steps where tunable)
    Parameter,
    /// the simulator, for diagnosis
    Local,
}

impl Causality {
    /// Name as FMI spells it.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Input => "input",
            Self::Output => "output",
            Self::Parameter => "parameter",
            Self::Local => "local",
        }
    }
}

/// When a variable changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Variability {
    /// any time
    Continuous,
    /// at communication points
    Discrete,
    /// never after initialisation
    Fixed,
    /// between communication steps
    Tunable,
}

impl Variability {
    /// Name as FMI spells it.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Continuous => "continuous",
            Self::Discrete => "discrete",
            Self::Fixed => "fixed",
            Self::Tunable => "tunable",
        }
    }
}

/// Where a variable lives.
///
/// The setters store without looking at ranges, and ignore a value of another kind;
/// [`SceneSettings::set`] is the checked way in.
#[derive(Clone, Copy, Debug)]
pub enum Access {
    /// a field of [`Inputs`]
    Input {
        /// reads the field
        get: fn(&Inputs) -> f64,
        /// writes the field
        set: fn(&mut Inputs, f64),
    },
    /// a field of [`Outputs`]
    Output(fn(&Outputs) -> Value),
    /// a leaf of [`SceneSettings`]
    Parameter {
        /// reads the leaf
        get: fn(&SceneSettings) -> Value,
        /// writes the leaf
        set: fn(&mut SceneSettings, Value),
    },
    /// the number of a choice of the text of this name, from 1; 0: as the text says
    Choice(&'static str),
}

/// One row of the table.
#[derive(Clone, Copy, Debug)]
pub struct Variable {
    /// value reference, unique over all kinds
    pub reference: u32,
    /// structured name
    pub name: &'static str,
    /// type
    pub kind: Kind,
    /// who writes it
    pub causality: Causality,
    /// when it changes
    pub variability: Variability,
    /// unit of a Real, a name listed by [`units`](super::units); empty for other kinds
    pub unit: &'static str,
    /// unit people use, a display unit of `unit`; empty: the unit itself
    pub display_unit: &'static str,
    /// smallest value allowed or possible
    pub min: Option<f64>,
    /// largest value allowed or possible
    pub max: Option<f64>,
    /// typical size
    pub nominal: Option<f64>,
    /// the texts allowed; empty: any
    pub choices: &'static [&'static str],
    /// start value in the FMU where that is not the scene's
    pub fmu_start: Option<&'static str>,
    /// serves `coilwind run` only; the FMU has inputs or the importer instead
    pub native_only: bool,
    /// what it means
    pub description: &'static str,
    /// where it lives
    pub access: Access,
}

impl Variable {
    /// The value this parameter or input has before a run of a scene; `None` for what the
    /// simulator computes.
    pub fn start(&self, settings: &SceneSettings) -> Option<Value> {
        match self.access {
            Access::Input { get, .. } => Some(Value::Real(get(&settings.start_inputs()))),
            Access::Output(_) => None,
            Access::Parameter { get, .. } => Some(get(settings)),
            Access::Choice(_) => Some(Value::Integer(0)),
        }
    }

    /// The value this parameter or input of the FMU has before the importer sets it; `None` for what the simulator
    /// computes.
    pub fn start_in_fmu(&self, settings: &SceneSettings) -> Option<Value> {
        match self.fmu_start {
            Some(text) => Some(Value::String(text.to_owned())),
            None => self.start(settings),
        }
    }

    /// Whether a value is of the row's kind, finite and inside its range or among its choices.
    pub fn admits(&self, value: &Value) -> bool {
        match value {
            _ if value.kind() != self.kind => false,
            Value::Real(x) => {
                x.is_finite()
                    && self.min.is_none_or(|min| *x >= min)
                    && self.max.is_none_or(|max| *x <= max)
            }
            Value::Integer(i) => {
                let x = f64::from(*i);
                self.min.is_none_or(|min| x >= min) && self.max.is_none_or(|max| x <= max)
            }
            Value::Boolean(_) => true,
            Value::String(s) => self.choices.is_empty() || self.choices.contains(&s.as_str()),
        }
    }

    /// The number in the row's range that is nearest to `x`.
    pub fn nearest(&self, x: f64) -> f64 {
        let low = self.min.unwrap_or(f64::NEG_INFINITY);
        x.clamp(low, self.max.unwrap_or(f64::INFINITY))
    }

    /// What the row allows, in words: `0.00002 to 0.005 m`.
    pub fn allowed(&self) -> String {
        let unit = if self.unit == "1" { "" } else { self.unit };
        let number = |x: f64| Value::Real(x).to_string();
        match (self.kind, self.min, self.max) {
            (Kind::Real, Some(min), Some(max)) => {
                format!("{} to {} {unit}", number(min), number(max))
                    .trim_end()
                    .to_owned()
            }
            (Kind::Real, Some(min), None) => format!("at least {} {unit}", number(min))
                .trim_end()
                .to_owned(),
            (Kind::Real, None, Some(max)) => format!("at most {} {unit}", number(max))
                .trim_end()
                .to_owned(),
            (Kind::Real, None, None) => "a finite number".to_owned(),
            (Kind::Integer, Some(min), Some(max)) => format!("{min} to {max}"),
            (Kind::Integer, ..) => "a whole number".to_owned(),
            (Kind::Boolean, ..) => "true or false".to_owned(),
            (Kind::String, ..) if self.choices.is_empty() => "a text".to_owned(),
            (Kind::String, ..) => self.choices.join(", "),
        }
    }
}
