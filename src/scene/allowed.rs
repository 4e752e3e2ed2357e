//! What a key may be, in the unit that it was given in.

use super::impossible::si;
use crate::variables::{Kind, Scale, Value, Variable, scaled, suffixes_of};

/// What a variable may be, and the same in the unit of the key that was given, `wire.diameter_mm`.
pub(super) fn allowed_for(key: &str, variable: &Variable, scale: Scale) -> String {
    let allowed = variable.allowed();
    let unit = key.strip_prefix(variable.name).unwrap_or_default();
    let bounds = [variable.min, variable.max].map(|bound| bound.map(|x| in_unit(x, scale)));
    match (bounds, scale) {
        (_, Scale::Tens(0)) => allowed,
        ([Some(min), Some(max)], _) => {
            let unit = unit
                .trim_start_matches('_')
                .replace("_per_", "/")
                .replace('_', ".");
            format!("{allowed}, which is {} to {} {unit}", si(min), si(max))
        }
        _ => allowed,
    }
}

/// What was meant by a number that is out of range: the other way round, or, as a question, the unit with which one without a unit would be
/// in range; or nothing.
pub(super) fn meant(key: &str, variable: &Variable, value: &Value) -> String {
    let Value::Real(x) = *value else {
        return String::new();
    };
    let fits = |scale| variable.admits(&Value::Real(scaled(x, scale)));
    let meant = suffixes_of(variable.unit).find(|&(_, scale)| fits(scale));
    match meant {
        Some((unit, _)) if variable.kind == Kind::Real && key == variable.name => {
            format!("; did you mean {key}_{unit}?")
        }
        _ if variable.name == "spindle.speed" && x < 0.0 => {
            "; spindle.direction = -y turns it the other way round".to_owned()
        }
        _ => String::new(),
    }
}

/// A number in SI in a unit.
fn in_unit(x: f64, scale: Scale) -> f64 {
    match scale {
        Scale::Tens(tens) => scaled(x, Scale::Tens(-tens)),
        Scale::Factor(factor) => x / factor,
    }
}
