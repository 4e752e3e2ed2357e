//! `map.html`: the process map of a sweep over two variables as a page, with the runs behind every cell.

use super::failure::Failure;
use super::sweep_files;
use super::sweep_grid::Grid;
use super::sweep_row::{Row, Rows};
use super::sweep_statistics as statistics;
use coilwind::output::write_whole_bytes;
use serde_json::{Value, json};
use std::path::Path;

const PAGE: &str = include_str!("sweep_page.html");

/// Writes the page of a grid of two ranges.
///
/// # Errors
/// Where it cannot be written.
pub(super) fn write(directory: &Path, grid: &Grid, rows: &Rows) -> Result<(), Failure> {
    let path = directory.join(sweep_files::PAGE);
    // Text of a script ends at the first `</script`, wherever it stands.
    let data = data(grid, rows).to_string().replace('<', "\\u003c");
    Ok(write_whole_bytes(
        &path,
        PAGE.replacen("{{data}}", &data, 1),
    )?)
}

fn data(grid: &Grid, rows: &Rows) -> Value {
    let (x, y) = (&grid.ranges[0], &grid.ranges[1]);
    let axis = |range: &super::sweep_range::Range| {
        let values: Vec<f64> = (0..range.count).map(|k| range.value(k)).collect();
        json!({ "name": range.name, "title": range.title(), "values": values })
    };
    let height = y.count as usize;
    let cells = (0..grid.points()).filter_map(|point| {
        let there: Vec<&Row> = (grid.runs_at(point))
            .filter_map(|run| rows.get(&run))
            .collect();
        let ensemble = statistics::Ensemble::of(&there)?;
        let gaps = there.iter().filter_map(|row| row.gap_mean_d);
        let runs: Vec<Value> = there.iter().map(|row| timeless(row)).collect();
        Some(json!({
            "x": point / height,
            "y": point % height,
            "members": ensemble.members,
            "defects": ensemble.defects,
            "failed": ensemble.failed,
            "gap_mean_d": ensemble.gap_mean_d,
            "gap_deviation_d": ensemble.gap_deviation_d,
            "gap_worst_d": gaps.reduce(f64::max),
            "verdicts": ensemble.verdicts,
            "runs": runs,
        }))
    });
    json!({ "x": axis(x), "y": axis(y), "cells": cells.collect::<Vec<_>>() })
}

/// A row without its processor time: the page does not depend on the machine.
fn timeless(row: &Row) -> Value {
    let mut value = json!(row);
    if let Some(fields) = value.as_object_mut() {
        fields.remove("cpu_s");
    }
    value
}
