//! Every leaf of a scene as the user gives it: one flat set, defaults until something is set.

use super::SceneError;
use super::error::Place;
use super::key::{Key, resolve};
use crate::simulation::Inputs;
use crate::variables::{Access, Kind, Value, Variable, by_name, parse_scaled, scaled, table};
use std::collections::BTreeMap;

/// The leaves of a scene, in SI units. A rigidity, limit or length of 0 is derived when the
/// [`Scene`](super::Scene) is built; `description` in the variable table says from what.
///
/// Leaves may be written directly; [`build`](Self::build) checks all of them again.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)]
pub struct SceneSettings {
    /// packed name or file stem
    pub name: String,
    /// `scene.file`: what was loaded; empty: default scene
    pub file: String,
    pub preset: String,
    pub wire: WireSettings,
    pub core: CoreSettings,
    pub nozzle: super::Nozzle,
    pub tensioner: super::Tensioner,
    pub start: super::Start,
    pub spindle: super::Spindle,
    pub traverse: super::Traverse,
    pub contact: super::Contact,
    pub friction: super::Friction,
    pub solver: SolverSettings,
    pub freeze: super::Freeze,
    pub defects: super::Defects,
    pub output: super::Output,
    /// who set a leaf, by its name; absent: default
    pub(super) places: BTreeMap<&'static str, Place>,
}

/// `[wire]`; 0 in a rigidity or limit: from the material.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)]
pub struct WireSettings {
    pub material: String,
    pub elastic: bool,
    pub diameter: f64,
    pub density: f64,
    pub yield_stress: f64,
    pub flow_stress: f64,
    pub ea: f64,
    pub ea_p: f64,
    pub ei: f64,
    pub ei_p: f64,
    pub gj: f64,
    pub gj_p: f64,
    pub n_y: f64,
    pub m_y: f64,
    pub t_y: f64,
    pub moment_cap: f64,
    pub strength: f64,
}

/// `[core]`; a shape reads its own leaves only.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)]
pub struct CoreSettings {
    pub shape: String,
    pub width_x: f64,
    pub height_z: f64,
    pub length_y: f64,
    pub corner_radius: f64,
    pub radius: f64,
    /// already resolved against the folder of the scene file
    pub file: String,
    pub unit: String,
}

/// `[solver]`.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)]
pub struct SolverSettings {
    pub integrator: String,
    pub twist: String,
    pub spacing_near: f64,
    pub spacing_free: f64,
    pub refine_distance: f64,
    pub step_share: f64,
    pub step: f64,
    pub tolerance: f64,
    pub live_contact: String,
    pub plasticity: String,
    pub friction: String,
    pub inertia: String,
    pub coarse_span: String,
    pub coarse_settled: String,
}

/// The scene of Fig. 8 with a section-consistent copper wire, and the settings of this program
/// that Fig. 8 leaves open.
impl Default for SceneSettings {
    fn default() -> Self {
        Self {
            name: "default".to_owned(),
            file: String::new(),
            preset: "default".to_owned(),
            wire: WireSettings {
                material: "copper".to_owned(),
                elastic: false,
                diameter: 0.7e-3,
                density: 8960.0,
                yield_stress: 100e6,
                // annealed copper at break, rounded; also the flow stress that caps its moment
                flow_stress: 220e6,
                ea: 0.0,
                ea_p: 0.0,
                ei: 0.0,
                ei_p: 0.0,
                gj: 0.0,
                gj_p: 0.0,
                n_y: 0.0,
                m_y: 0.0,
                t_y: 0.0,
                moment_cap: 0.0,
                strength: 0.0,
            },
            core: CoreSettings {
                shape: "rounded-box".to_owned(),
                width_x: 12e-3,
                height_z: 30e-3,
                length_y: 30e-3,
                corner_radius: 2e-3,
                radius: 10e-3,
                file: String::new(),
                unit: "mm".to_owned(),
            },
            nozzle: super::Nozzle {
                distance: 60e-3,
                y_start: 0.0,
                exit_friction: 0.0,
            },
            tensioner: super::Tensioner {
                tension: 15.0,
                mass: 1e-3,
                line_length: 0.5,
                line_damping_ratio: 0.1,
            },
            start: super::Start { clamp_y: 0.0 },
            spindle: super::Spindle {
                speed: 500.0,
                ramp_turns: 0.25,
                turns: 2.5,
            },
            traverse: super::Traverse {
                per_turn: 0.7e-3,
                lead: 0.0,
            },
            contact: super::Contact {
                stiffness: 1e10,
                restitution: 0.5,
            },
            friction: super::Friction {
                static_: 0.23,
                kinetic: 0.17,
                slip_speed: 10e-3,
            },
            solver: SolverSettings {
                integrator: "auto".to_owned(),
                twist: "auto".to_owned(),
                spacing_near: 0.0,
                spacing_free: 0.0,
                refine_distance: 0.0,
                step_share: 0.9,
                step: 0.0,
                tolerance: 2e-6,
                live_contact: "auto".to_owned(),
                plasticity: "auto".to_owned(),
                friction: "auto".to_owned(),
                inertia: "auto".to_owned(),
                coarse_span: "auto".to_owned(),
                coarse_settled: "auto".to_owned(),
            },
            freeze: super::Freeze {
                enabled: true,
                window: 1.0,
                // ten periods of the free span's slowest ringing (60 mm of 0.7 mm wire at 15 N: 1.8 ms)
                time: 0.02,
                creep: 2e-6,
                patience: 0.75,
                keep_length: 0.0,
                margin: 5e-3,
            },
            defects: super::Defects {
                gap: 0.15,
                gap_fraction: 0.10,
                bulge_excess: 0.5,
                bulge_absolute: 0.0,
                overlap_axial: 0.9,
                overlap_height: 0.3,
                skip_angle: 1.2,
            },
            output: super::Output {
                history_interval: std::f64::consts::PI / 180.0,
                directory: String::new(),
            },
            places: BTreeMap::new(),
        }
    }
}

impl SceneSettings {
    /// Sets a leaf by name, with or without unit: `wire.diameter`, `wire.diameter_mm`.
    /// Leaves everything as it was on an error.
    pub fn set(&mut self, name: &str, value: Value) -> Result<(), SceneError> {
        self.set_from(name, Given::Value(value), Place::Set)
    }

    /// The same from a text, as in `--set NAME=VALUE`.
    pub fn set_text(&mut self, name: &str, text: &str) -> Result<(), SceneError> {
        self.set_from(name, Given::Text(text), Place::Set)
    }

    /// The settings that result from parameters set one by one, in whatever order: defaults, then
    /// the scene that `scene.file` names, then every other parameter.
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

    /// Inputs before the first step: core at rest, nozzle where the programme starts, set tension.
    pub fn start_inputs(&self) -> Inputs {
        Inputs {
            spindle_speed: 0.0,
            nozzle_position: self.nozzle.y_start + self.traverse.lead,
            tension_setpoint: self.tensioner.tension,
        }
    }

    /// Who set a leaf.
    pub fn place(&self, name: &str) -> Place {
        self.places.get(name).cloned().unwrap_or_default()
    }

    pub(super) fn set_from(
        &mut self,
        name: &str,
        given: Given<'_>,
        place: Place,
    ) -> Result<(), SceneError> {
        let Key { variable, scale } = resolve(name, &given.to_string(), &place)?;
        if variable.name == "scene.file" {
            return Err(SceneError::Impossible {
                place,
                key: name.into(),
                value: given.to_string().into(),
                reason: "a scene is loaded before single values are set".into(),
                allowed: "name the scene instead of setting it".into(),
            });
        }
        let wrong_type = |found: &str| SceneError::WrongType {
            place: place.clone(),
            key: name.into(),
            value: given.to_string().into(),
            found: found.into(),
            allowed: variable.allowed().into(),
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
            return Err(SceneError::OutOfRange {
                place,
                key: name.into(),
                value: given.to_string().into(),
                allowed: variable.allowed().into(),
            });
        }
        if let Access::Parameter { set, .. } = variable.access {
            set(self, value);
            self.places.insert(variable.name, place);
        }
        Ok(())
    }

    /// A leaf's value in words, with its unit.
    pub(super) fn shown(&self, name: &str) -> String {
        match by_name(name).map(|v| (v, v.access)) {
            Some((v, Access::Parameter { get, .. })) => {
                let unit = if v.unit == "1" { "" } else { v.unit };
                format!("{} {unit}", get(self)).trim_end().to_owned()
            }
            _ => String::new(),
        }
    }

    /// Checks every leaf against its row, whoever wrote it.
    pub(super) fn check_ranges(&self) -> Result<(), SceneError> {
        for variable in table() {
            let Access::Parameter { get, .. } = variable.access else {
                continue;
            };
            let value = get(self);
            if !variable.admits(&value) {
                return Err(SceneError::OutOfRange {
                    place: self.place(variable.name),
                    key: variable.name.into(),
                    value: value.to_string().into(),
                    allowed: variable.allowed().into(),
                });
            }
        }
        Ok(())
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
    /// what no leaf takes, and its noun
    Other(String, &'static str),
}

impl std::fmt::Display for Given<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Value(Value::String(text)) => write!(f, "{text:?}"),
            Self::Value(value) => write!(f, "{value}"),
            Self::Text(text) => f.write_str(text),
            Self::Number(text) | Self::Other(text, _) => f.write_str(text),
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
