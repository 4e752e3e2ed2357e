//! The parameters that the importer set, and the scene that follows from them.

use crate::error::Error;
use crate::resources;
use crate::saved_files::SavedFiles;
use coilwind::measure::DefectLimits;
use coilwind::scene::{Scene, SceneError, Warning};
use coilwind::settings::{BY_INPUT, Friction, Origin, SceneSettings};
use coilwind::signals::Inputs;
use coilwind::variables::{Access, Value, Variable, by_name, by_reference, choice};
use coilwind_model_description::DEFAULT_TOLERANCE;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Name of the parameter that names the scene under all others.
const SCENE_FILE: &str = "scene.file";
/// Name of the parameter that names the surface of a core.
const MESH_FILE: &str = "core.file";
/// Name of the parameter that names the table of the nozzle's way.
const TRAVERSE_FILE: &str = "traverse.file";
/// Name of the parameter that says what the nozzle follows.
const TRAVERSE_MODE: &str = "traverse.mode";
/// Name of the parameter that the experiment's tolerance scales.
const SOLVER_TOLERANCE: &str = "solver.tolerance";

/// Largest tolerance of the solver in wire diameters; a scene with more is refused.
const COARSEST: f64 = 0.1;
/// Least tolerance of the solver, m; a scene with less is refused.
const FINEST: f64 = 1e-9;
/// How the core says where files are looked for, and how the FMU finds those that are set.
const BESIDE_THE_SCENE: &str = "relative to the scene file";
const BY_THE_FMU: &str = "by its name among the FMU's resources, or else as given";

/// What a saved state holds of parameters: `scene.file`, the scene that it held, and what was set
/// explicitly, by value reference, the tolerance of the experiment, and where files were.
pub(crate) type SavedParameters = (
    String,
    SceneSettings,
    BTreeMap<u32, Value>,
    Option<f64>,
    SavedFiles,
);

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
    /// Tolerance of the experiment, if the importer gave one.
    tolerance: Option<f64>,
    /// Where files were that a restored state names; none of others.
    files: SavedFiles,
    /// The resources in which files were last looked for.
    resources: Option<PathBuf>,
    /// `base` with `explicit` laid over it.
    settings: SceneSettings,
}

impl Parameters {
    /// Returns what a saved state holds. [`Self::restored`] is the inverse.
    pub(crate) fn saved(&self) -> SavedParameters {
        (
            self.file.clone(),
            self.base.clone(),
            self.explicit.clone(),
            self.tolerance,
            SavedFiles::of(&self.settings, self.resources.as_deref()),
        )
    }

    /// Returns the parameters of a saved state, for an FMU that is unpacked with its `resources` there. The scene is
    /// the one that `scene.file` held when it was read; the file itself is not read again. Files that the scene names are those that it
    /// named then, wherever this process runs.
    ///
    /// # Errors
    ///
    /// If a reference is unknown or a value is not valid.
    pub(crate) fn restored(
        saved: SavedParameters,
        resources: Option<&Path>,
    ) -> Result<Self, Error> {
        let (file, base, explicit, tolerance, files) = saved;
        let mut settings = laid_over(&base, &explicit, tolerance, resources)?;
        files.find(&mut settings, resources);
        Ok(Self {
            file,
            base,
            explicit,
            tolerance,
            files,
            resources: resources.map(Path::to_owned),
            settings,
        })
    }

    /// Returns the parameters of the default scene.
    pub(crate) fn new() -> Self {
        Self {
            file: String::new(),
            base: SceneSettings::default(),
            explicit: BTreeMap::new(),
            tolerance: None,
            files: SavedFiles::default(),
            resources: None,
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
        let names_files = |name: &str| [SCENE_FILE, MESH_FILE, TRAVERSE_FILE].contains(&name);
        if changes
            .iter()
            .any(|(variable, _)| names_files(variable.name))
        {
            next.files = SavedFiles::default();
        }
        next.resources = resources.map(Path::to_owned);
        next.settings = laid_over(&next.base, &next.explicit, next.tolerance, resources)?;
        next.files.find(&mut next.settings, resources);
        Ok(next)
    }

    /// Returns these parameters for an experiment with this relative tolerance, if it has one.
    ///
    /// # Errors
    ///
    /// [`Error::Tolerance`] if it is not a finite number above 0.
    pub(crate) fn for_tolerance(
        &self,
        tolerance: Option<f64>,
        resources: Option<&Path>,
    ) -> Result<Self, Error> {
        if let Some(value) = tolerance.filter(|x| !(x.is_finite() && *x > 0.0)) {
            return Err(Error::Tolerance { value });
        }
        let mut settings = laid_over(&self.base, &self.explicit, tolerance, resources)?;
        self.files.find(&mut settings, resources);
        Ok(Self {
            tolerance,
            settings,
            ..self.clone()
        })
    }

    /// Returns a text if the tolerance of the experiment makes the solver's another one.
    pub(crate) fn effect_of_tolerance(&self) -> Option<String> {
        let row = by_name(SOLVER_TOLERANCE)?;
        let tolerance = self.tolerance?;
        let mut without = self.settings.clone();
        without.solver.tolerance = self.base.solver.tolerance;
        let (is, scene) = (in_use(&self.settings), in_use(&without));
        (is != scene && !self.explicit.contains_key(&row.reference)).then(|| {
            let least = scene * (tolerance / DEFAULT_TOLERANCE) < FINEST;
            format!(
                "the experiment's tolerance {} makes {SOLVER_TOLERANCE} {} m{}; without it there were {} m, which {} stands for; \
                 set {SOLVER_TOLERANCE} to overrule the experiment",
                Value::Real(tolerance),
                Value::Real(six_digits(is)),
                if least { ", the least that it may be" } else { "" },
                Value::Real(six_digits(scene)),
                Value::Real(DEFAULT_TOLERANCE),
            )
        })
    }

    /// Returns the value of a parameter, or `None` for inputs and results.
    pub(crate) fn get(&self, variable: &Variable) -> Option<Value> {
        match variable.access {
            Access::Parameter { .. } if variable.name == SCENE_FILE => {
                Some(Value::String(self.file.clone()))
            }
            Access::Parameter { get, .. } => {
                let set = with_choices(&self.explicit).remove(&variable.reference);
                Some(set.unwrap_or_else(|| match variable.fmu_start {
                    Some(start) => Value::String(start.to_owned()),
                    None => get(&self.settings),
                }))
            }
            Access::Choice(_) => {
                let number = self.explicit.get(&variable.reference);
                Some(number.cloned().unwrap_or(Value::Integer(0)))
            }
            Access::Input { .. } | Access::Output(_) => None,
        }
    }

    /// Returns every setting of the scene, the explicit ones laid over.
    pub(crate) fn settings(&self) -> &SceneSettings {
        &self.settings
    }

    /// Returns the parameters that may change between steps: friction and limits of defects.
    pub(crate) fn tunable(&self) -> (Friction, DefectLimits) {
        (self.settings.friction, self.settings.defects)
    }

    /// Returns these parameters with other tunable ones.
    pub(crate) fn tuned(&self, friction: Friction, defects: DefectLimits) -> Self {
        let mut tuned = self.clone();
        (tuned.settings.friction, tuned.settings.defects) = (friction, defects);
        tuned
    }

    /// Returns what was set explicitly, by value reference, apart from `scene.file`.
    pub(crate) fn explicit(&self) -> impl Iterator<Item = (u32, &Value)> {
        self.explicit
            .iter()
            .map(|(reference, value)| (*reference, value))
    }

    /// Tells whether `scene.file` is empty.
    pub(crate) fn names_no_scene(&self) -> bool {
        self.file.is_empty()
    }

    /// Returns a text for every parameter that was set to another value than the scene file gives it.
    ///
    /// Importers that write every start value overrule the file without meaning to.
    pub(crate) fn contradictions(&self) -> Vec<String> {
        let chosen = with_choices(&self.explicit);
        let differing = chosen.iter().filter_map(|(reference, value)| {
            let variable = by_reference(*reference)?;
            let Access::Parameter { get, .. } = variable.access else {
                return None;
            };
            let Origin::File { file, .. } = self.base.origin(variable.name) else {
                return None;
            };
            let scene = get(&self.base);
            let (name, unit) = (variable.name, unit_of(variable));
            (scene != *value && !leaves_to_input(variable, value)).then(|| {
                format!(
                    "{name} = {value}{unit} was set and holds; scene.file {file} has {scene}{unit}"
                )
            })
        });
        let overruled = self.explicit.iter().filter_map(|(reference, value)| {
            let number = by_reference(*reference)?;
            let (row, text) = choice(number, value)?;
            let other = self.explicit.get(&row.reference).filter(|x| **x != text)?;
            let (name, by) = (row.name, number.name);
            Some(format!(
                "{name} = {text} was set by {by} = {value} and holds; {name} was set to {other} too"
            ))
        });
        differing.chain(overruled).collect()
    }

    /// Returns a text if a `value` of an input at the start is another than the scene's, which starts with `own`.
    pub(crate) fn contradiction_of_input(
        &self,
        input: &Variable,
        value: f64,
        own: &Inputs,
    ) -> Option<String> {
        let scene = match input.access {
            Access::Input { get, .. } => get(own),
            _ => return None,
        };
        let parameter = match input.name {
            "tension_setpoint" => "tensioner.tension",
            "nozzle_position" => "nozzle.y_start",
            _ => return None,
        };
        let (name, unit) = (input.name, unit_of(input));
        if name == "nozzle_position" && self.settings.nozzle_follows_law() {
            let mode = &self.settings.traverse.mode;
            return (value != scene).then(|| {
                format!("{name} = {value}{unit} was set and has no effect: by {TRAVERSE_MODE} = {mode} the nozzle starts at {scene}{unit}")
            });
        }
        let given = self.settings.origin(parameter) != Origin::Default;
        (given && value != scene).then(|| {
            format!("{name} = {value}{unit} was set and holds; the scene starts it at {scene}{unit}, by {parameter}")
        })
    }

    /// Checks that the files of a mesh and of a table are there, among the resources or where they are given.
    ///
    /// # Errors
    ///
    /// [`Error::NoFile`] with the places that were looked in.
    pub(crate) fn find_files(&self, resources: Option<&Path>) -> Result<(), Error> {
        let (core, traverse) = (&self.settings.core, &self.settings.traverse);
        let [saved_core, saved_traverse, _] = self.files.places(resources);
        let files = [
            (MESH_FILE, &core.file, core.shape == "mesh", saved_core),
            (
                TRAVERSE_FILE,
                &traverse.file,
                traverse.mode == "table",
                saved_traverse,
            ),
        ];
        let missing = files
            .into_iter()
            .find(|(_, file, read, _)| *read && !file.is_empty() && !Path::new(file).is_file());
        let Some((name, file, _, mut places)) = missing else {
            return Ok(());
        };
        let shown = |path: &Path| path.display().to_string();
        if !Path::new(file).is_absolute() {
            places.extend(resources.map(shown));
            places.extend(std::env::current_dir().ok().as_deref().map(shown));
        }
        Err(Error::NoFile {
            name,
            file: file.clone(),
            places: places.join(" and in "),
        })
    }

    /// Builds the scene of all parameters, with warnings about it.
    ///
    /// # Errors
    ///
    /// [`Error::Scene`] if the parameters do not make a valid scene.
    pub(crate) fn scene(&self) -> Result<(Scene, Vec<Warning>), Error> {
        let built = self.settings.build_for(self.settings.nozzle_follows());
        Ok(built.map_err(Self::by_the_fmu)?)
    }

    /// Returns the error with the FMU's way to a file where the file is not the scene's.
    fn by_the_fmu(mut error: SceneError) -> SceneError {
        match &mut error {
            SceneError::Several { errors } => {
                let told = std::mem::take(errors).into_iter();
                *errors = told.map(Self::by_the_fmu).collect();
            }
            SceneError::Impossible {
                origin,
                key,
                allowed,
                ..
            } if [MESH_FILE, TRAVERSE_FILE].contains(&&**key)
                && !matches!(origin, Origin::File { .. }) =>
            {
                *allowed = allowed.replace(BESIDE_THE_SCENE, BY_THE_FMU).into();
            }
            _ => {}
        }
        error
    }
}

/// Returns `base` with what was set explicitly, and solved for with the `tolerance` of the experiment. Files are taken from
/// the FMU's resources where they have them.
fn laid_over(
    base: &SceneSettings,
    explicit: &BTreeMap<u32, Value>,
    tolerance: Option<f64>,
    resources: Option<&Path>,
) -> Result<SceneSettings, Error> {
    let mut settings = base.clone();
    for (reference, value) in with_choices(explicit) {
        let variable = by_reference(reference).ok_or(Error::UnknownReference { reference })?;
        if leaves_to_input(variable, &value) {
            continue;
        }
        let value = match value {
            Value::String(file) if [MESH_FILE, TRAVERSE_FILE].contains(&variable.name) => {
                Value::String(resources::file(&file, resources))
            }
            value => value,
        };
        settings.set(variable.name, value)?;
    }
    if let (Some(tolerance), Some(row)) = (tolerance, by_name(SOLVER_TOLERANCE))
        && !explicit.contains_key(&row.reference)
    {
        let scaled = in_use(&settings) * (tolerance / DEFAULT_TOLERANCE);
        let most = COARSEST * settings.wire.diameter;
        if scaled != in_use(&settings) {
            settings.solver.tolerance = row.nearest(scaled.max(FINEST).min(most));
        }
    }
    Ok(settings)
}

/// The error, m, that a step may have with these settings.
fn in_use(settings: &SceneSettings) -> f64 {
    let diameter = settings.wire.outer_diameter();
    settings.solver.tolerance_for(diameter)
}

/// Returns what was set explicitly with the texts that numbers stand for; a number wins over the text.
fn with_choices(explicit: &BTreeMap<u32, Value>) -> BTreeMap<u32, Value> {
    let mut all = explicit.clone();
    for (reference, value) in explicit {
        let number = by_reference(*reference);
        if number.is_some_and(|row| matches!(row.access, Access::Choice(_))) {
            all.remove(reference);
        }
        if let Some((row, text)) = number.and_then(|row| choice(row, value)) {
            all.insert(row.reference, text);
        }
    }
    all
}

/// Tells whether a value leaves the nozzle to its input. The scene then keeps the mode of its own motion, whose layers say
/// what is wound.
fn leaves_to_input(variable: &Variable, value: &Value) -> bool {
    variable.name == TRAVERSE_MODE && *value == Value::String(BY_INPUT.to_owned())
}

/// Returns the unit of a variable with a space before it, or nothing where it has none.
fn unit_of(variable: &Variable) -> String {
    match variable.unit {
        "" | "1" => String::new(),
        unit => format!(" {unit}"),
    }
}

/// A number as it is told, without the last digits that a product leaves.
fn six_digits(x: f64) -> f64 {
    format!("{x:.5e}").parse().unwrap_or(x)
}
