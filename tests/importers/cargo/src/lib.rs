//! What the drivers are asked for on the command line, and how they answer: `FMU INPUTS.csv STEP OUTPUTS`.
//!
//! The table has a column for each input and a row for each step, of `STEP` seconds. `OUTPUTS` are names with commas.
//! Numbers keep all their bits on both ways.

use std::error::Error;

/// What one driver has to do.
pub struct Task {
    /// Path of the FMU.
    pub fmu: String,
    /// Names of the inputs.
    pub inputs: Vec<String>,
    /// Values of the inputs, held over each step.
    pub rows: Vec<Vec<f64>>,
    /// Length of a step, s.
    pub step: f64,
    /// Names of the outputs that are asked for after each step.
    pub outputs: Vec<String>,
}

impl Task {
    /// Reads the command line and the table of inputs.
    ///
    /// # Errors
    ///
    /// An argument or the table is missing, or what should be a number is none.
    pub fn read() -> Result<Self, Box<dyn Error>> {
        let mut words = std::env::args().skip(1);
        let mut word = || words.next().ok_or("usage: FMU INPUTS.csv STEP OUTPUTS");
        let (fmu, table, step, outputs) = (word()?, word()?, word()?, word()?);
        let names = |line: &str| line.split(',').map(str::to_owned).collect::<Vec<_>>();
        let text = std::fs::read_to_string(table)?;
        let mut lines = text.lines();
        let inputs = names(lines.next().ok_or("the table is empty")?);
        let numbers = |line: &str| line.split(',').map(str::parse).collect::<Result<_, _>>();
        let rows = lines.map(numbers).collect::<Result<_, _>>()?;
        Ok(Self {
            fmu,
            inputs,
            rows,
            step: step.parse()?,
            outputs: names(&outputs),
        })
    }

    /// Begin of a step, s.
    pub fn time(&self, step: usize) -> f64 {
        step as f64 * self.step
    }

    /// Prints the outputs after a step.
    pub fn say(&self, values: &[f64]) {
        let texts: Vec<String> = values.iter().map(|value| format!("{value:?}")).collect();
        println!("{}", texts.join(","));
    }
}
