//! The identity of a description: a name-based UUID of its own text.

use uuid::Uuid;

/// Returns the GUID, `{xxxxxxxx-...}`, of a description whose own `guid` attribute is empty.
///
/// It is a UUID of version 5 (RFC 9562). Any change of a name, unit, limit or start value changes
/// it, so that a library and an XML of different builds never pass for a pair.
pub(crate) fn guid_of(description: &str) -> String {
    let namespace = Uuid::new_v5(&Uuid::NAMESPACE_URL, b"coilwind/modelDescription.xml");
    format!("{{{}}}", Uuid::new_v5(&namespace, description.as_bytes()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn is_a_braced_version_five_uuid_that_follows_the_text() {
        let first = guid_of("a description");
        let inner = first
            .strip_prefix('{')
            .and_then(|s| s.strip_suffix('}'))
            .expect("braces");
        assert_eq!(Uuid::parse_str(inner).expect("a UUID").get_version_num(), 5);
        assert_eq!(guid_of("a description"), first);
        assert_ne!(guid_of("another description"), first);
    }
}
