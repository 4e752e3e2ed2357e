//! What an importer reads before it loads the FMU: `modelDescription.xml` and the archive round it.
//!
//! | module | holds |
//! |---|---|
//! | `variables`, `categories` | the variables and log categories that importers see |
//! | `format` | values as the XML writes them |
//! | `units`, `structure`, `xml` | parts of `modelDescription.xml` and the whole file |
//! | `guid`, `description` | the identity of the file, and the file with it |
//! | `document` | the page for people |
//! | `licenses` | the licences of linked crates |
//! | `pack` | the archive |
//! | `error` | what can go wrong |
//!
//! Everything is derived from the core's variable table, so that the XML cannot disagree with the
//! getters and setters of the C boundary. The boundary uses this crate for what both must know:
//! the [`guid()`], the [`variables()`] and the [`Category`] of a log message.
#![forbid(unsafe_code)]

mod categories;
mod description;
mod document;
mod error;
mod format;
mod guid;
mod licenses;
mod pack;
mod structure;
mod units;
mod variables;
mod xml;

pub use categories::Category;
pub use description::{guid, model_description};
pub use document::document;
pub use error::{DescriptionError, LicenseError, PackError};
pub use licenses::third_party;
pub use pack::{Contents, pack};
pub use variables::variables;
pub use xml::{DEFAULT_STOP_TIME, DEFAULT_TOLERANCE};
