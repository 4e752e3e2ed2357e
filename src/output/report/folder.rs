//! A run as its folder has it, in the arrays of the page.

use super::array::Array;
use super::error::ReportError;
use super::options::Options;
use super::read_vtp::{self, Arrays};
use crate::measure::STATIONS_PER_TURN;
use crate::output::vtp::SIDES;
use serde::Serialize;
use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{ErrorKind, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

/// Points of a curve over time; longer histories are thinned such that peaks stay.
const CURVE: usize = 6000;
/// Triangles of a core above which the page leaves it out: the page is to stay below 10 MB.
const MOST_TRIANGLES: usize = 200_000;
/// Distance from the wire at the end, in diameters, up to which wire of a frame is taken for that at the end.
const SAME: f64 = 0.02;

/// All that the page knows of a run.
#[derive(Serialize)]
pub(super) struct Run {
    /// name of the folder
    pub(super) name: String,
    summary: serde_json::Value,
    /// how far it was wound, in words, where it ended as it was to end
    wound_to: String,
    history: Option<Columns>,
    stations: Option<Columns>,
    wire: Option<BTreeMap<&'static str, Array>>,
    core: Option<BTreeMap<&'static str, Array>>,
    frames: Vec<Frame>,
}

/// The wire at an earlier time.
#[derive(Serialize)]
struct Frame {
    /// s
    time: f64,
    /// nodes of the wire at the end that lay there already
    keep: usize,
    /// the nodes after them
    wire: BTreeMap<&'static str, Array>,
}

impl Run {
    pub(super) fn read(directory: &Path) -> Result<Self, ReportError> {
        let path = directory.join("summary.json");
        let text = fs::read_to_string(&path).map_err(|error| match error.kind() {
            ErrorKind::InvalidData => broken(&path, "it is no text"),
            _ if directory.is_file() => ReportError::NoFolder {
                path: directory.to_owned(),
            },
            _ => ReportError::NoRun {
                directory: directory.to_owned(),
                missing: "summary.json",
            },
        })?;
        let summary: serde_json::Value =
            serde_json::from_str(&text).map_err(|e| broken(&path, e))?;
        let product = &summary["product"];
        let diameter = product["enamelled_diameter_m"]
            .as_f64()
            .or_else(|| product["wire_diameter_m"].as_f64())
            .ok_or_else(|| broken(&path, "product.wire_diameter_m is missing"))?;
        let end = Wire::read(&directory.join("coil.vtp"), SIDES)?;
        let mut frames = Vec::new();
        if let Some(end) = &end {
            for path in frame_files(&directory.join("frames")) {
                if let Some(wire) = Wire::read(&path, 1)? {
                    frames.push(wire.frame(end, SAME * diameter));
                }
            }
        }
        let [history_path, stations_path] =
            ["history.csv", "stations.csv"].map(|name| directory.join(name));
        let (history, ends_at) = history(&history_path)?.unzip();
        let (stations, rows) = stations(&stations_path)?.unzip();
        // (a run that could not write all ends with what it has)
        let is_whole = summary["status"] == "done";
        let told = |key: &str| summary[key].as_f64().filter(|_| is_whole);
        if let (Some(ends_at), Some(told)) = (ends_at, told("simulated_s"))
            && (ends_at - told).abs() > ANOTHER * told
        {
            let reason = format!("it ends at {ends_at} s, and the run of summary.json at {told} s");
            return Err(broken(&history_path, reason));
        }
        if let (Some(rows), Some(turns)) = (rows, told("turns_settled"))
            && (rows as f64 - turns * STATIONS_PER_TURN as f64).abs() > 2.0
        {
            let reason = format!(
                "it has {rows} rows, one a degree, and summary.json tells of {turns:.3} turns at rest"
            );
            return Err(broken(&stations_path, reason));
        }
        let place = fs::canonicalize(directory).unwrap_or_else(|_| directory.to_owned());
        Ok(Self {
            name: place
                .file_name()
                .map_or_else(String::new, |name| name.to_string_lossy().into_owned()),
            wound_to: Options::read(directory)
                .wound_to(summary["simulated_s"].as_f64().unwrap_or_default()),
            summary,
            history,
            stations,
            wire: end.as_ref().map(|wire| wire.arrays(0)),
            core: core(&directory.join("core.vtp"))?,
            frames,
        })
    }
}

fn broken(path: &Path, reason: impl ToString) -> ReportError {
    ReportError::Broken {
        path: path.to_owned(),
        reason: reason.to_string(),
    }
}

/// The files of the frames in their order.
fn frame_files(directory: &Path) -> Vec<PathBuf> {
    let Ok(entries) = fs::read_dir(directory) else {
        return Vec::new();
    };
    let mut files: Vec<PathBuf> = entries
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(|path| path.extension().is_some_and(|ending| ending == "vtp"))
        .collect();
    files.sort();
    files
}

/// The wire of a VTK file: centreline and fields, a value per node.
struct Wire {
    points: Vec<[f64; 3]>,
    fields: Arrays,
    time: f64,
}

/// Fields of the wire that the page colours by.
const REALS: [&str; 5] = ["arc", "tension", "plastic_strain", "gap", "bulge"];
const BYTES: [&str; 2] = ["layer", "frozen"];
const CODES: [&str; 1] = ["defect"];

impl Wire {
    /// `None` if there is no such file, or no wire in it. `sides`: points of the file for a node of the wire.
    fn read(path: &Path, sides: usize) -> Result<Option<Self>, ReportError> {
        if !path.exists() {
            return Ok(None);
        }
        let mut arrays = read_vtp::read(path).map_err(|e| broken(path, e))?;
        let tube = arrays.remove("Points").unwrap_or_default();
        if tube.is_empty() {
            return Ok(None);
        }
        // The centreline is the middle of each ring.
        let points: Vec<[f64; 3]> = tube
            .chunks(3 * sides)
            .map(|ring| {
                let mut sum = [0.0; 3];
                for point in ring.chunks(3) {
                    (0..3).for_each(|axis| sum[axis] += point[axis] / sides as f64);
                }
                sum
            })
            .collect();
        let mut fields = Arrays::new();
        for name in REALS.into_iter().chain(BYTES).chain(CODES) {
            let values = arrays.remove(name).unwrap_or_default();
            if values.len() != sides * points.len() {
                return Err(broken(path, format!("{name} is not on every node")));
            }
            fields.insert(name.to_owned(), values.into_iter().step_by(sides).collect());
        }
        let time = arrays.get("TimeValue").and_then(|t| t.first());
        Ok(Some(Self {
            time: time.copied().unwrap_or(0.0),
            points,
            fields,
        }))
    }

    /// Points and fields from a node on.
    fn arrays(&self, from: usize) -> BTreeMap<&'static str, Array> {
        let points = self.points[from..].iter().flatten().copied();
        let mut arrays = BTreeMap::from([("points", Array::reals(points))]);
        let of = |name: &str| self.fields[name][from..].iter().copied();
        arrays.extend(REALS.map(|name| (name, Array::reals(of(name)))));
        arrays.extend(BYTES.map(|name| (name, Array::bytes(of(name)))));
        arrays.extend(CODES.map(|name| (name, Array::codes(of(name)))));
        arrays
    }

    /// This wire as far as it is another than the one at the end: most of it lies where it will lie.
    fn frame(&self, end: &Self, same: f64) -> Frame {
        let (arc, end_arc) = (&self.fields["arc"], &end.fields["arc"]);
        let mut after = 0;
        let mut own = 0;
        for (node, point) in self.points.iter().enumerate() {
            while after < end_arc.len() && end_arc[after] < arc[node] {
                after += 1;
            }
            if after == end_arc.len() || distance(*point, end.at(after, arc[node])) > same {
                break;
            }
            own = node + 1;
        }
        let last = own.checked_sub(1).map_or(f64::NEG_INFINITY, |k| arc[k]);
        Frame {
            time: self.time,
            keep: end_arc.partition_point(|&a| a <= last),
            wire: self.arrays(own),
        }
    }

    /// The point at an arc between the node `after` and the one before it.
    fn at(&self, after: usize, arc: f64) -> [f64; 3] {
        let before = after.saturating_sub(1);
        let arcs = &self.fields["arc"];
        let span = arcs[after] - arcs[before];
        let share = if span > 0.0 {
            (arc - arcs[before]) / span
        } else {
            1.0
        };
        let (a, b) = (self.points[before], self.points[after]);
        [0, 1, 2].map(|axis| a[axis] + share * (b[axis] - a[axis]))
    }
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3)
        .map(|axis| (a[axis] - b[axis]).powi(2))
        .sum::<f64>()
        .sqrt()
}

/// Surface of the core: points and corners of triangles. `None` without the file, or where it is too large for a page.
fn core(path: &Path) -> Result<Option<BTreeMap<&'static str, Array>>, ReportError> {
    if !path.exists() {
        return Ok(None);
    }
    let mut arrays = read_vtp::read(path).map_err(|e| broken(path, e))?;
    let mut take = |name| arrays.remove(name).unwrap_or_default();
    let (points, corners) = (take("Points"), take("connectivity"));
    if corners.len() > 3 * MOST_TRIANGLES {
        return Ok(None);
    }
    let corners = corners.into_iter().map(|corner| corner as u32).collect();
    Ok(Some(BTreeMap::from([
        ("points", Array::reals(points)),
        ("corners", Array::U32(corners)),
    ])))
}

/// Whether the last line of a file has no end. The file is then as it was opened.
fn is_torn(file: &mut File) -> std::io::Result<bool> {
    let mut last = [b'\n'];
    if file.seek(SeekFrom::End(0))? > 0 {
        file.seek(SeekFrom::End(-1))?;
        file.read_exact(&mut last)?;
    }
    file.rewind()?;
    Ok(last != [b'\n'])
}

/// Columns of a table by name; an empty cell is not a number.
fn table<const N: usize>(
    path: &Path,
    names: [&'static str; N],
) -> Result<Option<[Vec<f64>; N]>, ReportError> {
    let Ok(mut file) = File::open(path) else {
        return Ok(None);
    };
    // A number that was cut may read as another one.
    if is_torn(&mut file).map_err(|e| broken(path, e))? {
        return Err(broken(path, "its last line has no end"));
    }
    let mut reader = csv::Reader::from_reader(file);
    let header = reader.headers().map_err(|e| broken(path, e))?;
    let place = |name| {
        header
            .iter()
            .position(|head| head == name)
            .ok_or_else(|| broken(path, format!("column {name} is missing")))
    };
    let mut places = [0; N];
    for (place_of, name) in places.iter_mut().zip(names) {
        *place_of = place(name)?;
    }
    let mut columns = [const { Vec::new() }; N];
    let mut row = csv::StringRecord::new();
    while reader.read_record(&mut row).map_err(|e| broken(path, e))? {
        for (column, place) in columns.iter_mut().zip(places) {
            let cell = &row[place];
            let value = match cell {
                "" => f64::NAN,
                _ => cell
                    .parse()
                    .map_err(|_| broken(path, format!("{cell:?} is not a number")))?,
            };
            column.push(value);
        }
    }
    Ok(Some(columns))
}

/// Share of its time by which a run ends elsewhere than its history where that is of another run, or was cut.
const ANOTHER: f64 = 1e-3;

/// Columns that the page draws.
type Columns = BTreeMap<&'static str, Array>;

/// Curves over time, thinned in pieces: mean, least and largest tension, the torque that is largest either way, the layer, and the turns
/// of wire that were wound by then. And when they end, s.
fn history(path: &Path) -> Result<Option<(Columns, f64)>, ReportError> {
    let names = [
        "time",
        "spindle_angle",
        "spindle_speed",
        "wire_tension",
        "wire_tension_min",
        "wire_tension_max",
        "spindle_torque",
        "layer",
        "turns_wound",
    ];
    let Some(mut columns) = table(path, names)? else {
        return Ok(None);
    };
    // A history of the FMU is in time of the experiment; defects are in time of the run.
    let start = columns[0].first().copied().unwrap_or(0.0);
    columns[0].iter_mut().for_each(|time| *time -= start);
    // (wire that came off again was wound before)
    columns[8].iter_mut().fold(0.0, |most: f64, turns| {
        *turns = turns.max(most);
        *turns
    });
    let rows = columns[0].len();
    let piece = rows.div_ceil(CURVE).max(1);
    let thin = |column: usize, choose: fn(&[f64]) -> f64| {
        Array::reals(columns[column].chunks(piece).map(choose))
    };
    let last = |piece: &[f64]| piece[piece.len() - 1];
    let mean = |piece: &[f64]| piece.iter().sum::<f64>() / piece.len() as f64;
    let least = |piece: &[f64]| piece.iter().copied().fold(f64::INFINITY, f64::min);
    let most = |piece: &[f64]| piece.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let farthest = |piece: &[f64]| {
        let larger = |a: f64, b: f64| if b.abs() > a.abs() { b } else { a };
        piece.iter().copied().fold(0.0, larger)
    };
    let end = columns[0].last().copied().unwrap_or(0.0);
    let curves = BTreeMap::from([
        ("time", thin(0, last)),
        ("angle", thin(1, last)),
        ("speed", thin(2, last)),
        ("tension", thin(3, mean)),
        ("tension_min", thin(4, least)),
        ("tension_max", thin(5, most)),
        ("torque", thin(6, farthest)),
        ("layer", thin(7, most)),
        ("wound", thin(8, last)),
    ]);
    Ok(Some((curves, end)))
}

/// Measures at every degree of every turn, and of how many degrees there are.
fn stations(path: &Path) -> Result<Option<(Columns, usize)>, ReportError> {
    let names = [
        "arc",
        "gap",
        "bulge",
        "bulge_excess",
        "layer",
        "measured",
        "crosses",
    ];
    let Some([arc, gap, bulge, excess, layer, measured, crosses]) = table(path, names)? else {
        return Ok(None);
    };
    let rows = arc.len();
    let measures = BTreeMap::from([
        ("arc", Array::reals(arc)),
        ("gap", Array::reals(gap)),
        ("bulge", Array::reals(bulge)),
        ("bulge_excess", Array::reals(excess)),
        ("layer", Array::bytes(layer)),
        ("measured", Array::bytes(measured)),
        ("crosses", Array::bytes(crosses)),
    ]);
    Ok(Some((measures, rows)))
}

#[cfg(test)]
mod tests {
    use super::history;

    /// A history of the FMU is in time of the experiment. Marks of slack and breaks, in time of the run, lay elsewhere.
    #[test]
    fn curves_of_a_run_that_starts_later_begin_at_zero() {
        let folder = tempfile::tempdir().unwrap();
        let curves = |start: f64| {
            let path = folder.path().join("history.csv");
            let head = "time,spindle_angle,spindle_speed,wire_tension,wire_tension_min,wire_tension_max,spindle_torque,layer,turns_wound";
            let row = |t: f64| format!("{},{t},1,15,14,16,0.1,1,0.1\n", start + t);
            std::fs::write(&path, format!("{head}\n{}{}", row(0.0), row(0.5))).unwrap();
            serde_json::to_string(&history(&path).unwrap()).unwrap()
        };
        assert_eq!(curves(10.0), curves(0.0));
    }

    /// A history that was cut within its last number was drawn with another one in its place.
    #[test]
    fn a_table_whose_last_line_is_torn_is_not_whole() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("history.csv");
        let text = "time,spindle_angle,spindle_speed,wire_tension,wire_tension_min,wire_tension_max,spindle_torque,layer,turns_wound\n0,0,1,15,14,16,0.125,1,12\n";
        for (end, whole) in [(0, true), (1, false), (3, false)] {
            std::fs::write(&path, &text[..text.len() - end]).unwrap();
            assert_eq!(history(&path).is_ok(), whole, "{end} bytes less");
        }
        std::fs::write(&path, "").unwrap();
        assert!(history(&path).is_err(), "no header");
    }
}
