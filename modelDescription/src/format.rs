//! Values of variables as the XML writes them.

use coilwind::variables::Value;

/// Returns a number as `xs:double`: the shortest decimal that reads back to the same bits.
pub(crate) fn number(x: f64) -> String {
    if x.is_infinite() {
        return if x > 0.0 { "INF" } else { "-INF" }.to_owned();
    }
    x.to_string()
}

/// Returns a value of any type as the text of an XML attribute, before escaping.
pub(crate) fn text(value: Value) -> String {
    match value {
        Value::Real(x) => number(x),
        Value::Integer(i) => i.to_string(),
        Value::Boolean(b) => b.to_string(),
        Value::String(s) => s,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
