//! Winds the default scene with the crate `fmu-runner`, which sets no Strings and so names no other scene.

use coilwind_importers::Task;
use fmu_runner::{Fmu, FmuInstance, fmi2Type};
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let task = Task::read()?;
    let library = Fmu::unpack(&task.fmu)?.load(fmi2Type::fmi2CoSimulation)?;
    let variables = library.variables();
    let variable = |name: &String| variables.get(name).ok_or(format!("no variable {name}"));
    let inputs = task
        .inputs
        .iter()
        .map(variable)
        .collect::<Result<Vec<_>, _>>()?;
    let outputs = task
        .outputs
        .iter()
        .map(variable)
        .collect::<Result<Vec<_>, _>>()?;
    let winder = FmuInstance::instantiate(&library, false)?;
    winder.setup_experiment(0.0, None, None)?;
    winder.enter_initialization_mode()?;
    winder.exit_initialization_mode()?;
    for (k, row) in task.rows.iter().enumerate() {
        winder.set_reals(&inputs.iter().copied().zip(row.iter().copied()).collect())?;
        winder.do_step(task.time(k), task.step, true)?;
        let values = winder.get_reals(&outputs)?;
        task.say(&outputs.iter().map(|name| values[name]).collect::<Vec<_>>());
    }
    Ok(())
}
