//! A case as files: a scene, its inputs, and its mesh if it winds on one.

use super::{Case, Kind, Layers, Measures, Outcome, Verdict};
use crate::settings::SceneSettings;
use crate::signals::Inputs;
use std::fmt::Write;
use std::io;
use std::path::{Path, PathBuf};

/// The files of a case.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Files {
    /// scene, TOML
    pub scene: PathBuf,
    /// inputs, CSV with a row per communication step
    pub inputs: PathBuf,
    /// mesh, STL
    pub mesh: PathBuf,
}

impl Files {
    /// In a folder, by a name.
    pub fn new(folder: &Path, name: &str) -> Self {
        let file = |end: &str| folder.join(format!("{name}.{end}"));
        Self {
            scene: file("toml"),
            inputs: file("csv"),
            mesh: file("stl"),
        }
    }

    /// Writes the mesh, if the case winds on one, and tells the case where it is.
    pub fn write_mesh(&self, case: &mut Case) -> io::Result<()> {
        let Some(mesh) = case.mesh else {
            return Ok(());
        };
        std::fs::write(&self.mesh, mesh.stl())?;
        case.settings.core.file = self.mesh.display().to_string();
        Ok(())
    }

    /// Writes scene and inputs of a case whose mesh is written. `words` go on top of the scene.
    pub fn write(&self, case: &Case, words: &str) -> io::Result<()> {
        let mut settings = case.settings.clone();
        if case.mesh.is_some()
            && let Some(name) = self.mesh.file_name()
        {
            // relative to the scene file, so that the folder can be moved
            settings.core.file = name.to_string_lossy().into_owned();
        }
        let mut text = String::new();
        for line in words.lines() {
            text += &format!("# {line}\n");
        }
        let name = |path: &Path| {
            path.file_name()
                .unwrap_or_default()
                .to_string_lossy()
                .into_owned()
        };
        text += &format!(
            "# coilwind run {} --inputs {} --step {}\n\n{}",
            name(&self.scene),
            name(&self.inputs),
            case.step,
            settings.to_toml()
        );
        std::fs::write(&self.scene, text)?;
        std::fs::write(&self.inputs, inputs(case))
    }

    /// Takes the mesh away again.
    pub fn remove_mesh(&self, case: &Case) -> io::Result<()> {
        match case.mesh {
            Some(_) => std::fs::remove_file(&self.mesh),
            None => Ok(()),
        }
    }
}

/// Reads a kept case back; seed, number and kind of its signals are not kept.
pub fn read(scene: &Path) -> Result<Case, String> {
    let bad = |what: &dyn std::fmt::Display| format!("{}: {what}", scene.display());
    let settings = SceneSettings::load(&scene.to_string_lossy()).map_err(|e| bad(&e))?;
    let mut reader = csv::Reader::from_path(scene.with_extension("csv")).map_err(|e| bad(&e))?;
    let mut rows: Vec<[f64; 4]> = Vec::new();
    for row in reader.deserialize() {
        rows.push(row.map_err(|e| bad(&e))?);
    }
    let inputs = rows.iter().map(|row| Inputs {
        spindle_speed: row[1],
        nozzle_position: row[2],
        tension_setpoint: row[3],
        ..Inputs::HELD
    });
    Ok(Case {
        seed: 0,
        number: 0,
        kind: Kind::Ramp,
        settings,
        mesh: None,
        layers: Layers::ONE,
        // samples are whole multiples of it
        step: rows.get(1).ok_or_else(|| bad(&"fewer than two samples"))?[0],
        inputs: inputs.collect(),
    })
}

/// Names of the columns of [`row`].
pub fn columns() -> String {
    format!(
        "number,signal,core,diameter,tension,speed,tolerance,twist,outcome,{}",
        Measures::COLUMNS
    )
}

/// A line of a table of cases: what was drawn, how it ended, and the numbers on the way.
pub fn row(case: &Case, verdict: &Verdict) -> String {
    let s = &case.settings;
    let outcome = match &verdict.outcome {
        Outcome::Completed => "completed".to_owned(),
        Outcome::Broke { .. } => "broke".to_owned(),
        Outcome::Ended { .. } => "ended".to_owned(),
        Outcome::GaveUp { .. } => "gave up".to_owned(),
        Outcome::Invariant { what, .. } => what.to_string(),
    };
    format!(
        "{},{},{},{:.4e},{:.4e},{:.4e},{:.3e},{},{outcome},{}",
        case.number,
        case.kind.as_str(),
        s.core.shape,
        s.wire.diameter,
        s.tensioner.tension,
        s.spindle.speed,
        s.solver.tolerance_for(s.wire.outer_diameter()),
        s.solver.twist,
        verdict.measures.row()
    )
}

/// Inputs as the command line reads them back to the bit: a sample at each communication point.
fn inputs(case: &Case) -> String {
    let mut text = "time,spindle_speed,nozzle_position,tension_setpoint\n".to_owned();
    for (k, i) in case.inputs.iter().enumerate() {
        let time = k as f64 * case.step;
        // writing to a text cannot fail; numbers print as short as they read back the same
        let _ = writeln!(
            text,
            "{time},{},{},{}",
            i.spindle_speed, i.nozzle_position, i.tension_setpoint
        );
    }
    text
}
