//! What a run has read beside its scene: a checksum of each file, by which two runs of files of the same name are told apart.

use coilwind::output::READ;
use coilwind::settings::SceneSettings;
use coilwind::variables::{Access, table};
use std::path::{Path, PathBuf};

/// The comment with the checksums, with its end of line; empty where nothing was read. Idle files count for nothing.
pub(super) fn note(settings: &SceneSettings, inputs: Option<&Path>) -> String {
    let idle = settings.idle_keys();
    let of_scene = table().iter().filter_map(|row| match row.access {
        Access::Parameter { get, .. } if is_file(row.name) && !idle.contains(row.name) => {
            Some((row.name, PathBuf::from(get(settings).to_string())))
        }
        _ => None,
    });
    let of_inputs = inputs.map(|path| ("--inputs", path.to_owned()));
    let mut words = String::new();
    for (name, path) in of_scene.chain(of_inputs) {
        if let Ok(sum) = checksum(&path) {
            words += &format!(" {name}={sum:08x}");
        }
    }
    match words.is_empty() {
        true => words,
        false => format!("{READ}{words}\n"),
    }
}

/// Checksum of a file's bytes.
pub(super) fn checksum(path: &Path) -> std::io::Result<u32> {
    std::fs::read(path).map(|bytes| crc32fast::hash(&bytes))
}

/// Whether a variable names a file that the scene reads, and not the scene.
fn is_file(name: &str) -> bool {
    name.ends_with(".file") && name != "scene.file"
}
