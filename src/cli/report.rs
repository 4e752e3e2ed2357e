//! `coilwind report`: the page of a run, or of two side by side, from the files that they left.

use super::checkpoint;
use super::failure::Failure;
use super::folder;
use super::shell::{SCENE, begin_again, resume_command};
use super::terminal::print;
use clap::Args;
use coilwind::output::{ReportError, missing_files, write_report};
use std::path::{Path, PathBuf};

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
        refuse_unfinished(directory)?;
        // Held meanwhile, so that a run that goes on keeps its files.
        if let Ok(_hold) = folder::hold(directory) {
            folder::clear_partial(directory);
        }
    }
    write_report(&directories, &page).map_err(what_would_do)?;
    for directory in &directories {
        let missing = missing_files(directory);
        for name in &missing {
            eprintln!(
                "warning: {} is missing, and the page goes without it",
                directory.join(name).display()
            );
        }
        if !missing.is_empty() && directory.join(SCENE).exists() {
            eprintln!("for a whole page, {}", what_ends_it(directory));
        }
    }
    print(&format!("report: {}\n", page.display()))
}

/// An error where a folder holds a run without results: one that is under way, or was killed before it wrote them.
fn refuse_unfinished(directory: &Path) -> Result<(), Failure> {
    let has = |name: &str| directory.join(name).exists();
    let place = directory.display();
    // A run that goes on has the results of its first part beside it.
    let ended = has("summary.json") && !has(checkpoint::FILE);
    if !ended && folder::hold(directory).is_err() {
        return Err(Failure::Resume {
            directory: place.to_string(),
            reason: "the run is under way and has not written its results; wait for its end, or stop it first".to_owned(),
        });
    }
    if has("summary.json") || !has(SCENE) {
        return Ok(());
    }
    Err(Failure::Resume {
        directory: place.to_string(),
        reason: format!(
            "the run was stopped before it wrote its results; {}",
            what_ends_it(directory)
        ),
    })
}

/// What brings the run in a folder to its end: one that can go on does not begin again.
fn what_ends_it(directory: &Path) -> String {
    match directory.join(checkpoint::FILE).exists() {
        true => format!("go on with: {}", resume_command(directory.display())),
        false => begin_again(directory),
    }
}

/// What a folder without a run holds, if that has pages.
fn other_results(directory: &Path) -> Option<Failure> {
    let member = directory.join("1");
    let reason = if directory.join("sweep.json").exists() {
        let page = directory.join("map.html");
        // (a page is made of a sweep over two variables)
        match page.exists() {
            true => format!("holds a sweep; its page is {}", page.display()),
            false => format!(
                "holds a sweep; its runs are the rows of {}",
                directory.join("sweep.csv").display()
            ),
        }
    } else if member.join("summary.json").exists() {
        format!(
            "holds an ensemble; name a member, such as {}",
            member.display()
        )
    } else {
        return None;
    };
    Some(Failure::Resume {
        directory: directory.display().to_string(),
        reason,
    })
}

/// The failure with what would mend it: a run that has ended cannot go on, so its scene is wound again.
fn what_would_do(error: ReportError) -> Failure {
    let (path, reason) = match &error {
        ReportError::Broken { path, reason } => (path, reason),
        ReportError::NoRun { directory, .. } => {
            return other_results(directory).unwrap_or_else(|| error.into());
        }
        _ => return error.into(),
    };
    let directory = path.parent().unwrap_or(path);
    let directory = match directory.ends_with("frames") {
        true => directory.parent().unwrap_or(directory),
        false => directory,
    };
    if directory.join(checkpoint::FILE).exists() {
        return error.into();
    }
    let next = match directory.join(SCENE).exists() {
        true => begin_again(directory),
        false => "wind the scene again".to_owned(),
    };
    let file = path.file_name().unwrap_or_default().to_string_lossy();
    Failure::Resume {
        directory: directory.display().to_string(),
        reason: format!("{file} is not whole ({reason}); {next}"),
    }
}
