//! What differs between the scenes and the options of two runs, in the words of the variable table.

use super::options::{CoilOption, OF_COIL, Options, checksum};
use crate::settings::SceneSettings;
use crate::variables::{Access, Value, Variable, table, units};
use serde::Serialize;
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

/// A parameter that two scenes give other values, or an option that two runs were given.
#[derive(Debug, PartialEq, Serialize)]
pub(super) struct Difference {
    name: &'static str,
    /// what the parameter is
    meaning: &'static str,
    /// value and unit in each scene; empty where an option was not given
    values: [String; 2],
}

/// Unit of spindle speeds, which people say in another one as well.
const SPEED: &str = "rad/s";

/// What a key has in place of a value where nothing reads it.
const NO_EFFECT: &str = "no effect";

/// What follows the name of the second run's file where the first run's has the same name.
const OTHER_CONTENT: &str = " (with other content)";

/// Options and parameters that differ between the runs in two folders, in the order of the table; `None` where a scene is missing or
/// cannot be read. What a run writes, and where to, is no difference of coils. Nor is a key that neither of them reads.
pub(super) fn differences(one: &Path, other: &Path) -> Option<Vec<Difference>> {
    let scenes = [scene(one)?, scene(other)?];
    let idle = scenes.each_ref().map(SceneSettings::idle_keys);
    let options = [one, other].map(Options::read);
    let other_content = |name: &str| {
        let sums = [one, other].map(|folder| checksum(folder, name));
        sums[0].is_some() && sums[1].is_some() && sums[0] != sums[1]
    };
    let of_options = OF_COIL
        .iter()
        .filter_map(|of| of_option(of, &options, other_content(of.name)));
    let coil = table()
        .iter()
        .filter(|row| !row.name.starts_with("output."));
    let of_scenes = coil.filter_map(|row| difference(row, &scenes, &idle, other_content(row.name)));
    Some(of_options.chain(of_scenes).collect())
}

fn of_option(of: &CoilOption, options: &[Options; 2], other_content: bool) -> Option<Difference> {
    let [one, other] = options.each_ref().map(|options| options.value(of.name));
    let shown = |value: Option<&str>| {
        let text = format!("{} {}", value?, of.unit);
        Some(text.trim_end().to_owned())
    };
    let values = [one, other].map(|value| shown(value).unwrap_or_default());
    (one != other || other_content).then(|| Difference {
        name: of.name,
        meaning: of.meaning,
        values: marked(values),
    })
}

fn scene(directory: &Path) -> Option<SceneSettings> {
    let text = fs::read_to_string(directory.join("scene.toml")).ok()?;
    SceneSettings::from_toml_str(&text, "scene.toml", directory).ok()
}

fn difference(
    row: &Variable,
    scenes: &[SceneSettings; 2],
    idle: &[BTreeSet<&str>; 2],
    other_content: bool,
) -> Option<Difference> {
    let Access::Parameter { get, .. } = row.access else {
        return None;
    };
    let values = scenes.each_ref().map(get);
    let idle = idle.each_ref().map(|keys| keys.contains(row.name));
    let differs = row.name != "scene.file" && values[0] != values[1] && idle != [true, true];
    (differs || other_content).then(|| Difference {
        name: row.name,
        meaning: row.description,
        values: marked([0, 1].map(|run| match idle[run] {
            true => NO_EFFECT.to_owned(),
            false => shown(row, &values[run]),
        })),
    })
}

/// Two values that differ, the second one marked where it has the words of the first.
fn marked([one, other]: [String; 2]) -> [String; 2] {
    match one == other {
        true => [one, other + OTHER_CONTENT],
        false => [one, other],
    }
}

/// A value in the unit that people use, or what a 0 stands for.
fn shown(row: &Variable, value: &Value) -> String {
    let Value::Real(x) = value else {
        return value.to_string();
    };
    if let Some((_, zero)) = row.description.split_once("; 0: ").filter(|_| *x == 0.0) {
        return zero.split(';').next().unwrap_or(zero).to_owned();
    }
    let unit = units().iter().find(|unit| unit.name == row.unit);
    let display = unit.and_then(|unit| unit.display.iter().find(|it| it.0 == row.display_unit));
    let (name, factor, offset) = display.copied().unwrap_or((row.unit, 1.0, 0.0));
    // Seven digits: the product with a factor has no more to say.
    let seven = |x: f64| format!("{x:.6e}").parse().unwrap_or(x);
    let rounded = seven(factor * x + offset);
    let name = if name == "1" { "" } else { name };
    if row.unit == SPEED {
        // (scenes have either)
        return format!(
            "{} {SPEED} ({} {name})",
            Value::Real(seven(*x)),
            Value::Real(rounded)
        );
    }
    format!("{} {name}", Value::Real(rounded))
        .trim_end()
        .to_owned()
}

#[cfg(test)]
mod tests {
    use super::super::options::{READ, WOUND_WITH};
    use super::*;

    #[test]
    fn what_differs_is_told_in_the_units_of_people() {
        let [one, other] = [(); 2].map(|()| tempfile::tempdir().expect("a folder"));
        let put = |folder: &tempfile::TempDir, text: &str| {
            fs::write(folder.path().join("scene.toml"), text).expect("a file");
        };
        put(
            &one,
            "[wire]\ndiameter = 7e-4\n[spindle]\nspeed = 150\n[output]\nhistory_interval = 0.1\n",
        );
        assert_eq!(differences(one.path(), other.path()), None, "no scene");
        put(
            &other,
            "[core]\nshape = \"cylinder\"\n[wire]\ndiameter_mm = 0.3\n[spindle]\nspeed_rpm = 1200\n",
        );
        let found = differences(one.path(), other.path()).expect("two scenes");
        let told: Vec<_> = found.iter().map(|d| (d.name, &d.values)).collect();
        let values = |one: &str, other: &str| [one.to_owned(), other.to_owned()];
        let expected = [
            ("wire.diameter", &values("0.7 mm", "0.3 mm")),
            ("core.shape", &values("rounded-box", "cylinder")),
            (
                "spindle.speed",
                // (speeds stood there in rpm alone)
                &values("150 rad/s (1432.394 rpm)", "125.6637 rad/s (1200 rpm)"),
            ),
        ];
        assert_eq!(told, expected);
        assert!(
            found[0]
                .meaning
                .starts_with("diameter of the bare round wire")
        );
        assert_eq!(differences(one.path(), one.path()), Some(Vec::new()));
    }

    /// A yield stress that the material gives was told as 0 MPa.
    #[test]
    fn a_zero_that_stands_for_something_is_told_as_that() {
        let [one, other] = [(); 2].map(|()| tempfile::tempdir().expect("a folder"));
        for (folder, text) in [(&one, ""), (&other, "[wire]\nyield_stress_MPa = 100\n")] {
            fs::write(folder.path().join("scene.toml"), text).expect("a file");
        }
        let found = differences(one.path(), other.path()).expect("two scenes");
        let told: Vec<_> = found.iter().map(|d| (d.name, &d.values)).collect();
        let values = ["of the material".to_owned(), "100 MPa".to_owned()];
        assert_eq!(told, [("wire.yield_stress", &values)]);
    }

    /// A core of the same name that had been drawn again in between was no difference.
    #[test]
    fn a_file_of_the_same_name_and_other_content_is_told() {
        let [one, other] = [(); 2].map(|()| tempfile::tempdir().expect("a folder"));
        let scene = "[core]\nshape = \"mesh\"\nfile = \"/core.stl\"\n";
        let put = |folder: &tempfile::TempDir, inputs: u32, core: u32| {
            let head = format!(
                "{WOUND_WITH} --inputs a.csv\n{READ} core.file={core:08x} --inputs={inputs:08x}\n"
            );
            fs::write(folder.path().join("scene.toml"), head + scene).expect("a file");
        };
        put(&one, 7, 8);
        put(&other, 7, 8);
        assert_eq!(differences(one.path(), other.path()), Some(Vec::new()));
        put(&other, 6, 9);
        let found = differences(one.path(), other.path()).expect("two scenes");
        let names: Vec<_> = found.iter().map(|d| d.name).collect();
        assert_eq!(names, ["--inputs", "core.file"]);
        assert_eq!(found[0].values, ["a.csv", "a.csv (with other content)"]);
    }

    /// Keys of a box stood among the differences from a cylinder, and those of a mesh too.
    #[test]
    fn a_key_that_only_one_shape_reads_is_told_as_such() {
        let [one, other] = [(); 2].map(|()| tempfile::tempdir().expect("a folder"));
        let put = |folder: &tempfile::TempDir, text: &str| {
            fs::write(folder.path().join("scene.toml"), text).expect("a file");
        };
        put(&one, "[core]\nwidth_x = 0.013\nunit = \"m\"\n");
        put(
            &other,
            "[core]\nshape = \"cylinder\"\nradius_mm = 9\nunit = \"mm\"\n",
        );
        let found = differences(one.path(), other.path()).expect("two scenes");
        let told: Vec<_> = found
            .iter()
            .map(|d| (d.name, d.values.each_ref().map(String::as_str)))
            .collect();
        let expected = [
            ("core.shape", ["rounded-box", "cylinder"]),
            ("core.width_x", ["13 mm", NO_EFFECT]),
            ("core.radius", [NO_EFFECT, "9 mm"]),
        ];
        assert_eq!(told, expected);
    }
}
