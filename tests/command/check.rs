//! What `coilwind check` says of a scene that is possible.

use crate::stl::write_revolved;
use std::process::Command;

/// A part that was drawn along z, or in another unit, passed without a word of how large it is.
#[test]
fn check_says_how_large_a_mesh_is() {
    let folder = tempfile::tempdir().unwrap();
    let outline = [[-4.0, 6.0], [14.0, 6.0]];
    write_revolved(&folder.path().join("barrel.stl"), &outline, 360);
    let scene = folder.path().join("barrel.toml");
    std::fs::write(
        &scene,
        "[core]\nshape = 'mesh'\nfile = 'barrel.stl'\n[nozzle]\ndistance_mm = 30\n",
    )
    .unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_coilwind"))
        .arg("check")
        .arg(&scene)
        .output()
        .unwrap();
    let said = String::from_utf8(output.stdout).unwrap();
    let size = "mesh: 12 x 18 x 12 mm along x, y, z; its axis is y, from -4 to 14 mm\n";
    assert!(said.contains(size), "{said}");
}
