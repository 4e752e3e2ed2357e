//! What differs between the scenes of two runs, in the words of the variable table.

use crate::settings::SceneSettings;
use crate::variables::{Access, Value, Variable, table, units};
use serde::Serialize;
use std::fs;
use std::path::Path;

/// A parameter that two scenes give other values.
#[derive(Debug, PartialEq, Serialize)]
pub(super) struct Difference {
    name: &'static str,
    /// what the parameter is
    meaning: &'static str,
    /// value and unit in each scene
    values: [String; 2],
}

/// Parameters that differ between the scenes in two folders, in the order of the table; `None` where a scene is missing or cannot
/// be read. What a run writes, and where to, is no difference of coils.
pub(super) fn differences(one: &Path, other: &Path) -> Option<Vec<Difference>> {
    let scenes = [scene(one)?, scene(other)?];
    let coil = table()
        .iter()
        .filter(|row| !row.name.starts_with("output."));
    Some(coil.filter_map(|row| difference(row, &scenes)).collect())
}

fn scene(directory: &Path) -> Option<SceneSettings> {
    let text = fs::read_to_string(directory.join("scene.toml")).ok()?;
    SceneSettings::from_toml_str(&text, "scene.toml", directory).ok()
}

fn difference(row: &Variable, scenes: &[SceneSettings; 2]) -> Option<Difference> {
    let Access::Parameter { get, .. } = row.access else {
        return None;
    };
    let [one, other] = [get(&scenes[0]), get(&scenes[1])];
    (row.name != "scene.file" && one != other).then(|| Difference {
        name: row.name,
        meaning: row.description,
        values: [shown(row, &one), shown(row, &other)],
    })
}

/// A value in the unit that people use.
fn shown(row: &Variable, value: &Value) -> String {
    let Value::Real(x) = value else {
        return value.to_string();
    };
    let unit = units().iter().find(|unit| unit.name == row.unit);
    let display = unit.and_then(|unit| unit.display.iter().find(|it| it.0 == row.display_unit));
    let (name, factor, offset) = display.copied().unwrap_or((row.unit, 1.0, 0.0));
    // Seven digits: the product with a factor has no more to say.
    let rounded: f64 = format!("{:.6e}", factor * x + offset).parse().unwrap_or(*x);
    let name = if name == "1" { "" } else { name };
    format!("{} {name}", Value::Real(rounded))
        .trim_end()
        .to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_differs_is_told_in_the_units_of_people() {
        let [one, other] = [(); 2].map(|()| tempfile::tempdir().expect("a folder"));
        let put = |folder: &tempfile::TempDir, text: &str| {
            fs::write(folder.path().join("scene.toml"), text).expect("a file");
        };
        put(
            &one,
            "[wire]\ndiameter = 7e-4\n[output]\nhistory_interval = 0.1\n",
        );
        assert_eq!(differences(one.path(), other.path()), None, "no scene");
        put(
            &other,
            "[core]\nshape = \"cylinder\"\n[wire]\ndiameter_mm = 0.3\n",
        );
        let found = differences(one.path(), other.path()).expect("two scenes");
        let told: Vec<_> = found.iter().map(|d| (d.name, &d.values)).collect();
        assert_eq!(
            told,
            [
                ("wire.diameter", &["0.7 mm".to_owned(), "0.3 mm".to_owned()]),
                (
                    "core.shape",
                    &["rounded-box".to_owned(), "cylinder".to_owned()]
                ),
            ]
        );
        assert!(
            found[0]
                .meaning
                .starts_with("diameter of the bare round wire")
        );
        assert_eq!(differences(one.path(), one.path()), Some(Vec::new()));
    }
}
