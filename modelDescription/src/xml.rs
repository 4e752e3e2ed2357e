//! `modelDescription.xml` (FMI 2.0.5, section 2.2) from the variable table.

use crate::{CATEGORIES, DescriptionError, MODEL_IDENTIFIER, guid, structure, units, variables};
use coilwind::settings::SceneSettings;
use coilwind::variables::{Causality, Kind, Value, Variable};
use quick_xml::Writer;
use quick_xml::events::{BytesDecl, Event};
use std::io;

/// What the FMU can do, as attributes of `CoSimulation`.
///
/// Only what the C boundary keeps: a flag turns true together with the code behind it.
const CAPABILITIES: [(&str, &str); 11] = [
    ("modelIdentifier", MODEL_IDENTIFIER),
    ("needsExecutionTool", "false"),
    ("canHandleVariableCommunicationStepSize", "true"),
    ("canInterpolateInputs", "true"),
    ("maxOutputDerivativeOrder", "1"),
    ("canRunAsynchronuously", "false"),
    ("canBeInstantiatedOnlyOncePerProcess", "false"),
    ("canNotUseMemoryManagementFunctions", "true"),
    ("canGetAndSetFMUstate", "true"),
    ("canSerializeFMUstate", "true"),
    ("providesDirectionalDerivative", "true"),
];

/// The whole file.
pub fn model_description() -> Result<String, DescriptionError> {
    render(guid()?)
}

/// The file with a given `guid`; the empty one is what the GUID is computed from.
pub(crate) fn render(guid: &str) -> Result<String, DescriptionError> {
    let settings = SceneSettings::default();
    let mut writer = Writer::new_with_indent(Vec::new(), b' ', 2);
    writer.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
    writer
        .create_element("fmiModelDescription")
        .with_attributes([
            ("fmiVersion", "2.0"),
            ("modelName", MODEL_IDENTIFIER),
            ("guid", guid),
            (
                "description",
                "Winding of wire on a turning core: tension and defects",
            ),
            ("version", env!("CARGO_PKG_VERSION")),
            ("license", env!("CARGO_PKG_LICENSE")),
            (
                "generationTool",
                concat!("coilwind ", env!("CARGO_PKG_VERSION")),
            ),
            ("variableNamingConvention", "structured"),
            ("numberOfEventIndicators", "0"),
        ])
        .write_inner_content(|writer| {
            writer
                .create_element("CoSimulation")
                .with_attributes(CAPABILITIES)
                .write_empty()?;
            units::write(writer)?;
            write_categories(writer)?;
            // Two turns at 30 rad/s take 0.42 s; a millisecond is 0.03 rad there.
            writer
                .create_element("DefaultExperiment")
                .with_attributes([
                    ("startTime", "0"),
                    ("stopTime", "0.42"),
                    ("stepSize", "0.001"),
                ])
                .write_empty()?;
            writer
                .create_element("ModelVariables")
                .write_inner_content(|writer| {
                    for variable in variables() {
                        write_variable(writer, variable, &settings)?;
                    }
                    Ok(())
                })?;
            structure::write(writer)
        })?;
    let mut text = String::from_utf8_lossy(&writer.into_inner()).into_owned();
    text.push('\n');
    Ok(text)
}

/// A number as `xs:double`: the shortest decimal that reads back to the same bits.
pub(crate) fn number(x: f64) -> String {
    if x.is_infinite() {
        return if x > 0.0 { "INF" } else { "-INF" }.to_owned();
    }
    x.to_string()
}

fn text(value: Value) -> String {
    match value {
        Value::Real(x) => number(x),
        Value::Integer(i) => i.to_string(),
        Value::Boolean(b) => b.to_string(),
        Value::String(s) => s,
    }
}

fn write_categories(writer: &mut Writer<Vec<u8>>) -> io::Result<()> {
    writer
        .create_element("LogCategories")
        .write_inner_content(|writer| {
            for (_, name, description) in CATEGORIES {
                writer
                    .create_element("Category")
                    .with_attributes([("name", name), ("description", description)])
                    .write_empty()?;
            }
            Ok(())
        })?;
    Ok(())
}

fn write_variable(
    writer: &mut Writer<Vec<u8>>,
    variable: &Variable,
    settings: &SceneSettings,
) -> io::Result<()> {
    let reference = variable.reference.to_string();
    let mut element = writer.create_element("ScalarVariable").with_attributes([
        ("name", variable.name),
        ("valueReference", reference.as_str()),
        ("description", variable.description),
        ("causality", variable.causality.as_str()),
        ("variability", variable.variability.as_str()),
    ]);
    match variable.causality {
        // FMI forbids `initial` on inputs.
        Causality::Input => {}
        Causality::Parameter => element = element.with_attribute(("initial", "exact")),
        Causality::Output | Causality::Local => {
            element = element.with_attribute(("initial", "calculated"));
        }
    }
    element.write_inner_content(|writer| write_type(writer, variable, settings))?;
    Ok(())
}

fn write_type(
    writer: &mut Writer<Vec<u8>>,
    variable: &Variable,
    settings: &SceneSettings,
) -> io::Result<()> {
    let mut attributes: Vec<(&str, String)> = Vec::new();
    if variable.kind == Kind::Real {
        for (key, unit) in [
            ("unit", variable.unit),
            ("displayUnit", variable.display_unit),
        ] {
            if !unit.is_empty() {
                attributes.push((key, unit.to_owned()));
            }
        }
    }
    if matches!(variable.kind, Kind::Real | Kind::Integer) {
        for (key, limit) in [("min", variable.min), ("max", variable.max)] {
            attributes.extend(limit.map(|limit| (key, number(limit))));
        }
    }
    if variable.kind == Kind::Real {
        attributes.extend(variable.nominal.map(|nominal| ("nominal", number(nominal))));
    }
    attributes.extend(variable.start(settings).map(|value| ("start", text(value))));
    writer
        .create_element(variable.kind.as_str())
        .with_attributes(attributes.iter().map(|(key, value)| (*key, value.as_str())))
        .write_empty()?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn start_values_have_the_declared_type() {
        let settings = SceneSettings::default();
        for variable in variables() {
            if let Some(start) = variable.start(&settings) {
                assert_eq!(start.kind(), variable.kind, "{}", variable.name);
            }
        }
    }

    #[test]
    fn units_of_variables_are_defined() {
        for variable in variables().filter(|variable| !variable.unit.is_empty()) {
            let unit = coilwind::variables::units()
                .iter()
                .find(|unit| unit.name == variable.unit);
            let unit = unit.unwrap_or_else(|| panic!("{}: unit {}", variable.name, variable.unit));
            assert!(
                variable.display_unit.is_empty()
                    || unit
                        .display
                        .iter()
                        .any(|display| display.0 == variable.display_unit),
                "{}: display unit {}",
                variable.name,
                variable.display_unit
            );
        }
    }

    #[test]
    fn numbers_in_the_xml_read_back_exactly() {
        for x in [
            7e-4,
            1e10,
            1.0 / 3.0,
            9.549_296_585_513_72,
            f64::MIN_POSITIVE,
        ] {
            let text = number(x);
            assert!(!text.contains(['e', 'E']));
            assert_eq!(
                text.parse::<f64>().expect("a number").to_bits(),
                x.to_bits()
            );
        }
    }
}
