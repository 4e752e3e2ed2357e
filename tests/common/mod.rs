//! What several of these tests begin with.

use coilwind::scene::Scene;
use coilwind::settings::SceneSettings;

/// The scene of Fig. 8 with other values for some of its variables.
pub fn fig8(changes: &[(&str, &str)]) -> Scene {
    let mut settings = SceneSettings::load("fig8").expect("packed");
    for (name, value) in changes {
        settings.set_text(name, value).expect("a valid setting");
    }
    settings.build().expect("a valid scene")
}
