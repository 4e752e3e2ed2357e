//! What the packages may depend on.

use super::{NOT_IN_THE_FMU, caught, none, text};

/// What the FMU and its description would link of the laboratory or the command.
fn leaks(library: &str, users: &[(&str, String)]) -> Vec<String> {
    let mut wrong = Vec::new();
    let library: toml::Table = library.parse().expect("TOML");
    for name in NOT_IN_THE_FMU {
        let found = library["dependencies"].get(name);
        if found.is_some_and(|d| d.get("optional").and_then(toml::Value::as_bool) != Some(true)) {
            wrong.push(format!("Cargo.toml: {name} is not optional"));
        }
    }
    let parser = |list: &toml::Value| {
        let words = list.as_array().into_iter().flatten();
        words
            .filter_map(toml::Value::as_str)
            .any(|word| word == "dep:clap" || word == "cli")
    };
    if library["features"].get("lab").is_some_and(parser) {
        wrong.push("Cargo.toml: lab brings in an argument parser".to_owned());
    }
    for (file, text) in users {
        let table: toml::Table = text.parse().expect("TOML");
        let on_library = &table["dependencies"]["coilwind"];
        let none = on_library
            .get("default-features")
            .and_then(toml::Value::as_bool)
            == Some(false);
        if !none || on_library.get("features").is_some() {
            wrong.push(format!("{file}: takes features of the library"));
        }
        for name in NOT_IN_THE_FMU {
            if table["dependencies"].get(name).is_some() {
                wrong.push(format!("{file}: depends on {name}"));
            }
        }
    }
    wrong
}

#[test]
fn the_fmu_links_neither_laboratory_nor_command() {
    let users = ["fmu/Cargo.toml", "modelDescription/Cargo.toml"].map(|file| (file, text(file)));
    none(&leaks(&text("Cargo.toml"), &users));
}

#[test]
fn a_dependency_that_reaches_the_fmu_is_caught() {
    let library =
        "[dependencies]\nclap = { version = \"4\", optional = true }\n[features]\nlab = []\n";
    let user = |on: &str| {
        [(
            "fmu/Cargo.toml",
            format!("[dependencies]\ncoilwind = {{ {on} }}"),
        )]
    };
    let plain = "path = \"..\", default-features = false";
    none(&leaks(library, &user(plain)));
    caught(
        &leaks(&library.replace("true", "false"), &[]),
        "clap is not optional",
    );
    caught(
        &leaks(&library.replace("[]", "[\"dep:clap\"]"), &[]),
        "argument parser",
    );
    caught(&leaks(library, &user("path = \"..\"")), "takes features");
    caught(
        &leaks(library, &user(&format!("{plain}, features = [\"lab\"]"))),
        "takes features",
    );
    let more = user(plain).map(|(file, text)| (file, text + "\nclap = \"4\""));
    caught(&leaks(library, &more), "depends on clap");
}
