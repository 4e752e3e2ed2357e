//! The XML that VTK files of points, cells and data are made of, with arrays in base64.

use super::{OutputError, write_whole};
use crate::math::V3;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use base64::write::EncoderWriter;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use quick_xml::Writer;
use quick_xml::events::{BytesDecl, BytesEnd, BytesStart, Event};
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;

/// Bytes of an array that are held before they are written.
const PIECE: usize = 1 << 16;

fn components(v: &V3) -> [f64; 3] {
    [v.x, v.y, v.z]
}

pub(super) fn components32(v: &V3) -> [f32; 3] {
    components(v).map(|c| c as f32)
}

/// A piece of a file but for its cells and data.
pub(super) struct Piece<'a> {
    /// m
    pub(super) points: &'a [V3],
    pub(super) form: Form,
    /// polygons or lines
    pub(super) cells: &'static str,
    /// attributes of the point data that name what a viewer shows first
    pub(super) active: &'a [(&'a str, &'a str)],
    /// numbers that belong to the whole file, by name
    pub(super) field: &'a [(&'a str, f64)],
}

/// Cells of a [`Piece`] that are polygons.
pub(super) const POLYGONS: &str = "Polys";
/// Cells of a [`Piece`] that are lines through their points.
pub(super) const LINES: &str = "Lines";

/// How points and arrays are written.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Form {
    /// points to all digits, arrays as they are
    Exact,
    /// points to 7 digits, arrays compressed
    Compact,
}

/// VTK's name for the compression of [`Form::Compact`].
pub(super) const ZLIB: &str = "vtkZLibDataCompressor";

/// Writes a file with one piece: its points, the data that `point_data` adds, and the `cells`, each a list of points.
pub(super) fn write_poly_data<C: Iterator<Item = impl AsRef<[u32]>>>(
    path: &Path,
    piece: &Piece,
    cells: impl Fn() -> C,
    point_data: impl FnOnce(&mut Xml<&mut BufWriter<File>>) -> io::Result<()>,
) -> Result<(), OutputError> {
    write_whole(path, |file| {
        write_xml(file, piece, cells, point_data).map_err(OutputError::io(path))
    })
}

fn write_xml<C: Iterator<Item = impl AsRef<[u32]>>>(
    file: &mut BufWriter<File>,
    piece: &Piece,
    cells: impl Fn() -> C,
    point_data: impl FnOnce(&mut Xml<&mut BufWriter<File>>) -> io::Result<()>,
) -> io::Result<()> {
    let compact = piece.form == Form::Compact;
    let mut xml = Xml {
        writer: Writer::new_with_indent(file, b' ', 1),
        compact,
    };
    xml.writer
        .write_event(Event::Decl(BytesDecl::new("1.0", None, None)))?;
    let mut root = vec![
        ("type", "PolyData"),
        ("version", "1.0"),
        ("byte_order", "LittleEndian"),
        ("header_type", "UInt64"),
    ];
    if compact {
        root.push(("compressor", ZLIB));
    }
    xml.open("VTKFile", &root)?;
    xml.open("PolyData", &[])?;
    if !piece.field.is_empty() {
        xml.open("FieldData", &[])?;
        for &(name, value) in piece.field {
            xml.tuples(name, &[("NumberOfTuples", "1")], 1, [value])?;
        }
        xml.close("FieldData")?;
    }
    let (mut count, mut corners) = (0, 0);
    for cell in cells() {
        count += 1;
        corners += cell.as_ref().len();
    }
    let (n_points, n_cells) = (piece.points.len().to_string(), count.to_string());
    let number = format!("NumberOf{}", piece.cells);
    let sizes = [("NumberOfPoints", &*n_points), (&number, &n_cells)];
    xml.open("Piece", &sizes)?;
    xml.open("PointData", piece.active)?;
    point_data(&mut xml)?;
    xml.close("PointData")?;
    xml.open("Points", &[])?;
    let numbers = 3 * piece.points.len();
    match piece.form {
        Form::Exact => {
            let points = piece.points.iter().flat_map(components);
            xml.array("Points", Some(3), numbers, points)?;
        }
        Form::Compact => {
            let points = piece.points.iter().flat_map(components32);
            xml.array("Points", Some(3), numbers, points)?;
        }
    }
    xml.close("Points")?;
    xml.open(piece.cells, &[])?;
    let connectivity = cells().flat_map(|cell| {
        let corners: Vec<i32> = cell.as_ref().iter().map(|&k| k as i32).collect();
        corners
    });
    xml.array("connectivity", None, corners, connectivity)?;
    let offsets = cells().scan(0, |end, cell| {
        *end += cell.as_ref().len() as i32;
        Some(*end)
    });
    xml.array("offsets", None, count, offsets)?;
    for element in [piece.cells, "Piece", "PolyData", "VTKFile"] {
        xml.close(element)?;
    }
    xml.writer.get_mut().write_all(b"\n")
}

/// A number of an array, with the name that VTK has for its type.
pub(super) trait Number: Copy {
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
pub(super) struct Xml<W: Write> {
    writer: Writer<W>,
    compact: bool,
}

impl<W: Write> Xml<W> {
    fn open(&mut self, name: &str, attributes: &[(&str, &str)]) -> io::Result<()> {
        let start = BytesStart::new(name).with_attributes(attributes.iter().copied());
        self.writer.write_event(Event::Start(start))
    }

    fn close(&mut self, name: &str) -> io::Result<()> {
        self.writer.write_event(Event::End(BytesEnd::new(name)))
    }

    /// An array of `count` numbers at the points or of the cells.
    pub(super) fn array<T: Number>(
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

    /// An array of `count` numbers in base64.
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
        if self.compact {
            self.compressed(&values.into_iter().collect::<Vec<T>>())?;
        } else {
            self.plain(name, count, values)?;
        }
        // Written past the XML writer, which would break the line before the closing tag only after an event.
        self.writer.get_mut().write_all(b"\n")?;
        self.close("DataArray")
    }

    /// An array as one compressed block: number of blocks, their length, that of a last shorter one (there is none) and
    /// the length of the block as it is in the file, then the block.
    fn compressed<T: Number>(&mut self, values: &[T]) -> io::Result<()> {
        let mut bytes = Vec::with_capacity(values.len() * T::SIZE);
        values.iter().for_each(|value| value.put(&mut bytes));
        let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
        encoder.write_all(&bytes)?;
        let block = encoder.finish()?;
        let header = match bytes.len() {
            0 => [0, 0, 0, 0],
            length => [1, length as u64, 0, block.len() as u64],
        };
        let words = if bytes.is_empty() { 3 } else { 4 };
        let header: Vec<u8> = header[..words]
            .iter()
            .flat_map(|n| n.to_le_bytes())
            .collect();
        let file = self.writer.get_mut();
        file.write_all(STANDARD.encode(header).as_bytes())?;
        if !bytes.is_empty() {
            file.write_all(STANDARD.encode(block).as_bytes())?;
        }
        Ok(())
    }

    /// An array as it is: its length in bytes, then the bytes. They are written a piece at a time, for that of a long
    /// wire is larger than the run's own state.
    fn plain<T: Number>(
        &mut self,
        name: &str,
        count: usize,
        values: impl IntoIterator<Item = T>,
    ) -> io::Result<()> {
        let mut encoder = EncoderWriter::new(self.writer.get_mut(), &STANDARD);
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
        Ok(())
    }
}
