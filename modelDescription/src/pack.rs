//! The FMU: a zip archive that depends on nothing but its contents.

use crate::{MODEL_IDENTIFIER, PackError, model_description};
use std::fs;
use std::io::{Cursor, Write};
use std::path::{Path, PathBuf};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

/// What goes into the archive besides the description.
#[derive(Clone, Debug, Default)]
pub struct Contents {
    /// shared libraries, one per platform; the extension tells which
    pub libraries: Vec<PathBuf>,
    /// directory whose `*.toml` become `resources/scenes/`; left out when it does not exist
    pub scenes: Option<PathBuf>,
}

/// One file of the archive.
struct Entry {
    name: String,
    bytes: Vec<u8>,
    permissions: u32,
}

/// FMI's name of a library's platform and the library's extension, from its file name.
pub fn platform_of(library: &Path) -> Option<(&'static str, &'static str)> {
    match library.extension()?.to_str()? {
        "so" => Some(("linux64", "so")),
        "dll" => Some(("win64", "dll")),
        "dylib" => Some(("darwin64", "dylib")),
        _ => None,
    }
}

/// Writes the FMU; the same contents give the same bytes.
///
/// Names are sorted after the description, times are the zip format's first day, permissions are
/// fixed. The file appears under its name only when complete.
pub fn pack(contents: &Contents, out: &Path) -> Result<(), PackError> {
    let mut entries = libraries(&contents.libraries)?;
    if let Some(directory) = contents
        .scenes
        .as_deref()
        .filter(|directory| directory.is_dir())
    {
        entries.extend(scenes(directory)?);
    }
    entries.sort_by(|a, b| a.name.cmp(&b.name));
    let description = model_description()?.into_bytes();
    let name = "modelDescription.xml".to_owned();
    entries.insert(
        0,
        Entry {
            name,
            bytes: description,
            permissions: 0o644,
        },
    );
    let bytes = archive(&entries).map_err(|source| PackError::Archive {
        path: out.to_owned(),
        source,
    })?;
    write_whole(out, &bytes)
}

fn libraries(paths: &[PathBuf]) -> Result<Vec<Entry>, PackError> {
    let mut entries: Vec<Entry> = Vec::new();
    for path in paths {
        let (platform, extension) =
            platform_of(path).ok_or_else(|| PackError::Platform { path: path.clone() })?;
        let name = format!("binaries/{platform}/{MODEL_IDENTIFIER}.{extension}");
        if entries.iter().any(|entry| entry.name == name) {
            return Err(PackError::Twice {
                path: path.clone(),
                platform,
            });
        }
        entries.push(Entry {
            name,
            bytes: read(path)?,
            permissions: 0o755,
        });
    }
    Ok(entries)
}

fn scenes(directory: &Path) -> Result<Vec<Entry>, PackError> {
    let failed = |source| PackError::File {
        path: directory.to_owned(),
        source,
    };
    let mut entries = Vec::new();
    for item in fs::read_dir(directory).map_err(failed)? {
        let path = item.map_err(failed)?.path();
        let Some(name) = path.file_name().and_then(|name| name.to_str()) else {
            continue;
        };
        if name.ends_with(".toml") {
            let name = format!("resources/scenes/{name}");
            entries.push(Entry {
                name,
                bytes: read(&path)?,
                permissions: 0o644,
            });
        }
    }
    Ok(entries)
}

fn read(path: &Path) -> Result<Vec<u8>, PackError> {
    fs::read(path).map_err(|source| PackError::File {
        path: path.to_owned(),
        source,
    })
}

fn archive(entries: &[Entry]) -> Result<Vec<u8>, zip::result::ZipError> {
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    for entry in entries {
        let options = SimpleFileOptions::default()
            .compression_method(CompressionMethod::Deflated)
            .last_modified_time(DateTime::default())
            .unix_permissions(entry.permissions);
        zip.start_file(entry.name.as_str(), options)?;
        zip.write_all(&entry.bytes)?;
    }
    Ok(zip.finish()?.into_inner())
}

/// Writes beside the target and renames, so that no importer opens half an archive.
fn write_whole(out: &Path, bytes: &[u8]) -> Result<(), PackError> {
    let failed = |source| PackError::File {
        path: out.to_owned(),
        source,
    };
    if let Some(directory) = out.parent() {
        fs::create_dir_all(directory).map_err(failed)?;
    }
    let partial = out.with_extension("fmu.part");
    fs::write(&partial, bytes).map_err(failed)?;
    fs::rename(&partial, out).map_err(failed)
}
