//! The parameters that the importer set, and the scene that follows from them.

use crate::error::Error;
use crate::resources;
use coilwind::scene::{Scene, Warning};
use coilwind::settings::SceneSettings;
use coilwind::signals::Inputs;
use coilwind::variables::{Access, Value, Variable, by_reference};
use std::collections::BTreeMap;
use std::path::Path;

/// Name of the parameter that names the scene under all others.
const SCENE_FILE: &str = "scene.file";

/// What a saved state holds of parameters: `scene.file`, the scene that it held, and what was set
/// explicitly, by value reference.
pub(crate) type SavedParameters = (String, SceneSettings, BTreeMap<u32, Value>);

/// The parameters with their precedence.
///
/// Defaults come first, then `scene.file`, then every parameter that was set explicitly. The order
/// of the calls does not matter.
#[derive(Clone, Debug)]
pub(crate) struct Parameters {
    /// `scene.file` as the importer set it; empty for the default scene.
    file: String,
    /// The scene of `file` alone.
    base: SceneSettings,
    /// What was set explicitly, by value reference, so that the order of calls cannot matter.
    explicit: BTreeMap<u32, Value>,
    /// `base` with `explicit` laid over it.
    settings: SceneSettings,
}

impl Parameters {
    /// Returns what a saved state holds. [`Self::restored`] is the inverse.
    pub(crate) fn saved(&self) -> SavedParameters {
        (self.file.clone(), self.base.clone(), self.explicit.clone())
    }

    /// Returns the parameters of a saved state. The scene is the one that `scene.file` held when
    /// it was read; the file itself is not read again.
    ///
    /// # Errors
    ///
    /// If a reference is unknown or a value is not valid.
    pub(crate) fn restored(saved: SavedParameters) -> Result<Self, Error> {
        let (file, base, explicit) = saved;
        let mut settings = base.clone();
        for (reference, value) in &explicit {
            let reference = *reference;
            let variable = by_reference(reference).ok_or(Error::UnknownReference { reference })?;
            settings.set(variable.name, value.clone())?;
        }
        Ok(Self {
            file,
            base,
            explicit,
            settings,
        })
    }

    /// Returns the parameters of the default scene.
    pub(crate) fn new() -> Self {
        Self {
            file: String::new(),
            base: SceneSettings::default(),
            explicit: BTreeMap::new(),
            settings: SceneSettings::default(),
        }
    }

    /// Returns these parameters with `changes` laid over. The caller has checked the values against
    /// the limits of their variables. `resources` is the folder of the unpacked FMU.
    ///
    /// # Errors
    ///
    /// If a new `scene.file` cannot be loaded or a value is not valid.
    pub(crate) fn with(
        &self,
        changes: &[(&'static Variable, Value)],
        resources: Option<&Path>,
    ) -> Result<Self, Error> {
        let mut next = self.clone();
        for (variable, value) in changes {
            match value {
                Value::String(file) if variable.name == SCENE_FILE => next.file.clone_from(file),
                _ => {
                    next.explicit.insert(variable.reference, value.clone());
                }
            }
        }
        if next.file.is_empty() {
            next.base = SceneSettings::default();
        } else if next.file != self.file {
            next.base = SceneSettings::load(&resources::scene(&next.file, resources))?;
        }
        next.settings = next.base.clone();
        for (reference, value) in &next.explicit {
            if let Some(variable) = by_reference(*reference) {
                next.settings.set(variable.name, value.clone())?;
            }
        }
        Ok(next)
    }

    /// Returns the value of a parameter, or `None` for inputs and results.
    pub(crate) fn get(&self, variable: &Variable) -> Option<Value> {
        match variable.access {
            Access::Parameter { .. } if variable.name == SCENE_FILE => {
                Some(Value::String(self.file.clone()))
            }
            Access::Parameter { get, .. } => Some(get(&self.settings)),
            Access::Input { .. } | Access::Output(_) => None,
        }
    }

    /// Returns every setting of the scene, the explicit ones laid over.
    pub(crate) fn settings(&self) -> &SceneSettings {
        &self.settings
    }

    /// Builds the scene of all parameters, with warnings about it.
    ///
    /// # Errors
    ///
    /// [`Error::Scene`] if the parameters do not make a valid scene.
    pub(crate) fn scene(&self) -> Result<(Scene, Vec<Warning>), Error> {
        Ok(self.settings.build_with_warnings()?)
    }

    /// Returns the inputs of that scene at the start.
    pub(crate) fn start_inputs(&self) -> Inputs {
        self.settings.start_inputs()
    }
}
