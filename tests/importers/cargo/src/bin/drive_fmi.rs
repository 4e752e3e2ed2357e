//! Winds `fig8` with the crate `fmi`.

use coilwind_importers::Task;
use fmi::fmi2::import::Fmi2Import;
use fmi::fmi2::instance::{CoSimulation, Common};
use fmi::{import, traits::FmiImport};
use std::error::Error;
use std::ffi::CString;

fn main() -> Result<(), Box<dyn Error>> {
    let task = Task::read()?;
    let import: Fmi2Import = import::from_path(&task.fmu)?;
    let variables = &import.model_description().model_variables.variables;
    let reference = |name: &String| {
        let found = variables.iter().find(|variable| variable.name == *name);
        found
            .map(|variable| variable.value_reference)
            .ok_or(format!("no variable {name}"))
    };
    let inputs = task
        .inputs
        .iter()
        .map(reference)
        .collect::<Result<Vec<_>, _>>()?;
    let outputs = task
        .outputs
        .iter()
        .map(reference)
        .collect::<Result<Vec<_>, _>>()?;
    let mut winder = import.instantiate_cs("winder", false, false)?;
    winder.setup_experiment(None, 0.0, None)?;
    winder.set_string(
        &[reference(&"scene.file".to_owned())?],
        &[CString::new("fig8")?],
    )?;
    winder.enter_initialization_mode()?;
    winder.exit_initialization_mode()?;
    let mut values = vec![0.0; outputs.len()];
    for (k, row) in task.rows.iter().enumerate() {
        winder.set_real(&inputs, row)?;
        winder.do_step(task.time(k), task.step, true)?;
        winder.get_real(&outputs, &mut values)?;
        task.say(&values);
    }
    winder.terminate()?;
    Ok(())
}
