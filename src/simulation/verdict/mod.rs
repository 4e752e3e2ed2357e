//! What is said of a whole run: its numbers, the coil as a product, and whether either can be trusted.

mod judgement;
mod product;
mod sharp_bend;
mod summary;
mod thinned;

pub use product::{Fill, Product};
pub(super) use sharp_bend::strain_outside;
pub use summary::{EnergySummary, PenetrationSummary, Summary};
