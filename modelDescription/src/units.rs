//! `UnitDefinitions` and `TypeDefinitions`: every unit of the table with its SI exponents and display units, and what it
//! measures.

use crate::format::number;
use coilwind::variables::{Unit, units};
use quick_xml::Writer;
use std::io;

/// Writes the element `UnitDefinitions`.
pub(crate) fn write(writer: &mut Writer<Vec<u8>>) -> io::Result<()> {
    writer
        .create_element("UnitDefinitions")
        .write_inner_content(|writer| {
            for unit in units() {
                write_unit(writer, unit)?;
            }
            Ok(())
        })?;
    Ok(())
}

/// Writes the element `TypeDefinitions`: a type for each unit, named after the quantity that it measures.
pub(crate) fn write_types(writer: &mut Writer<Vec<u8>>) -> io::Result<()> {
    writer
        .create_element("TypeDefinitions")
        .write_inner_content(|writer| {
            for unit in units() {
                writer
                    .create_element("SimpleType")
                    .with_attribute(("name", unit.quantity))
                    .write_inner_content(|writer| {
                        writer
                            .create_element("Real")
                            .with_attributes([("quantity", unit.quantity), ("unit", unit.name)])
                            .write_empty()?;
                        Ok(())
                    })?;
            }
            Ok(())
        })?;
    Ok(())
}

/// The quantity that a unit of the table measures, and the name of its type.
pub(crate) fn quantity(unit: &str) -> Option<&'static str> {
    let unit = units().iter().find(|known| known.name == unit)?;
    Some(unit.quantity)
}

fn write_unit(writer: &mut Writer<Vec<u8>>, unit: &Unit) -> io::Result<()> {
    writer
        .create_element("Unit")
        .with_attribute(("name", unit.name))
        .write_inner_content(|writer| {
            let mut base = writer.create_element("BaseUnit");
            for (name, exponent) in unit.base {
                base = base.with_attribute((*name, exponent.to_string().as_str()));
            }
            base.write_empty()?;
            for (name, factor, offset) in unit.display {
                let mut display = writer
                    .create_element("DisplayUnit")
                    .with_attributes([("name", *name), ("factor", number(*factor).as_str())]);
                if *offset != 0.0 {
                    display = display.with_attribute(("offset", number(*offset).as_str()));
                }
                display.write_empty()?;
            }
            Ok(())
        })?;
    Ok(())
}
