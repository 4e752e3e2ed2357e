//! Tables over the spindle's angle: a CSV file with a column of angles, from 0 on and rising, and one of values.

use super::SceneError;
use super::foreign_table::{WITH_COMMAS, foreign_separator};
use super::impossible::si;
use super::problems::Problems;
use crate::settings::SceneSettings;
use crate::variables::{Scale, scaled, split_suffix};
use std::f64::consts::TAU;
use std::path::Path;

/// Most lines that are told as wrong one by one.
const MOST_TOLD: usize = 5;

/// A column: its name without a unit, and that of its numbers in SI.
pub(super) type Column = (&'static str, &'static str);

/// What a table has to have.
#[derive(Clone, Copy, Debug)]
pub(super) struct Form<'a> {
    /// leaf that names the file
    pub(super) key: &'static str,
    /// the file
    pub(super) file: &'a str,
    /// columns of values, one of which is there
    pub(super) columns: &'a [Column],
    /// what is wrong with a value of a column, in words
    pub(super) wrong: fn(&str, f64) -> Option<String>,
    /// what is allowed, in words
    pub(super) allowed: &'static str,
}

/// A table that was read.
#[derive(Clone, Debug)]
pub(super) struct AngleTable {
    /// name of the column of values, without its unit
    pub(super) column: &'static str,
    /// turns and value (SI) of every row, two at least, by rising turns from 0
    pub(super) rows: Vec<[f64; 2]>,
}

impl SceneSettings {
    /// The table in a file; `None` where something is wrong with it, which is told line by line.
    pub(super) fn angle_table(
        &self,
        form: Form<'_>,
        problems: &mut Problems,
    ) -> Option<AngleTable> {
        let problem = |reason: String| self.impossible(form.key, reason, form.allowed);
        let opened = self.open_table(form).map_err(problem);
        let Opened {
            mut reader,
            angle,
            per_turn,
            value,
        } = problems.note(opened)?;
        let mut table = AngleTable {
            column: value.0,
            rows: Vec::new(),
        };
        let mut wrong: Vec<SceneError> = Vec::new();
        for record in reader.records() {
            let record = match record {
                Ok(record) => record,
                Err(error) => {
                    let remedy = match error.kind() {
                        csv::ErrorKind::UnequalLengths { .. } => {
                            format!("; if its numbers have decimal commas, {WITH_COMMAS}")
                        }
                        _ => String::new(),
                    };
                    wrong.push(problem(format!("{error}{remedy}")));
                    continue;
                }
            };
            let line = record.position().map_or(0, csv::Position::line);
            let cell = |(index, scale): Place| {
                let text = record.get(index).unwrap_or_default();
                let number: Option<f64> = text.parse().ok().filter(|x: &f64| x.is_finite());
                number
                    .map(|number| scaled(number, scale))
                    .ok_or_else(|| problem(format!("line {line}: {text:?} is no number")))
            };
            let (turns, value) = match (cell(angle), cell(value.1)) {
                (Ok(angle), Ok(value)) => (angle / per_turn, value),
                (angle, value) => {
                    wrong.extend([angle.err(), value.err()].into_iter().flatten());
                    continue;
                }
            };
            let last = table.rows.last().map(|row| row[0]);
            match last {
                None if turns != 0.0 => {
                    wrong.push(problem(format!("line {line}: the first angle is not 0")));
                }
                Some(last) if turns <= last => wrong.push(problem(format!(
                    "line {line}: the angle does not rise, {} turns after {}",
                    si(turns),
                    si(last)
                ))),
                _ => {}
            }
            if let Some(reason) = (form.wrong)(table.column, value) {
                wrong.push(problem(format!("line {line}: {reason}")));
            }
            table.rows.push([turns, value]);
        }
        if wrong.is_empty() && table.rows.len() < 2 {
            wrong.push(problem("the table has less than two rows".to_owned()));
        }
        if wrong.is_empty() {
            return Some(table);
        }
        if wrong.len() > MOST_TOLD {
            let more = wrong.len() - MOST_TOLD;
            wrong.truncate(MOST_TOLD);
            wrong.push(problem(format!("{more} more mistakes in the table")));
        }
        wrong.into_iter().for_each(|error| problems.add(error));
        None
    }

    /// Opens a table and finds its columns, or says what is wrong.
    fn open_table(&self, form: Form<'_>) -> Result<Opened, String> {
        let mut reader = csv::ReaderBuilder::new()
            .trim(csv::Trim::All)
            .comment(Some(b'#'))
            .from_path(Path::new(form.file))
            .map_err(|error| format!("the table cannot be opened ({error})"))?;
        let header = reader.headers().map_err(|error| error.to_string())?.clone();
        let turns = header.iter().position(|name| name == "turns");
        let (angle, per_turn) = match turns {
            Some(index) => (Some((index, Scale::Tens(0))), 1.0),
            None => (found(&header, ("angle", "rad")), TAU),
        };
        let is_angle = |name: &&str| *name == "turns" || scale_of(name, ("angle", "rad")).is_some();
        let is_value = |name: &&str| form.columns.iter().any(|of| scale_of(name, *of).is_some());
        let angles: Vec<&str> = header.iter().filter(is_angle).collect();
        let values: Vec<&str> = header.iter().filter(is_value).collect();
        if let Some(twice) = [angles, values].into_iter().find(|names| names.len() > 1) {
            return Err(format!("its columns {} tell the same", twice.join(" and ")));
        }
        let mut columns = form.columns.iter();
        let value = columns.find_map(|&column| Some((column.0, found(&header, column)?)));
        match (angle, value) {
            (Some(angle), Some(value)) => Ok(Opened {
                reader,
                angle,
                per_turn,
                value,
            }),
            _ if header.iter().all(str::is_empty) => Err("it is empty".to_owned()),
            _ if let Some(told) = foreign_separator(&header) => Err(told),
            _ => {
                let names: Vec<&str> = header.iter().collect();
                Err(format!("its columns are {}", names.join(", ")))
            }
        }
    }
}

/// A table whose header was read.
struct Opened {
    reader: csv::Reader<std::fs::File>,
    /// where the angle stands, and how its numbers become rad, or turns
    angle: Place,
    /// of the angle's unit, a turn
    per_turn: f64,
    /// name of the column of values, where it stands, and how its numbers become SI
    value: (&'static str, Place),
}

/// Index of a column, and how its numbers become SI.
type Place = (usize, Scale);

/// Where a column stands.
fn found(header: &csv::StringRecord, column: Column) -> Option<Place> {
    let mut names = header.iter().enumerate();
    names.find_map(|(index, name)| Some((index, scale_of(name, column)?)))
}

/// How numbers under a name become SI if it is that of a column, with its unit or none where it is SI.
fn scale_of(name: &str, (stem, unit): Column) -> Option<Scale> {
    if name == stem {
        return Some(Scale::Tens(0));
    }
    let (found, of, scale) = split_suffix(name)?;
    (found == stem && of == unit).then_some(scale)
}
