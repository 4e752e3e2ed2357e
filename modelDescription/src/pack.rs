//! The FMU: a zip archive whose bytes depend on nothing but its contents.

use crate::description::model_description;
use crate::document::{PICTURES, document};
use crate::error::PackError;
use crate::xml::MODEL_IDENTIFIER;
use std::fs;
use std::io::{Cursor, Write};
use std::path::{Path, PathBuf};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

/// The licence of coilwind itself.
const LICENSE: &str = include_str!("../../LICENSE");

/// The icon that importers show for the model.
const ICON: &[u8] = include_bytes!("../documentation/model.png");

/// What goes into the archive besides description and documentation.
#[derive(Clone, Debug, Default)]
pub struct Contents {
    /// Shared libraries, one per platform, which the extension tells.
    pub libraries: Vec<PathBuf>,
    /// Folder whose `*.toml` become `resources/scenes/`. One that does not exist is left out.
    pub scenes: Option<PathBuf>,
    /// Licences of what is linked in, see [`third_party`](crate::third_party).
    pub third_party: String,
}

/// One file of the archive.
struct Entry {
    name: String,
    bytes: Vec<u8>,
    permissions: u32,
}

impl Entry {
    fn file(name: impl Into<String>, bytes: impl Into<Vec<u8>>) -> Self {
        Self {
            name: name.into(),
            bytes: bytes.into(),
            permissions: 0o644,
        }
    }
}

/// Returns FMI's name of a library's platform and the extension, or `None` for another extension.
fn platform_of(library: &Path) -> Option<(&'static str, &'static str)> {
    match library.extension()?.to_str()? {
        "so" => Some(("linux64", "so")),
        "dll" => Some(("win64", "dll")),
        "dylib" => Some(("darwin64", "dylib")),
        _ => None,
    }
}

/// Writes the FMU to the file `out`. The same contents give the same bytes.
///
/// The description comes first, then the other entries sorted by name. Times are the first day of
/// the zip format, and permissions are fixed. The file appears under its name only when complete.
///
/// # Errors
///
/// If the extension of a library is unknown, two libraries are for one platform, or a file cannot
/// be read or written.
pub fn pack(contents: &Contents, out: &Path) -> Result<(), PackError> {
    let mut entries = libraries(&contents.libraries)?;
    if let Some(directory) = contents
        .scenes
        .as_deref()
        .filter(|directory| directory.is_dir())
    {
        entries.extend(scenes(directory)?);
    }
    entries.extend(documentation(&contents.third_party)?);
    entries.sort_by(|a, b| a.name.cmp(&b.name));
    let description = model_description()?;
    entries.insert(0, Entry::file("modelDescription.xml", description));
    let bytes = archive(&entries).map_err(|source| PackError::Archive {
        path: out.to_owned(),
        source,
    })?;
    write_whole(out, &bytes)
}

/// Returns what people look at: the page with its pictures, the licences, the icon.
fn documentation(third_party: &str) -> Result<Vec<Entry>, PackError> {
    let mut entries = vec![
        Entry::file("documentation/index.html", document()?),
        Entry::file("documentation/licenses/license.txt", LICENSE),
        Entry::file("documentation/licenses/third-party.txt", third_party),
        Entry::file("model.png", ICON),
    ];
    entries
        .extend(PICTURES.map(|(name, bytes)| Entry::file(format!("documentation/{name}"), bytes)));
    Ok(entries)
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
            entries.push(Entry::file(
                format!("resources/scenes/{name}"),
                read(&path)?,
            ));
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

/// Writes to a file beside `out` and renames it, so that no importer opens half an archive.
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
