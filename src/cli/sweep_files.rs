//! The files in the folder of a sweep, and who holds its plan.

use super::failure::Failure;
use super::lock::{self, Locked};
use std::path::Path;

/// What the sweep is: scene, ranges, members.
pub(super) const PLAN: &str = "sweep.json";
/// A row a run.
pub(super) const ROWS: &str = "sweep.csv";
/// A row a point of the grid.
pub(super) const STATISTICS: &str = "ensemble.csv";
/// The process map as a picture.
pub(super) const MAP: &str = "map.svg";
/// The process map as a page.
pub(super) const PAGE: &str = "map.html";

/// What `--find-max` found, or why it found nothing.
pub(super) const ANSWER: &str = "find_max.json";

/// Those by which a folder is known to hold a sweep.
pub(super) const SIGNS: [&str; 2] = [PLAN, ROWS];
/// All of them.
pub(super) const ALL: [&str; 6] = [PLAN, ROWS, STATISTICS, MAP, PAGE, ANSWER];

/// Holds the plan of a sweep, empty where there was none; an error where another sweep holds it. No command puts another file in
/// its place, so that two which begin at the same moment meet at the same one.
pub(super) fn begin(directory: &Path) -> Result<Locked, Failure> {
    lock::begin(&directory.join(PLAN), || goes_on(directory))
}

/// Holds the plan of the sweep in a folder, if it has one; an error where the sweep is going on.
pub(super) fn hold(directory: &Path) -> Result<Option<Locked>, Failure> {
    lock::hold(&directory.join(PLAN), || goes_on(directory))
}

fn goes_on(directory: &Path) -> Failure {
    Failure::sweep(format!(
        "{}: a sweep is going on here; wait for its end, or stop it first",
        directory.display()
    ))
}
