//! Symmetric block-banded equations of the implicit method, factored as `L D L^T` from both ends at
//! once.
//!
//! The matrix couples node `i` with itself, `i + 1` and `i + 2` in blocks of `D x D`, as bending of
//! a rod does.
//! In a one-ended elimination each pivot needs the one before, so that its division and products
//! cannot overlap with anything.
//! Here the chain is folded in the middle instead (a twisted factorisation). Step `s` eliminates
//! node `s` and node `nodes - 1 - s` together, in the two lanes of one `Pair`. Two or three
//! nodes are left, which are factored as a small dense matrix.
//! The lanes never meet before that, so every operation on a `Pair` maps to one two-wide
//! instruction of the baseline instruction set, without padding and with the symmetry fully used.
//! Compiled for what the machine has ([`crate::math::simd::run`]), neighbouring pairs go four wide,
//! with the same bits.
//!
//! Symbols: `w` is a row of the matrix right of its pivot when its turn comes, `l = w / pivot` the
//! same row of `L^T`.
//!
//! * `banded`: storage, entries, product with a vector
//! * `factor`: factorisation, and the error of a singular pivot
//! * `solve`: forward and backward substitution
//! * `pair`: two numbers worked on together

mod banded;
mod factor;
mod pair;
mod solve;
#[cfg(test)]
mod tests;

pub use banded::Banded;
#[cfg(any(test, feature = "lab"))]
pub use factor::SingularPivot;
