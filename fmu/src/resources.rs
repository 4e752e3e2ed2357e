//! The folder in which the unpacked FMU keeps its resources, and scene files in it.

use percent_encoding::percent_decode_str;
use std::path::{Path, PathBuf};

/// Returns the path of a `file:` URI, or `None` when it names no local directory.
///
/// Accepts `file:///path`, `file://localhost/path`, `file:/path`, each percent-encoded or not, and
/// the plain path that some importers pass. A `%` that starts no code stands for itself, so that
/// unencoded names work.
pub(crate) fn directory(uri: &str) -> Option<PathBuf> {
    let rest = match uri.get(..5) {
        Some(scheme) if scheme.eq_ignore_ascii_case("file:") => &uri[5..],
        _ if uri.contains("://") || uri.is_empty() => return None,
        _ => return Some(PathBuf::from(uri)),
    };
    let path = match rest.strip_prefix("//") {
        Some(authority_and_path) => {
            let slash = authority_and_path.find('/')?;
            let (authority, path) = authority_and_path.split_at(slash);
            if !(authority.is_empty() || authority.eq_ignore_ascii_case("localhost")) {
                return None;
            }
            path
        }
        None => rest,
    };
    if path.is_empty() {
        return None;
    }
    let decoded = percent_decode_str(path).decode_utf8().ok()?;
    Some(PathBuf::from(without_slash_before_drive(&decoded)))
}

/// Turns `/C:/x` into `C:/x`.
fn without_slash_before_drive(path: &str) -> &str {
    match path.as_bytes() {
        [b'/', drive, b':', ..] if drive.is_ascii_alphabetic() => &path[1..],
        _ => path,
    }
}

/// Returns what to load for a `scene.file` of that name.
///
/// That is a file of that name in `resources` or `resources/scenes` if there is one. Else it is the
/// name itself, which is a packed name or a path.
pub(crate) fn scene(name: &str, resources: Option<&Path>) -> String {
    let Some(resources) = resources else {
        return name.to_owned();
    };
    [resources.join(name), resources.join("scenes").join(name)]
        .iter()
        .filter(|path| path.is_file())
        .find_map(|path| path.to_str())
        .unwrap_or(name)
        .to_owned()
}

/// Returns what to load for a `core.file` or `traverse.file` of that name: the file of that name in `resources` if there is one, else the
/// name itself.
pub(crate) fn file(name: &str, resources: Option<&Path>) -> String {
    resources
        .map(|resources| resources.join(name))
        .filter(|path| !name.is_empty() && path.is_file())
        .and_then(|path| path.to_str().map(str::to_owned))
        .unwrap_or_else(|| name.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_spelling_of_a_directory() {
        for (uri, path) in [
            (
                "file:///data/unpacked/resources",
                "/data/unpacked/resources",
            ),
            ("file:/data/unpacked/resources", "/data/unpacked/resources"),
            ("FILE://localhost/data/resources", "/data/resources"),
            ("file:///data/two%20words/r%C3%A9s", "/data/two words/rés"),
            ("file:///data/two words/rés", "/data/two words/rés"),
            ("file:///data/50%/resources", "/data/50%/resources"),
            ("file:///C:/data/resources", "C:/data/resources"),
            ("/data/resources", "/data/resources"),
        ] {
            assert_eq!(directory(uri), Some(PathBuf::from(path)), "{uri}");
        }
    }

    #[test]
    fn what_is_no_local_directory() {
        for uri in [
            "",
            "file:",
            "file://",
            "file://server/share",
            "http://x/y",
            "file:///%FF",
        ] {
            assert_eq!(directory(uri), None, "{uri}");
        }
    }

    #[test]
    fn scenes_among_the_resources_come_first() {
        let resources = tempfile::tempdir().expect("directory");
        std::fs::create_dir(resources.path().join("scenes")).expect("directory");
        let file = resources.path().join("scenes/mine.toml");
        std::fs::write(&file, "").expect("file");
        let found = scene("mine.toml", Some(resources.path()));
        assert_eq!(Path::new(&found), file);
        assert_eq!(scene("fig8", Some(resources.path())), "fig8");
        assert_eq!(
            scene("/elsewhere/a.toml", Some(resources.path())),
            "/elsewhere/a.toml"
        );
        assert_eq!(scene("mine.toml", None), "mine.toml");
    }
}
