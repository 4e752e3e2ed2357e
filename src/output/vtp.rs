//! Wire and core as VTK XML PolyData, for ParaView and PyVista.

use super::tube::tube_mesh;
use super::vtk_xml::{Form, LINES, POLYGONS, Piece, components32, write_poly_data};
use super::{OutputError, write_whole_bytes};
use crate::math::V3;
use crate::math::{polar_angle, unwrap_angles};
use crate::simulation::Centreline;
use std::borrow::Cow;
use std::f64::consts::TAU;
use std::path::Path;

/// Points of a wire's section.
pub(super) const SIDES: usize = 16;

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
    let data = NodeData::new(path, wire, fields)?;
    let mesh = tube_mesh(&wire.points, radius, SIDES);
    // One point makes no tube; data must then be as empty as the points.
    let drawn = if mesh.rings == 0 { 0 } else { nodes };
    let piece = Piece {
        points: &mesh.points,
        form: Form::Exact,
        cells: POLYGONS,
        active: &[("Scalars", "turn"), ("Normals", "Normals")],
        field: &[("TimeValue", time)],
    };
    write_poly_data(
        path,
        &piece,
        || mesh.polygons(),
        |xml| {
            let normals = mesh.normals.iter().flat_map(components32);
            xml.array("Normals", Some(3), 3 * mesh.normals.len(), normals)?;
            let count = SIDES * drawn;
            xml.array("turn", None, count, per_ring(&data.turns[..drawn]))?;
            if let Some(defect) = &data.defect {
                xml.array("defect", None, count, per_ring(&defect[..drawn]))?;
            }
            for (name, values) in &data.bytes {
                xml.array(name, None, count, per_ring(&values[..drawn]))?;
            }
            for (name, values) in &data.reals {
                xml.array(name, None, count, per_ring(&values[..drawn]))?;
            }
            Ok(())
        },
    )
}

/// Writes the centreline as one line in the core frame: the wire of a film, a sixteenth of what [`write_vtp`] writes.
///
/// Data at the points as there, but for the normals. All but `arc` are written to 7 digits. `WireRadius` (m) belongs to
/// the whole file; a viewer's tube filter takes it.
///
/// # Errors
/// Where the file cannot be written or an array has another length than the wire has nodes.
pub fn write_frame(
    path: &Path,
    wire: &Centreline,
    radius: f64,
    fields: Option<&WireFields>,
    time: f64,
) -> Result<(), OutputError> {
    let nodes = wire.points.len();
    let data = NodeData::new(path, wire, fields)?;
    let piece = Piece {
        points: &wire.points,
        form: Form::Compact,
        cells: LINES,
        active: &[("Scalars", "tension")],
        field: &[("TimeValue", time), ("WireRadius", radius)],
    };
    // One point makes no line.
    let line: Option<Vec<u32>> = (nodes > 1).then(|| (0..nodes as u32).collect());
    write_poly_data(
        path,
        &piece,
        || line.iter(),
        |xml| {
            xml.array("turn", None, nodes, data.turns.iter().copied())?;
            if let Some(defect) = &data.defect {
                xml.array("defect", None, nodes, defect.iter().copied())?;
            }
            for (name, values) in &data.bytes {
                xml.array(name, None, nodes, values.iter().copied())?;
            }
            for (name, values) in &data.reals {
                match *name {
                    // Places of the wire at different times are compared by it.
                    "arc" => xml.array(name, None, nodes, values.iter().copied())?,
                    _ => xml.array(name, None, nodes, values.iter().map(|&v| v as f32))?,
                }
            }
            Ok(())
        },
    )
}

/// What is known of the wire, a value per node, in the order of the files.
struct NodeData<'a> {
    turns: Vec<i32>,
    defect: Option<Vec<i32>>,
    bytes: Vec<(&'static str, Cow<'a, [u8]>)>,
    reals: Vec<(&'static str, &'a [f64])>,
}

impl<'a> NodeData<'a> {
    /// An error where an array has another length than the wire has nodes.
    fn new(
        path: &Path,
        wire: &'a Centreline,
        fields: Option<&'a WireFields>,
    ) -> Result<Self, OutputError> {
        let nodes = wire.points.len();
        let mut reals = vec![
            ("arc", wire.arc.as_slice()),
            ("tension", &wire.tension),
            ("plastic_strain", &wire.plastic_strain),
        ];
        let frozen = (0..nodes).map(|node| u8::from(node < wire.frozen));
        let mut bytes = vec![("frozen", Cow::Owned(frozen.collect()))];
        if let Some(fields) = fields {
            reals.extend([
                ("height", fields.height.as_slice()),
                ("gap", &fields.gap),
                ("bulge", &fields.bulge),
            ]);
            bytes.extend([("layer", Cow::Borrowed(fields.layer.as_slice()))]);
        }
        let defect: Option<Vec<i32>> =
            fields.map(|fields| fields.defect.iter().map(|&code| code.into()).collect());
        let lengths = (reals.iter().map(|(name, values)| (*name, values.len())))
            .chain(bytes.iter().map(|(name, values)| (*name, values.len())))
            .chain(defect.iter().map(|values| ("defect", values.len())));
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
        let turns = turns_of_nodes(&wire.points);
        Ok(Self {
            turns: turns.iter().map(|&turn| turn as i32).collect(),
            defect,
            bytes,
            reals,
        })
    }
}

/// Writes a collection that ParaView opens as one film: files beside it, by name, with their times in s.
pub fn write_series(path: &Path, frames: &[(f64, String)]) -> Result<(), OutputError> {
    let mut text = String::from(concat!(
        "<?xml version=\"1.0\"?>\n",
        "<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n",
        " <Collection>\n"
    ));
    for (time, name) in frames {
        text.push_str(&format!(
            "  <DataSet timestep=\"{time}\" part=\"0\" file=\"{name}\"/>\n"
        ));
    }
    text.push_str(" </Collection>\n</VTKFile>\n");
    write_whole_bytes(path, text)
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
        form: Form::Exact,
        cells: POLYGONS,
        active: &[],
        field: &[],
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
