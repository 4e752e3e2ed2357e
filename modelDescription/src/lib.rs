//! What an importer reads before it loads the FMU: `modelDescription.xml` and the archive round it.
//!
//! Everything is derived from the core's variable table, so the XML cannot disagree with the
//! getters and setters of the C boundary. The boundary uses this crate for the two names both must
//! know: the [`guid()`] and the [`CATEGORIES`] of log messages.
#![forbid(unsafe_code)]

mod categories;
mod document;
mod error;
mod guid;
mod licenses;
mod pack;
mod structure;
mod units;
mod xml;

pub use categories::{CATEGORIES, Category};
pub use document::document;
pub use error::{DescriptionError, PackError};
pub use guid::guid;
pub use licenses::{LicenseError, third_party};
pub use pack::{Contents, pack, platform_of};
pub use xml::model_description;

use coilwind::variables::{Variable, table};

/// Name of the shared library inside the FMU, without extension; prefix of nothing else, as the
/// functions of a binary FMU 2.0 carry no prefix.
pub const MODEL_IDENTIFIER: &str = "CoilWinding";

/// The rows of the variable table that importers see.
///
/// The programmes of `coilwind run` are not among them: speed and traverse are inputs here.
pub fn variables() -> impl Iterator<Item = &'static Variable> {
    table().iter().filter(|variable| !variable.native_only)
}
