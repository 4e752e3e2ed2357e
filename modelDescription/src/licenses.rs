//! Licences of everything that is linked into the libraries, collected from the crates' sources.

use serde::Deserialize;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

/// What is linked in besides crates: the standard library and what the linkers add.
const RUNTIME: &str = include_str!("../licenses/runtime.txt");

/// Crates that come without a text, and the crate of the same repository and licence that has it.
const TEXT_OF: [(&str, &str); 2] = [
    ("pulp-wasm-simd-flag", "pulp"),
    ("winapi-x86_64-pc-windows-gnu", "winapi"),
];

/// Beginnings of the names of licence files, in lower case.
const FILE_NAMES: [&str; 5] = ["license", "licence", "copying", "unlicense", "notice"];

/// Why the licences could not be collected.
#[derive(Debug, thiserror::Error)]
pub enum LicenseError {
    /// what `cargo metadata` printed is not what it should be
    #[error("cargo metadata: {0}")]
    Metadata(#[from] serde_json::Error),
    /// the crate to start from is not among them
    #[error("cargo metadata names no package {name}")]
    NoRoot {
        /// name of the package
        name: String,
    },
    /// a crate has no licence file
    #[error("{package} has no licence file in {directory}")]
    NoText {
        /// name and version
        package: String,
        /// where its sources are
        directory: PathBuf,
    },
    /// a file could not be read
    #[error("{path}: {source}")]
    File {
        /// which file
        path: PathBuf,
        /// what the system says
        source: std::io::Error,
    },
}

#[derive(Deserialize)]
struct Metadata {
    packages: Vec<Package>,
    resolve: Resolve,
}

#[derive(Deserialize)]
struct Package {
    id: String,
    name: String,
    version: String,
    license: Option<String>,
    /// `None` for the crates of this workspace
    source: Option<String>,
    manifest_path: PathBuf,
    targets: Vec<Target>,
}

#[derive(Deserialize)]
struct Target {
    kind: Vec<String>,
}

#[derive(Deserialize)]
struct Resolve {
    nodes: Vec<Node>,
}

#[derive(Deserialize)]
struct Node {
    id: String,
    deps: Vec<Dependency>,
}

#[derive(Deserialize)]
struct Dependency {
    pkg: String,
    dep_kinds: Vec<DependencyKind>,
}

#[derive(Deserialize)]
struct DependencyKind {
    /// `None`: of the library itself, not of its tests or build script
    kind: Option<String>,
}

impl Package {
    fn runs_in_the_compiler(&self) -> bool {
        let mut kinds = self.targets.iter().flat_map(|target| &target.kind);
        kinds.any(|kind| kind == "proc-macro")
    }

    fn directory(&self) -> &Path {
        self.manifest_path.parent().unwrap_or(Path::new(""))
    }

    fn title(&self) -> String {
        format!("{} {}", self.name, self.version)
    }
}

/// One text for all that is linked into `root` and not ours, from the JSON of `cargo metadata`.
///
/// First a table of crates with the numbers of their texts, then each different text once, then
/// what the standard library and the linkers bring. Sorted by name, so the same crates give the
/// same bytes.
pub fn third_party(metadata: &str, root: &str) -> Result<String, LicenseError> {
    let metadata: Metadata = serde_json::from_str(metadata)?;
    let packages: BTreeMap<&str, &Package> = metadata
        .packages
        .iter()
        .map(|package| (package.id.as_str(), package))
        .collect();
    let mut linked: Vec<&Package> = linked_ids(&metadata, &packages, root)?
        .into_iter()
        .map(|id| packages[id])
        .filter(|package| package.source.is_some())
        .collect();
    linked.sort_by_key(|package| package.title());

    let mut texts: Vec<String> = Vec::new();
    let mut table = String::new();
    for package in linked {
        let mut numbers = Vec::new();
        for text in texts_of(package, &metadata.packages)? {
            let known = texts.iter().position(|other| *other == text);
            numbers.push(1 + known.unwrap_or(texts.len()));
            if known.is_none() {
                texts.push(text);
            }
        }
        let licence = package.license.as_deref().unwrap_or("see its text");
        let numbers: Vec<_> = numbers.iter().map(ToString::to_string).collect();
        // Writing to a String cannot fail.
        let _ = writeln!(
            table,
            "{}: {licence} (text {})",
            package.title(),
            numbers.join(", ")
        );
    }
    Ok(document(&table, &texts))
}

fn document(table: &str, texts: &[String]) -> String {
    let rule = "=".repeat(78);
    let mut document = format!(
        "Software of others that is part of this FMU's shared libraries. Of coilwind itself see\n\
         license.txt.\n\nCrates\n------\n\n{table}"
    );
    for (number, text) in (1..).zip(texts) {
        let _ = write!(document, "\n{rule}\nText {number}\n{rule}\n\n{text}");
    }
    let _ = write!(
        document,
        "\n{rule}\nStandard library and runtime\n{rule}\n\n{RUNTIME}"
    );
    document
}

/// Ids of what `root` is linked from, itself included.
fn linked_ids<'a>(
    metadata: &'a Metadata,
    packages: &BTreeMap<&str, &'a Package>,
    root: &str,
) -> Result<BTreeSet<&'a str>, LicenseError> {
    let nodes: BTreeMap<&str, &Node> = metadata
        .resolve
        .nodes
        .iter()
        .map(|node| (node.id.as_str(), node))
        .collect();
    let root = packages
        .values()
        .find(|package| package.name == root && package.source.is_none())
        .ok_or_else(|| LicenseError::NoRoot {
            name: root.to_owned(),
        })?;
    let mut linked = BTreeSet::new();
    let mut open = vec![root.id.as_str()];
    while let Some(id) = open.pop() {
        if packages[id].runs_in_the_compiler() || !linked.insert(id) {
            continue;
        }
        let dependencies = nodes.get(id).map_or(&[][..], |node| &node.deps);
        open.extend(
            dependencies
                .iter()
                .filter(|dependency| dependency.dep_kinds.iter().any(|kind| kind.kind.is_none()))
                .map(|dependency| dependency.pkg.as_str()),
        );
    }
    Ok(linked)
}

/// Texts of a crate's licence files, by rising file name, with line ends and margins made equal.
fn texts_of(package: &Package, all: &[Package]) -> Result<Vec<String>, LicenseError> {
    let lender = TEXT_OF.iter().find(|entry| entry.0 == package.name);
    let owner = lender
        .and_then(|entry| all.iter().find(|other| other.name == entry.1))
        .unwrap_or(package);
    let directory = owner.directory();
    let failed = |path: &Path| {
        let path = path.to_owned();
        move |source| LicenseError::File { path, source }
    };
    let mut files = Vec::new();
    for item in fs::read_dir(directory).map_err(failed(directory))? {
        let path = item.map_err(failed(directory))?.path();
        let name = path
            .file_name()
            .map(|name| name.to_string_lossy().to_lowercase());
        if name.is_some_and(|name| FILE_NAMES.iter().any(|start| name.starts_with(start)))
            && path.is_file()
        {
            files.push(path);
        }
    }
    files.sort();
    if files.is_empty() {
        return Err(LicenseError::NoText {
            package: package.title(),
            directory: directory.to_owned(),
        });
    }
    files
        .iter()
        .map(|path| {
            let text = fs::read(path).map_err(failed(path))?;
            let text = String::from_utf8_lossy(&text).replace("\r\n", "\n");
            Ok(format!("{}\n", text.trim_matches('\n')))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A workspace crate `ours` that links `near` and, through it, `far`; `tool` only builds it,
    /// `derive` runs in the compiler, and what that needs is not linked.
    fn sample(directory: &Path) -> String {
        let package = |name: &str, source: &str, kind: &str| {
            let manifest = directory.join(name).join("Cargo.toml");
            serde_json::json!({
                "id": name, "name": name, "version": "1.0.0", "license": "MIT",
                "source": (!source.is_empty()).then_some(source),
                "manifest_path": manifest, "targets": [{"kind": [kind]}],
            })
        };
        let node = |name: &str, deps: &[(&str, Option<&str>)]| {
            let deps: Vec<_> = deps
                .iter()
                .map(|(pkg, kind)| serde_json::json!({"pkg": pkg, "dep_kinds": [{"kind": kind}]}))
                .collect();
            serde_json::json!({"id": name, "deps": deps})
        };
        for (name, text) in [
            ("near", "One text.\r\n"),
            ("far", "One text.\n"),
            ("derive", "Two."),
        ] {
            fs::create_dir_all(directory.join(name)).expect("directory");
            fs::write(directory.join(name).join("LICENSE-MIT"), text).expect("text");
        }
        serde_json::json!({
            "packages": [
                package("ours", "", "cdylib"), package("near", "registry", "lib"),
                package("far", "registry", "lib"), package("derive", "registry", "proc-macro"),
                package("helper", "registry", "lib"), package("tool", "registry", "lib"),
            ],
            "resolve": {"nodes": [
                node("ours", &[("near", None), ("tool", Some("build")), ("derive", None)]),
                node("near", &[("far", None), ("tool", Some("dev"))]),
                node("far", &[]), node("derive", &[("helper", None)]), node("helper", &[]),
                node("tool", &[]),
            ]},
        })
        .to_string()
    }

    #[test]
    fn what_is_linked_is_listed_once_with_its_text() {
        let directory = tempfile::tempdir().expect("directory");
        let text = third_party(&sample(directory.path()), "ours").expect("licences");
        assert!(
            text.contains("\nfar 1.0.0: MIT (text 1)\nnear 1.0.0: MIT (text 1)\n"),
            "{text}"
        );
        assert_eq!(text.matches("One text.").count(), 1);
        assert!(text.contains("Standard library and runtime"));
        for absent in ["tool 1", "derive 1", "helper 1", "Two.", "ours 1"] {
            assert!(!text.contains(absent), "{absent}");
        }
    }

    #[test]
    fn a_crate_without_a_text_is_an_error() {
        let directory = tempfile::tempdir().expect("directory");
        let metadata = sample(directory.path());
        fs::remove_file(directory.path().join("far/LICENSE-MIT")).expect("removed");
        let error = third_party(&metadata, "ours").expect_err("no text");
        assert!(
            error
                .to_string()
                .starts_with("far 1.0.0 has no licence file"),
            "{error}"
        );
        let error = third_party(&metadata, "theirs").expect_err("no root");
        assert!(matches!(error, LicenseError::NoRoot { .. }));
    }
}
