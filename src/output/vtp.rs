//! Wire and core as VTK XML PolyData, for ParaView and PyVista.

use super::OutputError;
use super::tube::tube_mesh;
use crate::math::V3;
use crate::math::{polar_angle, unwrap_angles};
use crate::simulation::Centreline;
use quick_xml::Writer;
use quick_xml::events::{BytesDecl, BytesEnd, BytesStart, BytesText, Event};
use std::f64::consts::TAU;
use std::fmt::{Display, Write as _};
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;

/// Points of a wire's section.
const SIDES: usize = 16;
/// Characters of an array that are held before they are written.
const PIECE: usize = 1 << 16;

/// Writes the wire as a tube of `radius` (m) in the core frame.
///
/// Data at the points: `Normals`, `turn`, `arc` (m), `tension` (N), `plastic_strain` and `frozen`
/// (0 or 1). `turn` counts from 1 by polar angle from the clamp. `height` (m) is added if `heights`
/// has one per node.
pub fn write_vtp(
    path: &Path,
    wire: &Centreline,
    radius: f64,
    heights: Option<&[f64]>,
) -> Result<(), OutputError> {
    let nodes = wire.points.len();
    let optional = heights.map(|values| ("height", values));
    let arrays = [
        ("arc", wire.arc.as_slice()),
        ("tension", &wire.tension),
        ("plastic_strain", &wire.plastic_strain),
    ];
    let given: Vec<(&'static str, &[f64])> = arrays.into_iter().chain(optional).collect();
    for &(name, values) in &given {
        if values.len() != nodes {
            let (path, got) = (path.to_owned(), values.len());
            return Err(OutputError::Length {
                path,
                name,
                got,
                expected: nodes,
            });
        }
    }
    let mesh = tube_mesh(&wire.points, radius, SIDES);
    // One point makes no tube; data must then be as empty as the points.
    let drawn = if mesh.rings == 0 { 0 } else { nodes };
    let turns: Vec<i64> = turns_of_nodes(&wire.points)
        .iter()
        .map(|&turn| turn as i64)
        .collect();
    let frozen: Vec<i64> = (0..nodes)
        .map(|node| i64::from(node < wire.frozen))
        .collect();
    let integers = [("turn", turns), ("frozen", frozen)];
    let active = [("Scalars", "turn"), ("Normals", "Normals")];
    write_poly_data(path, &mesh.points, mesh.polygons(), &active, |data| {
        data.array(
            "Normals",
            "Float32",
            Some(3),
            mesh.normals.iter().flat_map(components32),
        )?;
        for (name, values) in &integers {
            data.array(name, "Int64", None, per_ring(&values[..drawn]))?;
        }
        for (name, values) in &given {
            data.array(name, "Float64", None, per_ring(&values[..drawn]))?;
        }
        Ok(())
    })
}

/// Writes the core's surface: `vertices` in m in the core frame, three indices per triangle.
pub fn write_core_vtp(
    path: &Path,
    vertices: &[V3],
    triangles: &[[u32; 3]],
) -> Result<(), OutputError> {
    check_mesh(path, vertices, triangles)?;
    write_poly_data(path, vertices, triangles.iter(), &[], |_| Ok(()))
}

/// An error where a triangle names a vertex that is not there.
pub(crate) fn check_mesh(
    path: &Path,
    vertices: &[V3],
    triangles: &[[u32; 3]],
) -> Result<(), OutputError> {
    let bad = |t: &[u32; 3]| t.iter().any(|&vertex| vertex as usize >= vertices.len());
    triangles.iter().position(bad).map_or(Ok(()), |triangle| {
        Err(OutputError::Mesh {
            path: path.to_owned(),
            triangle,
            vertices: vertices.len(),
        })
    })
}

/// Turn (from 1) of each node by its polar angle from the first, whichever way it is wound.
pub(crate) fn turns_of_nodes(points: &[V3]) -> Vec<u32> {
    let start = points.first().map_or(0.0, |&point| polar_angle(point));
    let angles = unwrap_angles(points, start, 1.0);
    angles
        .iter()
        .map(|angle| (angle.abs() / TAU) as u32 + 1)
        .collect()
}

fn per_ring<T: Copy>(values: &[T]) -> impl Iterator<Item = T> {
    values
        .iter()
        .flat_map(|&value| std::iter::repeat_n(value, SIDES))
}

fn components(v: &V3) -> [f64; 3] {
    [v.x, v.y, v.z]
}

fn components32(v: &V3) -> [f32; 3] {
    components(v).map(|c| c as f32)
}

fn write_poly_data(
    path: &Path,
    points: &[V3],
    polygons: impl Iterator<Item = impl AsRef<[u32]>> + Clone,
    active: &[(&str, &str)],
    point_data: impl FnOnce(&mut Xml<BufWriter<File>>) -> io::Result<()>,
) -> Result<(), OutputError> {
    let file = File::create(path).map_err(OutputError::io(path))?;
    let mut xml = Xml(Writer::new_with_indent(BufWriter::new(file), b' ', 1));
    let write = || {
        xml.0
            .write_event(Event::Decl(BytesDecl::new("1.0", None, None)))?;
        let root = [
            ("type", "PolyData"),
            ("version", "1.0"),
            ("byte_order", "LittleEndian"),
        ];
        xml.open("VTKFile", &root)?;
        xml.open("PolyData", &[])?;
        let (n_points, n_polys) = (
            points.len().to_string(),
            polygons.clone().count().to_string(),
        );
        xml.open(
            "Piece",
            &[("NumberOfPoints", &n_points), ("NumberOfPolys", &n_polys)],
        )?;
        xml.open("PointData", active)?;
        point_data(&mut xml)?;
        xml.close("PointData")?;
        xml.open("Points", &[])?;
        xml.array(
            "Points",
            "Float64",
            Some(3),
            points.iter().flat_map(components),
        )?;
        xml.close("Points")?;
        xml.open("Polys", &[])?;
        let mut corners = xml.begin("connectivity", "Int64", None)?;
        for polygon in polygons.clone() {
            corners.add(polygon.as_ref())?;
        }
        corners.end()?;
        let offsets = polygons.scan(0, |end, polygon| {
            *end += polygon.as_ref().len();
            Some(*end)
        });
        xml.array("offsets", "Int64", None, offsets)?;
        for element in ["Polys", "Piece", "PolyData", "VTKFile"] {
            xml.close(element)?;
        }
        let file: &mut BufWriter<File> = xml.0.get_mut();
        file.write_all(b"\n")?;
        file.flush()
    };
    write().map_err(OutputError::io(path))
}

/// The few XML forms that a VTK file is made of.
struct Xml<W: Write>(Writer<W>);

impl<W: Write> Xml<W> {
    fn open(&mut self, name: &str, attributes: &[(&str, &str)]) -> io::Result<()> {
        let start = BytesStart::new(name).with_attributes(attributes.iter().copied());
        self.0.write_event(Event::Start(start))
    }

    fn close(&mut self, name: &str) -> io::Result<()> {
        self.0.write_event(Event::End(BytesEnd::new(name)))
    }

    fn array<T: Display>(
        &mut self,
        name: &str,
        kind: &str,
        components: Option<usize>,
        values: impl Iterator<Item = T>,
    ) -> io::Result<()> {
        let mut numbers = self.begin(name, kind, components)?;
        for value in values {
            numbers.add(&[value])?;
        }
        numbers.end()
    }

    fn begin(
        &mut self,
        name: &str,
        kind: &str,
        components: Option<usize>,
    ) -> io::Result<Numbers<'_, W>> {
        let components = components.map(|count| count.to_string());
        let mut attributes = vec![("type", kind), ("Name", name), ("format", "ascii")];
        if let Some(count) = &components {
            attributes.push(("NumberOfComponents", count));
        }
        self.open("DataArray", &attributes)?;
        Ok(Numbers {
            xml: self,
            text: String::new(),
            count: 0,
        })
    }
}

/// An array being written, a piece at a time: that of a long wire is larger than the run's own
/// state.
struct Numbers<'a, W: Write> {
    xml: &'a mut Xml<W>,
    text: String,
    count: usize,
}

impl<W: Write> Numbers<'_, W> {
    /// Numbers in the shortest decimal form that reads back to the same number.
    fn add<T: Display>(&mut self, values: &[T]) -> io::Result<()> {
        for value in values {
            let separator = if self.count.is_multiple_of(12) {
                '\n'
            } else {
                ' '
            };
            self.count += 1;
            // Writing to a string cannot fail.
            let _ = write!(self.text, "{separator}{value}");
        }
        if self.text.len() >= PIECE {
            self.put()?;
        }
        Ok(())
    }

    fn put(&mut self) -> io::Result<()> {
        let text = BytesText::from_escaped(self.text.as_str());
        self.xml.0.write_event(Event::Text(text))?;
        self.text.clear();
        Ok(())
    }

    fn end(mut self) -> io::Result<()> {
        self.text.push('\n');
        self.put()?;
        self.xml.close("DataArray")
    }
}
