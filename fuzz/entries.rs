//! What the fuzzer calls with arbitrary bytes, and what must hold whatever they are.
//!
//! Shared by the fuzz targets and by the tests that run with every `cargo test`.

use coilwind::geometry::stl;
use coilwind::settings::SceneSettings;
use std::io::Cursor;
use std::path::Path;

/// A scene file: an error that says something, or settings that survive being written and read.
pub fn scene(bytes: &[u8]) {
    let text = String::from_utf8_lossy(bytes);
    let read = |text: &str| SceneSettings::from_toml_str(text, "fuzzed.toml", Path::new(""));
    match read(&text) {
        Err(error) => assert!(!error.to_string().is_empty()),
        Ok(settings) => {
            let written = settings.to_toml();
            let again = read(&written)
                .unwrap_or_else(|error| panic!("{error}\nwhat was written:\n{written}"));
            assert_eq!(again.to_toml(), written);
        }
    }
}

/// An STL file: an error that says something, or a mesh with an inside and unit normals.
pub fn stl_file(bytes: &[u8]) {
    match stl::read(&mut Cursor::new(bytes), 1e-3) {
        Err(error) => assert!(!error.to_string().is_empty()),
        Ok(mesh) => {
            assert!(mesh.volume() > 0.0 && mesh.volume().is_finite());
            for triangle in 0..mesh.len() {
                let length = mesh.normal(triangle as u32).norm();
                assert!((length - 1.0).abs() < 1e-6, "normal of length {length}");
            }
        }
    }
}
