//! `ModelStructure`: which variables are outputs and what they depend on.

use crate::variables::variables;
use coilwind::signals::Outputs;
use coilwind::variables::{Causality, Variable};
use quick_xml::Writer;
use std::io;

/// Writes the element `ModelStructure`.
///
/// In step mode an output is a result of the last step. The outputs that follow its inputs, always or where wire comes to rest in
/// it, depend on them, as `fmi2GetDirectionalDerivative` says; the others go in jumps and declare no dependency. At the start
/// every output may follow from the inputs and from every parameter of the scene.
pub(crate) fn write(writer: &mut Writer<Vec<u8>>) -> io::Result<()> {
    let outputs = indices(|variable| variable.causality == Causality::Output);
    let following = indices(|variable| {
        [Outputs::SMOOTH, Outputs::SETTLED]
            .iter()
            .any(|group| group.contains(&variable.name))
    });
    let inputs = indices(|variable| variable.causality == Causality::Input);
    let by_inputs = join(&inputs, ToString::to_string);
    let of_inputs = join(&inputs, |_| "dependent".to_owned());
    let knowns = indices(shapes_the_start);
    let dependencies = join(&knowns, ToString::to_string);
    let kinds = join(&knowns, |_| "dependent".to_owned());
    writer
        .create_element("ModelStructure")
        .write_inner_content(|writer| {
            writer
                .create_element("Outputs")
                .write_inner_content(|writer| {
                    for index in &outputs {
                        match following.contains(index) {
                            true => write_unknown(writer, *index, &by_inputs, &of_inputs)?,
                            false => write_unknown(writer, *index, "", "")?,
                        }
                    }
                    Ok(())
                })?;
            writer
                .create_element("InitialUnknowns")
                .write_inner_content(|writer| {
                    for index in &outputs {
                        write_unknown(writer, *index, &dependencies, &kinds)?;
                    }
                    Ok(())
                })?;
            Ok(())
        })?;
    Ok(())
}

/// Tells whether outputs at the start may depend on a variable. The folder of the results is the
/// only thing to set that does not move the wire.
fn shapes_the_start(variable: &Variable) -> bool {
    matches!(variable.causality, Causality::Input | Causality::Parameter)
        && !variable.name.starts_with("output.")
}

/// Returns the positions in `ModelVariables`, counted from 1 as FMI does.
fn indices(wanted: fn(&Variable) -> bool) -> Vec<usize> {
    (1..)
        .zip(variables())
        .filter(|(_, variable)| wanted(variable))
        .map(|(index, _)| index)
        .collect()
}

fn join(indices: &[usize], text: fn(&usize) -> String) -> String {
    indices.iter().map(text).collect::<Vec<_>>().join(" ")
}

fn write_unknown(
    writer: &mut Writer<Vec<u8>>,
    index: usize,
    dependencies: &str,
    kinds: &str,
) -> io::Result<()> {
    writer
        .create_element("Unknown")
        .with_attributes([
            ("index", index.to_string().as_str()),
            ("dependencies", dependencies),
            ("dependenciesKind", kinds),
        ])
        .write_empty()?;
    Ok(())
}
