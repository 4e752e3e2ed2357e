//! Meshes from STL files, binary or ASCII.
//!
//! The `stl_io` crate parses the binary form; its reader of the text form tells no line of a fault. It takes any file that begins
//! with `solid ` for text, although many programs write that into binary headers, so that the form is told apart here.

use super::error::MeshError;
use super::flat::cut_the_other_way;
use super::mesh::TriMesh;
use super::stl_text;
use crate::math::V3;
use std::collections::HashMap;
use std::io::{self, Cursor, Read, Seek, SeekFrom};

/// Bytes of a binary file before its first triangle.
const BINARY_HEADER: usize = 84;
/// Bytes of a triangle in a binary file.
const BINARY_TRIANGLE: usize = 50;

/// Why an STL file gives no mesh.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum StlError {
    /// The file could not be read.
    #[error("cannot read the STL file: {0}")]
    Read(#[source] io::Error),
    /// It is not an STL file, or a damaged one.
    #[error(
        "not a valid STL file ({bytes} bytes, read as {form}), after {triangles} triangles: {reason}"
    )]
    NotStl {
        /// size of the file
        bytes: usize,
        /// `binary` or `ASCII`
        form: &'static str,
        /// triangles understood before the damage
        triangles: usize,
        /// what the parser says
        reason: String,
    },
    /// The file unit makes no sense.
    #[error("unit = {unit} m is out of range: above 0")]
    Unit {
        /// metres per file unit
        unit: f64,
    },
    /// The triangles do not make a closed surface.
    #[error(transparent)]
    Mesh(#[from] MeshError),
}

/// Reads a mesh; `unit` is metres per file unit (0.001 for mm).
///
/// Vertices with equal coordinates become one, and where that leaves the surface open, also those nearer to each other than a
/// millionth of the core's size. Triangles that have two equal vertices then are dropped, which leaves no hole. Those of three
/// vertices on a line are cut differently, with a neighbour. Normals in the file are ignored: the order of the vertices
/// says what is outside. Triangle indices in errors count what is left. The reader is rewound
/// first.
pub fn read<R: Read + Seek>(reader: &mut R, unit: f64) -> Result<TriMesh, StlError> {
    if !(unit > 0.0 && unit.is_finite()) {
        return Err(StlError::Unit { unit });
    }
    let mut bytes = Vec::new();
    reader.seek(SeekFrom::Start(0)).map_err(StlError::Read)?;
    reader.read_to_end(&mut bytes).map_err(StlError::Read)?;
    let mut welded = Welded::default();
    match text_of(&bytes) {
        Some(text) => {
            let facet = |corners| welded.push(corners, unit);
            stl_text::read(text, facet).map_err(|fault| StlError::NotStl {
                bytes: bytes.len(),
                form: "ASCII",
                triangles: fault.triangles,
                reason: fault.reason,
            })?;
        }
        None => read_binary(bytes, |corners| welded.push(corners, unit))?,
    }
    let apart = welded.clone();
    cut_the_other_way(&welded.vertices, &mut welded.triangles);
    match TriMesh::new(welded.vertices, welded.triangles) {
        // Seams whose two sides were rounded differently look open.
        Err(open @ MeshError::Open { .. }) => {
            let Welded {
                vertices,
                mut triangles,
                ..
            } = apart.pulled_together();
            cut_the_other_way(&vertices, &mut triangles);
            TriMesh::new(vertices, triangles).map_err(|_| open.into())
        }
        mesh => Ok(mesh?),
    }
}

/// Hands the corners of each triangle of a binary file on.
fn read_binary(mut bytes: Vec<u8>, mut push: impl FnMut([[f32; 3]; 3])) -> Result<(), StlError> {
    let (size, counted) = (bytes.len(), counted(&bytes));
    let broken = |triangles: usize| StlError::NotStl {
        bytes: size,
        form: "binary",
        triangles,
        reason: match counted {
            Some(count) => {
                let needed = BINARY_HEADER as u64 + BINARY_TRIANGLE as u64 * u64::from(count);
                format!("its header counts {count} triangles, which take {needed} bytes")
            }
            None => format!("a binary file has a header of {BINARY_HEADER} bytes"),
        },
    };
    // (the parser must not take the header for that of a text)
    if let Some(header) = bytes.get_mut(..BINARY_HEADER - 4) {
        header.fill(0);
    }
    let mut cursor = Cursor::new(bytes);
    let parser = stl_io::create_stl_reader(&mut cursor).map_err(|_| broken(0))?;
    for (index, triangle) in parser.enumerate() {
        let triangle = triangle.map_err(|_| broken(index))?;
        push(triangle.vertices.map(|v| v.0));
    }
    Ok(())
}

/// The text of a file whose first word is `solid`, unless it has the size of a binary one.
fn text_of(bytes: &[u8]) -> Option<&str> {
    let text = std::str::from_utf8(bytes)
        .ok()
        .filter(|_| !is_binary(bytes))?;
    let text = text.trim_start_matches('\u{feff}');
    let word = text.split_whitespace().next()?;
    word.eq_ignore_ascii_case("solid").then_some(text)
}

/// Whether the size is that of a binary file with the number of triangles its header names.
fn is_binary(bytes: &[u8]) -> bool {
    let body = bytes.len().checked_sub(BINARY_HEADER);
    let size = |count: u32| (count as usize).checked_mul(BINARY_TRIANGLE);
    body.is_some() && counted(bytes).and_then(size) == body
}

/// The number of triangles that the header of a binary file names; none where the file is shorter than a header.
fn counted(bytes: &[u8]) -> Option<u32> {
    let count = bytes.get(BINARY_HEADER - 4..BINARY_HEADER)?;
    count.try_into().ok().map(u32::from_le_bytes)
}

/// Share of the size of a core by which two vertices may differ that are meant to be one: a few units in the last place of
/// single precision.
const SAME: f64 = 1e-6;

/// Vertices numbered in the order in which they first occur.
#[derive(Clone, Default)]
struct Welded {
    vertices: Vec<V3>,
    triangles: Vec<[u32; 3]>,
    /// looked up only, never iterated
    known: HashMap<[u32; 3], u32>,
}

impl Welded {
    fn push(&mut self, corners: [[f32; 3]; 3], unit: f64) {
        let triangle = corners.map(|corner| {
            // Adding zero turns -0 into +0, which is the same place.
            let key = corner.map(|x| (x + 0.0).to_bits());
            let next = self.vertices.len() as u32;
            *self.known.entry(key).or_insert_with(|| {
                self.vertices.push(unit * V3::from(corner.map(f64::from)));
                next
            })
        });
        let [a, b, c] = triangle;
        if a != b && b != c && c != a {
            self.triangles.push(triangle);
        }
    }
}

impl Welded {
    /// The same, where of vertices that are nearly at one place only the first is left.
    fn pulled_together(self) -> Self {
        let size = self.vertices.iter().flat_map(|v| v.iter().copied());
        let near = SAME * size.fold(0.0, |size: f64, x| size.max(x.abs()));
        // Two places that near lie in one cell, or in cells side by side.
        let cell = |place: &V3, aside: [f64; 3]| {
            [0, 1, 2].map(|k| ((place[k] + near * aside[k]) / (2.0 * near)).floor() as i64)
        };
        let mut left = Self::default();
        let mut known: HashMap<[i64; 3], Vec<u32>> = HashMap::new();
        let stand_in: Vec<u32> = self
            .vertices
            .iter()
            .map(|place| {
                let at = |&v: &u32| (left.vertices[v as usize] - place).norm() <= near;
                let corners =
                    (0..8).map(|k| [1, 2, 4].map(|bit| if k & bit > 0 { 1.0 } else { -1.0 }));
                let mut beside = corners.filter_map(|aside| known.get(&cell(place, aside)));
                if let Some(first) = beside.find_map(|cell| cell.iter().copied().find(at)) {
                    return first;
                }
                let next = left.vertices.len() as u32;
                left.vertices.push(*place);
                known.entry(cell(place, [0.0; 3])).or_default().push(next);
                next
            })
            .collect();
        let triangles = self
            .triangles
            .iter()
            .map(|t| t.map(|v| stand_in[v as usize]));
        left.triangles = triangles
            .filter(|[a, b, c]| a != b && b != c && c != a)
            .collect();
        left
    }
}

#[cfg(test)]
mod tests {
    use super::super::generate::rounded_box;
    use super::*;
    use proptest::prelude::*;
    use std::fmt::Write;
    use stl_io::{Normal, Triangle, Vertex};

    /// A rounded box in millimetres, as a soup of triangles.
    fn soup() -> Vec<Triangle> {
        let mesh = rounded_box(20.0, 12.0, 30.0, 2.0, 4).unwrap();
        let vertex = |v: u32| Vertex::new(mesh.vertices[v as usize].map(|x| x as f32).into());
        // The zero normals show that they are not read.
        let normal = Normal::new([0.0; 3]);
        mesh.triangles
            .iter()
            .map(|t| Triangle {
                normal,
                vertices: t.map(vertex),
            })
            .collect()
    }

    fn binary(soup: &[Triangle]) -> Vec<u8> {
        let mut bytes = Vec::new();
        stl_io::write_stl(&mut bytes, soup.iter()).unwrap();
        bytes
    }

    fn ascii(soup: &[Triangle]) -> String {
        let mut text = "solid box\n".to_owned();
        for triangle in soup {
            text += "  facet normal 0 0 0\n    outer loop\n";
            for Vector([x, y, z]) in triangle.vertices {
                writeln!(text, "      vertex {x:e} {y:e} {z:e}").unwrap();
            }
            text += "    endloop\n  endfacet\n";
        }
        text + "endsolid box\n"
    }
    use stl_io::Vector;

    fn read_bytes(bytes: impl Into<Vec<u8>>) -> Result<TriMesh, StlError> {
        read(&mut Cursor::new(bytes.into()), 1e-3)
    }

    /// Corners that an exporter has rounded differently in each triangle.
    #[test]
    fn a_seam_whose_sides_were_rounded_differently_is_closed() {
        let mut torn = soup();
        for (k, triangle) in torn.iter_mut().enumerate() {
            for corner in &mut triangle.vertices {
                for (axis, x) in corner.0.iter_mut().enumerate() {
                    *x += 5e-7 * ((7 * k + 3 * axis) % 5) as f32 - 1e-6;
                }
            }
        }
        check(&read_bytes(ascii(&torn)).unwrap());
        // A gap of a hundredth of a millimetre stays one.
        torn[0].vertices[0].0[0] += 0.01;
        assert!(matches!(
            read_bytes(ascii(&torn)),
            Err(StlError::Mesh(MeshError::Open { .. }))
        ));
    }

    fn check(mesh: &TriMesh) {
        let exact = rounded_box(0.02, 0.012, 0.03, 0.002, 4).unwrap();
        assert_eq!(mesh.vertices.len(), exact.vertices.len());
        assert_eq!(mesh.len(), exact.len());
        assert!((mesh.volume() / exact.volume() - 1.0).abs() < 1e-6);
        assert!(mesh.is_convex());
        for (read, written) in mesh.triangles.iter().zip(&exact.triangles) {
            for (a, b) in read.iter().zip(written) {
                let gap = mesh.vertices[*a as usize] - exact.vertices[*b as usize];
                assert!(gap.norm() < 2e-9);
            }
        }
    }

    #[test]
    fn binary_and_ascii_give_the_mesh_back() {
        check(&read_bytes(binary(&soup())).unwrap());
        check(&read_bytes(ascii(&soup())).unwrap());
    }

    #[test]
    fn binary_header_may_say_solid() {
        let mut bytes = binary(&soup());
        bytes[..11].copy_from_slice(b"solid thing");
        check(&read_bytes(bytes).unwrap());
    }

    #[test]
    fn ascii_dialects_are_read() {
        let text = ascii(&soup());
        check(&read_bytes(text.replace("solid box", "solid")).unwrap());
        check(&read_bytes(text.to_uppercase()).unwrap());
        check(&read_bytes(text.replace('\n', "\r\n")).unwrap());
        check(&read_bytes(format!("\u{feff}  {text}")).unwrap());
    }

    /// A file whose faces had names was refused as several solids.
    #[test]
    fn solids_of_a_file_make_up_one_surface() {
        let (soup, faces) = (soup(), 5);
        let parts = soup.chunks(soup.len().div_ceil(faces)).map(ascii);
        let text = parts.collect::<String>();
        assert_eq!(text.matches("endsolid").count(), faces);
        check(&read_bytes(text.clone()).unwrap());
        check(&read_bytes(text.replace('\n', "\r\n")).unwrap());
        // cut off within the last part, and before it
        for word in ["endloop", "endsolid"] {
            let cut = text[..text.rfind(word).unwrap()].to_owned();
            let error = read_bytes(cut).unwrap_err();
            assert!(
                matches!(error, StlError::NotStl { form: "ASCII", .. }),
                "{error}"
            );
        }
        let cut = text[..text.rfind("solid box\n  facet").unwrap()].to_owned();
        let error = read_bytes(cut).unwrap_err();
        assert!(
            matches!(error, StlError::Mesh(MeshError::Open { .. })),
            "{error}"
        );
    }

    #[test]
    fn negative_zero_and_collapsed_triangles_are_welded() {
        let mut soup = soup();
        for (index, triangle) in soup.iter_mut().enumerate() {
            for vertex in &mut triangle.vertices {
                for x in vertex.0.iter_mut().filter(|x| **x == 0.0) {
                    *x = if index % 2 == 0 { 0.0 } else { -0.0 };
                }
            }
        }
        let mut collapsed = soup[0];
        collapsed.vertices[1] = collapsed.vertices[0];
        soup.push(collapsed);
        check(&read_bytes(binary(&soup)).unwrap());
    }

    /// A triangle of three corners on a line was refused although the surface is closed.
    #[test]
    fn triangles_that_close_t_junctions_are_cut_differently() {
        let whole = read_bytes(binary(&soup())).unwrap();
        let middle =
            |a: Vector<f32>, b: Vector<f32>| Vector([0, 1, 2].map(|k| 0.5 * (a.0[k] + b.0[k])));
        let mut with_junction = soup();
        let normal = with_junction[0].normal;
        // one side of an edge is cut in four; what is open between them is filled by triangles on its line
        let [a, b, c] = with_junction[0].vertices;
        let m = middle(a, b);
        let (l, n) = (middle(a, m), middle(m, b));
        let triangle = |vertices| Triangle { normal, vertices };
        let cut = [[a, l, c], [l, m, c], [m, n, c], [n, b, c]].map(triangle);
        with_junction.splice(0..1, cut);
        let open = read_bytes(binary(&with_junction)).unwrap_err();
        assert!(
            matches!(open, StlError::Mesh(MeshError::Open { .. })),
            "{open}"
        );
        with_junction.extend([[l, a, m], [m, b, n], [m, a, b]].map(triangle));
        for backwards in [false, true] {
            if backwards {
                with_junction.reverse();
            }
            let mesh = read_bytes(binary(&with_junction)).unwrap();
            assert_eq!(mesh.len(), with_junction.len());
            assert!((mesh.volume() / whole.volume() - 1.0).abs() < 1e-6);
            assert!(mesh.is_convex());
        }
    }

    /// "failed to fill whole buffer"
    #[test]
    fn a_binary_file_that_was_cut_off_tells_what_is_missing() {
        let whole = binary(&soup());
        let said = read_bytes(&whole[..whole.len() - 33])
            .unwrap_err()
            .to_string();
        let (count, size) = (soup().len(), whole.len());
        let needed = format!("its header counts {count} triangles, which take {size} bytes");
        assert!(said.contains(&needed), "{said}");
        assert!(said.contains(&format!("({} bytes", size - 33)), "{said}");
    }

    #[test]
    fn bad_surfaces_are_refused() {
        let mut open = soup();
        open.pop();
        for bytes in [binary(&open), ascii(&open).into_bytes()] {
            let error = read_bytes(bytes).unwrap_err();
            assert!(
                matches!(error, StlError::Mesh(MeshError::Open { .. })),
                "{error}"
            );
        }
        let mut flipped = soup();
        flipped.iter_mut().for_each(|t| t.vertices.swap(0, 1));
        let error = read_bytes(binary(&flipped)).unwrap_err();
        assert!(
            matches!(error, StlError::Mesh(MeshError::InsideOut { .. })),
            "{error}"
        );

        let error = read_bytes(binary(&[])).unwrap_err();
        assert!(matches!(error, StlError::Mesh(MeshError::Empty)), "{error}");

        let mut infinite = soup();
        infinite[7].vertices[0].0[1] = f32::INFINITY;
        let error = read_bytes(binary(&infinite)).unwrap_err();
        assert!(
            matches!(error, StlError::Mesh(MeshError::Coordinate { .. })),
            "{error}"
        );
    }

    #[test]
    fn other_files_are_refused() {
        let not_stl = |bytes: Vec<u8>| match read_bytes(bytes) {
            Err(StlError::NotStl {
                form, triangles, ..
            }) => (form, triangles),
            other => panic!("{other:?}"),
        };
        assert_eq!(not_stl(vec![]), ("binary", 0));
        assert_eq!(not_stl(b"<html>not found</html>".to_vec()), ("binary", 0));
        assert_eq!(not_stl(b"solid".to_vec()), ("ASCII", 0));
        let mut cut = binary(&soup());
        cut.truncate(84 + 50 * 3 + 7);
        assert_eq!(not_stl(cut), ("binary", 3));
        let text = ascii(&soup());
        let cut = text[..text.rfind("vertex").unwrap()].to_owned();
        assert_eq!(not_stl(cut.into_bytes()), ("ASCII", soup().len() - 1));

        assert!(matches!(read_bytes(text.repeat(2)), Err(StlError::Mesh(_))));
        for unit in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            let mut cursor = Cursor::new(binary(&soup()));
            assert!(matches!(
                read(&mut cursor, unit),
                Err(StlError::Unit { .. })
            ));
        }
        for unit in [1e-300, 1e300] {
            let mut cursor = Cursor::new(binary(&soup()));
            assert!(matches!(read(&mut cursor, unit), Err(StlError::Mesh(_))));
        }
    }

    proptest! {
        #[test]
        fn damaged_files_never_panic(
            as_text in any::<bool>(),
            damage in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
            keep in any::<prop::sample::Index>(),
        ) {
            let mut bytes = if as_text { ascii(&soup()).into_bytes() } else { binary(&soup()) };
            for (at, byte) in damage {
                let at = at.index(bytes.len());
                bytes[at] = byte;
            }
            // Only returning matters; a changed attribute byte is even a good file.
            if let Ok(mesh) = read_bytes(bytes.clone()) {
                prop_assert!(mesh.volume() > 0.0);
            }
            bytes.truncate(keep.index(bytes.len()));
            prop_assert!(read_bytes(bytes).is_err());
        }

        #[test]
        fn noise_is_refused(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
            prop_assert!(read_bytes(bytes).is_err());
        }
    }
}
