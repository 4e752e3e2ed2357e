//! `map.svg`: the process map of a sweep over two variables, a cell a point of the grid.

use super::failure::Failure;
use super::members::rounded;
use super::sweep_files::MAP;
use super::sweep_grid::Grid;
use super::sweep_page as page;
use super::sweep_row::Rows;
use super::sweep_statistics::{self as statistics, Ensemble};
use coilwind::output::write_whole_bytes;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use std::path::Path;

/// Size of a cell, pixels: two short lines of text fit.
const CELL: (u32, u32) = (92, 52);
/// Room for axes and caption, pixels.
const MARGIN: (u32, u32) = (110, 110);
/// Cells along an axis from which on texts would not be read: the table has the numbers.
const MOST: u32 = 60;
/// Colours of no defect, of the first defects, of a defect in every run, and of runs that tell nothing; told apart also by the
/// colour-blind. From blue to orange there is a grey halfway, so one defect already counts as orange.
const FREE: [f64; 3] = [214.0, 232.0, 244.0];
const FEW: [f64; 3] = [253.0, 228.0, 205.0];
const DEFECT: [f64; 3] = [213.0, 94.0, 0.0];
const UNKNOWN: [f64; 3] = [150.0, 150.0, 150.0];
/// Digits of a value at an axis: what a cell has room for.
const LABEL_DIGITS: usize = 6;

/// Draws the map, as a picture and as a page, where two variables are swept and it can be read; tells whether.
///
/// # Errors
/// Where the picture cannot be drawn or written.
pub(super) fn write(directory: &Path, grid: &Grid, rows: &Rows) -> Result<bool, Failure> {
    let [x, y] = &grid.ranges[..] else {
        return Ok(false);
    };
    if x.count > MOST || y.count > MOST {
        return Ok(false);
    }
    let path = directory.join(MAP);
    let text = draw(grid, rows).map_err(|reason| {
        Failure::sweep(format!("{} cannot be drawn: {reason}", path.display()))
    })?;
    write_whole_bytes(&path, text)?;
    page::write(directory, grid, rows)?;
    Ok(true)
}

/// The picture as a text.
fn draw(grid: &Grid, rows: &Rows) -> Result<String, String> {
    let told = |e: DrawingAreaErrorKind<std::io::Error>| e.to_string();
    let (x, y) = (&grid.ranges[0], &grid.ranges[1]);
    let size = (
        MARGIN.0 + x.count.max(4) * CELL.0,
        MARGIN.1 + y.count.max(2) * CELL.1,
    );
    let mut text = String::new();
    {
        let area = SVGBackend::with_string(&mut text, size).into_drawing_area();
        area.fill(&WHITE).map_err(told)?;
        let span = |count: u32| -0.5..f64::from(count) - 0.5;
        let caption = "share of runs with a defect; worst mean gap of a turn, in wire diameters";
        let mut chart = ChartBuilder::on(&area)
            .caption(caption, ("sans-serif", 14))
            .margin(10)
            .x_label_area_size(50)
            .y_label_area_size(80)
            .build_cartesian_2d(span(x.count), span(y.count))
            .map_err(told)?;
        // Cells stand at whole numbers; between them there is nothing to say.
        let label = |range: &super::sweep_range::Range, at: f64| {
            let index = at.round();
            let whole = (at - index).abs() < 1e-6 && (0.0..f64::from(range.count)).contains(&index);
            match whole {
                true => rounded(range.value(index as u32), LABEL_DIGITS).to_string(),
                false => String::new(),
            }
        };
        chart
            .configure_mesh()
            .disable_mesh()
            .x_desc(x.title())
            .y_desc(y.title())
            .x_labels(x.count as usize + 1)
            .y_labels(y.count as usize + 1)
            .x_label_formatter(&|at| label(x, *at))
            .y_label_formatter(&|at| label(y, *at))
            .draw()
            .map_err(told)?;
        let style = ("sans-serif", 13).into_text_style(&area);
        let style = style.pos(Pos::new(HPos::Center, VPos::Center));
        for point in 0..grid.points() {
            let Some(ensemble) = statistics::at(grid, rows, point) else {
                continue;
            };
            let height = y.count as usize;
            let (i, j) = ((point / height) as f64, (point % height) as f64);
            let corners = [(i - 0.48, j - 0.47), (i + 0.48, j + 0.47)];
            let cell = Rectangle::new(corners, colour(&ensemble).filled());
            chart.draw_series([cell]).map_err(told)?;
            let lines = words(&ensemble).into_iter().zip([0.15, -0.2]);
            let lines = lines.map(|(words, up)| Text::new(words, (i, j + up), style.clone()));
            chart.draw_series(lines).map_err(told)?;
        }
        area.present().map_err(told)?;
    }
    Ok(text)
}

/// Free, or from few to all by the share of runs with a defect; grey by the share that failed or could not be judged.
fn colour(ensemble: &Ensemble) -> RGBColor {
    let bad = ensemble.defect_share();
    let unknown = ensemble.failed_share() + ensemble.unjudged_share();
    let part = |k: usize| {
        let judged = match bad > 0.0 {
            true => FEW[k] + bad * (DEFECT[k] - FEW[k]),
            false => FREE[k],
        };
        (judged + unknown * (UNKNOWN[k] - judged)).round() as u8
    };
    RGBColor(part(0), part(1), part(2))
}

/// What a cell says: `2 of 8`, and the gap.
fn words(ensemble: &Ensemble) -> [String; 2] {
    let (defects, members) = (ensemble.defects, ensemble.members);
    let gap = ensemble.gap_mean_d;
    [
        match (ensemble.failed, ensemble.unjudged) {
            (0, 0) => format!("{defects} of {members}"),
            (0, unjudged) if unjudged == members => "not judged".to_owned(),
            (0, unjudged) => format!("{defects} of {} judged", members - unjudged),
            (failed, _) => format!("{defects} of {members} ({failed} failed)"),
        },
        gap.map_or_else(String::new, |gap| format!("{gap:.3} d")),
    ]
}
