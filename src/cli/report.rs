//! `coilwind report`: the page of a run, or of two side by side, from the files that they left.

use super::checkpoint;
use super::failure::Failure;
use super::folder;
use super::terminal::print;
use clap::Args;
use coilwind::output::write_report;
use std::path::PathBuf;

/// Arguments of `report`.
#[derive(Args, Debug)]
pub(super) struct ReportArgs {
    /// Folder of a run
    directory: PathBuf,
    /// Folder of another run, to compare it with
    other: Option<PathBuf>,
    /// The page; default: report.html in the folder, compare.html in the first folder for two
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

/// Makes the page.
pub(super) fn report(args: &ReportArgs) -> Result<(), Failure> {
    let name = match args.other {
        None => "report.html",
        Some(_) => "compare.html",
    };
    let page = args.out.clone().unwrap_or(args.directory.join(name));
    let mut directories = vec![args.directory.as_path()];
    directories.extend(args.other.as_deref());
    for directory in &directories {
        checkpoint::refuse_stopped(directory)?;
        // Held meanwhile, so that a run that goes on keeps its files.
        if let Ok(_hold) = folder::hold(directory) {
            folder::clear_partial(directory);
        }
    }
    write_report(&directories, &page)?;
    print(&format!("report: {}\n", page.display()))
}
