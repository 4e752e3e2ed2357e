//! Files in the folder of an ensemble, by which it is known, and the folders of its members.

use super::failure::Failure;
use super::lock::{self, Locked};
use coilwind::output::write_summary;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// What an ensemble is, in its folder until all members have ended.
pub(super) const PLAN: &str = "ensemble.bin";
/// How many members it has, and what came of them.
pub(super) const SUMMARY: &str = "ensemble.json";
/// Both.
const ALL: [&str; 2] = [PLAN, SUMMARY];

/// What stands in [`SUMMARY`].
#[derive(Serialize, Deserialize)]
pub(super) struct Summary {
    pub(super) members: u32,
    /// runs by their verdicts, once all have ended
    pub(super) verdicts: BTreeMap<String, u32>,
}

impl Summary {
    /// Leaves it in the folder of the ensemble.
    pub(super) fn write(&self, directory: &Path) -> Result<(), Failure> {
        Ok(write_summary(&directory.join(SUMMARY), self)?)
    }
}

/// Whether a folder holds an ensemble that could go on.
pub(super) fn can_go_on(directory: &Path) -> bool {
    directory.join(PLAN).is_file()
}

/// Holds the plan of an ensemble that is about to be wound, in a folder without one; an error where another process has it.
pub(super) fn begin(directory: &Path) -> Result<Locked, Failure> {
    lock::begin(&directory.join(PLAN), || goes_on(directory))
}

/// Holds the plan of the ensemble in a folder, if it has one; an error where the ensemble is going on.
pub(super) fn hold(directory: &Path) -> Result<Option<Locked>, Failure> {
    lock::hold(&directory.join(PLAN), || goes_on(directory))
}

fn goes_on(directory: &Path) -> Failure {
    Failure::Resume {
        directory: directory.display().to_string(),
        reason: "the ensemble is going on; wait for its end, or stop it first".to_owned(),
    }
}

/// Whether a folder holds an ensemble.
pub(super) fn is_in(directory: &Path) -> bool {
    ALL.iter().any(|name| directory.join(name).is_file())
}

/// The folders of the members of the ensemble in a folder, made or not.
pub(super) fn members(directory: &Path) -> Vec<PathBuf> {
    let text = std::fs::read_to_string(directory.join(SUMMARY)).unwrap_or_default();
    let members = serde_json::from_str(&text).map_or(0, |summary: Summary| summary.members);
    let folder = |member: u32| directory.join(member.to_string());
    (1..=members).map(folder).collect()
}
