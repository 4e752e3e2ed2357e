//! Banded symmetric linear equations of the implicit method.

mod ldl;

pub use ldl::{Banded, SingularPivot};
