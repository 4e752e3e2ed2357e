//! The way of messages to the importer: which ones it wants, and the call of its logger.

use crate::error::Error;
use crate::ffi::{Status, fmi2CallbackFunctions, fmi2CallbackLogger, fmi2ComponentEnvironment};
use crate::message::Message;
use coilwind_model_description::Category;
use std::ffi::CString;
use std::sync::Arc;

/// The messages that the importer asked for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Filter {
    on: bool,
    /// The categories that are on; `None` stands for all of them.
    categories: Option<Vec<Category>>,
}

impl Filter {
    /// Returns the filter of `loggingOn` in `fmi2Instantiate`, for all categories.
    pub(crate) fn new(on: bool) -> Self {
        Self {
            on,
            categories: None,
        }
    }

    /// Returns the filter of the arguments of `fmi2SetDebugLogging`. No names stand for all
    /// categories.
    ///
    /// # Errors
    ///
    /// [`Error::UnknownCategory`] for a name that is not declared.
    pub(crate) fn with(on: bool, names: &[String]) -> Result<Self, Error> {
        let categories = names
            .iter()
            .map(|name| {
                Category::by_name(name).ok_or_else(|| Error::UnknownCategory { name: name.clone() })
            })
            .collect::<Result<Vec<_>, _>>()?;
        let all = categories.is_empty() || categories.contains(&Category::All);
        Ok(Self {
            on,
            categories: (!all).then_some(categories),
        })
    }

    /// Tells whether a message goes to the importer.
    ///
    /// Errors and discarded steps always do, since nobody can act on the status without the
    /// reason. Other messages do where their category is on.
    pub(crate) fn passes(&self, message: &Message) -> bool {
        message.status >= Status::Discard
            || self.on
                && self
                    .categories
                    .as_ref()
                    .is_none_or(|wanted| wanted.contains(&message.category))
    }
}

/// The importer's side of an instance.
#[derive(Clone, Debug)]
pub(crate) struct Host {
    logger: Option<fmi2CallbackLogger>,
    environment: fmi2ComponentEnvironment,
    name: Arc<CString>,
}

impl Host {
    /// Keeps the name and the callbacks that `fmi2Instantiate` got.
    ///
    /// # Safety
    ///
    /// The logger must be callable with the environment for as long as this or a clone lives.
    pub(crate) unsafe fn new(name: &str, callbacks: Option<&fmi2CallbackFunctions>) -> Self {
        Self {
            logger: callbacks.and_then(|callbacks| callbacks.logger),
            environment: callbacks.map_or(std::ptr::null_mut(), |callbacks| {
                callbacks.componentEnvironment
            }),
            name: Arc::new(c_string(name)),
        }
    }

    /// Calls the logger once per message, if the importer has one.
    pub(crate) fn deliver(&self, messages: &[Message]) {
        let Some(logger) = self.logger else { return };
        for message in messages {
            let (category, text) = (c_string(message.category.name()), c_string(&message.text));
            // SAFETY: `new` was promised a callable logger. It gets pointers that live through the
            // call, and "%s" with its one argument, so nothing in the text is read as a format.
            unsafe {
                logger(
                    self.environment,
                    self.name.as_ptr(),
                    message.status.code(),
                    category.as_ptr(),
                    c"%s".as_ptr(),
                    text.as_ptr(),
                );
            }
        }
    }
}

/// Returns a C string. NULs inside the text are left out.
pub(crate) fn c_string(text: &str) -> CString {
    let bytes: Vec<u8> = text.bytes().filter(|byte| *byte != 0).collect();
    CString::new(bytes).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(status: Status, category: Category) -> Message {
        Message {
            status,
            category,
            text: String::new(),
        }
    }

    #[test]
    fn errors_always_pass_the_rest_where_switched_on() {
        let error = message(Status::Error, Category::Error);
        let event = message(Status::Ok, Category::Events);
        let slack = message(Status::Warning, Category::Warning);
        let passed = |filter: &Filter| [&error, &event, &slack].map(|m| filter.passes(m));
        assert_eq!(passed(&Filter::new(false)), [true, false, false]);
        assert_eq!(passed(&Filter::new(true)), [true, true, true]);
        let some = Filter::with(true, &["logEvents".to_owned()]).expect("declared");
        assert_eq!(passed(&some), [true, true, false]);
        let all = Filter::with(true, &["logAll".to_owned()]).expect("declared");
        assert_eq!(passed(&all), [true, true, true]);
        let off = Filter::with(false, &["logEvents".to_owned()]).expect("declared");
        assert_eq!(passed(&off), [true, false, false]);
        assert!(Filter::with(true, &["logNonsense".to_owned()]).is_err());
    }

    #[test]
    fn nuls_are_left_out() {
        assert_eq!(c_string("a\0b%s\0").as_c_str(), c"ab%s");
    }

    #[test]
    fn nobody_listens_without_a_logger() {
        // SAFETY: without callbacks nothing is ever called.
        let host = unsafe { Host::new("x", None) };
        host.deliver(&[message(Status::Error, Category::Error)]);
        assert_eq!(host.name.as_c_str(), c"x");
    }
}
