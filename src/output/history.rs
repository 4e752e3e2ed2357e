//! `history.csv`: every input, output and diagnostic over time, header from the variable table.

use super::OutputError;
use crate::simulation::Simulation;
use crate::variables::{Access, Value, table};
use std::fs::File;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Rows reach the disk at least this often, so that a run that dies leaves what it computed.
const FLUSH: Duration = Duration::from_millis(500);

/// The open file.
#[derive(Debug)]
pub struct History {
    path: PathBuf,
    writer: csv::Writer<File>,
    flushed: Instant,
}

impl History {
    /// Creates the file and writes the header.
    pub fn create(path: &Path) -> Result<Self, OutputError> {
        let file = File::create(path).map_err(OutputError::io(path))?;
        let mut history = Self {
            path: path.to_owned(),
            writer: csv::Writer::from_writer(file),
            flushed: Instant::now(),
        };
        let names = columns().map(|(name, _)| name);
        let written = history
            .writer
            .write_record(std::iter::once("time").chain(names));
        history.checked(written)?;
        history.flush()?;
        Ok(history)
    }

    /// Writes the state at a communication point, `time` in s. Numbers are in the shortest form
    /// that reads back to the same bits; Booleans are 0 and 1, so that every column reads as
    /// numbers.
    pub fn row(&mut self, time: f64, simulation: &Simulation) -> Result<(), OutputError> {
        let (inputs, outputs) = (simulation.inputs(), simulation.outputs());
        let cells = columns().map(|(_, access)| match access {
            Access::Input { get, .. } => Value::Real(get(&inputs)).to_string(),
            Access::Output(get) => match get(outputs) {
                Value::Boolean(flag) => i32::from(flag).to_string(),
                value => value.to_string(),
            },
            Access::Parameter { .. } => String::new(),
        });
        let time = Value::Real(time).to_string();
        let written = self.writer.write_record(std::iter::once(time).chain(cells));
        self.checked(written)?;
        if self.flushed.elapsed() >= FLUSH {
            self.flush()?;
        }
        Ok(())
    }

    /// Puts what was written on disk.
    pub fn flush(&mut self) -> Result<(), OutputError> {
        self.writer.flush().map_err(OutputError::io(&self.path))?;
        self.flushed = Instant::now();
        Ok(())
    }

    fn checked(&self, written: Result<(), csv::Error>) -> Result<(), OutputError> {
        written.map_err(|source| OutputError::Csv {
            path: self.path.clone(),
            source,
        })
    }
}

/// Name and accessor of what changes over time.
fn columns() -> impl Iterator<Item = (&'static str, Access)> {
    table()
        .iter()
        .filter(|v| !matches!(v.access, Access::Parameter { .. }))
        .map(|v| (v.name, v.access))
}
