//! Names of the files in the folder of a sweep.

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
