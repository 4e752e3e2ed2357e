//! All that is wrong with a scene, collected before any of it is told.

use super::{SceneError, Warning};
use crate::variables::by_name;

/// Errors in the order in which they were found.
#[derive(Debug, Default)]
pub(super) struct Problems(Vec<SceneError>);

impl Problems {
    /// Adds an error; one that stands for several adds each of them once.
    pub(super) fn add(&mut self, error: SceneError) {
        match error {
            SceneError::Several { errors } => errors.into_iter().for_each(|error| self.add(error)),
            error if self.0.contains(&error) => {}
            error => self.0.push(error),
        }
    }

    /// Adds all of `others`.
    pub(super) fn append(&mut self, others: Self) {
        others.0.into_iter().for_each(|error| self.add(error));
    }

    /// The value, if there is one; otherwise its error is added.
    pub(super) fn note<T>(&mut self, result: Result<T, SceneError>) -> Option<T> {
        result.map_err(|error| self.add(error)).ok()
    }

    /// Whether nothing is wrong.
    pub(super) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// What is wrong, as warnings of a scene that goes without it, since `so`.
    pub(super) fn as_warnings(&self, so: &str) -> Vec<Warning> {
        let warning = |error: &SceneError| match error {
            SceneError::Impossible {
                origin,
                key,
                value,
                reason,
                allowed,
            } => Some(Warning {
                origin: origin.clone(),
                key: by_name(key)?.name,
                value: value.to_string(),
                message: format!("{so} {reason}; allowed: {allowed}"),
            }),
            _ => None,
        };
        self.0.iter().filter_map(warning).collect()
    }

    /// An error where there was one, of all where there were several.
    pub(super) fn finish(mut self) -> Result<(), SceneError> {
        match self.0.len() {
            0 => Ok(()),
            1 => Err(self.0.remove(0)),
            _ => Err(SceneError::Several { errors: self.0 }),
        }
    }

    /// The value where nothing is wrong. There is one in that case; if there is none, that is told.
    pub(super) fn finish_with<T>(self, value: Option<T>) -> Result<T, SceneError> {
        self.finish()
            .and_then(|()| value.ok_or(SceneError::Unexplained))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The message was empty.
    #[test]
    fn what_is_missing_without_a_problem_is_told() {
        let error = Problems::default().finish_with(None::<()>);
        let said = error.expect_err("there is no value").to_string();
        assert!(said.contains("fault of coilwind"), "{said}");
        assert_eq!(Problems::default().finish_with(Some(1)), Ok(1));
    }
}
