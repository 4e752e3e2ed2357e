//! What a source may hold: unsafe code, length, documentation, words.

use super::sources::{Source, tokens};
use super::{LONGEST_FILE, PET_WORDS, UNSAFE, all_sources, caught, none, text};

fn unsafe_code(sources: &[Source]) -> Vec<String> {
    let allowed =
        |path: &str| path.starts_with("fmu/") || UNSAFE.iter().any(|(file, _)| *file == path);
    let mut wrong = Vec::new();
    for source in sources.iter().filter(|source| !allowed(&source.path)) {
        for token in tokens(&source.text).iter().filter(|t| t.text == "unsafe") {
            wrong.push(format!("{}:{}: unsafe", source.path, token.line));
        }
    }
    wrong
}

#[test]
fn unsafe_code_stands_at_the_c_boundary_only() {
    let sources = all_sources();
    none(&unsafe_code(&sources));
    for (path, reason) in UNSAFE {
        let source = sources.iter().find(|source| source.path == path);
        let holds = source.is_some_and(|s| tokens(&s.text).iter().any(|t| t.text == "unsafe"));
        assert!(holds, "{path} ({reason}) holds no unsafe code");
    }
}

#[test]
fn unsafe_code_elsewhere_is_caught() {
    let source = |path| Source::new(path, "/// unsafe\nfn f() {\n  unsafe { g() }\n}");
    caught(
        &unsafe_code(&[source("src/rod/mod.rs")]),
        "src/rod/mod.rs:3",
    );
    none(&unsafe_code(&[
        source("fmu/src/ffi.rs"),
        source("tests/allocations.rs"),
    ]));
}

fn long_files(sources: &[Source]) -> Vec<String> {
    let count = |source: &Source| source.text.lines().count();
    let long = sources.iter().filter(|source| count(source) > LONGEST_FILE);
    long.map(|source| format!("{}: {} lines", source.path, count(source)))
        .collect()
}

#[test]
fn no_file_is_long() {
    none(&long_files(&all_sources()));
}

#[test]
fn a_long_file_is_caught() {
    none(&long_files(&[Source::new(
        "a.rs",
        &"//\n".repeat(LONGEST_FILE),
    )]));
    caught(
        &long_files(&[Source::new("a.rs", &"//\n".repeat(LONGEST_FILE + 1))]),
        "a.rs: 601",
    );
}

/// Sources of the libraries, of which every public item is documented.
fn is_library(path: &str) -> bool {
    ["src/", "fmu/src/", "modelDescription/src/"]
        .iter()
        .any(|folder| path.starts_with(folder))
}

fn undocumented(workspace: &str, sources: &[Source]) -> Vec<String> {
    let mut wrong = Vec::new();
    let table: toml::Table = workspace.parse().expect("TOML");
    if table["workspace"]["lints"]["rust"]["missing_docs"].as_str() != Some("deny") {
        wrong.push("Cargo.toml: missing_docs is not denied".to_owned());
    }
    for source in sources.iter().filter(|source| is_library(&source.path)) {
        let words = tokens(&source.text);
        for pair in words.windows(3) {
            if pair[0].text == "allow" && pair[2].text == "missing_docs" {
                wrong.push(format!(
                    "{}:{}: allows missing_docs",
                    source.path, pair[0].line
                ));
            }
        }
    }
    wrong
}

#[test]
fn every_public_item_is_documented() {
    none(&undocumented(&text("Cargo.toml"), &all_sources()));
}

#[test]
fn an_allowed_gap_in_the_documentation_is_caught() {
    let lints = |level: &str| format!("[workspace.lints.rust]\nmissing_docs = \"{level}\"");
    let source = [Source::new(
        "src/signals.rs",
        "\n#[allow(missing_docs)]\npub struct S;",
    )];
    caught(&undocumented(&lints("deny"), &source), "src/signals.rs:2");
    caught(&undocumented(&lints("warn"), &[]), "not denied");
}

fn pet_words(sources: &[Source]) -> Vec<String> {
    let mut wrong = Vec::new();
    for source in sources.iter().filter(|source| is_library(&source.path)) {
        for (line, said) in source.text.lines().enumerate() {
            let said = said.trim_start();
            if !(said.starts_with("///") || said.starts_with("//!")) {
                continue;
            }
            let plain: String = said
                .chars()
                .map(|c| if c.is_alphanumeric() { c } else { ' ' })
                .collect();
            let plain = format!(
                " {} ",
                plain
                    .to_lowercase()
                    .split_whitespace()
                    .collect::<Vec<_>>()
                    .join(" ")
            );
            for word in PET_WORDS
                .iter()
                .filter(|word| plain.contains(&format!(" {word} ")))
            {
                wrong.push(format!("{}:{}: '{word}'", source.path, line + 1));
            }
        }
    }
    wrong
}

#[test]
fn doc_comments_have_no_pet_names() {
    none(&pet_words(&all_sources()));
}

#[test]
fn a_pet_name_is_caught() {
    let source = |text| [Source::new("src/rod/mod.rs", text)];
    caught(
        &pet_words(&source("\n/// Energy, as the Books have it.")),
        "src/rod/mod.rs:2: 'books'",
    );
    caught(
        &pet_words(&source("//! Its daily\n//! daily bread")),
        "rs:2: 'daily bread'",
    );
    none(&pet_words(&source(
        "/// A bookshelf.\nlet knee = 1; // the house",
    )));
}
