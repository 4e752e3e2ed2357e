//! Sampled inputs on a communication grid, read and applied exactly as fmpy does it.
//!
//! Same samples, same grid and same arithmetic make a native run and one of the FMU agree to the
//! bit. Points are `k H`; where two samples share a time (a jump) there is a point more, and the
//! value after the jump holds from there.

use super::failure::Failure;
use super::members::rounded;
use coilwind::scene::{WITH_COMMAS, foreign_separator};
use coilwind::signals::Inputs;
use coilwind::variables::{Access, Causality, Value, Variable, by_name, table};
use std::collections::BTreeSet;
use std::path::Path;

/// A column of samples.
#[derive(Debug)]
struct Column {
    name: &'static str,
    set: fn(&mut Inputs, f64),
    values: Vec<f64>,
    /// from the least to the largest value
    range: f64,
}

/// Input signals over time.
#[derive(Debug)]
pub(super) struct Signals {
    /// s, never falling
    time: Vec<f64>,
    columns: Vec<Column>,
}

/// Share of all that an input goes through by which a sample may lie off what a run reads. Chosen: a hundredth, about a pixel of a plot.
const SEEN: f64 = 1e-2;
/// Wrong cells that are told, at most.
const MOST_TOLD: usize = 20;

/// Python's `math.isclose` with its default tolerance.
fn is_close(a: f64, b: f64) -> bool {
    a == b || (a - b).abs() <= 1e-9 * a.abs().max(b.abs())
}

impl Signals {
    /// Reads `time` and any of the inputs; a missing column leaves its input at the start value.
    pub(super) fn read(path: &Path) -> Result<Self, Failure> {
        let text = std::fs::read_to_string(path).map_err(|error| Failure::Signals {
            file: path.display().to_string(),
            reason: format!("cannot be read: {error}"),
        })?;
        Self::parse(&text, &path.display().to_string())
    }

    fn parse(text: &str, file: &str) -> Result<Self, Failure> {
        let whole = |reason: String| Failure::Signals {
            file: file.to_owned(),
            reason,
        };
        let text = text.trim_start_matches('\u{feff}');
        let mut reader = csv::ReaderBuilder::new()
            .trim(csv::Trim::All)
            .from_reader(text.as_bytes());
        let header = reader.headers().map_err(|e| whole(e.to_string()))?.clone();
        if let Some(reason) = foreign(&header) {
            return Err(whole(reason));
        }
        let rows = columns(&header, file)?;

        let mut samples = vec![Vec::new(); header.len()];
        let mut wrong = Vec::new();
        for record in reader.records() {
            let record = record.map_err(|e| unequal(&e, &header, file))?;
            let line = record.position().map_or(0, csv::Position::line);
            for (column, cell) in record.iter().enumerate() {
                let allowed =
                    || rows[column].map_or("a finite number".to_owned(), Variable::allowed);
                let admits =
                    |x: f64| rows[column].map_or(x.is_finite(), |v| v.admits(&Value::Real(x)));
                let last = samples[column].last().filter(|_| rows[column].is_none());
                let (reason, allowed) = match (cell.parse::<f64>(), last) {
                    (Err(_), _) => ("not a number", allowed()),
                    (Ok(x), _) if !admits(x) => ("out of range", allowed()),
                    (Ok(x), Some(&last)) if x < last => {
                        ("time runs backwards", format!("at least {last} s"))
                    }
                    (Ok(x), _) => {
                        samples[column].push(x);
                        continue;
                    }
                };
                let name = &header[column];
                wrong.push(format!(
                    "{file}:{line}: {name} = {cell}: {reason}; allowed: {allowed}"
                ));
            }
        }
        if !wrong.is_empty() {
            let more = wrong.len().saturating_sub(MOST_TOLD);
            wrong.truncate(MOST_TOLD);
            if more > 0 {
                wrong.push(format!("{file}: and {more} more cells"));
            }
            return Err(Failure::Cells { cells: wrong });
        }

        let mut signals = Self {
            time: Vec::new(),
            columns: Vec::new(),
        };
        for (row, values) in rows.into_iter().zip(samples) {
            match row.map(|v| (v.name, v.access)) {
                Some((name, Access::Input { set, .. })) => {
                    let least = values.iter().copied().fold(f64::INFINITY, f64::min);
                    let range = values.iter().copied().fold(f64::NEG_INFINITY, f64::max) - least;
                    signals.columns.push(Column {
                        name,
                        set,
                        values,
                        range,
                    });
                }
                _ => signals.time = values,
            }
        }
        if signals.time.is_empty() {
            return Err(whole("no samples; one row or more is needed".to_owned()));
        }
        Ok(signals)
    }

    /// Whether there are samples of an input.
    pub(super) fn has(&self, input: &str) -> bool {
        self.columns.iter().any(|column| column.name == input)
    }

    /// Time of the first sample, s.
    pub(super) fn begin(&self) -> f64 {
        self.time.first().copied().unwrap_or(0.0)
    }

    /// The inputs of the first sample in words.
    pub(super) fn first(&self) -> String {
        let tell = |column: &Column| {
            let unit = by_name(column.name).map_or("", |variable| variable.unit);
            format!("{} = {} {unit}", column.name, column.values[0])
        };
        let all: Vec<String> = self.columns.iter().map(tell).collect();
        all.join(", ")
    }

    /// Time of the last sample, s.
    pub(super) fn end(&self) -> f64 {
        self.time.last().copied().unwrap_or(0.0)
    }

    /// Inputs at a time over what they were, before any jump at that time.
    pub(super) fn before(&self, time: f64, inputs: Inputs) -> Inputs {
        self.at(time, inputs, false)
    }

    /// The same after any jump at that time.
    pub(super) fn after(&self, time: f64, inputs: Inputs) -> Inputs {
        self.at(time, inputs, true)
    }

    fn at(&self, time: f64, mut inputs: Inputs, after_jump: bool) -> Inputs {
        for column in &self.columns {
            (column.set)(
                &mut inputs,
                self.interpolate(time, &column.values, after_jump),
            );
        }
        inputs
    }

    /// The way round on which the core winds, 1 or -1: on which it is first turned beyond its start by `least`, rad, or else at the
    /// end; 0 if it does not turn.
    pub(super) fn winding_sense(&self, least: f64) -> f64 {
        let mut times: Vec<f64> = self.time.iter().map(|time| time.max(0.0)).collect();
        times.insert(0, 0.0);
        let mut turned: f64 = 0.0;
        for pair in times.windows(2) {
            let from = self.after(pair[0], Inputs::HELD).spindle_speed;
            let to = self.before(pair[1], Inputs::HELD).spindle_speed;
            turned += 0.5 * (from + to) * (pair[1] - pair[0]);
            if turned.abs() > least {
                break;
            }
        }
        if turned == 0.0 { 0.0 } else { turned.signum() }
    }

    /// The samples up to `end`, s, that a run in steps of `step`, s, does not see, in words.
    pub(super) fn missed(&self, step: f64, end: f64) -> Option<String> {
        let mut worst = (0.0, String::new());
        let mut rows = BTreeSet::new();
        for column in &self.columns {
            for row in 0..self.time.len() {
                let Some((share, [from, to])) = self.unseen(column, row, step, end) else {
                    continue;
                };
                rows.insert(row);
                if share > worst.0 {
                    let unit = by_name(column.name).map_or("", |variable| variable.unit);
                    let (name, value, time) = (column.name, column.values[row], self.time[row]);
                    let there = format!(
                        "{name} = {value} {unit} at {time} s, where the run goes from {from} to {to} {unit}"
                    );
                    worst = (share, there);
                }
            }
        }
        let count = match rows.len() {
            0 => return None,
            1 => "1 row lies".to_owned(),
            n => format!("{n} rows lie"),
        };
        let apart = self.time.windows(2).map(|pair| pair[1] - pair[0]);
        let apart = apart.filter(|dt| *dt > 0.0).fold(f64::INFINITY, f64::min);
        Some(format!(
            "{count} between points that are {step} s apart, and the run does not see them: most of all {}; rows are at least {} s apart, and --step can be that",
            worst.1,
            rounded(apart, 6)
        ))
    }

    /// By which share of all that its input goes through a sample lies off what is read before and after it, and these values.
    /// `None` for up to [`SEEN`].
    fn unseen(&self, column: &Column, row: usize, step: f64, end: f64) -> Option<(f64, [f64; 2])> {
        let (time, values) = (self.time[row], &column.values);
        // (a jump has a point of its own)
        let beside = [row.checked_sub(1), Some(row + 1)].into_iter().flatten();
        let jumps = beside.filter_map(|k| self.time.get(k)).any(|t| *t == time);
        if !(0.0..=end).contains(&time) || jumps {
            return None;
        }
        let before = (time / step).floor() * step;
        let from = self.interpolate(before, values, true);
        let to = self.interpolate((before + step).min(end), values, false);
        let off = (from.min(to) - values[row]).max(values[row] - from.max(to));
        let share = off / column.range;
        (share > SEEN).then_some((share, [from, to]))
    }

    /// fmpy's `Input.interpolate`, operation by operation.
    fn interpolate(&self, time: f64, v: &[f64], after_jump: bool) -> f64 {
        let t = &self.time;
        let last = t.len() - 1;
        let mut i = t.partition_point(|&sample| sample < time);
        if i == 0 || last == 0 {
            return v[0];
        }
        if i > last {
            return v[last];
        }
        if is_close(time, t[i]) && i < last && is_close(t[i], t[i + 1]) {
            while after_jump && i < last && is_close(t[i], t[i + 1]) {
                i += 1;
            }
            return v[i];
        }
        let w0 = (t[i] - time) / (t[i] - t[i - 1]);
        let w1 = 1.0 - w0;
        w0 * v[i - 1] + w1 * v[i]
    }

    /// The next jump after a time; infinite if there is none.
    fn next_jump(&self, time: f64) -> f64 {
        self.time
            .windows(2)
            .filter(|pair| pair[0] == pair[1])
            .map(|pair| pair[0])
            .find(|&jump| jump > time && !is_close(jump, time))
            .unwrap_or(f64::INFINITY)
    }
}

/// Where the header is not one of columns with commas between them: what it is, and what would do.
fn foreign(header: &csv::StringRecord) -> Option<String> {
    let told = foreign_separator(header)?;
    Some(format!("{told}, such as time,spindle_speed and 0.5,30"))
}

/// What is wrong with a row that is not as long as the header.
fn unequal(error: &csv::Error, header: &csv::StringRecord, file: &str) -> Failure {
    let csv::ErrorKind::UnequalLengths {
        pos,
        expected_len,
        len,
    } = error.kind()
    else {
        return Failure::Signals {
            file: file.to_owned(),
            reason: error.to_string(),
        };
    };
    let place = pos.as_ref().map(|pos| format!(":{}", pos.line()));
    let counted = |count: &u64, what: &str| match count {
        1 => format!("1 {what}"),
        n => format!("{n} {what}s"),
    };
    let names: Vec<&str> = header.iter().collect();
    let remedy = match len > expected_len {
        true => {
            format!(
                "leave out those beyond it, or, if its numbers have decimal commas, {WITH_COMMAS}"
            )
        }
        false => "write the cells that are missing".to_owned(),
    };
    Failure::Signals {
        file: format!("{file}{}", place.unwrap_or_default()),
        reason: format!(
            "{}, and the header has {} ({}); {remedy}",
            counted(len, "cell"),
            counted(expected_len, "column"),
            names.join(", ")
        ),
    }
}

/// The row of every column; `None` for time.
fn columns(
    header: &csv::StringRecord,
    file: &str,
) -> Result<Vec<Option<&'static Variable>>, Failure> {
    let inputs = || table().iter().filter(|v| v.causality == Causality::Input);
    let allowed = || inputs().map(|v| v.name).collect::<Vec<_>>().join(", ");
    let bad = |reason: String| Failure::Signals {
        file: file.to_owned(),
        reason,
    };
    let mut rows = Vec::new();
    for (index, name) in header.iter().enumerate() {
        if header.iter().take(index).any(|earlier| earlier == name) {
            return Err(bad(format!("column {name} is there twice")));
        }
        if name == "time" {
            rows.push(None);
            continue;
        }
        let Some(row) = inputs().find(|v| v.name == name) else {
            let guess = inputs()
                .map(|v| (strsim::jaro_winkler(v.name, name), v))
                .filter(|g| g.0 > 0.8)
                .max_by(|a, b| a.0.total_cmp(&b.0))
                .map(|g| format!("; did you mean {}, in {}?", g.1.name, g.1.unit))
                .unwrap_or_default();
            return Err(bad(format!(
                "unknown column {name}{guess} (allowed: time, {})",
                allowed()
            )));
        };
        rows.push(Some(row));
    }
    if !rows.iter().any(Option::is_none) {
        return Err(bad(format!(
            "no column time (allowed: time, {})",
            allowed()
        )));
    }
    Ok(rows)
}

/// Communication points of a run: `k H`, jumps of the input, and the end.
#[derive(Debug)]
pub(super) struct Grid {
    step: f64,
    stop: f64,
    time: f64,
    count: u64,
}

impl Grid {
    /// From 0 to `stop` in steps of `step`, both in s and positive.
    pub(super) fn new(step: f64, stop: f64) -> Self {
        Self {
            step,
            stop,
            time: 0.0,
            count: 0,
        }
    }

    /// Time between two of its points, s, but for those at jumps.
    pub(super) fn step(&self) -> f64 {
        self.step
    }

    /// Time, s, and steps so far, for [`Self::go_on`].
    pub(super) fn place(&self) -> (f64, u64) {
        (self.time, self.count)
    }

    /// Goes on from a place.
    pub(super) fn go_on(&mut self, place: (f64, u64)) {
        (self.time, self.count) = place;
    }

    /// The next step as start, length and end, s; `None` at the end. Points come from an integer
    /// count, so they do not drift.
    pub(super) fn next(&mut self, signals: &Signals) -> Option<(f64, f64, f64)> {
        let start = self.time;
        if start > self.stop || is_close(start, self.stop) {
            return None;
        }
        let regular = (self.count + 1) as f64 * self.step;
        let mut end = regular;
        for limit in [signals.next_jump(start), self.stop] {
            if end > limit && !is_close(end, limit) {
                end = limit;
            }
        }
        self.time = end;
        if is_close(end, regular) {
            self.count += 1;
        }
        Some((start, end - start, end))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const START: Inputs = Inputs {
        spindle_speed: 0.0,
        nozzle_position: 0.25,
        tension_setpoint: 15.0,
        ..Inputs::HELD
    };

    fn parse(text: &str) -> Signals {
        Signals::parse(text, "in.csv").unwrap()
    }

    fn error(text: &str) -> String {
        Signals::parse(text, "in.csv").unwrap_err().to_string()
    }

    /// A table that begins at rest says by its further rows which way round the core winds.
    #[test]
    fn a_core_winds_the_way_it_first_goes_beyond_jitter() {
        let sense = |rows: &str| parse(&format!("time,spindle_speed\n{rows}")).winding_sense(0.3);
        assert_eq!(sense("0,0\n1,0\n"), 0.0);
        assert_eq!(sense("0,0\n1,-10\n"), -1.0);
        assert_eq!(sense("0,0.1\n1,0.1\n2,-10\n9,30\n"), -1.0);
        assert_eq!(sense("0,-0.1\n1,0\n2,10\n9,-30\n"), 1.0);
        // (the first row holds before it, and what is before the run counts for nothing)
        assert_eq!(sense("1,-10\n1,30\n"), -1.0);
        assert_eq!(sense("-5,-10\n-1,-10\n0,0\n1,3\n"), 1.0);
    }

    #[test]
    fn linear_between_samples_held_outside() {
        let signals = parse("time, spindle_speed\n 0.1, 10\n 0.3, 30\n");
        let speed = |t| signals.after(t, START).spindle_speed;
        assert_eq!(speed(0.0), 10.0);
        assert_eq!(speed(0.1), 10.0);
        assert!((speed(0.15) - 15.0).abs() < 1e-12);
        assert_eq!(speed(0.3), 30.0);
        assert_eq!(speed(9.0), 30.0);
        assert_eq!(signals.after(0.2, START).nozzle_position, 0.25);
        assert_eq!(
            parse("time,tension_setpoint\n5,7\n")
                .before(0.0, START)
                .tension_setpoint,
            7.0
        );
    }

    /// Only the first wrong cell was told, so that a table with seven took seven runs.
    #[test]
    fn all_wrong_cells_are_told_at_once() {
        let said = error("time,spindle_speed,tension_setpoint\n0,fast,15\n0.2,9e9,-1\n0.1,30,15\n");
        for part in [
            "in.csv:2: spindle_speed = fast: not a number",
            "in.csv:3: spindle_speed = 9e9: out of range",
            "in.csv:3: tension_setpoint = -1: out of range",
            "in.csv:4: time = 0.1: time runs backwards; allowed: at least 0.2 s",
        ] {
            assert!(said.contains(part), "{part}: {said}");
        }
        let many = format!("time\n{}", "x\n".repeat(30));
        assert!(error(&many).ends_with("in.csv: and 10 more cells"));
    }

    #[test]
    fn a_jump_is_a_point_of_its_own() {
        let signals = parse("spindle_speed,time\n0,0\n10,0.25\n100,0.25\n100,1\n");
        assert_eq!(signals.before(0.25, START).spindle_speed, 10.0);
        assert_eq!(signals.after(0.25, START).spindle_speed, 100.0);
        let mut grid = Grid::new(0.1, 0.45);
        let mut points = Vec::new();
        while let Some((start, length, end)) = grid.next(&signals) {
            assert_eq!(length, end - start);
            points.push(end);
        }
        assert_eq!(points, [0.1, 0.2, 0.25, 3.0 * 0.1, 0.4, 0.45]);
    }

    #[test]
    fn the_grid_does_not_drift_and_ends_on_the_end() {
        let signals = parse("time,spindle_speed\n0,1\n");
        let mut grid = Grid::new(0.1, 100.0);
        let ends: Vec<f64> =
            std::iter::from_fn(|| grid.next(&signals).map(|step| step.2)).collect();
        assert_eq!(ends.len(), 1000);
        assert!(
            ends.iter()
                .enumerate()
                .all(|(k, &t)| t == (k + 1) as f64 * 0.1)
        );
    }

    /// Numbers from fmpy 0.3.32, `Input.interpolate`, with these samples.
    #[test]
    fn the_same_bits_as_fmpy() {
        let signals = parse(
            "time,spindle_speed\n0,0.1\n0.013,7.7\n0.07,-3.3\n0.07,5.9\n0.07,6.1\n0.31,2.2\n",
        );
        for (time, bits) in FMPY {
            assert_eq!(
                signals.after(time, START).spindle_speed.to_bits(),
                bits,
                "{time}"
            );
        }
    }

    const FMPY: [(f64, u64); 6] = [
        (0.0, 0x3fb999999999999a),
        (0.0031, 0x3ffe98cff3659cc2),
        (0.013, 0x401ecccccccccccd),
        (0.0419, 0x4000fb823ee08fb9),
        (0.07, 0x4018666666666666),
        (0.1337, 0x4014426e978d4fdf),
    ];

    #[test]
    fn mistakes_name_file_line_and_column() {
        for (text, parts) in [
            (
                "time,spindel_speed\n0,1\n",
                &["in.csv", "spindel_speed", "mean spindle_speed, in rad/s?"][..],
            ),
            ("spindle_speed\n1\n", &["no column time"]),
            ("time,time\n1,1\n", &["time is there twice"]),
            ("time,spindle_speed\n", &["no samples"]),
            (
                "time,spindle_speed\n0,1\n1,fast\n",
                &["in.csv:3", "spindle_speed = fast"],
            ),
            (
                "time,tension_setpoint\n0,-1\n",
                &["in.csv:2", "= -1", "0 to 10000 N"],
            ),
            (
                "time,tension_setpoint\n0,nan\n",
                &["in.csv:2", "= nan", "0 to 10000 N"],
            ),
            (
                "time,spindle_speed\n1,1\n0.5,1\n",
                &["in.csv:3", "backwards", "at least 1 s"],
            ),
            ("time,spindle_speed\n0,1\n1\n", &["in.csv:3: 1 cell, "]),
            (
                "time;spindle_speed\n0;1,5\n",
                &["in.csv: semicolons", "save it with commas", "0.5,30"],
            ),
            ("time\tspindle_speed\n0\t1\n", &["in.csv: tabs stand"]),
            (
                "time,spindle_speed\n0,5,30,2\n",
                &["in.csv", "decimal commas, save it with"],
            ),
        ] {
            let message = error(text);
            for part in parts {
                assert!(message.contains(part), "{part:?} is missing in: {message}");
            }
        }
    }
}
