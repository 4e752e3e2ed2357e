//! `modelDescription.xml` (FMI 2.0.5, section 2.2) from the variable table.

use crate::categories::CATEGORIES;
use crate::error::DescriptionError;
use crate::format::{number, text};
use crate::variables::variables;
use crate::{structure, units};
use coilwind::settings::SceneSettings;
use coilwind::variables::{Causality, Kind, Variable};
use quick_xml::Writer;
use quick_xml::events::{BytesDecl, Event};
use std::io;

/// Name of the model and of the shared library inside the FMU, without extension.
///
/// Functions of a binary FMU 2.0 carry no prefix, so that their names do not contain it.
pub(crate) const MODEL_IDENTIFIER: &str = "CoilWinding";

/// End of the default experiment, s: an importer that only simulates sees the demonstration to its end.
pub const DEFAULT_STOP_TIME: f64 = 0.2;

/// Tolerance of the default experiment, the one that most importers have: with it the solver keeps `solver.tolerance`.
pub const DEFAULT_TOLERANCE: f64 = 1e-4;

/// What the FMU can do, as attributes of `CoSimulation`.
///
/// They announce what the C boundary does. A flag becomes true in the same commit as the code
/// behind it.
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

/// Returns the file with a given `guid` attribute.
///
/// # Errors
///
/// If the XML cannot be written.
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
            units::write_types(writer)?;
            write_categories(writer)?;
            // A millisecond is at most 0.1 rad of the demonstration.
            let (stop, tolerance) = (number(DEFAULT_STOP_TIME), number(DEFAULT_TOLERANCE));
            writer
                .create_element("DefaultExperiment")
                .with_attributes([
                    ("startTime", "0"),
                    ("stopTime", stop.as_str()),
                    ("tolerance", tolerance.as_str()),
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
    let description = described(variable);
    let mut element = writer.create_element("ScalarVariable").with_attributes([
        ("name", variable.name),
        ("valueReference", reference.as_str()),
        ("description", description.as_str()),
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

/// What a variable means, with its choices: importers that read no enumerations show them too.
fn described(variable: &Variable) -> String {
    match variable.choices {
        [] => variable.description.to_owned(),
        choices => format!("{} (one of {})", variable.description, choices.join(", ")),
    }
}

fn write_type(
    writer: &mut Writer<Vec<u8>>,
    variable: &Variable,
    settings: &SceneSettings,
) -> io::Result<()> {
    let mut attributes: Vec<(&str, String)> = Vec::new();
    if variable.kind == Kind::Real {
        if let Some(quantity) = units::quantity(variable.unit) {
            attributes.push(("declaredType", quantity.to_owned()));
            attributes.push(("quantity", quantity.to_owned()));
        }
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
    attributes.extend(
        variable
            .start_in_fmu(settings)
            .map(|value| ("start", text(value))),
    );
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

    /// FMI asks for names of types that are no names of variables, and for each of them once.
    #[test]
    fn types_have_names_of_their_own() {
        let quantities: std::collections::BTreeSet<_> = coilwind::variables::units()
            .iter()
            .map(|unit| unit.quantity)
            .collect();
        assert_eq!(quantities.len(), coilwind::variables::units().len());
        assert!(variables().all(|variable| !quantities.contains(variable.name)));
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
}
