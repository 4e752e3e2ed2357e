//! How a leaf of the settings is set: by name, with a unit, checked against its row.

use super::allowed::{allowed_for, meant};
use super::error::Warning;
use super::follow_on::refuses;
use super::key::{Key, resolve};
use super::problems::Problems;
use super::{Scene, SceneError};
use crate::settings::{NozzleFollows, Origin, SceneSettings};
use crate::variables::{Access, Kind, Value, Variable, by_name, parse_scaled, scaled, table};

impl SceneSettings {
    /// Sets a leaf by name, with or without unit: `wire.diameter`, `wire.diameter_mm`.
    /// Leaves everything as it was on an error.
    ///
    /// # Errors
    ///
    /// An unknown name or unit (with a suggestion), a value of the wrong kind or outside its range.
    pub fn set(&mut self, name: &str, value: Value) -> Result<(), SceneError> {
        self.set_from(name, Given::Value(value), Origin::Set)
    }

    /// Sets a leaf by name from a text, as in `--set NAME=VALUE`.
    ///
    /// # Errors
    ///
    /// Those of [`set`](Self::set), and a text that is no value of this kind.
    pub fn set_text(&mut self, name: &str, text: &str) -> Result<(), SceneError> {
        self.set_from(name, Given::Text(text), Origin::Set)
    }

    /// Sets leaves by name from texts, as [`set_text`](Self::set_text) does, then builds the scene; tells all that is
    /// wrong at once. The nozzle of the run follows what `follows` says of them.
    ///
    /// # Errors
    ///
    /// Everything that [`load`](Self::load), `set_text` and [`build`](Self::build) find. Leaves that were refused have their
    /// defaults where a later check needs them; what is wrong with those only is not told.
    pub fn load_and_build(
        name_or_path: &str,
        set: &[(String, String)],
        follows: impl Fn(&Self) -> NozzleFollows,
    ) -> Result<(Self, Scene, Vec<Warning>), SceneError> {
        let mut problems = Problems::default();
        let (mut settings, mut found) = Self::load_with(name_or_path)?;
        for (name, text) in set {
            match settings.set_text(name, text) {
                // it takes the place of what the scene has
                Ok(()) => found.retain(|error| !refuses(error, name)),
                Err(error) => found.push(error),
            }
        }
        let built = settings.build_without(&found, follows(&settings));
        found.into_iter().for_each(|error| problems.add(error));
        let built = problems.note(built);
        let (scene, warnings) = problems.finish_with(built)?;
        Ok((settings, scene, warnings))
    }

    /// The settings from parameters in any order: defaults, then the scene that `scene.file` names,
    /// then every other parameter.
    pub fn from_parameters<'a>(
        parameters: impl Iterator<Item = (&'a Variable, Value)> + Clone,
    ) -> Result<Self, SceneError> {
        let file = parameters.clone().find(|(v, _)| v.name == "scene.file");
        let mut settings = match file {
            Some((_, Value::String(file))) if !file.is_empty() => Self::load(&file)?,
            _ => Self::default(),
        };
        for (variable, value) in parameters.filter(|(v, _)| v.name != "scene.file") {
            settings.set(variable.name, value)?;
        }
        Ok(settings)
    }

    pub(super) fn set_from(
        &mut self,
        name: &str,
        given: Given<'_>,
        origin: Origin,
    ) -> Result<(), SceneError> {
        let Key { variable, scale } = resolve(name, &given.to_string(), &origin)?;
        if variable.name == "scene.file" {
            return Err(SceneError::Impossible {
                origin,
                key: name.into(),
                value: given.to_string().into(),
                reason: "a scene is loaded before single values are set".into(),
                allowed: "name the scene instead of setting it".into(),
            });
        }
        let wrong_type = |found: &str| SceneError::WrongType {
            origin: origin.clone(),
            key: name.into(),
            value: given.to_string().into(),
            found: found.into(),
            allowed: allowed_for(name, variable, scale).into(),
        };
        let value = match (&given, variable.kind) {
            (Given::Value(Value::Real(x)), Kind::Real) => Value::Real(scaled(*x, scale)),
            (Given::Value(Value::Integer(i)), Kind::Real) => {
                Value::Real(scaled(f64::from(*i), scale))
            }
            (Given::Value(value), kind) if value.kind() == kind => value.clone(),
            (Given::Value(value), _) => return Err(wrong_type(noun(value.kind()))),
            (Given::Number(text), Kind::Real) => {
                Value::Real(parse_scaled(text, scale).ok_or_else(|| wrong_type("no number"))?)
            }
            (Given::Number(_), _) => return Err(wrong_type("a number")),
            (Given::Other(_, noun), _) => return Err(wrong_type(noun)),
            (Given::List(text), Kind::String) if variable.name == "wire.stress_strain" => {
                Value::String(text.clone())
            }
            (Given::List(_), _) => return Err(wrong_type("a list")),
            (Given::Text(text), Kind::Real) => Value::Real(
                parse_scaled(text.trim(), scale).ok_or_else(|| wrong_type("no number"))?,
            ),
            (Given::Text(text), Kind::Integer) => Value::Integer(
                text.trim()
                    .parse()
                    .map_err(|_| wrong_type("no whole number"))?,
            ),
            (Given::Text(text), Kind::Boolean) => match text.trim() {
                "true" => Value::Boolean(true),
                "false" => Value::Boolean(false),
                _ => return Err(wrong_type("neither true nor false")),
            },
            (Given::Text(text), Kind::String) => Value::String((*text).to_owned()),
        };
        if !variable.admits(&value) {
            let meant = match given {
                Given::Number(_) | Given::Text(_) => meant(name, variable, &value),
                _ => String::new(),
            };
            return Err(SceneError::OutOfRange {
                origin,
                key: name.into(),
                value: given.to_string().into(),
                allowed: (allowed_for(name, variable, scale) + &meant).into(),
            });
        }
        if let Access::Parameter { set, .. } = variable.access {
            set(self, value);
            self.origins.insert(variable.name, origin);
        }
        Ok(())
    }

    /// The value of a leaf as text with its unit, for messages.
    pub(super) fn shown(&self, name: &str) -> String {
        match by_name(name).map(|v| (v, v.access)) {
            Some((v, Access::Parameter { get, .. })) => {
                let unit = if v.unit == "1" { "" } else { v.unit };
                match get(self) {
                    Value::String(text) if text.is_empty() => "\"\"".to_owned(),
                    // (without what converting a unit leaves in the last digits)
                    Value::Real(x) => {
                        let rounded = format!("{x:.11e}").parse().unwrap_or(x);
                        format!("{} {unit}", Value::Real(rounded))
                            .trim_end()
                            .to_owned()
                    }
                    value => format!("{value} {unit}").trim_end().to_owned(),
                }
            }
            _ => String::new(),
        }
    }

    /// Checks every leaf against its row of the variable table.
    pub(super) fn check_ranges(&self) -> Result<(), SceneError> {
        let mut problems = Problems::default();
        for variable in table() {
            let Access::Parameter { get, .. } = variable.access else {
                continue;
            };
            let value = get(self);
            if !variable.admits(&value) {
                problems.add(SceneError::OutOfRange {
                    origin: self.told_origin(variable.name),
                    key: variable.name.into(),
                    value: value.to_string().into(),
                    allowed: variable.allowed().into(),
                });
            }
        }
        problems.finish()
    }
}

/// A value on its way in.
#[derive(Clone, Debug)]
pub(super) enum Given<'a> {
    /// typed
    Value(Value),
    /// a text that stands for any kind
    Text(&'a str),
    /// a number as a file spells it
    Number(String),
    /// a list of numbers or of such lists, as a text
    List(String),
    /// what no leaf takes, and its noun
    Other(String, &'static str),
}

impl std::fmt::Display for Given<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Value(Value::String(text)) => write!(f, "{text:?}"),
            Self::Value(value) => write!(f, "{value}"),
            Self::Text(text) => f.write_str(text),
            Self::Number(text) | Self::List(text) | Self::Other(text, _) => f.write_str(text),
        }
    }
}

fn noun(kind: Kind) -> &'static str {
    match kind {
        Kind::Real | Kind::Integer => "a number",
        Kind::Boolean => "a boolean",
        Kind::String => "a text",
    }
}
