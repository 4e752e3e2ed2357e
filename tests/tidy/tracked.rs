//! What git holds: modes of scripts, and no output of a build.

use super::{caught, none, root};
use std::process::Command;

/// One tracked file: its mode as git knows it, its path, whether it begins with `#!`.
struct Tracked {
    mode: String,
    path: String,
    starts_a_program: bool,
}

/// Every tracked file; none in a copy without its history, where there is nothing to judge.
fn tracked() -> Vec<Tracked> {
    if !root().join(".git").exists() {
        return Vec::new();
    }
    let listed = Command::new("git")
        .args(["ls-files", "--stage", "-z"])
        .current_dir(root())
        .output()
        .expect("git runs");
    assert!(listed.status.success(), "git ls-files fails");
    let listed = String::from_utf8(listed.stdout).expect("paths in UTF-8");
    let entries = listed.split_terminator('\0').map(|entry| {
        let (mode, rest) = entry.split_once(' ').expect("a mode");
        let (_, path) = rest.split_once('\t').expect("a path");
        let starts = std::fs::read(root().join(path)).is_ok_and(|text| text.starts_with(b"#!"));
        Tracked {
            mode: mode.to_owned(),
            path: path.to_owned(),
            starts_a_program: starts,
        }
    });
    entries.collect()
}

fn not_executable(files: &[Tracked]) -> Vec<String> {
    let programs = files.iter().filter(|file| file.starts_a_program);
    programs
        .filter(|file| file.mode != "100755")
        .map(|file| format!("{}: begins with #! and is not executable", file.path))
        .collect()
}

fn build_output(files: &[Tracked]) -> Vec<String> {
    let inside = |path: &str| {
        path.split('/')
            .any(|part| ["target", "node_modules", "__pycache__"].contains(&part))
    };
    let built = files.iter().filter(|file| inside(&file.path));
    built
        .map(|file| format!("{}: made by a build", file.path))
        .collect()
}

#[test]
fn what_begins_as_a_program_is_executable() {
    none(&not_executable(&tracked()));
}

#[test]
fn no_build_output_is_tracked() {
    none(&build_output(&tracked()));
}

#[test]
fn a_wrong_mode_or_a_built_file_is_caught() {
    let file = |mode: &str, path: &str| Tracked {
        mode: mode.to_owned(),
        path: path.to_owned(),
        starts_a_program: true,
    };
    caught(&not_executable(&[file("100644", "scripts/a.py")]), "a.py");
    none(&not_executable(&[file("100755", "scripts/a.py")]));
    caught(&build_output(&[file("100644", "fuzz/target/x")]), "fuzz/");
    none(&build_output(&[file("100755", "scripts/targets.py")]));
}
