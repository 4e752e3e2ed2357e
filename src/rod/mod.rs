//! The wire as a discrete rod: section law, stretch, bend and twist.

mod section;

pub use section::Section;
