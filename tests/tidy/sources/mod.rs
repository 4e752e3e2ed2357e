//! The sources as a graph: which file names what of which other file.
//!
//! Reads tokens, not types: paths in `use` and inline paths that begin with `crate`, `self`, `super` or the
//! name of a module beside them. A name that a module only hands on is followed to the file that defines it.
//! Calls of methods are not seen.

mod names;
mod tokens;

use names::Names;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
pub use tokens::{Token, tokens};

/// One file, its path relative to the workspace and with `/` on every system.
#[derive(Clone, Debug)]
pub struct Source {
    /// such as `src/rod/state.rs`
    pub path: String,
    /// what it holds
    pub text: String,
}

impl Source {
    /// A file that need not exist.
    pub fn new(path: &str, text: &str) -> Self {
        Self {
            path: path.to_owned(),
            text: text.to_owned(),
        }
    }
}

/// One file names something of another.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Arrow {
    /// path of the file that names
    pub from: String,
    /// path of the file that defines
    pub to: String,
    /// in `from`, from 1
    pub line: usize,
    /// the path as resolved, such as `crate::rod::Section`
    pub name: String,
    /// in code that only tests see
    pub test: bool,
}

impl std::fmt::Display for Arrow {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(
            f,
            "{}:{} -> {} ({})",
            self.from, self.line, self.to, self.name
        )
    }
}

/// Every `*.rs` file below these folders of the workspace, in order of its path.
pub fn read(root: &Path, folders: &[&str]) -> Vec<Source> {
    let mut sources = Vec::new();
    for folder in folders {
        collect(root, &root.join(folder), &mut sources);
    }
    sources.sort_by(|a, b| a.path.cmp(&b.path));
    sources
}

fn collect(root: &Path, folder: &Path, into: &mut Vec<Source>) {
    let entries = std::fs::read_dir(folder).unwrap_or_else(|e| panic!("{}: {e}", folder.display()));
    for entry in entries {
        let path = entry.expect("readable").path();
        if path.is_dir() {
            if !path.ends_with("target") {
                collect(root, &path, into);
            }
        } else if path.extension().is_some_and(|e| e == "rs") {
            let relative = path.strip_prefix(root).expect("below the root");
            let parts: Vec<_> = relative.iter().map(|p| p.to_string_lossy()).collect();
            into.push(Source {
                path: parts.join("/"),
                text: std::fs::read_to_string(&path).expect("UTF-8"),
            });
        }
    }
}

/// Room of a file of `src`: the first folder, or the file itself; `None` for `lib.rs` and `main.rs`.
pub fn room(path: &str) -> Option<&str> {
    let inside = path.strip_prefix("src/")?;
    let first = inside.split('/').next()?.trim_end_matches(".rs");
    (!["lib", "main"].contains(&first)).then_some(first)
}

/// Folder of a file.
pub fn folder(path: &str) -> &str {
    path.rsplit_once('/').map_or("", |(folder, _)| folder)
}

/// All arrows between different files of `src`, in order; one for each pair of files, name and kind of code.
pub fn arrows(sources: &[Source]) -> Vec<Arrow> {
    let names = Names::of(sources);
    let mut found: BTreeMap<(String, String, String, bool), usize> = BTreeMap::new();
    for source in sources {
        for mention in names.mentions(&source.path) {
            let Some(to) = names.definition(&mention.path) else {
                continue;
            };
            if to == source.path {
                continue;
            }
            let name = format!("crate::{}", mention.path.join("::"));
            let key = (source.path.clone(), to.to_owned(), name, mention.test);
            let line = found.entry(key).or_insert(mention.line);
            *line = mention.line.min(*line);
        }
    }
    found
        .into_iter()
        .map(|((from, to, name, test), line)| Arrow {
            from,
            to,
            line,
            name,
            test,
        })
        .collect()
}

/// Each file of the library with its words that not only tests see.
pub fn production(sources: &[Source]) -> Vec<(String, Vec<Token>)> {
    let names = Names::of(sources);
    names
        .production()
        .map(|(file, words)| (file.to_owned(), words.into_iter().cloned().collect()))
        .collect()
}

/// Groups of more than one node that all reach each other, in order.
pub fn circles<'a>(edges: impl IntoIterator<Item = (&'a str, &'a str)>) -> Vec<Vec<&'a str>> {
    let mut next: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
    for (from, to) in edges {
        next.entry(from).or_default().insert(to);
        next.entry(to).or_default();
    }
    let reach = |start: &'a str| {
        let mut seen = BTreeSet::new();
        let mut open = vec![start];
        while let Some(node) = open.pop() {
            for &to in &next[node] {
                if seen.insert(to) {
                    open.push(to);
                }
            }
        }
        seen
    };
    let reached: BTreeMap<&str, BTreeSet<&str>> = next.keys().map(|&n| (n, reach(n))).collect();
    let mut groups: BTreeSet<Vec<&str>> = BTreeSet::new();
    for (node, to) in &reached {
        let group: Vec<&str> = to
            .iter()
            .copied()
            .filter(|other| reached[other].contains(node))
            .collect();
        if group.len() > 1 {
            groups.insert(group);
        }
    }
    groups.into_iter().collect()
}
