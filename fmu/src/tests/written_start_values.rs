//! Tests of an importer that writes every start value of `modelDescription.xml` before the start.

use crate::instance::Instance;
use coilwind::scene::packed_names;
use coilwind::settings::SceneSettings;
use coilwind::variables::{Causality, Value, by_name, table};
use coilwind_model_description::Category;

/// Writes all start values but the name of the scene, which is `scene`, and the folder of results; starts, and returns the warnings.
fn started(scene: &str) -> Result<Vec<String>, String> {
    let mut instance = Instance::for_tests();
    let file = by_name("scene.file").expect("a variable").reference;
    let written = instance.set(&[file], [scene.to_owned()]);
    written.expect("a packed scene");
    let defaults = SceneSettings::default();
    for row in table() {
        let is_set = matches!(row.causality, Causality::Parameter | Causality::Input);
        if !is_set || row.native_only || ["scene.file", "output.directory"].contains(&row.name) {
            continue;
        }
        let at = [row.reference];
        let written = match row.start_in_fmu(&defaults) {
            None => continue,
            Some(Value::Real(x)) => instance.set(&at, [x]),
            Some(Value::Integer(x)) => instance.set(&at, [x]),
            Some(Value::Boolean(x)) => instance.set(&at, [x]),
            Some(Value::String(x)) => instance.set(&at, [x]),
        };
        written.map_err(|error| format!("{}: {error}", row.name))?;
    }
    let told = |error: crate::error::Error| error.to_string();
    instance.setup_experiment(None, 0.0, None).map_err(told)?;
    instance.enter_initialization_mode().map_err(told)?;
    instance.exit_initialization_mode().map_err(told)?;
    instance.do_step(0.0, 1e-3).map_err(told)?;
    let messages = instance.end_call().into_iter();
    let warnings = messages.filter(|m| m.category == Category::Warning);
    Ok(warnings.map(|m| m.text).collect())
}

/// Three of five packed scenes were refused for layers that a nozzle by input does not wind.
#[test]
fn every_packed_scene_starts() {
    for scene in packed_names() {
        let warnings = started(scene).unwrap_or_else(|error| panic!("{scene}: {error}"));
        assert!(!warnings.is_empty(), "{scene} has values of its own");
    }
}

/// Some 25 values that a scene does not use hid those that overruled it.
#[test]
fn values_without_effect_do_not_hide_what_overrules_the_scene() {
    let warnings = started("fig8_gap").expect("starts");
    let idle = warnings
        .iter()
        .filter(|text| text.contains("has no effect"));
    assert_eq!(idle.count(), 0, "{warnings:#?}");
    let overruled = |text: &&String| text.contains("wire.material = copper was set and holds");
    assert_eq!(warnings.iter().filter(overruled).count(), 1);
}
