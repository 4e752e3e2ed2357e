//! The rows of the core's variable table that the FMU has.

use coilwind::variables::{Variable, table};

/// Returns the variables that importers see, in the order of the table.
///
/// The spindle's motion profile of `coilwind run` is not among them: speed is an input here.
pub fn variables() -> impl Iterator<Item = &'static Variable> {
    table().iter().filter(|variable| !variable.native_only)
}
