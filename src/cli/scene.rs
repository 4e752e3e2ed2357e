//! The scene that a command takes.

use clap::Args;
use clap::builder::NonEmptyStringValueParser;
use coilwind::scene::{Scene, SceneError, Warning, assignment, refuse_repeated};
use coilwind::settings::{NozzleFollows, SceneSettings};

/// A scene and what to change in it.
#[derive(Args, Debug)]
pub(super) struct SceneArgs {
    /// Scene file (TOML), or the name of a packed scene such as fig8
    #[arg(value_parser = NonEmptyStringValueParser::new())]
    pub(super) scene: String,
    /// Set a parameter, with or without its unit: wire.diameter=7e-4, wire.diameter_mm=0.7
    #[arg(long, value_name = "NAME=VALUE", value_parser = assignment)]
    pub(super) set: Vec<(String, String)>,
}

impl SceneArgs {
    /// Defaults, then the scene, then every `--set` in its order; and the scene that this makes.
    pub(super) fn build(&self) -> Result<(SceneSettings, Scene, Vec<Warning>), SceneError> {
        refuse_repeated(&self.set)?;
        SceneSettings::load_and_build(&self.scene, &self.set, |_| NozzleFollows::Law)
    }
}
