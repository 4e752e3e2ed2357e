//! The scene that a command takes.

use clap::Args;
use coilwind::scene::{SceneError, assignment};
use coilwind::settings::SceneSettings;

/// A scene and what to change in it.
#[derive(Args, Debug)]
pub(super) struct SceneArgs {
    /// Scene file (TOML), or the name of a packed scene such as fig8
    pub(super) scene: String,
    /// Set a parameter, with or without its unit: wire.diameter=7e-4, wire.diameter_mm=0.7
    #[arg(long, value_name = "NAME=VALUE", value_parser = assignment)]
    pub(super) set: Vec<(String, String)>,
}

impl SceneArgs {
    /// Defaults, then the scene, then every `--set` in its order.
    pub(super) fn settings(&self) -> Result<SceneSettings, SceneError> {
        let mut settings = SceneSettings::load(&self.scene)?;
        for (name, value) in &self.set {
            settings.set_text(name, value)?;
        }
        Ok(settings)
    }
}
