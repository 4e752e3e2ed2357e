//! Wire and core as VTK XML PolyData, for ParaView and PyVista.

use super::OutputError;
use super::tube::tube_mesh;
use crate::math::V3;
use crate::math::{polar_angle, unwrap_angles};
use crate::simulation::Centreline;
use base64::engine::general_purpose::STANDARD;
use base64::write::EncoderWriter;
use quick_xml::Writer;
use quick_xml::events::{BytesDecl, BytesEnd, BytesStart, Event};
use std::f64::consts::TAU;
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;

/// Points of a wire's section.
pub(super) const SIDES: usize = 16;
/// Bytes of an array that are held before they are written.
const PIECE: usize = 1 << 16;

/// What is known of the wire besides its centreline, a value per node.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WireFields {
    /// height over the core, m
    pub height: Vec<f64>,
    /// layer from 1; 0 where the wire has not come to rest
    pub layer: Vec<u8>,
    /// gap to the wire one turn back, m; not a number where there is none
    pub gap: Vec<f64>,
    /// height over what the wire was laid over, m; not a number where it has not come to rest
    pub bulge: Vec<f64>,
    /// kinds of defect, a sum of [`DefectKind::code`](crate::measure::DefectKind::code)
    pub defect: Vec<u16>,
}

/// Writes the wire as a tube of `radius` (m) in the core frame, `time` s after the start.
///
/// Data at the points: `Normals`, `turn`, `arc` (m), `tension` (N), `plastic_strain` and `frozen`
/// (0 or 1), and the `fields`, if they are given. `turn` counts from 1 by polar angle from the clamp.
/// Arrays are binary: 64-bit floats where nothing may be lost.
///
/// # Errors
/// Where the file cannot be written or an array has another length than the wire has nodes.
pub fn write_vtp(
    path: &Path,
    wire: &Centreline,
    radius: f64,
    fields: Option<&WireFields>,
    time: f64,
) -> Result<(), OutputError> {
    let nodes = wire.points.len();
    let mut reals = vec![
        ("arc", wire.arc.as_slice()),
        ("tension", &wire.tension),
        ("plastic_strain", &wire.plastic_strain),
    ];
    let frozen: Vec<u8> = (0..nodes)
        .map(|node| u8::from(node < wire.frozen))
        .collect();
    let mut bytes = vec![("frozen", frozen.as_slice())];
    if let Some(fields) = fields {
        reals.extend([
            ("height", fields.height.as_slice()),
            ("gap", &fields.gap),
            ("bulge", &fields.bulge),
        ]);
        bytes.push(("layer", fields.layer.as_slice()));
    }
    let defects: Option<Vec<i32>> =
        fields.map(|fields| fields.defect.iter().map(|&code| code.into()).collect());
    let lengths = (reals.iter().map(|(name, values)| (*name, values.len())))
        .chain(bytes.iter().map(|(name, values)| (*name, values.len())))
        .chain(defects.iter().map(|values| ("defect", values.len())));
    for (name, got) in lengths {
        if got != nodes {
            return Err(OutputError::Length {
                path: path.to_owned(),
                name,
                got,
                expected: nodes,
            });
        }
    }
    let mesh = tube_mesh(&wire.points, radius, SIDES);
    // One point makes no tube; data must then be as empty as the points.
    let drawn = if mesh.rings == 0 { 0 } else { nodes };
    let turns = turns_of_nodes(&wire.points);
    let turns: Vec<i32> = turns.iter().map(|&turn| turn as i32).collect();
    let active = [("Scalars", "turn"), ("Normals", "Normals")];
    let polygons = || mesh.polygons();
    let piece = Piece {
        points: &mesh.points,
        active: &active,
        time: Some(time),
    };
    write_poly_data(path, &piece, polygons, |data| {
        let normals = mesh.normals.iter().flat_map(components32);
        data.array("Normals", Some(3), 3 * mesh.normals.len(), normals)?;
        let count = SIDES * drawn;
        data.array("turn", None, count, per_ring(&turns[..drawn]))?;
        if let Some(defects) = &defects {
            data.array("defect", None, count, per_ring(&defects[..drawn]))?;
        }
        for (name, values) in &bytes {
            data.array(name, None, count, per_ring(&values[..drawn]))?;
        }
        for (name, values) in &reals {
            data.array(name, None, count, per_ring(&values[..drawn]))?;
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
    let piece = Piece {
        points: vertices,
        active: &[],
        time: None,
    };
    write_poly_data(path, &piece, || triangles.iter(), |_| Ok(()))
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

/// A piece of a file but for its polygons and data.
struct Piece<'a> {
    points: &'a [V3],
    /// attributes of the point data that name what a viewer shows first
    active: &'a [(&'a str, &'a str)],
    /// s
    time: Option<f64>,
}

fn write_poly_data<P: Iterator<Item = impl AsRef<[u32]>>>(
    path: &Path,
    piece: &Piece,
    polygons: impl Fn() -> P,
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
            ("header_type", "UInt64"),
        ];
        xml.open("VTKFile", &root)?;
        xml.open("PolyData", &[])?;
        if let Some(time) = piece.time {
            xml.open("FieldData", &[])?;
            xml.tuples("TimeValue", &[("NumberOfTuples", "1")], 1, [time])?;
            xml.close("FieldData")?;
        }
        let (mut count, mut corners) = (0, 0);
        for polygon in polygons() {
            count += 1;
            corners += polygon.as_ref().len();
        }
        let (n_points, n_polys) = (piece.points.len().to_string(), count.to_string());
        let sizes = [("NumberOfPoints", &*n_points), ("NumberOfPolys", &n_polys)];
        xml.open("Piece", &sizes)?;
        xml.open("PointData", piece.active)?;
        point_data(&mut xml)?;
        xml.close("PointData")?;
        xml.open("Points", &[])?;
        let points = piece.points.iter().flat_map(components);
        xml.array("Points", Some(3), 3 * piece.points.len(), points)?;
        xml.close("Points")?;
        xml.open("Polys", &[])?;
        let connectivity = polygons().flat_map(|polygon| {
            let corners: Vec<i32> = polygon.as_ref().iter().map(|&k| k as i32).collect();
            corners
        });
        xml.array("connectivity", None, corners, connectivity)?;
        let offsets = polygons().scan(0, |end, polygon| {
            *end += polygon.as_ref().len() as i32;
            Some(*end)
        });
        xml.array("offsets", None, count, offsets)?;
        for element in ["Polys", "Piece", "PolyData", "VTKFile"] {
            xml.close(element)?;
        }
        let file: &mut BufWriter<File> = xml.0.get_mut();
        file.write_all(b"\n")?;
        file.flush()
    };
    write().map_err(OutputError::io(path))
}

/// A number of an array, with the name that VTK has for its type.
trait Number: Copy {
    const KIND: &str;
    const SIZE: usize;
    fn put(self, bytes: &mut Vec<u8>);
}

macro_rules! number {
    ($type:ty, $kind:literal) => {
        impl Number for $type {
            const KIND: &str = $kind;
            const SIZE: usize = size_of::<$type>();
            fn put(self, bytes: &mut Vec<u8>) {
                bytes.extend(self.to_le_bytes());
            }
        }
    };
}
number!(f64, "Float64");
number!(f32, "Float32");
number!(i32, "Int32");
number!(u8, "UInt8");

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

    /// An array of `count` numbers at the points or polygons.
    fn array<T: Number>(
        &mut self,
        name: &str,
        components: Option<usize>,
        count: usize,
        values: impl IntoIterator<Item = T>,
    ) -> io::Result<()> {
        let components = components.map(|number| number.to_string());
        let attribute = components
            .as_deref()
            .map(|number| ("NumberOfComponents", number));
        self.tuples(name, attribute.as_slice(), count, values)
    }

    /// An array of `count` numbers in base64: its length in bytes, then the bytes. They are written a piece at a time,
    /// for that of a long wire is larger than the run's own state.
    fn tuples<T: Number>(
        &mut self,
        name: &str,
        more: &[(&str, &str)],
        count: usize,
        values: impl IntoIterator<Item = T>,
    ) -> io::Result<()> {
        let mut attributes = vec![("type", T::KIND), ("Name", name), ("format", "binary")];
        attributes.extend(more);
        self.open("DataArray", &attributes)?;
        let mut encoder = EncoderWriter::new(self.0.get_mut(), &STANDARD);
        let mut bytes = ((count * T::SIZE) as u64).to_le_bytes().to_vec();
        let mut given = 0;
        for value in values {
            given += 1;
            value.put(&mut bytes);
            if bytes.len() >= PIECE {
                encoder.write_all(&bytes)?;
                bytes.clear();
            }
        }
        if given != count {
            let text = format!("{name} has {given} values for {count}");
            return Err(io::Error::new(io::ErrorKind::InvalidData, text));
        }
        encoder.write_all(&bytes)?;
        encoder.finish()?;
        drop(encoder);
        // Written past the XML writer, which would break the line before the closing tag only after an event.
        self.0.get_mut().write_all(b"\n")?;
        self.close("DataArray")
    }
}
