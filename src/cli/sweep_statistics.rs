//! `ensemble.csv`: what the members of an ensemble say together, a row a point of the grid.

use super::failure::Failure;
use super::sweep_grid::Grid;
use super::sweep_row::{Row, Rows};
use std::collections::BTreeMap;
use std::path::Path;

/// Columns after those of the swept variables.
const COLUMNS: [&str; 7] = [
    "members",
    "defect_share",
    "failed_share",
    "unjudged_share",
    "gap_mean_d",
    "gap_deviation_d",
    "verdicts",
];

/// An ensemble in numbers.
pub(super) struct Ensemble {
    /// runs that are done
    pub(super) members: usize,
    /// runs with a defect
    pub(super) defects: usize,
    /// runs that the solver gave up
    pub(super) failed: usize,
    /// runs that ended as planned, and in which nothing could be judged
    pub(super) unjudged: usize,
    /// mean over the runs of their largest mean gap, in wire diameters
    pub(super) gap_mean_d: Option<f64>,
    /// standard deviation of the same between runs, of a sample
    pub(super) gap_deviation_d: Option<f64>,
    /// how often each verdict was given
    pub(super) verdicts: BTreeMap<String, usize>,
}

impl Ensemble {
    /// Sums up the rows of one point; `None` where there are none.
    pub(super) fn of(rows: &[&Row]) -> Option<Self> {
        if rows.is_empty() {
            return None;
        }
        let gaps: Vec<f64> = rows.iter().filter_map(|row| row.gap_mean_d).collect();
        let count = gaps.len() as f64;
        let mean = (!gaps.is_empty()).then(|| gaps.iter().sum::<f64>() / count);
        let deviation = mean.filter(|_| gaps.len() > 1).map(|mean| {
            let squares: f64 = gaps.iter().map(|gap| (gap - mean).powi(2)).sum();
            (squares / (count - 1.0)).sqrt()
        });
        let mut verdicts = BTreeMap::new();
        for row in rows {
            let word = if row.failed() { "failed" } else { &row.verdict };
            *verdicts.entry(word.to_owned()).or_insert(0) += 1;
        }
        Some(Self {
            members: rows.len(),
            defects: rows.iter().filter(|row| row.defect).count(),
            failed: rows.iter().filter(|row| row.failed()).count(),
            unjudged: rows.iter().filter(|row| row.is_unjudged()).count(),
            gap_mean_d: mean,
            gap_deviation_d: deviation,
            verdicts,
        })
    }

    /// Share of the runs with a defect.
    pub(super) fn defect_share(&self) -> f64 {
        self.defects as f64 / self.members as f64
    }

    /// Share of the runs that the solver gave up.
    pub(super) fn failed_share(&self) -> f64 {
        self.failed as f64 / self.members as f64
    }

    /// Share of the runs in which nothing could be judged.
    pub(super) fn unjudged_share(&self) -> f64 {
        self.unjudged as f64 / self.members as f64
    }

    /// `aligned 6, gap 2`.
    fn verdicts(&self) -> String {
        let counts = self.verdicts.iter().map(|(word, n)| format!("{word} {n}"));
        counts.collect::<Vec<_>>().join(", ")
    }

    /// In a line: `mean gap 0.031 +- 0.004 d; aligned 8`.
    pub(super) fn line(&self) -> String {
        let gap = match (self.gap_mean_d, self.gap_deviation_d) {
            (Some(mean), Some(deviation)) => format!("gap {mean:.3} +- {deviation:.3} d; "),
            (Some(mean), None) => format!("gap {mean:.3} d; "),
            _ => String::new(),
        };
        gap + &self.verdicts()
    }
}

/// The ensemble at a point, of the runs that are done.
pub(super) fn at(grid: &Grid, rows: &Rows, point: usize) -> Option<Ensemble> {
    let there: Vec<&Row> = grid
        .runs_at(point)
        .filter_map(|run| rows.get(&run))
        .collect();
    Ensemble::of(&there)
}

/// The table of all points with a run that is done.
pub(super) fn table(
    grid: &Grid,
    rows: &Rows,
    path: &Path,
) -> Result<csv::Writer<Vec<u8>>, Failure> {
    let encode = |e: csv::Error| Failure::write(path, e.into());
    let mut writer = csv::Writer::from_writer(Vec::new());
    let names = grid.ranges.iter().map(|range| range.name.as_str());
    writer.write_record(names.chain(COLUMNS)).map_err(encode)?;
    let shown = |x: Option<f64>| x.map_or_else(String::new, |x| x.to_string());
    for point in 0..grid.points() {
        let Some(ensemble) = at(grid, rows, point) else {
            continue;
        };
        let mut cells = grid.values(grid.runs_at(point).start);
        cells.extend([
            ensemble.members.to_string(),
            ensemble.defect_share().to_string(),
            ensemble.failed_share().to_string(),
            ensemble.unjudged_share().to_string(),
            shown(ensemble.gap_mean_d),
            shown(ensemble.gap_deviation_d),
            ensemble.verdicts(),
        ]);
        writer.write_record(cells).map_err(encode)?;
    }
    Ok(writer)
}
