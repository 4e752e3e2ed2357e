//! `documentation/index.html`: what the FMU models, how to use it, and a table of every variable.

use crate::description::guid;
use crate::error::DescriptionError;
use crate::variables::variables;
use coilwind::settings::SceneSettings;
use coilwind::variables::{Causality, Unit, Variability, Variable, units};
use std::fmt::Write;

/// The part of the page that does not depend on the table: the model, and how to use it.
const INTRODUCTION: &str = include_str!("../documentation/introduction.html");

/// Pictures that the page shows, with their file names beside it.
pub(crate) const PICTURES: [(&str, &[u8]); 1] =
    [("coil.png", include_bytes!("../../docs/coil.png"))];

const STYLE: &str = "body{font-family:sans-serif;max-width:62em;margin:2em auto;padding:0 1em;\
line-height:1.4}img,svg{max-width:100%;height:auto}table{border-collapse:collapse;width:100%}\
td,th{border:1px solid #bbb;padding:.2em .5em;text-align:left;vertical-align:top}\
th{background:#eee}td.number{white-space:nowrap}figure{margin:1em 0}figcaption{color:#555}";

/// Returns the whole page. It is well-formed XML, so that any browser and any test can read it.
///
/// # Errors
///
/// If there is no GUID to print.
pub fn document() -> Result<String, DescriptionError> {
    let settings = SceneSettings::default();
    let mut page = format!(
        "<!DOCTYPE html>\n<html xmlns=\"http://www.w3.org/1999/xhtml\" lang=\"en\">\n<head>\n\
         <meta charset=\"utf-8\"/>\n<title>CoilWinding</title>\n<style>{STYLE}</style>\n</head>\n\
         <body>\n<h1>CoilWinding</h1>\n{INTRODUCTION}\n<h2>Variables</h2>\n\
         <p>All values are in the first unit of a row, the SI unit. The unit in brackets is the \
         display unit. The number in brackets after a name is the value reference.</p>\n"
    );
    for (title, causality) in [
        ("Inputs", Causality::Input),
        ("Outputs", Causality::Output),
        ("Diagnostics", Causality::Local),
    ] {
        let rows = variables().filter(|variable| variable.causality == causality);
        section(&mut page, title, rows, &settings);
    }
    for group in groups() {
        let rows = variables().filter(|variable| {
            variable.causality == Causality::Parameter && group_of(variable) == group
        });
        section(&mut page, &format!("Parameters: {group}"), rows, &settings);
    }
    let _ = write!(
        page,
        "<h2>This FMU</h2>\n<p>coilwind {}, FMI 2.0 for co-simulation, GUID {}. Licences: \
         <a href=\"licenses/license.txt\">coilwind</a>, <a href=\"licenses/third-party.txt\">linked \
         software</a>.</p>\n</body>\n</html>\n",
        env!("CARGO_PKG_VERSION"),
        escaped(guid()?)
    );
    Ok(page)
}

/// Returns the groups of parameters, which are the sections of the scene file, in the order of the
/// table.
fn groups() -> Vec<&'static str> {
    let mut groups = Vec::new();
    for variable in variables().filter(|variable| variable.causality == Causality::Parameter) {
        let group = group_of(variable);
        if !groups.contains(&group) {
            groups.push(group);
        }
    }
    groups
}

fn group_of(variable: &Variable) -> &'static str {
    variable
        .name
        .split_once('.')
        .map_or("general", |(group, _)| group)
}

fn section(
    page: &mut String,
    title: &str,
    rows: impl Iterator<Item = &'static Variable>,
    settings: &SceneSettings,
) {
    // Writing to a String cannot fail.
    let _ = writeln!(
        page,
        "<h3>{title}</h3>\n<table>\n<tr><th>Name</th><th>Unit</th><th>Start</th><th>Allowed</th>\
         <th>Meaning</th></tr>"
    );
    for variable in rows {
        let start = variable
            .start_in_fmu(settings)
            .map_or(String::new(), |value| value.to_string());
        let tunable = match (variable.causality, variable.variability) {
            (Causality::Parameter, Variability::Tunable) => ". Tunable",
            _ => "",
        };
        let _ = writeln!(
            page,
            "<tr id=\"{name}\"><td><code>{name}</code> ({reference})</td><td>{unit}</td>\
             <td class=\"number\">{start}</td><td>{allowed}</td><td>{meaning}{tunable}</td></tr>",
            name = escaped(variable.name),
            reference = variable.reference,
            unit = escaped(&unit_of(variable)),
            start = escaped(&start),
            allowed = escaped(&allowed(variable)),
            meaning = escaped(variable.description),
        );
    }
    page.push_str("</table>\n");
}

/// Returns what may be set, or the type of what the FMU computes.
fn allowed(variable: &Variable) -> String {
    match variable.causality {
        Causality::Input | Causality::Parameter => variable.allowed(),
        Causality::Output | Causality::Local => variable.kind.as_str().to_owned(),
    }
}

/// Returns the unit with the display unit, `m (mm)`, or the type of what is not a Real.
fn unit_of(variable: &Variable) -> String {
    if variable.unit.is_empty() {
        return variable.kind.as_str().to_owned();
    }
    let shown = units()
        .iter()
        .find(|unit| unit.name == variable.unit)
        .and_then(|unit: &Unit| {
            unit.display
                .iter()
                .find(|shown| shown.0 == variable.display_unit)
        });
    match shown {
        Some((name, ..)) => format!("{} ({name})", variable.unit),
        None => variable.unit.to_owned(),
    }
}

fn escaped(text: &str) -> String {
    quick_xml::escape::escape(text).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use quick_xml::Reader;
    use quick_xml::events::Event;

    #[test]
    fn every_variable_stands_there_with_unit_and_meaning() {
        let page = document().expect("default scene is valid");
        for variable in variables() {
            let row = page
                .lines()
                .find(|line| line.starts_with(&format!("<tr id=\"{}\">", variable.name)))
                .unwrap_or_else(|| panic!("{} is missing", variable.name));
            assert!(row.contains(&escaped(variable.description)), "{row}");
            assert!(row.contains(&format!("({})", variable.reference)), "{row}");
            assert!(
                row.contains(&format!("<td>{}", escaped(&unit_of(variable)))),
                "{row}"
            );
        }
        assert!(page.contains("<td>m (mm)</td>"));
        let rows = page.matches("<tr id=").count();
        assert_eq!(rows, variables().count());
        for native in coilwind::variables::table()
            .iter()
            .filter(|v| v.native_only)
        {
            assert!(
                !page.contains(&format!("\"{}\"", native.name)),
                "{}",
                native.name
            );
        }
    }

    #[test]
    fn the_page_is_well_formed_and_shows_what_is_packed() {
        let page = document().expect("default scene is valid");
        let mut reader = Reader::from_str(&page);
        reader.config_mut().check_end_names = true;
        let mut shown = Vec::new();
        loop {
            match reader.read_event().expect("well-formed") {
                Event::Eof => break,
                Event::Empty(element) if element.name().as_ref() == "img" => {
                    let source = element
                        .try_get_attribute("src")
                        .expect("attributes")
                        .expect("a source");
                    shown.push(source.value.into_owned());
                }
                _ => {}
            }
        }
        assert_eq!(shown, PICTURES.map(|picture| picture.0));
        assert!(page.ends_with("</html>\n"));
    }
}
