//! Scene files: TOML to settings, each leaf with the line it stands on.

use super::SceneError;
use super::assign::Given;
use super::key::{nearest, resolve, sections};
use super::problems::Problems;
use crate::settings::Origin;
use crate::settings::SceneSettings;
use crate::variables::{Value, table};
use std::collections::BTreeMap;
use std::path::Path;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Scenes inside the program, by name.
const PACKED: &[(&str, &str)] = &[
    ("fig8", include_str!("packed/fig8.toml")),
    ("fig8_gap", include_str!("packed/fig8_gap.toml")),
    ("tooth", include_str!("packed/tooth.toml")),
    ("bobbin", include_str!("packed/bobbin.toml")),
    ("fine", include_str!("packed/fine.toml")),
];

/// Names of the packed scenes.
pub fn packed_names() -> impl Iterator<Item = &'static str> {
    PACKED.iter().map(|p| p.0)
}

impl SceneSettings {
    /// A packed scene; `None` if there is none of that name.
    pub fn packed(name: &str) -> Option<Result<Self, SceneError>> {
        let (name, text) = PACKED.iter().find(|p| p.0 == name)?;
        Some(Self::from_toml_str(text, name, Path::new("")))
    }

    /// A packed scene or, if none has that name, a file. The empty name is the default scene.
    ///
    /// # Errors
    ///
    /// No such scene or unreadable file (names that come near are suggested), and what
    /// [`from_toml_str`](Self::from_toml_str) finds.
    pub fn load(name_or_path: &str) -> Result<Self, SceneError> {
        let (settings, found) = Self::load_with(name_or_path)?;
        all_or(found, settings)
    }

    /// The same, with leaves that are wrong left at their defaults and told beside the settings.
    pub(super) fn load_with(name_or_path: &str) -> Result<(Self, Vec<SceneError>), SceneError> {
        if name_or_path.is_empty() {
            return Ok((Self::default(), Vec::new()));
        }
        if let Some((_, text)) = PACKED.iter().find(|p| p.0 == name_or_path) {
            return Self::read(text, name_or_path, Path::new(""));
        }
        let path = Path::new(name_or_path);
        let text = std::fs::read_to_string(path).map_err(|error| match error.kind() {
            std::io::ErrorKind::NotFound => SceneError::NotFound {
                name: name_or_path.into(),
                packed: packed_names().collect::<Vec<_>>().join(", ").into(),
                suggestion: nearest(name_or_path, packed_names()).map(Into::into),
            },
            _ => SceneError::Unreadable {
                file: name_or_path.into(),
                reason: error.to_string().into(),
            },
        })?;
        Self::read(&text, name_or_path, path.parent().unwrap_or(Path::new("")))
    }

    /// Reads a scene from a TOML text; leaves that it does not give keep their defaults.
    ///
    /// Messages name `file_name`; paths in the text are relative to `base_dir`.
    ///
    /// # Errors
    ///
    /// Text that is no TOML, an unknown section or key, a value of the wrong kind or outside its range, each with
    /// file and line.
    pub fn from_toml_str(text: &str, file_name: &str, base_dir: &Path) -> Result<Self, SceneError> {
        let (settings, found) = Self::read(text, file_name, base_dir)?;
        all_or(found, settings)
    }

    /// The same, with leaves that are wrong left at their defaults and told beside the settings.
    fn read(
        text: &str,
        file_name: &str,
        base_dir: &Path,
    ) -> Result<(Self, Vec<SceneError>), SceneError> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let at = |offset: Option<usize>| Origin::File {
            file: file_name.into(),
            line: offset.map(|o| 1 + text.bytes().take(o).filter(|&b| b == b'\n').count()),
        };
        let table = DeTable::parse(text).map_err(|error| {
            let start = error.span().map(|span| span.start);
            let hint = match start.is_some_and(|start| is_decimal_comma(text, start)) {
                true => "; write a point for a decimal comma",
                false => "",
            };
            SceneError::Syntax {
                origin: at(start),
                message: format!("{}{hint}", error.message()).into(),
            }
        })?;

        let mut settings = Self {
            name: Path::new(file_name).file_stem().map_or_else(
                || file_name.to_owned(),
                |stem| stem.to_string_lossy().into_owned(),
            ),
            file: file_name.to_owned(),
            ..Self::default()
        };
        let mut first_key = BTreeMap::new();
        let mut leaf = |settings: &mut Self, key: &str, offset, value: &DeValue<'_>| {
            let (origin, given) = (at(Some(offset)), given(value));
            let name = resolve(key, &given.to_string(), &origin)?.variable.name;
            if let Some(first) = first_key.insert(name, key.to_owned()) {
                return Err(SceneError::Repeated {
                    origin,
                    key: key.into(),
                    value: given.to_string().into(),
                    leaf: name.into(),
                    first: first.into(),
                });
            }
            settings.set_from(key, given, origin)
        };

        // Mistakes are told in the order of the file.
        let mut found = Vec::new();
        for (key, value) in in_file_order(table.get_ref()) {
            let (name, offset) = (key.get_ref().as_ref(), key.span().start);
            match value.get_ref() {
                DeValue::Table(section) if sections().contains(&name) => {
                    for (path, offset, value) in leaves(name, section) {
                        found.extend(leaf(&mut settings, &path, offset, value).err());
                    }
                }
                DeValue::Table(_) => {
                    found.push(SceneError::UnknownSection {
                        origin: at(Some(offset)),
                        section: name.into(),
                        suggestion: nearest(name, sections().into_iter())
                            .map(|s| format!("[{s}]").into()),
                        allowed: sections().join(", ").into(),
                    });
                }
                value => found.extend(leaf(&mut settings, name, offset, value).err()),
            }
        }

        for file in settings.files_mut() {
            if !file.is_empty() {
                *file = from_anywhere(&base_dir.join(&*file));
            }
        }
        Ok((settings, found))
    }
}

/// Whether a text has a comma between two digits at this place or right before it.
fn is_decimal_comma(text: &str, start: usize) -> bool {
    let bytes = text.as_bytes();
    let digit = |at: usize| bytes.get(at).is_some_and(u8::is_ascii_digit);
    let comma = |at: usize| bytes.get(at) == Some(&b',') && digit(at + 1);
    (start.saturating_sub(1)..=start).any(|at| at > 0 && comma(at) && digit(at - 1))
}

/// A path that means the same from any folder. Results and saved states are read elsewhere.
pub(super) fn from_anywhere(path: &Path) -> String {
    let whole = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    whole.to_string_lossy().into_owned()
}

/// The settings, or all that is wrong with them.
fn all_or(found: Vec<SceneError>, settings: SceneSettings) -> Result<SceneSettings, SceneError> {
    let mut problems = Problems::default();
    found.into_iter().for_each(|error| problems.add(error));
    problems.finish().map(|()| settings)
}

/// Paths, places in the file and values of a section, in the order of the file; `[core.flange]` is a part of `[core]`.
fn leaves<'t, 'i>(name: &str, section: &'t DeTable<'i>) -> Vec<(String, usize, &'t DeValue<'i>)> {
    let mut found = Vec::new();
    for (key, value) in in_file_order(section) {
        let path = format!("{name}.{}", key.get_ref());
        match value.get_ref() {
            DeValue::Table(part) if is_part(&path) => found.extend(leaves(&path, part)),
            value => found.push((path, key.span().start, value)),
        }
    }
    found
}

/// Whether some leaves stand in a part of a section of this name.
fn is_part(path: &str) -> bool {
    let inside = |name: &str| {
        name.strip_prefix(path)
            .is_some_and(|rest| rest.starts_with('.'))
    };
    table().iter().any(|v| inside(v.name))
}

fn in_file_order<'t, 'i>(
    table: &'t DeTable<'i>,
) -> Vec<(
    &'t Spanned<std::borrow::Cow<'i, str>>,
    &'t Spanned<DeValue<'i>>,
)> {
    let mut entries: Vec<_> = table.iter().collect();
    entries.sort_by_key(|(key, _)| key.span().start);
    entries
}

/// Numbers stay text, so that a unit can shift their decimal exponent exactly.
fn given(value: &DeValue<'_>) -> Given<'static> {
    match value {
        DeValue::String(text) => Given::Value(Value::String(text.to_string())),
        DeValue::Boolean(b) => Given::Value(Value::Boolean(*b)),
        DeValue::Float(x) => Given::Number(x.as_str().to_owned()),
        DeValue::Integer(i) if i.radix() == 10 => Given::Number(i.as_str().to_owned()),
        DeValue::Integer(i) => match i64::from_str_radix(i.as_str(), i.radix()) {
            Ok(number) => Given::Number(number.to_string()),
            Err(_) => Given::Other(i.as_str().to_owned(), "no number"),
        },
        DeValue::Datetime(date) => Given::Other(date.to_string(), "a date"),
        DeValue::Array(list) => match numbers(list) {
            Some(text) => Given::List(text),
            None => Given::Other("[...]".to_owned(), "a list"),
        },
        DeValue::Table(_) => Given::Other("{...}".to_owned(), "a section"),
    }
}

/// A list of numbers, or of such lists, as a text that reads like it.
fn numbers(list: &[Spanned<DeValue<'_>>]) -> Option<String> {
    let texts: Option<Vec<String>> = list
        .iter()
        .map(|value| match value.get_ref() {
            DeValue::Array(inner) => numbers(inner),
            DeValue::Float(x) => Some(x.as_str().to_owned()),
            DeValue::Integer(i) if i.radix() == 10 => Some(i.as_str().to_owned()),
            _ => None,
        })
        .collect();
    Some(format!("[{}]", texts?.join(", ")))
}
