//! `modelDescription.xml` with its GUID.

use crate::error::DescriptionError;
use crate::guid::guid_of;
use crate::xml::render;
use std::sync::OnceLock;

/// Returns the GUID of the description, `{xxxxxxxx-...}`, computed once per process.
///
/// The GUID is computed from the text of the XML with an empty `guid` attribute.
///
/// # Errors
///
/// If the XML cannot be written.
pub fn guid() -> Result<&'static str, DescriptionError> {
    static GUID: OnceLock<String> = OnceLock::new();
    if let Some(guid) = GUID.get() {
        return Ok(guid);
    }
    let guid = guid_of(&render("")?);
    Ok(GUID.get_or_init(|| guid))
}

/// Returns the text of `modelDescription.xml`.
///
/// # Errors
///
/// If the XML cannot be written.
pub fn model_description() -> Result<String, DescriptionError> {
    render(guid()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_file_carries_the_guid_of_its_own_text() {
        let guid = guid().expect("default scene is valid");
        let text = model_description().expect("default scene is valid");
        let attribute = format!("guid=\"{guid}\"");
        assert_eq!(text.matches(&attribute).count(), 1);
        assert_eq!(guid_of(&text.replace(&attribute, "guid=\"\"")), guid);
    }
}
