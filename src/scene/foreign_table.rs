//! Tables as programs of other countries write them.

/// What helps a table from another country.
pub const WITH_COMMAS: &str = "save it with commas between columns and points in numbers";

/// What stands between the columns of a `header` that was split at commas, where it is something else, and what would do.
pub fn foreign_separator(header: &csv::StringRecord) -> Option<String> {
    let first = header.get(0)?;
    let marks = [(';', "semicolons"), ('\t', "tabs")];
    let (_, name) = marks.into_iter().find(|(mark, _)| first.contains(*mark))?;
    Some(format!("{name} stand between its columns; {WITH_COMMAS}"))
}
