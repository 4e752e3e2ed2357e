//! VTK files of a run, read back.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::read::ZlibDecoder;
use quick_xml::Reader;
use quick_xml::events::Event;
use std::collections::BTreeMap;
use std::io::Read;
use std::path::Path;

const SHORTER: &str = "it is not as long as it says";

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
    let (mut compact, mut closed) = (false, false);
    loop {
        match reader.read_event_into(&mut buffer) {
            Err(error) => return Err(error.to_string()),
            Ok(Event::Start(element)) if element.name().as_ref() == "VTKFile" => {
                compact = element
                    .try_get_attribute("compressor")
                    .is_ok_and(|found| found.is_some());
            }
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
                    let bytes = match compact {
                        true => decompress(text.trim()),
                        false => plain(text.trim()),
                    };
                    let values = bytes.and_then(|bytes| numbers(&bytes, &kind));
                    let values = values.map_err(|e| format!("{name}: {e}"))?;
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

/// The bytes of an array: their length, then the bytes, in base64.
fn plain(text: &str) -> Result<Vec<u8>, String> {
    let bytes = STANDARD.decode(text).map_err(|e| e.to_string())?;
    let (length, bytes) = bytes
        .split_first_chunk::<8>()
        .ok_or("its length is missing")?;
    if u64::from_le_bytes(*length) != bytes.len() as u64 {
        return Err(SHORTER.to_owned());
    }
    Ok(bytes.to_vec())
}

/// The bytes of an array that is one compressed block, or none.
fn decompress(text: &str) -> Result<Vec<u8>, String> {
    // The header's four numbers of 8 bytes are 44 letters. An empty array has three of them and nothing else.
    let (header, block) = text.split_at_checked(44).unwrap_or((text, ""));
    let header = STANDARD.decode(header).map_err(|e| e.to_string())?;
    let header: Vec<u64> = header
        .as_chunks()
        .0
        .iter()
        .map(|&word| u64::from_le_bytes(word))
        .collect();
    let length = match header[..] {
        [0, ..] => return Ok(Vec::new()),
        [1, length, 0, _] => length,
        _ => return Err("it is not one block".to_owned()),
    };
    let block = STANDARD.decode(block).map_err(|e| e.to_string())?;
    let mut bytes = Vec::new();
    // One byte more than it says would be wrong already: a damaged file does not fill the memory.
    let mut decoder = ZlibDecoder::new(&block[..]).take(length + 1);
    decoder.read_to_end(&mut bytes).map_err(|e| e.to_string())?;
    if length != bytes.len() as u64 {
        return Err(SHORTER.to_owned());
    }
    Ok(bytes)
}

fn numbers(bytes: &[u8], kind: &str) -> Result<Vec<f64>, String> {
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
