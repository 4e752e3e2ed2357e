//! Sizes and volumes of what triangles enclose, and which side of each closed body of a mesh is out.

use super::error::{MeshError, Place};
use crate::math::V3;
use std::f64::consts::PI;

/// A body whose volume is so small a share of the cube of its size has none but by rounding.
const NO_VOLUME: f64 = 1e-15;

/// How often the others wind round a place that lies inside of them, at least: once, less what rounding leaves. On their surface it
/// is a half.
const INSIDE: f64 = 0.75;

/// Checks that each of the `count` bodies has its outside out; `piece` is the body of each triangle.
///
/// A body that is inside out inside of others is a cavity in them. Where all are inside out, the volume of the mesh tells.
pub(super) fn check_bodies(
    vertices: &[V3],
    triangles: &[[u32; 3]],
    piece: &[u32],
    count: u32,
) -> Result<(), MeshError> {
    if count < 2 {
        return Ok(());
    }
    let mut bodies = vec![Vec::new(); count as usize];
    for (&triangle, &body) in triangles.iter().zip(piece) {
        bodies[body as usize].push(triangle);
    }
    let volumes: Vec<f64> = bodies
        .iter()
        .map(|body| signed_volume(vertices, body))
        .collect();
    if volumes.iter().all(|&volume| volume <= 0.0) {
        return Ok(());
    }
    for (own, (body, volume)) in bodies.iter().zip(volumes).enumerate() {
        let (low, high) = bounds(vertices, body);
        let size = (high - low).max();
        if volume > -NO_VOLUME * size * size * size {
            continue;
        }
        let others = || {
            let others = bodies.iter().enumerate().filter(|(other, _)| *other != own);
            others.flat_map(|(_, body)| body)
        };
        let inside = |p: V3| winding_number(vertices, others(), p) > INSIDE;
        if let Some(at) = outermost(vertices, body).into_iter().find(|&p| !inside(p)) {
            let at = Place(at);
            return Err(MeshError::BodyInsideOut { at, volume });
        }
    }
    Ok(())
}

/// Bounding box of all used vertices, m: lowest and highest corner.
pub(crate) fn bounds(vertices: &[V3], triangles: &[[u32; 3]]) -> (V3, V3) {
    let mut low = V3::repeat(f64::INFINITY);
    let mut high = V3::repeat(f64::NEG_INFINITY);
    for v in triangles.iter().flatten() {
        low = low.inf(&vertices[*v as usize]);
        high = high.sup(&vertices[*v as usize]);
    }
    (low, high)
}

/// Divergence theorem over tetrahedra from one vertex of the mesh (less cancellation than from
/// the origin), m^3.
pub(super) fn signed_volume(vertices: &[V3], triangles: &[[u32; 3]]) -> f64 {
    let Some(first) = triangles.first() else {
        return 0.0;
    };
    let apex = vertices[first[0] as usize];
    let tetrahedron = |corner: &[u32; 3]| {
        let [a, b, c] = corner.map(|v| vertices[v as usize] - apex);
        a.dot(&b.cross(&c)) / 6.0
    };
    triangles.iter().map(tetrahedron).sum()
}

/// The corners of a body that lie farthest out along each axis, both ways.
///
/// A body that reaches out of others does so with one of them, unless the others are hollow there. What is missed then is an odd
/// cavity. To ask every corner would take the square of the mesh.
fn outermost(vertices: &[V3], body: &[[u32; 3]]) -> Vec<V3> {
    let corners = || body.iter().flatten().map(|&v| vertices[v as usize]);
    let along = (0..3).flat_map(|axis| [1.0, -1.0].map(|side| (axis, side)));
    along
        .filter_map(|(axis, side)| {
            corners().max_by(|a, b| (side * a[axis]).total_cmp(&(side * b[axis])))
        })
        .collect()
}

/// How often closed bodies wind round a place: the solid angle of their triangles as seen from there (van Oosterom and Strackee
/// 1983), over that of a sphere.
fn winding_number<'a>(
    vertices: &[V3],
    triangles: impl Iterator<Item = &'a [u32; 3]>,
    p: V3,
) -> f64 {
    let solid_angle = |corners: &[u32; 3]| {
        let [a, b, c] = corners.map(|v| vertices[v as usize] - p);
        let [la, lb, lc] = [a, b, c].map(|side| side.norm());
        let volume = a.dot(&b.cross(&c));
        let rest = la * lb * lc + a.dot(&b) * lc + b.dot(&c) * la + c.dot(&a) * lb;
        2.0 * libm::atan2(volume, rest)
    };
    triangles.map(solid_angle).sum::<f64>() / (4.0 * PI)
}

#[cfg(test)]
mod tests {
    use super::super::generate::rounded_box;
    use super::super::mesh::TriMesh;
    use super::*;

    /// Boxes of these sizes, so far along x; the last one inside out.
    fn last_inside_out(boxes: &[(f64, f64)]) -> Result<TriMesh, MeshError> {
        let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
        for (number, &(size, x)) in boxes.iter().enumerate() {
            let first = vertices.len() as u32;
            let body = rounded_box(size, size, size, 0.1 * size, 3).expect("a box");
            vertices.extend(body.vertices.iter().map(|v| v + V3::new(x, 0.0, 0.0)));
            triangles.extend(body.triangles.iter().map(|t| {
                let [a, b, c] = t.map(|v| v + first);
                match number + 1 == boxes.len() {
                    true => [a, c, b],
                    false => [a, b, c],
                }
            }));
        }
        TriMesh::new(vertices, triangles)
    }

    /// Only the volume of all bodies together was looked at.
    #[test]
    fn one_of_several_bodies_inside_out_is_refused_with_its_place() {
        for x in [0.4, 0.6, 2.0] {
            let error = last_inside_out(&[(1.0, 0.0), (1.0, -0.3), (0.5, x)]).expect_err("one");
            assert!(
                matches!(error, MeshError::BodyInsideOut { at, volume }
                    if (at.0.x - x).abs() < 0.26 && at.0.y.abs() < 0.26 && volume < -0.1),
                "{error}"
            );
        }
        // beside one body and in another
        assert!(last_inside_out(&[(1.0, 3.0), (1.0, 0.0), (0.5, 0.1)]).is_ok());
    }

    #[test]
    fn a_cavity_is_no_fault() {
        let hollow = last_inside_out(&[(1.0, 0.0), (0.5, 0.1)]).expect("a hollow body");
        let [outer, inner] = [1.0, 0.5].map(|size| {
            rounded_box(size, size, size, 0.1 * size, 3)
                .expect("a box")
                .volume()
        });
        assert!((hollow.volume() - (outer - inner)).abs() < 1e-12);
        // a body in the cavity
        let (mut vertices, mut triangles) = (hollow.vertices, hollow.triangles);
        let first = vertices.len() as u32;
        let kernel = rounded_box(0.2, 0.2, 0.2, 0.02, 3).expect("a box");
        vertices.extend(&kernel.vertices);
        triangles.extend(kernel.triangles.iter().map(|t| t.map(|v| v + first)));
        assert!(TriMesh::new(vertices, triangles).is_ok());
    }

    #[test]
    fn a_body_winds_once_round_what_is_inside() {
        let body = rounded_box(2.0, 3.0, 4.0, 0.3, 4).expect("a box");
        for (p, expected) in [
            (V3::new(0.9, 0.3, 1.2), 1.0),
            (V3::new(0.5, 1.9, 0.0), 1.0),
            (V3::new(1.1, 0.3, 1.2), 0.0),
            (V3::new(0.0, -9.0, 0.0), 0.0),
        ] {
            let number = winding_number(&body.vertices, body.triangles.iter(), p);
            assert!((number - expected).abs() < 1e-12, "{number} at {p:?}");
        }
    }
}
