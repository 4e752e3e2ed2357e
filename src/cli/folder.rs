//! The folder of a run: made, kept from being overwritten by mistake, and held by one run at a time.

use super::checkpoint;
use super::ensemble_files;
use super::failure::Failure;
use super::lock::Locked;
use super::shell::SCENE;
use super::sweep_files;
use coilwind::output::{PARTIAL, RESULTS};
use coilwind::settings::SceneSettings;
use std::fs;
use std::path::{Path, PathBuf};

/// Files by which a folder is known to hold a run.
const SIGNS: [&str; 4] = ["summary.json", "history.csv", SCENE, checkpoint::FILE];

/// Why a scene in the folder of its results is refused.
const REMOVES_SCENE: &str = "the scene lies in this folder under the name of a file of results, and would be lost; --out for another folder, or copy the scene";

/// What a folder holds that holds a sweep.
const SWEEP: &str = "a sweep";

/// Makes the folder; one that holds a run is refused unless `force` says otherwise, and one with an ensemble or a sweep that goes
/// on in any case. So is one in which the run would overwrite this `scene`.
pub(super) fn prepare(directory: &Path, force: bool, scene: Option<&str>) -> Result<(), Failure> {
    if directory.is_file() {
        return Err(Failure::Resume {
            directory: directory.display().to_string(),
            reason: "is a file; name a folder with --out".to_owned(),
        });
    }
    if let Some(scene) = scene {
        refuse_to_overwrite(directory, scene)?;
    }
    refuse_occupied(directory, force)?;
    drop(hold_ensemble(directory)?);
    drop(sweep_files::hold(directory)?);
    fs::create_dir_all(directory).map_err(|e| Failure::write(directory, e))
}

/// An error where the folder holds a run, unless `force` says otherwise.
pub(super) fn refuse_occupied(directory: &Path, force: bool) -> Result<(), Failure> {
    refuse(directory, held(directory).filter(|_| !force))
}

/// The same where it is no sweep that the folder holds: a sweep that has begun there a moment ago may be the one that is asked for.
pub(super) fn refuse_all_but_sweeps(directory: &Path, force: bool) -> Result<(), Failure> {
    let other = held(directory).filter(|holds| *holds != SWEEP);
    refuse(directory, other.filter(|_| !force))
}

fn refuse(directory: &Path, holds: Option<&'static str>) -> Result<(), Failure> {
    let Some(holds) = holds else {
        return Ok(());
    };
    Err(Failure::Occupied {
        directory: directory.display().to_string(),
        holds,
        can_go_on: has(directory, checkpoint::FILE) || ensemble_files::can_go_on(directory),
    })
}

/// What a folder holds, in words; `None` where that is no run, sweep or ensemble.
pub(super) fn held(directory: &Path) -> Option<&'static str> {
    let any = |names: &[&str]| names.iter().any(|name| has(directory, name));
    match (any(&SIGNS), any(&sweep_files::SIGNS)) {
        (true, _) => Some("another run"),
        (_, true) => Some(SWEEP),
        _ => ensemble_files::is_in(directory).then_some("an ensemble"),
    }
}

/// Whether a folder has this file, with something in it.
fn has(directory: &Path, name: &str) -> bool {
    let data = fs::metadata(directory.join(name));
    data.is_ok_and(|data| data.is_file() && data.len() > 0)
}

/// Removes what an earlier run or sweep left, and leaves the scene as it is about to be run,
/// below a `note` of how. The history must be open by then:
/// it is what tells that no other run writes here.
pub(super) fn begin(directory: &Path, settings: &SceneSettings, note: &str) -> Result<(), Failure> {
    clear(directory)?;
    remove_sweep(directory)?;
    let path = directory.join(SCENE);
    let text = format!("{note}{}", settings.to_toml_for_elsewhere());
    fs::write(&path, text).map_err(|e| Failure::write(&path, e))
}

/// Removes the results of a run, but for its history and its scene, and the members of an ensemble.
fn clear(directory: &Path) -> Result<(), Failure> {
    let (plan, _members) = hold_ensemble(directory)?;
    for member in ensemble_files::members(directory) {
        clear(&member)?;
        remove(&member, &SIGNS)?;
        // With files of somebody else in it, it stays.
        let _ = fs::remove_dir(member);
    }
    if let Some(plan) = plan {
        let path = directory.join(ensemble_files::PLAN);
        plan.remove().map_err(|e| Failure::write(path, e))?;
    }
    remove(directory, &[ensemble_files::SUMMARY])?;
    let folder = directory.join("frames");
    let frames = fs::read_dir(&folder).into_iter().flatten();
    let frames = frames.filter_map(|entry| Some(entry.ok()?.path()));
    let is_frame = |path: &std::path::PathBuf| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let ends = name.ends_with(".vtp") || name.ends_with(".png");
        name.starts_with("frame_") && ends && path.is_file()
    };
    for path in frames.filter(is_frame) {
        fs::remove_file(&path).map_err(|e| Failure::write(&path, e))?;
    }
    remove(directory, &RESULTS)?;
    clear_partial(directory);
    // With files of somebody else in it, it stays.
    let _ = fs::remove_dir(folder);
    Ok(())
}

/// An error where this scene lies in the folder as that of an earlier run, so that making room there would remove it.
pub(super) fn refuse_own_scene(directory: &Path, scene: &str) -> Result<(), Failure> {
    let given = fs::canonicalize(scene).ok();
    let members = ensemble_files::members(directory).into_iter();
    let mut kept = members.chain([directory.to_owned()]);
    let is_given = |folder: PathBuf| fs::canonicalize(folder.join(SCENE)).ok() == given;
    match given.is_some() && kept.any(is_given) {
        true => Err(Failure::Resume {
            directory: directory.display().to_string(),
            reason: REMOVES_SCENE.to_owned(),
        }),
        false => Ok(()),
    }
}

/// An error where this scene is its writer's own and lies where a run keeps its scene. The kept scene of an earlier run says the
/// same when it is wound again.
fn refuse_to_overwrite(directory: &Path, scene: &str) -> Result<(), Failure> {
    let of_run = SIGNS.iter().filter(|sign| **sign != SCENE);
    let holds_run = of_run.into_iter().any(|sign| has(directory, sign));
    if holds_run {
        return Ok(());
    }
    refuse_own_scene(directory, scene)
}

/// Removes all that a run left, for a sweep or an ensemble in its place.
pub(super) fn clear_run(directory: &Path) -> Result<(), Failure> {
    drop(hold(directory)?);
    clear(directory)?;
    remove(directory, &SIGNS)
}

/// Removes all that a run or a sweep left.
pub(super) fn clear_all(directory: &Path) -> Result<(), Failure> {
    clear_run(directory)?;
    remove_sweep(directory)
}

/// Removes all that a sweep left; an error where it is going on.
fn remove_sweep(directory: &Path) -> Result<(), Failure> {
    let _plan = sweep_files::hold(directory)?;
    remove(directory, &sweep_files::ALL)
}

/// Removes files of these names.
fn remove(directory: &Path, names: &[&str]) -> Result<(), Failure> {
    for path in names.iter().map(|name| directory.join(name)) {
        // A device in place of a file is what tests put there.
        if path.is_file() {
            fs::remove_file(&path).map_err(|e| Failure::write(&path, e))?;
        }
    }
    Ok(())
}

/// Removes what a run that was killed left of files on their way; only those that a run writes, and of no run that goes on.
pub(super) fn clear_partial(directory: &Path) {
    let names = SIGNS.iter().chain(&RESULTS);
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

/// Holds the plan and every member of the ensemble in a folder; an error where one goes on. Held all at a time, so that none is
/// lost to a command which one of the others refuses.
fn hold_ensemble(directory: &Path) -> Result<(Option<Locked>, Vec<Option<fs::File>>), Failure> {
    let plan = ensemble_files::hold(directory)?;
    let members = ensemble_files::members(directory);
    let members: Result<_, Failure> = members.iter().map(|member| hold(member)).collect();
    Ok((plan, members?))
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::frames;

    #[test]
    fn results_are_removed_by_the_names_that_they_are_written_by() {
        for name in [frames::SERIES, checkpoint::FILE] {
            assert!(RESULTS.contains(&name), "{name}");
        }
    }
}
