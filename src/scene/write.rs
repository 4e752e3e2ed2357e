//! Settings back to a scene file, so that a run can leave what it really ran.

use super::file::from_anywhere;
use crate::settings::SceneSettings;
use crate::variables::{Access, Kind, Variable, table};
use std::path::Path;

impl SceneSettings {
    /// [`Self::to_toml`] for a file in any folder: the scene's own files are named from the root.
    pub fn to_toml_for_elsewhere(&self) -> String {
        let mut there = self.clone();
        for file in there.files_mut() {
            if !file.is_empty() {
                *file = from_anywhere(Path::new(&*file));
            }
        }
        there.to_toml()
    }

    /// The text of a scene file that loads to the same settings; SI keys only, and every leaf but those that follow from others.
    /// Files are named as they are.
    pub fn to_toml(&self) -> String {
        let leaves = table()
            .iter()
            .filter(|v| v.name != "scene.file" && !self.follows_from_way(v.name));
        // Top-level keys must precede the first section.
        let (top, sections): (Vec<&Variable>, Vec<&Variable>) =
            leaves.partition(|v| !v.name.contains('.'));
        let mut text = String::new();
        let mut section = "";
        for variable in top.iter().chain(&sections) {
            let Access::Parameter { get, .. } = variable.access else {
                continue;
            };
            let (head, leaf) = variable.name.split_once('.').unwrap_or(("", variable.name));
            if head != section {
                section = head;
                text += &format!("\n[{section}]\n");
            }
            let value = match variable.kind {
                Kind::String => toml::Value::String(get(self).to_string()).to_string(),
                _ => get(self).to_string(),
            };
            text += &format!("{leaf} = {value}\n");
        }
        text
    }
}
