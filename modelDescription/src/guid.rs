//! The identity of the description: a name-based UUID of its own text.

use crate::DescriptionError;
use crate::xml::render;
use std::sync::OnceLock;
use uuid::Uuid;

/// GUID of the description, `{xxxxxxxx-...}`: version 5 of the XML with an empty `guid`.
///
/// Any change of a name, unit, limit or start value changes it, so a library and an XML of
/// different builds never pass for a pair. Computed once per process.
pub fn guid() -> Result<&'static str, DescriptionError> {
    static GUID: OnceLock<String> = OnceLock::new();
    if let Some(guid) = GUID.get() {
        return Ok(guid);
    }
    let content = render("")?;
    let namespace = Uuid::new_v5(&Uuid::NAMESPACE_URL, b"coilwind/modelDescription.xml");
    let guid = format!("{{{}}}", Uuid::new_v5(&namespace, content.as_bytes()));
    Ok(GUID.get_or_init(|| guid))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn is_a_braced_version_five_uuid_and_stays_the_same() {
        let first = guid().expect("default scene is valid");
        let inner = first
            .strip_prefix('{')
            .and_then(|s| s.strip_suffix('}'))
            .expect("braces");
        assert_eq!(Uuid::parse_str(inner).expect("a UUID").get_version_num(), 5);
        assert_eq!(guid().expect("default scene is valid"), first);
    }
}
