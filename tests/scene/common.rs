//! Scenes from texts, and the messages of those that are refused.

use coilwind::scene::SceneError;
use coilwind::settings::SceneSettings;
use std::path::Path;

pub(crate) fn parse(text: &str) -> Result<SceneSettings, SceneError> {
    SceneSettings::from_toml_str(text, "test.toml", Path::new(""))
}

pub(crate) fn fig8() -> SceneSettings {
    SceneSettings::packed("fig8")
        .expect("packed")
        .expect("valid")
}

/// The message of a scene that parses but cannot be built.
pub(crate) fn refused(text: &str) -> String {
    parse(text)
        .expect("parses")
        .build()
        .expect_err("must be refused")
        .to_string()
}

/// The message of a scene that does not parse.
pub(crate) fn unread(text: &str) -> String {
    parse(text).expect_err("must not parse").to_string()
}

pub(crate) fn assert_says(message: &str, parts: &[&str]) {
    for part in parts {
        assert!(message.contains(part), "{part:?} is missing in: {message}");
    }
}
