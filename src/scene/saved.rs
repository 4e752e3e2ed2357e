//! Settings in a saved state: every leaf of the variable table with its origin.
//!
//! Numbers are stored by their bits, unlike in a scene file. Leaves at their defaults are stored
//! too, because another version's defaults may differ.

use crate::settings::Origin;
use crate::settings::SceneSettings;
use crate::variables::{Access, Value, by_reference, table};
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Name and file, then each leaf with its reference, value and origin, unless it is the default.
type Saved = (String, String, Vec<(u32, Value, Option<Origin>)>);

impl Serialize for SceneSettings {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let leaves = table().iter().filter_map(|v| match v.access {
            Access::Parameter { get, .. } => {
                Some((v.reference, get(self), self.origins.get(v.name).cloned()))
            }
            Access::Input { .. } | Access::Output(_) | Access::Choice(_) => None,
        });
        let saved: Saved = (self.name.clone(), self.file.clone(), leaves.collect());
        saved.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for SceneSettings {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let (name, file, leaves) = Saved::deserialize(deserializer)?;
        let mut settings = Self::default();
        for (reference, value, origin) in leaves {
            let variable = by_reference(reference)
                .ok_or_else(|| D::Error::custom(format!("no parameter {reference}")))?;
            let Access::Parameter { set, .. } = variable.access else {
                let name = variable.name;
                return Err(D::Error::custom(format!("{name} is no parameter")));
            };
            if value.kind() != variable.kind {
                let name = variable.name;
                return Err(D::Error::custom(format!(
                    "{name} = {value} is of the wrong type"
                )));
            }
            set(&mut settings, value);
            if let Some(origin) = origin {
                settings.origins.insert(variable.name, origin);
            }
        }
        (settings.name, settings.file) = (name, file);
        Ok(settings)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_come_back_as_they_were() {
        let mut settings = SceneSettings::load("fig8").expect("packed");
        for (name, value) in [
            ("wire.diameter_mm", "0.35"),
            ("friction.kinetic", "0.123456789012345678"),
            ("solver.integrator", "verlet"),
            ("output.directory", "results ü"),
        ] {
            settings.set_text(name, value).expect("a setting");
        }
        for settings in [SceneSettings::default(), settings] {
            let bytes = postcard::to_stdvec(&settings).expect("written");
            let back: SceneSettings = postcard::from_bytes(&bytes).expect("read");
            assert_eq!(back, settings);
        }
    }

    #[test]
    fn what_is_no_parameter_is_refused() {
        for (reference, value) in [(4_000_000_000, Value::Real(1.0)), (100, Value::Real(1.0))] {
            let saved: Saved = (String::new(), String::new(), vec![(reference, value, None)]);
            let bytes = postcard::to_stdvec(&saved).expect("written");
            assert!(postcard::from_bytes::<SceneSettings>(&bytes).is_err());
        }
    }
}
