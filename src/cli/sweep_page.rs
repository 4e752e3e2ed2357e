//! `map.html`: the process map of a sweep over two variables as a page, with the runs behind every cell.

use super::failure::Failure;
use super::members::rounded;
use super::sweep_files;
use super::sweep_grid::Grid;
use super::sweep_row::{Row, Rows};
use super::sweep_statistics as statistics;
use coilwind::output::write_whole_bytes;
use coilwind::settings::Origin;
use coilwind::variables::{Access, Variable, table};
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
            "unjudged": ensemble.unjudged,
            "gap_mean_d": ensemble.gap_mean_d,
            "gap_deviation_d": ensemble.gap_deviation_d,
            "gap_worst_d": gaps.reduce(f64::max),
            "verdicts": ensemble.verdicts,
            "runs": runs,
        }))
    });
    let cells = cells.collect::<Vec<_>>();
    json!({ "x": axis(x), "y": axis(y), "cells": cells, "facts": facts(grid), "settings": settings(grid) })
}

/// What was wound, in pairs of name and words.
fn facts(grid: &Grid) -> Vec<[String; 2]> {
    let base = grid.base();
    let mm = |length: f64| format!("{} mm", rounded(1e3 * length, 9));
    let core = match base.core.shape.as_str() {
        "cylinder" => format!("cylinder, radius {}", mm(base.core.radius)),
        "mesh" => format!("mesh, {}", base.core.file),
        shape => format!(
            "{shape}, {} x {}, corner radius {}",
            mm(base.core.width_x),
            mm(base.core.height_z),
            mm(base.core.corner_radius)
        ),
    };
    // A base value of what is swept would be taken for that of every cell.
    let swept = |room: &str| -> String {
        let names = grid.ranges.iter().map(|range| range.variable());
        let names = names.filter(|name| name.starts_with(room));
        names.map(|name| format!("; {name} is swept")).collect()
    };
    let ensemble = match grid.members {
        1 => "1 run a point".to_owned(),
        n => format!("{n} runs a point, the nozzle up to half a wire nearer and farther"),
    };
    [
        ("scene", base.name.clone()),
        ("core", core + &swept("core.")),
        (
            "wire",
            format!(
                "{}, {}{}",
                base.wire.material,
                mm(base.wire.diameter),
                swept("wire.")
            ),
        ),
        ("ensemble", ensemble),
        (
            "solver.tolerance",
            tolerance(grid) + &swept("solver.tolerance"),
        ),
        ("version", format!("coilwind {}", env!("CARGO_PKG_VERSION"))),
    ]
    .map(|(name, words)| [name.to_owned(), words])
    .into()
}

/// The error that a step was allowed, from the least to the most of all cells; it goes with the wire where none is given.
fn tolerance(grid: &Grid) -> String {
    if grid.base().idle_keys().contains("solver.tolerance") {
        return "not used by an explicit method".to_owned();
    }
    let of = |point: usize| {
        let settings = grid.settings(grid.runs_at(point).start).ok()?;
        Some((settings.solver).tolerance_for(settings.wire.outer_diameter()))
    };
    let all = || (0..grid.points()).filter_map(of);
    let least = rounded(all().fold(f64::INFINITY, f64::min), 9);
    let most = rounded(all().fold(0.0, f64::max), 9);
    match least < most {
        true => format!("{least:e} to {most:e} m"),
        false => format!("{most:e} m"),
    }
}

/// Every setting that the scene or `--set` gives and the sweep does not: name, value, unit, and which of the two gave it.
fn settings(grid: &Grid) -> Vec<[String; 4]> {
    let base = grid.base();
    let swept = |name: &str| grid.ranges.iter().any(|range| range.variable() == name);
    let row = |variable: &Variable| {
        let Access::Parameter { get, .. } = variable.access else {
            return None;
        };
        let by = match base.origin(variable.name) {
            Origin::Set => "--set",
            Origin::File { .. } => "scene",
            Origin::Default | Origin::LeftOut { .. } => return None,
        };
        let unit = if variable.unit == "1" {
            ""
        } else {
            variable.unit
        };
        let words = [variable.name, &get(base).to_string(), unit, by];
        (!swept(variable.name)).then(|| words.map(str::to_owned))
    };
    table().iter().filter_map(row).collect()
}

/// A row without its processor time: the page does not depend on the machine.
fn timeless(row: &Row) -> Value {
    let mut value = json!(row);
    if let Some(fields) = value.as_object_mut() {
        fields.remove("cpu_s");
    }
    value
}
