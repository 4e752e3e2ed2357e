//! STL files of cores.

use std::f64::consts::TAU;
use std::path::Path;

/// Writes what an outline of (y, radius), mm, from end to end, encloses as it turns about y, in so many flat sides.
pub fn write_revolved(path: &Path, outline: &[[f64; 2]], sides: usize) {
    let at = |[y, r]: [f64; 2], side: usize| {
        let a = TAU * (side % sides) as f64 / sides as f64;
        [r * a.cos(), y, r * a.sin()].map(|c| c as f32)
    };
    let mut triangles = Vec::new();
    let mut triangle = |corners: [[f32; 3]; 3]| {
        triangles.push(stl_io::Triangle {
            normal: stl_io::Normal::new([0.0; 3]),
            vertices: corners.map(stl_io::Vertex::new),
        });
    };
    let (first, last) = (outline[0], outline[outline.len() - 1]);
    let hub = |[y, _]: [f64; 2]| [0.0, y as f32, 0.0];
    for side in 0..sides {
        for pair in outline.windows(2) {
            let [low, high] = [pair[0], pair[1]];
            triangle([at(low, side), at(high, side), at(high, side + 1)]);
            triangle([at(low, side), at(high, side + 1), at(low, side + 1)]);
        }
        triangle([hub(first), at(first, side), at(first, side + 1)]);
        triangle([hub(last), at(last, side + 1), at(last, side)]);
    }
    let mut file = std::fs::File::create(path).expect("a file");
    stl_io::write_stl(&mut file, triangles.iter()).expect("written");
}
