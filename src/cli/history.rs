//! `history.csv`: every input, output and diagnostic over time, header from the variable table.

use super::failure::Failure;
use coilwind::simulation::Simulation;
use coilwind::variables::{Access, Value, table};
use std::fs::File;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Rows reach the disk at least this often, so that a run that dies leaves what it computed.
const FLUSH: Duration = Duration::from_millis(500);

/// The open file.
pub(super) struct History {
    path: PathBuf,
    writer: csv::Writer<File>,
    flushed: Instant,
}

impl History {
    /// Creates the file and writes the header.
    pub(super) fn create(path: &Path) -> Result<Self, Failure> {
        let file = File::create(path).map_err(|e| Failure::write(path, e))?;
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

    /// Writes the state at a point of the grid, `time` in s. Booleans are 0 and 1, so that every column
    /// reads as numbers.
    pub(super) fn row(&mut self, time: f64, simulation: &Simulation) -> Result<(), Failure> {
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
    pub(super) fn flush(&mut self) -> Result<(), Failure> {
        self.writer
            .flush()
            .map_err(|e| Failure::write(&self.path, e))?;
        self.flushed = Instant::now();
        Ok(())
    }

    fn checked(&self, written: Result<(), csv::Error>) -> Result<(), Failure> {
        written.map_err(|e| Failure::write(&self.path, e.into()))
    }
}

/// Name and accessor of what changes over time.
fn columns() -> impl Iterator<Item = (&'static str, Access)> {
    table()
        .iter()
        .filter(|v| !matches!(v.access, Access::Parameter { .. }))
        .map(|v| (v.name, v.access))
}
