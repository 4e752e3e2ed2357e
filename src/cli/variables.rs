//! `coilwind variables`: the variable table, for people or as JSON.

use super::failure::Failure;
use super::terminal::print;
use clap::Args;
use coilwind::scene::unit_suffixes;
use coilwind::settings::SceneSettings;
use coilwind::variables::{Access, Value, Variable, table};
use serde_json::json;

/// Arguments of `variables`.
#[derive(Args, Debug)]
pub(super) struct VariablesArgs {
    /// One JSON array of objects instead of a table
    #[arg(long)]
    json: bool,
}

/// Prints every row.
pub(super) fn variables(args: &VariablesArgs) -> Result<(), Failure> {
    let defaults = SceneSettings::default();
    if args.json {
        let rows: Vec<_> = table().iter().map(|v| as_json(v, &defaults)).collect();
        return print(&format!("{:#}\n", serde_json::Value::from(rows)));
    }
    let mut text = String::new();
    for v in table() {
        let start = match v.start(&defaults) {
            Some(Value::String(s)) => format!(" = {s:?}"),
            Some(value) => format!(" = {value}"),
            None => String::new(),
        };
        let unit = match v.unit {
            "" | "1" => String::new(),
            unit => format!(" {unit}"),
        };
        let head = format!("{:<28}{start}{unit}", v.name);
        let class = format!("{} {}", v.causality.as_str(), v.kind.as_str());
        text += &format!(
            "{:>4} {head:<44} {class:<18} {}",
            v.reference, v.description
        );
        if v.start(&defaults).is_some() {
            text += &format!(" [{}]", v.allowed());
        }
        text.push('\n');
    }
    print(&text)
}

fn as_json(v: &Variable, defaults: &SceneSettings) -> serde_json::Value {
    let start = v.start(defaults).map(|value| match value {
        Value::Real(x) => json!(x),
        Value::Integer(i) => json!(i),
        Value::Boolean(b) => json!(b),
        Value::String(s) => json!(s),
    });
    json!({
        "reference": v.reference,
        "name": v.name,
        "type": v.kind.as_str(),
        "causality": v.causality.as_str(),
        "variability": v.variability.as_str(),
        "unit": v.unit,
        "displayUnit": v.display_unit,
        "min": v.min,
        "max": v.max,
        "nominal": v.nominal,
        "start": start,
        "choices": v.choices,
        "keySuffixes": unit_suffixes(v),
        "fmuStart": v.fmu_start,
        "nativeOnly": v.native_only,
        "fmuOnly": matches!(v.access, Access::Choice(_)),
        "description": v.description,
    })
}
