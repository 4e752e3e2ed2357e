//! VTK files of a run, read back.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use quick_xml::Reader;
use quick_xml::events::Event;
use std::collections::BTreeMap;
use std::path::Path;

/// Arrays of a file by name.
pub(super) type Arrays = BTreeMap<String, Vec<f64>>;

/// Reads the arrays of a file that [`write_vtp`](super::super::write_vtp) or
/// [`write_core_vtp`](super::super::write_core_vtp) has written.
///
/// # Errors
/// Says what is wrong with the file.
pub(super) fn read(path: &Path) -> Result<Arrays, String> {
    let mut reader = Reader::from_file(path).map_err(|e| e.to_string())?;
    let (mut arrays, mut buffer) = (Arrays::new(), Vec::new());
    let mut array: Option<(String, String)> = None;
    let mut closed = false;
    loop {
        match reader.read_event_into(&mut buffer) {
            Err(error) => return Err(error.to_string()),
            Ok(Event::Start(element)) if element.name().as_ref() == "DataArray" => {
                let attribute = |name: &str| {
                    let found = element.try_get_attribute(name).ok().flatten();
                    found.map(|a| a.value.into_owned()).unwrap_or_default()
                };
                if attribute("format") != "binary" {
                    return Err("it is of another version of coilwind".to_owned());
                }
                array = Some((attribute("Name"), attribute("type")));
            }
            Ok(Event::Text(text)) => {
                if let Some((name, kind)) = array.take() {
                    let values = decode(text.trim(), &kind).map_err(|e| format!("{name}: {e}"))?;
                    arrays.insert(name, values);
                }
            }
            Ok(Event::End(element)) => closed |= element.name().as_ref() == "VTKFile",
            Ok(Event::Eof) if closed => return Ok(arrays),
            Ok(Event::Eof) => return Err("it breaks off".to_owned()),
            Ok(_) => {}
        }
        buffer.clear();
    }
}

/// The numbers of an array: their length in bytes, then the bytes, in base64.
fn decode(text: &str, kind: &str) -> Result<Vec<f64>, String> {
    let bytes = STANDARD.decode(text).map_err(|e| e.to_string())?;
    let (length, bytes) = bytes
        .split_first_chunk::<8>()
        .ok_or("its length is missing")?;
    if u64::from_le_bytes(*length) != bytes.len() as u64 {
        return Err("it is shorter than it says".to_owned());
    }
    fn each<const N: usize>(bytes: &[u8], number: fn([u8; N]) -> f64) -> Vec<f64> {
        bytes
            .as_chunks::<N>()
            .0
            .iter()
            .map(|&c| number(c))
            .collect()
    }
    Ok(match kind {
        "Float64" => each(bytes, f64::from_le_bytes),
        "Float32" => each(bytes, |c| f64::from(f32::from_le_bytes(c))),
        "Int32" => each(bytes, |c| f64::from(i32::from_le_bytes(c))),
        "UInt8" => each(bytes, |[byte]| f64::from(byte)),
        other => return Err(format!("numbers of type {other}")),
    })
}
