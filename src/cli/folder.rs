//! The folder of a run: made, kept from being overwritten by mistake, and held by one run at a time.

use super::checkpoint;
use super::failure::Failure;
use super::frames;
use coilwind::output::PARTIAL;
use coilwind::settings::SceneSettings;
use std::fs;
use std::path::Path;

/// Files by which a folder is known to hold a run.
const SIGNS: [&str; 4] = [
    "summary.json",
    "history.csv",
    "scene.toml",
    checkpoint::FILE,
];

/// Files that a run leaves when it ends. Those of an earlier run would mix with a later one that is stopped.
const RESULTS: [&str; 10] = [
    "summary.json",
    "turns.csv",
    "stations.csv",
    "defects.csv",
    "coil.vtp",
    "coil.png",
    "core.vtp",
    "report.html",
    frames::SERIES,
    checkpoint::FILE,
];

/// Makes the folder; one that holds a run is refused unless `force` says otherwise.
pub(super) fn prepare(directory: &Path, force: bool) -> Result<(), Failure> {
    refuse_occupied(directory, force)?;
    fs::create_dir_all(directory).map_err(|e| Failure::write(directory, e))
}

/// An error where the folder holds a run, unless `force` says otherwise.
pub(super) fn refuse_occupied(directory: &Path, force: bool) -> Result<(), Failure> {
    let is_file = |name: &&str| {
        let data = fs::metadata(directory.join(name));
        data.is_ok_and(|data| data.is_file() && data.len() > 0)
    };
    if !force && SIGNS.iter().any(is_file) {
        return Err(Failure::Occupied {
            directory: directory.display().to_string(),
            can_go_on: is_file(&checkpoint::FILE),
        });
    }
    Ok(())
}

/// Removes what an earlier run left, and leaves the scene as it is about to be run. The history must be open by then:
/// it is what tells that no other run writes here.
pub(super) fn begin(directory: &Path, settings: &SceneSettings) -> Result<(), Failure> {
    let frames = fs::read_dir(directory.join("frames")).into_iter().flatten();
    let frames = frames.filter_map(|entry| Some(entry.ok()?.path()));
    let is_frame = |path: &std::path::PathBuf| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        name.starts_with("frame_") && (name.ends_with(".vtp") || name.ends_with(".png"))
    };
    let results = RESULTS.iter().map(|name| directory.join(name));
    for path in results.chain(frames.filter(is_frame)) {
        // A device in place of a file is what tests put there.
        if path.is_file() {
            fs::remove_file(&path).map_err(|e| Failure::write(&path, e))?;
        }
    }
    clear_partial(directory);
    let path = directory.join("scene.toml");
    fs::write(&path, settings.to_toml()).map_err(|e| Failure::write(&path, e))
}

/// Removes what a run that was killed left of files on their way; only those that a run writes, and of no run that goes on.
pub(super) fn clear_partial(directory: &Path) {
    let names = SIGNS.iter().chain(&RESULTS).chain(&["compare.html"]);
    let frames = fs::read_dir(directory.join("frames")).into_iter().flatten();
    let frames = frames.filter_map(|entry| Some(entry.ok()?.path()));
    let is_frame = |path: &std::path::PathBuf| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        name.starts_with("frame_") && name.ends_with(PARTIAL)
    };
    for path in names
        .map(|name| directory.join(format!("{name}{PARTIAL}")))
        .chain(frames.filter(is_frame))
    {
        // What cannot be removed harms nobody.
        let _ = fs::remove_file(path);
    }
}

/// Holds the history of a run that goes on; an error where another run writes it.
#[cfg(unix)]
pub(super) fn hold(directory: &Path) -> Result<Option<fs::File>, Failure> {
    let path = directory.join("history.csv");
    let Ok(file) = fs::File::open(&path) else {
        return Ok(None);
    };
    // Not every file system has locks.
    if let Err(fs::TryLockError::WouldBlock) = file.try_lock() {
        return Err(Failure::Resume {
            directory: directory.display().to_string(),
            reason: "the run is going on; wait for its end, or stop it first".to_owned(),
        });
    }
    Ok(Some(file))
}

/// A lock would keep readers out as well here.
#[cfg(not(unix))]
pub(super) fn hold(_: &Path) -> Result<Option<fs::File>, Failure> {
    Ok(None)
}
