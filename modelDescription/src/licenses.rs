//! Licences of everything that is linked into the shared libraries.

use crate::error::LicenseError;
use serde::Deserialize;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

/// Licences of what is linked in besides crates: the standard library and the linkers' runtimes.
const RUNTIME: &str = include_str!("../licenses/runtime.txt");

/// Crates that come without a licence text, and the crate of the same repository and licence that
/// has it.
const TEXT_OF: [(&str, &str); 2] = [
    ("pulp-wasm-simd-flag", "pulp"),
    ("winapi-x86_64-pc-windows-gnu", "winapi"),
];

/// Beginnings of the names of licence files, in lower case.
const FILE_NAMES: [&str; 5] = ["license", "licence", "copying", "unlicense", "notice"];

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
    /// `None` for the crates of this workspace.
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
    /// `None` if the library itself depends on it, not its tests or its build script.
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

/// Returns one text with the licences of all foreign crates that are linked into package `root`.
///
/// `metadata` is the JSON of `cargo metadata`. The text holds a table of crates with the numbers of
/// their licence texts, then each different text once, then those of the standard library and the
/// linkers' runtimes. Crates are sorted by name, so that the same crates give the same bytes.
///
/// # Errors
///
/// If the JSON is not that of `cargo metadata`, names no package `root`, or lists a crate whose
/// licence file is missing or cannot be read.
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

/// Returns the ids of the packages that `root` is linked from, itself included.
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

/// Returns the texts of a crate's licence files, by rising file name. Line ends are `\n`, and there
/// are no empty lines at either end.
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

    /// Returns metadata of a workspace crate `ours` that links `near` and, through it, `far`.
    /// `tool` is only needed to build it. `derive` runs in the compiler, so that neither it nor its
    /// dependency is linked.
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
