//! Arguments that take one of a few words.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};

/// Parser of one of these words: (word, meaning in the help, value).
pub(super) fn one_of<T>(
    choices: &'static [(&'static str, &'static str, T)],
) -> impl TypedValueParser<Value = T>
where
    T: Copy + Send + Sync + 'static,
{
    let words = choices
        .iter()
        .map(|(word, meaning, _)| PossibleValue::new(*word).help(*meaning));
    PossibleValuesParser::new(words).try_map(move |given| {
        choices
            .iter()
            .find(|(word, _, _)| word.eq_ignore_ascii_case(&given))
            .map(|(_, _, value)| *value)
            .ok_or_else(|| format!("{given} is none of the words"))
    })
}
