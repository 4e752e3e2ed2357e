//! The copy of `modelDescription.xml` in the repository is current.
//!
//! It shows in a review what a change does to importers.

use coilwind_model_description::model_description;
use std::path::Path;

/// Set this to write the copy instead of comparing it.
const REFRESH: &str = "COILWIND_REFRESH_GOLDEN";

#[test]
fn copy_in_the_repository_is_current() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("modelDescription.xml");
    let current = model_description().expect("default scene is valid");
    if std::env::var_os(REFRESH).is_some() {
        std::fs::write(&path, &current).expect("copy can be written");
        return;
    }
    let copy = std::fs::read_to_string(&path).unwrap_or_default();
    let first = copy.lines().zip(current.lines()).position(|(a, b)| a != b);
    assert!(
        copy == current,
        "modelDescription.xml in the repository is out of date from line {}; refresh it with\n  \
         {REFRESH}=1 cargo test -p coilwind-model-description --test golden\nand commit it",
        first.unwrap_or_else(|| copy.lines().count().min(current.lines().count())) + 1
    );
}
