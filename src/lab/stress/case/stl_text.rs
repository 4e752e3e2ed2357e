//! Writes triangles as ASCII STL in mm.

use std::fmt::Write;

/// A file that grows.
pub(super) struct StlText {
    name: &'static str,
    text: String,
}

impl StlText {
    pub(super) fn new(name: &'static str) -> Self {
        Self {
            name,
            text: format!("solid {name}\n"),
        }
    }

    /// Adds a triangle; corners in m, anticlockwise as seen from outside.
    pub(super) fn facet(&mut self, corners: [[f64; 3]; 3]) {
        self.text += "facet normal 0 0 0\nouter loop\n";
        for [x, y, z] in corners {
            // as the file's reader will see them
            let mm = [x, y, z].map(|c| (c * 1e3) as f32);
            // writing to a text cannot fail
            let _ = writeln!(self.text, "vertex {} {} {}", mm[0], mm[1], mm[2]);
        }
        self.text += "endloop\nendfacet\n";
    }

    pub(super) fn finish(self) -> String {
        self.text + "endsolid " + self.name + "\n"
    }
}
