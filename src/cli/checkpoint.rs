//! Where a run could go on: `checkpoint.bin` in its folder, written now and then and removed at the end.
//!
//! It holds the scene, the motion, the state of the run and where its files stood. A kill at any instant leaves the old
//! file or the new one, whole.

use super::drive::{Motion, Place};
use super::ends::Ends;
use super::failure::Failure;
use super::read_files;
use super::shell::{SCENE, begin_again, quoted};
use super::sweep_files;
use coilwind::output::{Mark, READ, WOUND_WITH, write_whole_bytes};
use coilwind::settings::SceneSettings;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::fs;
use std::path::{Path, PathBuf};

/// Name of the file in the folder of a run.
pub(super) const FILE: &str = "checkpoint.bin";
/// Changes whenever the layout does; the state has a version of its own.
const MAGIC: &[u8; 8] = b"coilwck3";
/// Bytes before the state: [`MAGIC`] and a checksum of what follows.
const HEAD: usize = MAGIC.len() + size_of::<u32>();

/// What does not change during a run.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Plan {
    pub(super) settings: SceneSettings,
    pub(super) motion: Motion,
    /// checksum of the file of inputs; 0 without one
    pub(super) inputs_checksum: u32,
    pub(super) frames: u32,
    pub(super) geometry: bool,
    pub(super) ends: Ends,
}

/// A run between two communication steps.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Checkpoint {
    pub(super) plan: Plan,
    pub(super) place: Place,
    /// end of the history
    pub(super) history: Mark,
    /// number and time of the frames written
    pub(super) frames: Vec<(u32, f64)>,
    /// wall time so far, s
    pub(super) wall_s: f64,
    /// [`Simulation::to_bytes`](coilwind::simulation::Simulation::to_bytes)
    pub(super) state: Vec<u8>,
}

impl Plan {
    /// Paths are made absolute, so that the run can go on from another folder.
    ///
    /// # Errors
    /// Where the inputs cannot be read.
    pub(super) fn new(
        settings: &SceneSettings,
        motion: &Motion,
        (frames, geometry): (u32, bool),
        ends: Ends,
    ) -> Result<Self, Failure> {
        let absolute = |path: &Path| std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        let mut settings = settings.clone();
        for file in settings.files_mut() {
            if !file.is_empty() {
                *file = absolute(Path::new(file)).display().to_string();
            }
        }
        let mut motion = motion.clone();
        let mut inputs_checksum = 0;
        if let Some((path, _)) = &mut motion.inputs {
            *path = absolute(path);
            inputs_checksum = checksum(path)?;
        }
        Ok(Self {
            settings,
            motion,
            inputs_checksum,
            frames,
            geometry,
            ends,
        })
    }

    /// An error where the scene in the folder is not the one that the run wrote there: what goes on is the run's own.
    pub(super) fn check_scene(&self, directory: &Path) -> Result<(), Failure> {
        let Ok(text) = fs::read_to_string(directory.join(SCENE)) else {
            return Ok(());
        };
        let head = |line: &&str| line.starts_with(WOUND_WITH) || line.starts_with(READ);
        let lines = text.split_inclusive('\n').skip_while(head);
        if lines.eq(self.settings.to_toml_for_elsewhere().split_inclusive('\n')) {
            return Ok(());
        }
        Err(Failure::Resume {
            directory: directory.display().to_string(),
            reason: format!(
                "{SCENE} is not the one that the run wrote; put it back to go on, or {}",
                begin_again(directory)
            ),
        })
    }

    /// An error where the inputs are not those that the run began with.
    pub(super) fn check_inputs(&self) -> Result<(), Failure> {
        let Some((path, _)) = &self.motion.inputs else {
            return Ok(());
        };
        if checksum(path)? == self.inputs_checksum {
            return Ok(());
        }
        Err(Failure::Signals {
            file: path.display().to_string(),
            reason: "not the inputs that the run began with; put them back to go on, or begin again with --force"
                .to_owned(),
        })
    }
}

/// Whether the run of a folder went on to its end, as its summary says. One that is not whole counts as an end: nothing else is known.
fn has_ended(directory: &Path) -> bool {
    let Ok(text) = fs::read_to_string(directory.join("summary.json")) else {
        return false;
    };
    let summary: serde_json::Value = serde_json::from_str(&text).unwrap_or_default();
    !matches!(summary["status"].as_str(), Some("failed" | "interrupted"))
}

fn checksum(path: &Path) -> Result<u32, Failure> {
    read_files::checksum(path).map_err(|error| Failure::Signals {
        file: path.display().to_string(),
        reason: format!("cannot be read: {error}"),
    })
}

impl Checkpoint {
    /// Writes the file in the place of the one that is there.
    pub(super) fn write(&self, directory: &Path) -> Result<(), Failure> {
        let path = directory.join(FILE);
        Ok(write_whole_bytes(&path, checked(&path, MAGIC, self)?)?)
    }

    /// Reads the file of a folder.
    ///
    /// # Errors
    /// Says what to do where there is none, or where it is not whole.
    pub(super) fn read(directory: &Path) -> Result<Self, Failure> {
        let path = directory.join(FILE);
        let place = directory.display();
        let resume = |reason| Failure::Resume {
            directory: place.to_string(),
            reason,
        };
        if directory.is_file() {
            return Err(resume("is a file; name the folder of a run".to_owned()));
        }
        let bytes = fs::read(&path).map_err(|_| {
            let has = |name: &str| directory.join(name).exists();
            resume(match (has_ended(directory), has(SCENE)) {
                (true, _) => "the run has ended; wind it again with --force, or look at it with coilwind report".to_owned(),
                _ if has(sweep_files::PLAN) => format!(
                    "holds a sweep; it goes on by the command that began it, coilwind sweep SCENE ... --out {}",
                    quoted(&place)
                ),
                _ if has("1/summary.json") => "the ensemble has ended; wind it again with --force, or look at a member with coilwind report".to_owned(),
                (_, true) => format!("{FILE} is missing; {}", begin_again(directory)),
                _ => format!(
                    "there is no run that could go on ({FILE} is missing); begin one with: coilwind run SCENE --out {}",
                    quoted(&place)
                ),
            })
        })?;
        read_checked(&bytes, MAGIC)
            .map_err(|what| resume(format!("{FILE} {what}; {}", begin_again(directory))))
    }

    /// Removes the file: the run has ended.
    pub(super) fn remove(directory: &Path) -> Result<(), Failure> {
        let path: PathBuf = directory.join(FILE);
        match fs::remove_file(&path) {
            Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
                Err(Failure::write(&path, error))
            }
            _ => Ok(()),
        }
    }
}

/// A value as bytes, after a checksum; errors name the file that they are for.
pub(super) fn checked(
    path: &Path,
    magic: &[u8; 8],
    value: &impl Serialize,
) -> Result<Vec<u8>, Failure> {
    let mut bytes = postcard::to_extend(value, vec![0; HEAD])
        .map_err(|error| Failure::write(path, std::io::Error::other(error)))?;
    let checksum = crc32fast::hash(&bytes[HEAD..]).to_le_bytes();
    bytes[..magic.len()].copy_from_slice(magic);
    bytes[magic.len()..HEAD].copy_from_slice(&checksum);
    Ok(bytes)
}

/// The value of such a file.
///
/// # Errors
/// What is wrong with the file, in words that follow its name.
pub(super) fn read_checked<T: DeserializeOwned>(
    bytes: &[u8],
    magic: &[u8; 8],
) -> Result<T, String> {
    let body = bytes
        .strip_prefix(magic)
        .ok_or("is of another version of coilwind, or not whole")?;
    let (sum, body) = body.split_first_chunk::<4>().ok_or("is not whole")?;
    if crc32fast::hash(body) != u32::from_le_bytes(*sum) {
        return Err("is not whole".to_owned());
    }
    postcard::from_bytes(body).map_err(|error| format!("cannot be read ({error})"))
}
