//! What may know what: floors, circles of folders, circles of files, and the page that shows the floors.

use super::sources::{Arrow, Source, arrows, circles, folder, room};
use super::{FLOORS, all_sources, caught, none, text};
use std::collections::BTreeSet;

fn arrows_that_run_up(sources: &[Source]) -> Vec<String> {
    let level = |name: &str| FLOORS.iter().position(|floor| floor.name == name);
    let mut wrong = Vec::new();
    for arrow in arrows(sources) {
        let (Some(from), Some(to)) = (room(&arrow.from), room(&arrow.to)) else {
            continue;
        };
        let (Some(low), Some(high)) = (level(from), level(to)) else {
            wrong.push(format!("{arrow}: a room that is not in the list of floors"));
            continue;
        };
        if high > low {
            wrong.push(format!("{arrow}: {to} lies above {from}"));
        } else if FLOORS[low].never.contains(&to) {
            wrong.push(format!("{arrow}: {from} may not know {to}"));
        }
    }
    wrong
}

#[test]
fn no_arrow_runs_up() {
    none(&arrows_that_run_up(&all_sources()));
}

#[test]
fn an_arrow_that_runs_up_is_caught() {
    let planted = |path: &str, text: &str| {
        let ground = [
            Source::new("src/math/mod.rs", "pub struct V3;"),
            Source::new("src/rod/mod.rs", "mod joint;\npub use joint::Joint;"),
            Source::new("src/rod/joint.rs", "pub struct Joint;"),
            Source::new("src/integrate/mod.rs", "pub fn step() {}"),
            Source::new("src/lib.rs", "pub mod math; pub use rod::Joint as Hinge;"),
        ];
        arrows_that_run_up(&[&ground[..], &[Source::new(path, text)]].concat())
    };
    let up = "math lies above";
    none(&planted(
        "src/system/mod.rs",
        "use crate::{math::V3, rod::{Joint as J, *}};",
    ));
    none(&planted(
        "src/math/x.rs",
        "// use crate::rod::Joint;\nconst T: &str = \"crate::rod\";",
    ));
    none(&planted(
        "src/math/x.rs",
        "fn f<'a>(r: &'a str) -> char { 'r' }",
    ));
    caught(
        &planted("src/math/x.rs", "use crate::rod::Joint;"),
        "x.rs:1 -> src/rod/joint.rs",
    );
    caught(
        &planted("src/math/x.rs", "fn f() {\n crate::rod::f() }"),
        "x.rs:2 -> src/rod/mod.rs",
    );
    caught(
        &planted("src/math/x.rs", "use super::super::{rod::{Joint}};"),
        "rod lies above math",
    );
    caught(
        &planted(
            "src/math/x.rs",
            "mod tests { use super::super::super::rod; }",
        ),
        "rod lies above",
    );
    caught(
        &planted("src/math/x.rs", "use crate::Hinge;"),
        "src/rod/joint.rs",
    );
    caught(
        &planted("src/measure/x.rs", "use crate::integrate::step;"),
        "measure may not know integrate",
    );
    caught(
        &planted("src/attic/x.rs", "use crate::math::V3;"),
        "not in the list of floors",
    );
    assert!(
        !planted("src/rod/x.rs", "use crate::math::V3;")
            .iter()
            .any(|w| w.contains(up))
    );
}

/// Circles between folders, by code that is not of tests.
fn folder_circles(sources: &[Source]) -> Vec<String> {
    let arrows = of_production(sources);
    let pairs = arrows.iter().map(|a| (folder(&a.from), folder(&a.to)));
    circles(pairs.filter(|(from, to)| from != to))
        .iter()
        .map(|group| describe(group, &arrows, |path| folder(path)))
        .collect()
}

fn of_production(sources: &[Source]) -> Vec<Arrow> {
    let is_room = |path: &str| room(path).is_some();
    let mut found = arrows(sources);
    found.retain(|a| !a.test && is_room(&a.from) && is_room(&a.to));
    found
}

/// A circle with the arrows that make it.
fn describe<'a>(group: &[&str], arrows: &'a [Arrow], node: impl Fn(&'a str) -> &'a str) -> String {
    let mut text = format!("circle of {}:", group.join(", "));
    for arrow in arrows {
        let (from, to) = (node(&arrow.from), node(&arrow.to));
        if from != to && group.contains(&from) && group.contains(&to) {
            text += &format!("\n    {arrow}");
        }
    }
    text
}

#[test]
fn no_circle_between_folders() {
    none(&folder_circles(&all_sources()));
}

#[test]
fn a_circle_between_folders_is_caught() {
    let sources = [
        Source::new("src/rod/mod.rs", "pub mod batch;"),
        Source::new(
            "src/rod/joint.rs",
            "use super::batch::lanes::Lane; pub struct Joint;",
        ),
        Source::new("src/rod/batch/mod.rs", "pub mod lanes;"),
        Source::new(
            "src/rod/batch/lanes.rs",
            "use crate::rod::joint::Joint; pub struct Lane;",
        ),
    ];
    caught(
        &folder_circles(&sources),
        "circle of src/rod, src/rod/batch:",
    );
    none(&folder_circles(&sources[..3]));
    let seen_above = Source::new("src/rod/batch/lanes.rs", "pub(in crate::rod) struct Lane;");
    none(&folder_circles(&[&sources[..3], &[seen_above]].concat()));
}

/// Circles between files, by code that is not of tests, and excuses that excuse nothing.
///
/// `// circle with FILE: REASON` takes the arrow from the file that holds the line to `FILE` (its path, or its
/// path from the folder of the file that holds the line) out of the graph.
fn file_circles(sources: &[Source]) -> Vec<String> {
    let mut arrows = of_production(sources);
    let mut wrong = Vec::new();
    for source in sources {
        for line in source.text.lines() {
            let Some(said) = line.trim().strip_prefix("// circle with ") else {
                continue;
            };
            let (file, reason) = said.split_once(':').unwrap_or((said, ""));
            let near = format!("{}/{file}", folder(&source.path));
            let is_meant = |a: &Arrow| a.from == source.path && (a.to == file || a.to == near);
            if reason.trim().is_empty() || !arrows.iter().any(is_meant) {
                wrong.push(format!(
                    "{}: excuses nothing, or gives no reason: {line}",
                    source.path
                ));
            }
            arrows.retain(|a| !is_meant(a));
        }
    }
    let pairs = arrows.iter().map(|a| (a.from.as_str(), a.to.as_str()));
    wrong.extend(
        circles(pairs)
            .iter()
            .map(|group| describe(group, &arrows, |path| path)),
    );
    wrong
}

#[test]
fn no_circle_between_files() {
    let sources = all_sources();
    none(&file_circles(&sources));
}

#[test]
fn a_circle_between_files_is_caught() {
    let with = |a: &str| {
        file_circles(&[
            Source::new(
                "src/rod/mod.rs",
                "mod a; mod b; pub use a::A; pub use b::B;",
            ),
            Source::new("src/rod/a.rs", a),
            Source::new("src/rod/b.rs", "pub struct B { a: super::A }"),
        ])
    };
    none(&with(
        "pub struct A; #[cfg(test)] mod tests { use super::*; use crate::rod::B; }",
    ));
    none(&with(
        "#[cfg(doc)] use super::B;\n#[cfg(test)] use super::B; pub struct A;",
    ));
    caught(
        &with("use crate::rod::B; pub struct A;"),
        "circle of src/rod/a.rs, src/rod/b.rs",
    );
    none(&with(
        "// circle with b.rs: two halves of one law\nuse super::B; pub struct A;",
    ));
    caught(
        &with("// circle with b.rs:\nuse super::B; pub struct A;"),
        "no reason",
    );
    caught(
        &with("// circle with b.rs: none is left\npub struct A;"),
        "excuses nothing",
    );
    let parent = [
        Source::new(
            "src/feed/mod.rs",
            "mod line; pub use line::Line; pub struct Feed(Line);",
        ),
        Source::new("src/feed/line.rs", "use super::Feed; pub struct Line;"),
    ];
    caught(
        &file_circles(&parent),
        "circle of src/feed/line.rs, src/feed/mod.rs",
    );
}

/// The list of floors as a page shows it, top first.
fn floors_block() -> String {
    let rows = FLOORS
        .iter()
        .rev()
        .map(|room| format!("{:<10}  {}\n", room.name, room.holds));
    format!("floors, top to bottom\n{}", rows.collect::<String>())
}

fn floors_of_page(page: &str) -> Vec<String> {
    let start = "```text\nfloors, top to bottom\n";
    let names = |block: &str| -> Vec<String> {
        let first = |line: &str| line.split_whitespace().next().map(str::to_owned);
        block.lines().skip(1).filter_map(first).collect()
    };
    let block = page
        .split_once(start)
        .and_then(|(_, rest)| rest.split_once("```"));
    match block {
        None => vec![format!(
            "no list of floors; expected:\n```text\n{}```",
            floors_block()
        )],
        Some((block, _)) if names(&format!("\n{block}")) != names(&floors_block()) => {
            vec![format!(
                "the list of floors differs from:\n{}",
                floors_block()
            )]
        }
        Some(_) => Vec::new(),
    }
}

#[test]
fn architecture_shows_these_floors() {
    none(&floors_of_page(
        &text("ARCHITECTURE.md").replace("\r\n", "\n"),
    ));
    let rooms: BTreeSet<&str> = FLOORS.iter().map(|floor| floor.name).collect();
    let sources = all_sources();
    let found: BTreeSet<&str> = sources
        .iter()
        .filter_map(|source| room(&source.path))
        .collect();
    assert_eq!(rooms, found);
}

#[test]
fn a_page_with_other_floors_is_caught() {
    let page = format!("# Map\n\n```text\n{}```\n", floors_block());
    none(&floors_of_page(&page));
    caught(&floors_of_page(&page.replace("math ", "maths ")), "differs");
    caught(
        &floors_of_page(&page.replace("floors, top", "rooms, top")),
        "no list of floors",
    );
}
