//! The folder of a sweep: what it is, and the rows of the runs that ended, so that a stopped sweep goes on.

use super::failure::Failure;
use super::folder;
use super::lock::Locked;
use super::sweep_files::{self, ALL, PLAN, ROWS, STATISTICS};
use super::sweep_grid::Grid;
use super::sweep_row::{COLUMNS, Row, Rows};
use super::sweep_statistics as statistics;
use coilwind::output::write_whole_bytes;
use serde_json::{Value, json};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Time between two writes of the rows while runs end one after the other.
const EVERY: Duration = Duration::from_millis(500);

/// Rows by the number of their run, in memory and on disk.
pub(super) struct Ledger {
    directory: PathBuf,
    rows: Rows,
    written: Option<Instant>,
    /// keeps other sweeps out of the folder
    _hold: Locked,
}

impl Ledger {
    /// Begins a sweep in a folder, or goes on with the one that it holds.
    ///
    /// # Errors
    /// A folder that holds another sweep without `force`, one where a sweep is going on, or one that cannot be written.
    pub(super) fn open(
        directory: &Path,
        grid: &Grid,
        find_max: bool,
        force: bool,
    ) -> Result<Self, Failure> {
        let plan = plan(grid, find_max);
        let path = directory.join(PLAN);
        // Before anything of the folder is touched ..
        let (found, begun) = look(directory, &plan, force).or_else(|_| {
            // A plan that is being written this instant is not whole.
            drop(sweep_files::hold(directory)?);
            look(directory, &plan, force)
        })?;
        if found.is_none() && !begun {
            folder::refuse_all_but_sweeps(directory, force)?;
        }
        if force {
            folder::clear_run(directory)?;
        }
        fs::create_dir_all(directory).map_err(|e| Failure::write(directory, e))?;
        let mut hold = sweep_files::begin(directory)?;
        // .. and again: another sweep may have begun here, and ended, since.
        let (found, begun) = look(directory, &plan, force)?;
        let goes_on = found.as_ref() == Some(&plan) && !force;
        if !goes_on {
            for name in ALL.into_iter().filter(|name| *name != PLAN) {
                let path = directory.join(name);
                if path.is_file() {
                    fs::remove_file(&path).map_err(|e| Failure::write(&path, e))?;
                }
            }
            let text = format!("{plan:#}\n");
            hold.write(text.as_bytes())
                .map_err(|e| Failure::write(&path, e))?;
        }
        let mut ledger = Self {
            directory: directory.to_owned(),
            rows: Rows::new(),
            written: None,
            _hold: hold,
        };
        if goes_on && begun {
            ledger.read(grid)?;
        }
        Ok(ledger)
    }

    /// Takes the rows that are there.
    fn read(&mut self, grid: &Grid) -> Result<(), Failure> {
        let path = self.directory.join(ROWS);
        let damaged = |line: u64| {
            Failure::sweep(format!(
                "{}:{line}: no row of this sweep; remove the line, or begin again with --force",
                path.display()
            ))
        };
        let headless = || {
            Failure::sweep(format!(
                "{}:1: not the header of this sweep; begin again with --force",
                path.display()
            ))
        };
        let mut text = fs::read(&path).map_err(|_| headless())?;
        // A machine that went down may have left the last line torn: its run is wound again.
        text.truncate(
            text.iter()
                .rposition(|byte| *byte == b'\n')
                .map_or(0, |end| end + 1),
        );
        let mut reader = csv::Reader::from_reader(text.as_slice());
        let columns = grid.ranges.len();
        let names = csv::StringRecord::from(COLUMNS.to_vec());
        let runs = (0..grid.runs()).map(|run| ((grid.values(run), grid.member(run)), run));
        let runs: BTreeMap<_, _> = runs.collect();
        if reader.headers().ok() != Some(&csv::StringRecord::from(header(grid))) {
            return Err(headless());
        }
        for (index, record) in reader.records().enumerate() {
            let line = index as u64 + 2;
            let record = record.map_err(|_| damaged(line))?;
            let values = record.iter().take(columns).map(str::to_owned).collect();
            let rest: csv::StringRecord = record.iter().skip(columns).collect();
            let row: Row = rest.deserialize(Some(&names)).map_err(|_| damaged(line))?;
            let run = runs.get(&(values, row.member));
            self.rows.insert(*run.ok_or_else(|| damaged(line))?, row);
        }
        Ok(())
    }

    /// How many runs are done.
    pub(super) fn count(&self) -> usize {
        self.rows.len()
    }

    /// The row of a run that is done.
    pub(super) fn row(&self, run: usize) -> Option<&Row> {
        self.rows.get(&run)
    }

    /// Rows of the runs that are done, in the order of the grid.
    pub(super) fn rows(&self) -> &Rows {
        &self.rows
    }

    /// Keeps a row; it is on disk soon.
    pub(super) fn add(&mut self, grid: &Grid, run: usize, row: Row) -> Result<(), Failure> {
        self.rows.insert(run, row);
        match self.written {
            Some(written) if written.elapsed() < EVERY => Ok(()),
            _ => self.write(grid),
        }
    }

    /// Writes what there is, in the order of the grid. A reader finds the old table or the new one, never half of it.
    pub(super) fn write(&mut self, grid: &Grid) -> Result<(), Failure> {
        let mut writer = csv::WriterBuilder::new()
            .has_headers(false)
            .from_writer(Vec::new());
        let path = self.directory.join(ROWS);
        let encode = |e: csv::Error| Failure::write(&path, e.into());
        writer.write_record(header(grid)).map_err(encode)?;
        for (&run, row) in &self.rows {
            writer
                .serialize((grid.values(run), row))
                .map_err(|e| Failure::write(&path, e.into()))?;
        }
        replace(&path, writer)?;
        let path = self.directory.join(STATISTICS);
        replace(&path, statistics::table(grid, &self.rows, &path)?)?;
        self.written = Some(Instant::now());
        Ok(())
    }
}

/// Columns of `sweep.csv`.
fn header(grid: &Grid) -> Vec<&str> {
    let names = grid.ranges.iter().map(|range| range.name.as_str());
    names.chain(COLUMNS).collect()
}

/// What makes a sweep the same sweep.
fn plan(grid: &Grid, find_max: bool) -> Value {
    let over: Vec<String> = grid.ranges.iter().map(ToString::to_string).collect();
    let checksum = |file: &String| fs::read(file).map_or(0, |bytes| crc32fast::hash(&bytes));
    let [core, table, speed] = grid.base().files().map(checksum);
    json!({
        "version": env!("CARGO_PKG_VERSION"),
        "over": over,
        "ensemble": grid.members,
        "find_max": find_max,
        "core_checksum": core,
        "table_checksum": table,
        "speed_checksum": speed,
        "scene": grid.base().to_toml(),
    })
}

/// In which respect the folder holds another sweep, if it does.
fn difference(plan: &Value, found: Option<&Value>, begun: bool) -> Option<String> {
    let Some(found) = found else {
        return begun.then(|| format!("without {PLAN}"));
    };
    if !found.is_object() {
        return Some(format!("its {PLAN} is not whole"));
    }
    let names = plan.as_object()?.keys();
    let names = names.filter(|name| plan[name.as_str()] != found[name.as_str()]);
    let told = names.map(|name| match name.as_str() {
        "scene" => scene_difference(&plan[name.as_str()], &found[name.as_str()]),
        "core_checksum" => "content of core.file".to_owned(),
        "table_checksum" => "content of traverse.file".to_owned(),
        "speed_checksum" => "content of spindle.file".to_owned(),
        other => other.to_owned(),
    });
    let told: Vec<String> = told.collect();
    (!told.is_empty()).then(|| format!("another {}", told.join(", ")))
}

/// The keys in which the scenes of two plans differ.
fn scene_difference(a: &Value, b: &Value) -> String {
    let parsed = |text: &Value| text.as_str()?.parse::<toml::Table>().ok();
    let (Some(a), Some(b)) = (parsed(a), parsed(b)) else {
        return "scene".to_owned();
    };
    let (a, b) = (leaves(&a), leaves(&b));
    let mut keys: Vec<&str> = a
        .symmetric_difference(&b)
        .map(|(key, _)| key.as_str())
        .collect();
    // (a key that both have stands there with either value)
    keys.dedup();
    format!("scene: {}", keys.join(", "))
}

/// Every key of a scene with its value as text.
fn leaves(table: &toml::Table) -> BTreeSet<(String, String)> {
    let mut all = BTreeSet::new();
    for (key, value) in table {
        match value {
            toml::Value::Table(inner) => {
                let inner = leaves(inner).into_iter();
                all.extend(inner.map(|(name, text)| (format!("{key}.{name}"), text)));
            }
            other => {
                all.insert((key.clone(), other.to_string()));
            }
        }
    }
    all
}

/// The plan that a folder holds, if any, and whether it has rows.
///
/// # Errors
/// Those of another sweep, without `force`.
fn look(directory: &Path, plan: &Value, force: bool) -> Result<(Option<Value>, bool), Failure> {
    let begun = directory.join(ROWS).exists();
    let found = fs::read(directory.join(PLAN)).ok();
    // One that has begun this instant has written nothing yet.
    let found = found.filter(|bytes| begun || !bytes.is_empty());
    let found = found.map(|bytes| serde_json::from_slice::<Value>(&bytes).unwrap_or_default());
    match difference(plan, found.as_ref(), begun).filter(|_| !force) {
        Some(differs) => Err(Failure::sweep(format!(
            "{} holds another sweep ({differs}); add --force to overwrite it, or --out for another folder",
            directory.display()
        ))),
        None => Ok((found, begun)),
    }
}

/// Puts a table in the place of the old one.
fn replace(path: &Path, table: csv::Writer<Vec<u8>>) -> Result<(), Failure> {
    let bytes = table
        .into_inner()
        .map_err(|e| Failure::write(path, e.into_error()))?;
    Ok(write_whole_bytes(path, bytes)?)
}
