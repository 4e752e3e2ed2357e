//! Rules of the repository, held by reading its files. Each rule also sees a planted violation.

#[path = "tidy/arrows.rs"]
mod arrows;
#[path = "tidy/manifests.rs"]
mod manifests;
#[path = "tidy/numbers.rs"]
mod numbers;
#[path = "tidy/sources/mod.rs"]
mod sources;
#[path = "tidy/texts.rs"]
mod texts;
#[path = "tidy/tracked.rs"]
mod tracked;

use sources::{Source, read};
use std::path::Path;

/// A folder (or file) of `src/`, what it holds, and rooms below it that it still may not know.
struct Room {
    name: &'static str,
    holds: &'static str,
    never: &'static [&'static str],
}

const fn floor(name: &'static str, holds: &'static str) -> Room {
    Room {
        name,
        holds,
        never: &[],
    }
}

const fn apart(name: &'static str, holds: &'static str) -> Room {
    Room {
        name,
        holds,
        never: &["contact", "feed", "system", "integrate"],
    }
}

/// From the ground up: a room may know those before it in this list, but for those in `never`.
const FLOORS: [Room; 17] = [
    floor("math", "vectors, frames, angles, lanes"),
    floor("linalg", "banded linear equations"),
    floor(
        "geometry",
        "cores, meshes, search trees, splines of frozen wire",
    ),
    floor("rod", "section, plasticity, bending, twisting"),
    floor("contact", "touches with core, frozen wire and live wire"),
    floor("feed", "tensioner, line and nozzle"),
    floor(
        "system",
        "model, state and scratch of rod, supports and feed",
    ),
    floor("integrate", "implicit and explicit steps of a system"),
    apart("signals", "inputs, outputs, events"),
    apart("measure", "turns, stations, gaps, bulges, verdicts"),
    apart("settings", "leaves of a scene as given, with who gave them"),
    apart(
        "variables",
        "the one table of inputs, outputs and parameters",
    ),
    apart("scene", "TOML to settings to a checked, immutable scene"),
    floor(
        "simulation",
        "the one door: steps, outputs, rest, saved states",
    ),
    floor("output", "tables, VTK, pictures, summaries on disk"),
    floor("lab", "exact answers, benchmarks, random scenes"),
    floor("cli", "arguments, progress, exit codes of the command"),
];

/// Folders with Rust sources.
const FOLDERS: [&str; 9] = [
    "src",
    "fmu/src",
    "fmu/benches",
    "fmu/tests",
    "modelDescription",
    "tests",
    "benches",
    "examples",
    "fuzz",
];

/// Where `unsafe` may stand outside of the C boundary, and why.
const UNSAFE: [(&str, &str); 2] = [
    (
        "tests/allocations.rs",
        "an allocator that counts is unsafe to implement",
    ),
    (
        "fuzz/state_entry.rs",
        "calls the C functions as an importer does",
    ),
];

/// Lines of a file: a longer one holds several ideas.
const LONGEST_FILE: usize = 600;

/// Packages that only the laboratory or the command may bring in.
const NOT_IN_THE_FMU: [&str; 7] = [
    "clap",
    "cpu-time",
    "ctrlc",
    "indicatif",
    "plotters",
    "rand_chacha",
    "rayon",
];

/// Words of doc comments that a stranger cannot know.
const PET_WORDS: [&str; 14] = [
    "anew",
    "books",
    "daily bread",
    "foresee",
    "foresees",
    "foresight",
    "gets it first",
    "house",
    "knee",
    "laid to rest",
    "lay to rest",
    "programme",
    "stands for nothing",
    "whoever",
];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn text(path: &str) -> String {
    std::fs::read_to_string(root().join(path)).unwrap_or_else(|e| panic!("{path}: {e}"))
}

fn all_sources() -> Vec<Source> {
    read(root(), &FOLDERS)
}

/// Fails with one line for each violation.
fn none(violations: &[String]) {
    assert!(
        violations.is_empty(),
        "{} violations:\n{}",
        violations.len(),
        violations.join("\n")
    );
}

/// Whether one of the violations says this.
#[track_caller]
fn caught(violations: &[String], part: &str) {
    assert!(
        violations.iter().any(|line| line.contains(part)),
        "no {part:?} in {violations:?}"
    );
}
