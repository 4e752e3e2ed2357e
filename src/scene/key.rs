//! Keys as people write them: exact, with a unit, or nearly right.

use super::SceneError;
use crate::settings::Origin;
use crate::variables::{Access, Kind, Scale, Variable, by_name, split_suffix, suffixes_of, table};

/// Similarity (Jaro-Winkler) from which a guess helps more than it misleads; chosen.
const SIMILAR: f64 = 0.8;

/// A key understood: the row, and how the number becomes SI.
pub(super) struct Key {
    pub(super) variable: &'static Variable,
    pub(super) scale: Scale,
}

/// Finds the parameter that `name` means; `value` only serves the message.
pub(super) fn resolve(name: &str, value: &str, origin: &Origin) -> Result<Key, SceneError> {
    if let Some(variable) = parameter(name) {
        return Ok(Key {
            variable,
            scale: Scale::Tens(0),
        });
    }
    let split = split_suffix(name);
    if let Some((stem, unit, scale)) = split
        && let Some(variable) = parameter(stem)
    {
        if variable.unit == unit {
            return Ok(Key { variable, scale });
        }
        let with_unit = |s: (&str, Scale)| format!("{stem}_{}", s.0);
        let allowed: Vec<_> = std::iter::once(stem.to_owned())
            .chain(suffixes_of(variable.unit).map(with_unit))
            .collect();
        return Err(SceneError::WrongUnit {
            origin: origin.clone(),
            key: name.into(),
            value: value.into(),
            stem: stem.into(),
            allowed: allowed.join(", ").into(),
        });
    }
    Err(unknown(name, value, origin, split))
}

/// Whether a variable is a leaf of a scene.
fn is_leaf(variable: &Variable) -> bool {
    matches!(variable.access, Access::Parameter { .. })
}

fn parameter(name: &str) -> Option<&'static Variable> {
    by_name(name).filter(|v| is_leaf(v))
}

/// The sections of a scene file, in the order of the table.
pub(super) fn sections() -> Vec<&'static str> {
    let mut sections = Vec::new();
    for variable in table().iter().filter(|v| is_leaf(v)) {
        if let Some((section, _)) = variable.name.split_once('.')
            && section != "scene"
            && !sections.contains(&section)
        {
            sections.push(section);
        }
    }
    sections
}

/// The most similar of some names, if it is similar enough.
pub(super) fn nearest<'a>(name: &str, names: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    names
        .map(|candidate| (strsim::jaro_winkler(name, candidate), candidate))
        .filter(|(similarity, _)| *similarity >= SIMILAR)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, candidate)| candidate)
}

fn unknown(
    name: &str,
    value: &str,
    origin: &Origin,
    split: Option<(&str, &'static str, Scale)>,
) -> SceneError {
    let parameters = || table().iter().filter(|v| is_leaf(v));
    let (section, leaf) = name.split_once('.').unwrap_or(("", name));
    let in_section = |v: &&Variable| {
        v.name
            .split_once('.')
            .is_some_and(|(head, _)| head == section)
    };
    let siblings: Vec<_> = parameters()
        .filter(in_section)
        .filter_map(|v| Some(v.name.split_once('.')?.1))
        .collect();

    // With a unit, look for the stem among leaves that can have it, and give the unit back.
    let with_unit = split.and_then(|(stem, unit, _)| {
        let (_, stem_leaf) = stem.split_once('.')?;
        let of_unit = parameters().filter(in_section).filter(|v| v.unit == unit);
        let found = nearest(
            stem_leaf,
            of_unit.filter_map(|v| Some(v.name.split_once('.')?.1)),
        )?;
        Some(format!("{section}.{found}{}", &name[stem.len()..]))
    });
    let suggestion = with_unit
        .or_else(|| {
            let found = nearest(leaf, siblings.iter().copied())?;
            Some(format!("{section}.{found}"))
        })
        .or_else(|| {
            // The right leaf in the wrong section, or a name without one.
            let stem = split.map_or(leaf, |(s, ..)| s.split_once('.').map_or(s, |(_, l)| l));
            let same_leaf = |v: &&Variable| v.name.split_once('.').is_some_and(|(_, l)| l == stem);
            parameters().find(same_leaf).map(|v| v.name.to_owned())
        })
        .or_else(|| nearest(name, parameters().map(|v| v.name)).map(str::to_owned));
    let allowed = if siblings.is_empty() {
        format!("sections are {}", sections().join(", "))
    } else {
        format!("keys of [{section}]: {}", siblings.join(", "))
    };
    SceneError::UnknownKey {
        origin: origin.clone(),
        key: name.into(),
        value: value.into(),
        suggestion: suggestion.map(Into::into),
        allowed: allowed.into(),
    }
}

/// The unit suffixes that a key of this variable may carry, for listings.
pub fn unit_suffixes(variable: &Variable) -> Vec<&'static str> {
    if variable.kind != Kind::Real || !is_leaf(variable) {
        return Vec::new();
    }
    suffixes_of(variable.unit).map(|s| s.0).collect()
}

/// Name and value of `NAME=VALUE`, as `--set` takes it.
pub fn assignment(text: &str) -> Result<(String, String), String> {
    match text.split_once('=') {
        Some((name, value)) if !name.trim().is_empty() => {
            Ok((name.trim().to_owned(), value.to_owned()))
        }
        _ => Err("expected NAME=VALUE".to_owned()),
    }
}
