//! Settings back to a scene file, so that a run can leave what it really ran.

use crate::settings::SceneSettings;
use crate::variables::{Access, Kind, Variable, table};

impl SceneSettings {
    /// The text of a scene file that loads to the same settings; every leaf, SI keys only.
    pub fn to_toml(&self) -> String {
        let leaves = table().iter().filter(|v| v.name != "scene.file");
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
