//! What a refused leaf leads to: errors that hold only for the default that stands in for it.

use super::key::resolve;
use super::{Scene, SceneError, Warning};
use crate::settings::{NozzleFollows, Origin, SceneSettings};
use crate::variables::{Access, Value, Variable};

/// Shares of a default at which an error is looked for as well. Chosen: what is wrong with a third and with three times the
/// default is wrong whatever was meant.
const OTHERS: [f64; 2] = [1.0 / 3.0, 3.0];

/// The leaf that an error refused, or that its key was meant to be.
fn refused(error: &SceneError) -> Option<&'static Variable> {
    let key = match error {
        SceneError::UnknownKey { suggestion, .. } => suggestion.as_ref()?,
        SceneError::WrongUnit { stem, .. } => stem,
        SceneError::WrongType { key, .. } | SceneError::OutOfRange { key, .. } => key,
        _ => return None,
    };
    Some(resolve(key, "", &Origin::Set).ok()?.variable)
}

/// Whether an error refuses the value of the leaf that this key names, in whatever unit.
pub(super) fn refuses(error: &SceneError, name: &str) -> bool {
    let of_value = matches!(
        error,
        SceneError::WrongType { .. } | SceneError::OutOfRange { .. }
    );
    let leaf = resolve(name, "", &Origin::Set).ok();
    let leaf = leaf.map(|key| key.variable.name);
    of_value && refused(error).map(|variable| variable.name) == leaf
}

/// The key that an error is about.
fn key_of(error: &SceneError) -> Option<&str> {
    match error {
        SceneError::Impossible { key, .. } | SceneError::OutOfRange { key, .. } => Some(key),
        _ => None,
    }
}

/// Other values that a leaf might have been meant to have.
fn others(leaf: &Variable, value: &Value) -> Vec<Value> {
    let others: Vec<Value> = match value {
        Value::Real(x) => OTHERS.iter().map(|share| Value::Real(share * x)).collect(),
        Value::String(_) => leaf
            .choices
            .iter()
            .map(|choice| Value::String((*choice).to_owned()))
            .collect(),
        _ => Vec::new(),
    };
    let differs = |other: &Value| other != value && leaf.admits(other);
    others.into_iter().filter(differs).collect()
}

impl SceneSettings {
    /// [`Self::build_for`] of settings in which the leaves that these errors `found` are about have their defaults. Of what is
    /// wrong then it tells what does not hang on those defaults, and of numbers that do with which default they are.
    pub(super) fn build_without(
        &self,
        found: &[SceneError],
        follows: NozzleFollows,
    ) -> Result<(Scene, Vec<Warning>), SceneError> {
        let built = self.build_for(follows);
        let Err(error) = built else {
            return built;
        };
        let all = each(error);
        // each with the defaults that its numbers hang on
        let mut told: Vec<(&SceneError, Vec<String>)> =
            all.iter().map(|error| (error, Vec::new())).collect();
        for leaf in found.iter().filter_map(refused) {
            let Access::Parameter { get, set, .. } = leaf.access else {
                continue;
            };
            let with = format!("{} = {}", leaf.name, self.shown(leaf.name));
            for other in others(leaf, &get(self)) {
                let mut settings = self.clone();
                set(&mut settings, other);
                let then = settings.build_for(follows).err().map(each);
                let then = then.unwrap_or_default();
                let in_all = |of: &SceneError| all.iter().any(|error| key_of(error) == key_of(of));
                // (a choice that needs other keys says nothing of the rest)
                if !leaf.choices.is_empty() && !then.iter().all(in_all) {
                    continue;
                }
                told.retain(|(error, _)| then.iter().any(|then| key_of(then) == key_of(error)));
                for (error, defaults) in &mut told {
                    if !then.contains(error) && !defaults.contains(&with) {
                        defaults.push(with.clone());
                    }
                }
            }
        }
        let told = told.into_iter().map(|(error, defaults)| {
            let mut error = error.clone();
            if let SceneError::Impossible { allowed, .. } = &mut error
                && !defaults.is_empty()
            {
                *allowed = format!("{allowed} (with {})", defaults.join(", ")).into();
            }
            error
        });
        let errors = told.collect();
        Err(SceneError::Several { errors })
    }
}

/// The errors that one stands for.
fn each(error: SceneError) -> Vec<SceneError> {
    match error {
        SceneError::Several { errors } => errors,
        error => vec![error],
    }
}
