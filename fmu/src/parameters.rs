//! What the importer set before the start, and the scene that follows from it.

use crate::refusal::Refusal;
use crate::resources;
use coilwind::scene::{Scene, Warning};
use coilwind::settings::SceneSettings;
use coilwind::signals::Inputs;
use coilwind::variables::{Access, Value, Variable, by_reference};
use std::collections::BTreeMap;
use std::path::Path;

/// Name of the parameter that the others are laid over.
const SCENE_FILE: &str = "scene.file";

/// `scene.file`, what it held, and what was set explicitly.
pub(crate) type SavedParameters = (String, SceneSettings, BTreeMap<u32, Value>);

/// Parameters with their precedence: defaults, then `scene.file`, then every parameter set
/// explicitly, in whatever order.
#[derive(Clone, Debug)]
pub(crate) struct Parameters {
    /// as the importer set it; empty: default scene
    file: String,
    /// the scene of `file`, nothing laid over
    base: SceneSettings,
    /// by reference, so that the order of calls cannot matter
    explicit: BTreeMap<u32, Value>,
    /// `base` with `explicit` over it
    settings: SceneSettings,
}

impl Parameters {
    /// What a saved state holds of them; [`Self::restored`] is the way back.
    pub(crate) fn saved(&self) -> SavedParameters {
        (self.file.clone(), self.base.clone(), self.explicit.clone())
    }

    /// Parameters of a saved state: `scene.file` as it was read then, whatever has become of the file.
    pub(crate) fn restored(saved: SavedParameters) -> Result<Self, Refusal> {
        let (file, base, explicit) = saved;
        let mut settings = base.clone();
        for (reference, value) in &explicit {
            let reference = *reference;
            let variable =
                by_reference(reference).ok_or(Refusal::UnknownReference { reference })?;
            settings.set(variable.name, value.clone())?;
        }
        Ok(Self {
            file,
            base,
            explicit,
            settings,
        })
    }

    /// The default scene.
    pub(crate) fn new() -> Self {
        Self {
            file: String::new(),
            base: SceneSettings::default(),
            explicit: BTreeMap::new(),
            settings: SceneSettings::default(),
        }
    }

    /// These parameters with some more set; the values have passed their rows' limits.
    pub(crate) fn with(
        &self,
        changes: &[(&'static Variable, Value)],
        resources: Option<&Path>,
    ) -> Result<Self, Refusal> {
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

    /// Value of a parameter; `None` for inputs and results.
    pub(crate) fn get(&self, variable: &Variable) -> Option<Value> {
        match variable.access {
            Access::Parameter { .. } if variable.name == SCENE_FILE => {
                Some(Value::String(self.file.clone()))
            }
            Access::Parameter { get, .. } => Some(get(&self.settings)),
            Access::Input { .. } | Access::Output(_) => None,
        }
    }

    /// Every leaf of the scene with the explicit ones laid over.
    pub(crate) fn settings(&self) -> &SceneSettings {
        &self.settings
    }

    /// The scene they make together, and what is odd about it.
    pub(crate) fn scene(&self) -> Result<(Scene, Vec<Warning>), Refusal> {
        Ok(self.settings.build_with_warnings()?)
    }

    /// Inputs of that scene before the first step.
    pub(crate) fn start_inputs(&self) -> Inputs {
        self.settings.start_inputs()
    }
}
