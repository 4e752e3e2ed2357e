//! Keys as people write them: exact, with a unit, or nearly right.

use super::SceneError;
use super::problems::Problems;
use crate::settings::Origin;
use crate::variables::{Access, Kind, Scale, Variable, by_name, split_suffix, suffixes_of, table};
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

/// Similarity (Jaro-Winkler) from which a guess helps more than it misleads; chosen.
const SIMILAR: f64 = 0.8;

/// Letters of the shortest key that one wrong letter leaves recognisable; chosen.
const SHORTEST: usize = 3;

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

/// A key that is no leaf, taken apart.
struct Unknown<'a> {
    /// as given
    name: &'a str,
    section: &'a str,
    /// after the section
    leaf: &'a str,
    /// the same without its unit, where it ends in one
    stem: &'a str,
    /// the unit that it ends in, in SI
    unit: Option<&'static str>,
}

impl<'a> Unknown<'a> {
    fn new(name: &'a str, split: Option<(&'a str, &'static str, Scale)>) -> Self {
        let (section, leaf) = name.split_once('.').unwrap_or(("", name));
        let stem = split.map_or(leaf, |(stem, ..)| {
            stem.split_once('.').map_or(stem, |(_, leaf)| leaf)
        });
        Self {
            name,
            section,
            leaf,
            stem,
            unit: split.map(|(_, unit, _)| unit),
        }
    }

    /// The leaves of the section, with their variables.
    fn siblings(&self) -> impl Iterator<Item = (&'static str, &'static Variable)> {
        parameters().filter_map(|variable| {
            let (section, leaf) = variable.name.split_once('.')?;
            (section == self.section).then_some((leaf, variable))
        })
    }

    /// The leaves of the section that can have the unit that was given; all of them without one.
    fn of_unit(&self) -> impl Iterator<Item = &'static str> {
        let fits = |v: &Variable| self.unit.is_none_or(|unit| v.unit == unit);
        self.siblings()
            .filter_map(move |(leaf, v)| fits(v).then_some(leaf))
    }

    /// A leaf of the section as it would be written, with the unit that was given.
    fn written(&self, leaf: &str) -> String {
        let unit = &self.leaf[self.stem.len()..];
        format!("{}.{leaf}{unit}", self.section)
    }

    /// The key that was meant, as far as one can guess. A key of the same section is nearer than any other.
    fn suggestion(&self) -> Option<String> {
        let in_section = || nearest(self.stem, self.in_section()).map(|leaf| self.written(leaf));
        let misspelt_unit = || {
            let found = nearest(self.leaf, self.siblings().map(|(leaf, _)| leaf))?;
            Some(format!("{}.{found}", self.section))
        };
        let of_word = || self.of_same_word().map(|leaf| self.written(leaf));
        let elsewhere = || {
            // The right leaf in the wrong section, or a name without one.
            let same_leaf =
                |v: &&Variable| matches!(v.name.split_once('.'), Some((_, l)) if l == self.stem);
            parameters().find(same_leaf).map(|v| v.name.to_owned())
        };
        let similar = || nearest(self.name, parameters().map(|v| v.name)).map(str::to_owned);
        self.section_itself()
            .or_else(|| self.of_half_or_double())
            .or_else(|| self.of_same_axis().map(|leaf| self.written(leaf)))
            .or_else(|| self.of_one_letter().map(|leaf| self.written(leaf)))
            .or_else(of_word)
            .or_else(in_section)
            .or_else(misspelt_unit)
            .or_else(elsewhere)
            .or_else(similar)
    }

    /// A section that was given like a key.
    fn section_itself(&self) -> Option<String> {
        let section = sections().into_iter().find(|name| *name == self.name)?;
        Some(format!("[{section}] with keys under it"))
    }

    /// The radius where a diameter was given, and the reverse.
    fn of_half_or_double(&self) -> Option<String> {
        let (leaf, share) = match self.stem.contains("diameter") {
            true => (self.stem.replace("diameter", "radius"), "half the diameter"),
            false => (self.stem.replace("radius", "diameter"), "twice the radius"),
        };
        let found = self.of_unit().any(|sibling| sibling == leaf);
        (leaf != self.stem && found).then(|| format!("{}, {share}", self.written(&leaf)))
    }

    /// The only leaf along the axis that the key ends in: the word before it may name another side, as in `width_z`.
    fn of_same_axis(&self) -> Option<&'static str> {
        let axis = |text: &str| {
            let (before, axis) = text.rsplit_once('_')?;
            let table = before.rsplit_once('.').map_or("", |(table, _)| table);
            matches!(axis, "x" | "y" | "z").then(|| (table.to_owned(), axis.to_owned()))
        };
        let wanted = axis(self.stem)?;
        let mut along = self
            .of_unit()
            .filter(|leaf| axis(leaf).as_ref() == Some(&wanted));
        along.next().filter(|_| along.next().is_none())
    }

    /// A leaf of the section that is one letter away, or two letters that stand the other way round.
    fn of_one_letter(&self) -> Option<&'static str> {
        let short = self.stem.chars().count() < SHORTEST;
        let near = |leaf: &&str| !short && strsim::damerau_levenshtein(self.stem, leaf) == 1;
        self.in_section().find(near)
    }

    /// The leaves of the section that can have the unit that was given; without one also its tables.
    fn in_section(&self) -> impl Iterator<Item = &'static str> {
        let tables = self
            .siblings()
            .filter_map(|(leaf, _)| leaf.rsplit_once('.'));
        let tables = tables.map(|(table, _)| table);
        self.of_unit().chain(tables.filter(|_| self.unit.is_none()))
    }

    /// The first leaf of the section that has each word of the key among its own.
    fn of_same_word(&self) -> Option<&'static str> {
        let words = |text: &'a str| text.split(['.', '_']).filter(|word| !word.is_empty());
        self.of_unit()
            .find(|leaf| words(self.stem).all(|word| leaf.split(['.', '_']).any(|w| w == word)))
    }
}

/// What a file can hold: `scene.file` names one.
fn parameters() -> impl Iterator<Item = &'static Variable> {
    let in_file = |v: &&Variable| is_leaf(v) && v.name != "scene.file";
    table().iter().filter(in_file)
}

fn unknown(
    name: &str,
    value: &str,
    origin: &Origin,
    split: Option<(&str, &'static str, Scale)>,
) -> SceneError {
    let key = Unknown::new(name, split);
    let siblings: Vec<_> = key.siblings().map(|(leaf, _)| leaf).collect();
    let allowed = if siblings.is_empty() {
        format!("sections are {}", sections().join(", "))
    } else {
        format!("keys of [{}]: {}", key.section, siblings.join(", "))
    };
    SceneError::UnknownKey {
        origin: origin.clone(),
        key: name.into(),
        value: value.into(),
        suggestion: key.suggestion().map(Into::into),
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

/// An error where one of these names means a leaf that another means in another unit: which counts would be no one's choice. Of one name
/// twice the last counts, as of other options. A name that means no leaf is no matter of this.
///
/// # Errors
/// All such names, each with the one that came first.
pub fn refuse_repeated(set: &[(String, String)]) -> Result<(), SceneError> {
    let mut problems = Problems::default();
    let mut first: BTreeMap<_, (&str, &str)> = BTreeMap::new();
    for (name, value) in set {
        let Ok(key) = resolve(name, value, &Origin::Set) else {
            continue;
        };
        let leaf = key.variable.name;
        match first.entry(leaf) {
            Entry::Vacant(place) => {
                place.insert((name, value));
            }
            Entry::Occupied(place) if place.get().0 == name => {}
            Entry::Occupied(place) => problems.add(SceneError::Repeated {
                origin: Origin::Set,
                key: name.as_str().into(),
                value: value.as_str().into(),
                leaf: leaf.into(),
                first: format!("{} = {}", place.get().0, place.get().1).into(),
            }),
        }
    }
    problems.finish()
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
