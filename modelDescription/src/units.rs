//! `UnitDefinitions`: every unit of the table with its SI exponents and display units.

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
