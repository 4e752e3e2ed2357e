//! The one table of variables: inputs, outputs, diagnostics and every leaf of a scene.
//!
//! One row holds reference, name, kind, unit, range, description and accessors. The FMU's XML and
//! its getters and setters, the header of `history.csv`, `coilwind variables`, the scene file's
//! keys and `--set` all derive from it; start values come from the default scene. References are
//! explicit, unique over all kinds and never reused:
//!
//! | from | what |
//! |---|---|
//! | 0 | inputs |
//! | 100 | outputs |
//! | 200 | diagnostics (local) |
//! | 1000 | parameters, a hundred per section of the scene file |
//! | 3000 | numbers of choices, for importers that set no texts |

mod rows;
mod unit;
mod variable;

pub(crate) use unit::{Scale, parse_scaled, scaled, split_suffix, suffixes_of};
pub use unit::{Unit, units};
pub use variable::{Access, Causality, Kind, Value, Variability, Variable};

/// Every variable, by rising reference within inputs, outputs, locals, parameters.
pub fn table() -> &'static [Variable] {
    rows::TABLE
}

/// The row of a name, spelled exactly.
pub fn by_name(name: &str) -> Option<&'static Variable> {
    table().iter().find(|v| v.name == name)
}

/// The row of a reference.
pub fn by_reference(reference: u32) -> Option<&'static Variable> {
    let rows = table();
    rows.binary_search_by_key(&reference, |v| v.reference)
        .ok()
        .map(|row| &rows[row])
}

/// The text that the number of a choice stands for, with its row: `None` where `number` is no such variable, and for 0,
/// which leaves the text as it is.
pub fn choice(number: &Variable, value: &Value) -> Option<(&'static Variable, Value)> {
    let (Access::Choice(text), Value::Integer(place)) = (number.access, value) else {
        return None;
    };
    let row = by_name(text)?;
    let text = row
        .choices
        .get(usize::try_from(*place).ok()?.checked_sub(1)?)?;
    Some((row, Value::String((*text).to_owned())))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::SceneSettings;
    use crate::signals::Outputs;
    use std::collections::BTreeSet;

    #[test]
    fn references_rise_and_names_are_unique() {
        let rows = table();
        assert!(rows.windows(2).all(|w| w[0].reference < w[1].reference));
        let names: BTreeSet<_> = rows.iter().map(|v| v.name).collect();
        assert_eq!(names.len(), rows.len());
        for v in rows {
            assert_eq!(by_reference(v.reference).map(|w| w.name), Some(v.name));
            assert_eq!(by_name(v.name).map(|w| w.reference), Some(v.reference));
            let group = match v.causality {
                Causality::Input => 0..100,
                Causality::Output => 100..200,
                Causality::Local => 200..300,
                Causality::Parameter => 1000..9999,
            };
            assert!(group.contains(&v.reference), "{}", v.name);
        }
    }

    #[test]
    fn reals_carry_a_known_unit_a_range_and_a_nominal() {
        for v in table() {
            assert!(!v.description.is_empty(), "{}", v.name);
            if v.kind != Kind::Real {
                assert!(v.unit.is_empty() && v.nominal.is_none(), "{}", v.name);
                continue;
            }
            let unit = units().iter().find(|u| u.name == v.unit);
            let unit = unit.unwrap_or_else(|| panic!("{}: unit {}", v.name, v.unit));
            assert!(
                v.display_unit.is_empty() || unit.display.iter().any(|d| d.0 == v.display_unit),
                "{}: {}",
                v.name,
                v.display_unit
            );
            assert!(v.nominal.is_some_and(|n| n > 0.0), "{}", v.name);
            assert!(v.min < v.max && v.min.is_some(), "{}", v.name);
        }
    }

    #[test]
    fn defaults_are_admitted_and_setters_reach_their_own_leaf() {
        let default = SceneSettings::default();
        for v in table() {
            let Access::Parameter { get, set } = v.access else {
                continue;
            };
            assert!(v.admits(&get(&default)), "{} = {}", v.name, get(&default));
            let mut changed = default.clone();
            let other = match get(&default) {
                Value::Real(x) => Value::Real(x + 0.125),
                Value::Integer(i) => Value::Integer(i + 1),
                Value::Boolean(b) => Value::Boolean(!b),
                Value::String(s) => Value::String(s + "x"),
            };
            set(&mut changed, other.clone());
            for w in table() {
                let Access::Parameter { get, .. } = w.access else {
                    continue;
                };
                let expected = if w.name == v.name {
                    other.clone()
                } else {
                    get(&default)
                };
                assert_eq!(get(&changed), expected, "{} after {}", w.name, v.name);
            }
        }
    }

    #[test]
    fn outputs_read_the_field_of_their_name() {
        let zero = serde_json::to_value(Outputs::default()).unwrap();
        let names: BTreeSet<_> = table()
            .iter()
            .filter(|v| matches!(v.access, Access::Output(_)))
            .map(|v| v.name.to_owned())
            .collect();
        let fields: BTreeSet<_> = zero.as_object().unwrap().keys().cloned().collect();
        assert_eq!(names, fields);

        let outputs = Outputs {
            wire_tension: 3.0,
            layer: 2,
            defect_gap: true,
            ..zero_outputs()
        };
        for v in table() {
            let Access::Output(get) = v.access else {
                continue;
            };
            let expected = match v.name {
                "wire_tension" => Value::Real(3.0),
                "layer" => Value::Integer(2),
                "defect_gap" => Value::Boolean(true),
                _ => get(&zero_outputs()),
            };
            assert_eq!(get(&outputs), expected, "{}", v.name);
            assert_eq!(get(&outputs).kind(), v.kind, "{}", v.name);
        }
    }

    fn zero_outputs() -> Outputs {
        Outputs::default()
    }

    #[test]
    fn values_print_shortest_and_read_back() {
        for x in [
            0.0,
            0.0007,
            1e10,
            -2e-6,
            1.0 / 3.0,
            523.598_775_598_298_9,
            f64::MIN_POSITIVE,
        ] {
            let text = Value::Real(x).to_string();
            assert_eq!(text.parse::<f64>().unwrap(), x);
            assert!(text.len() < 25, "{text}");
        }
    }

    #[test]
    fn not_a_number_is_never_admitted() {
        let v = by_name("wire.diameter").unwrap();
        assert!(!v.admits(&Value::Real(f64::NAN)));
        assert!(!v.admits(&Value::Real(f64::INFINITY)));
        assert!(!v.admits(&Value::Integer(1)));
        assert_eq!(v.allowed(), "2e-5 to 0.005 m");
    }
}
