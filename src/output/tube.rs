//! The wire's surface: circular sections swept along the centreline.

use crate::math::V3;

/// Surface of a wire as quadrilaterals between rings of points.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TubeMesh {
    /// points, ring by ring, m
    pub points: Vec<V3>,
    /// outward unit normals at the points
    pub normals: Vec<V3>,
    /// points per ring
    pub sides: usize,
    /// number of rings, one per node of the centreline
    pub rings: usize,
}

/// Point indices of one polygon, outward side counterclockwise.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Polygon {
    /// between two rings
    Side([u32; 4]),
    /// the wire's end
    Cap(Vec<u32>),
}

impl AsRef<[u32]> for Polygon {
    fn as_ref(&self) -> &[u32] {
        match self {
            Self::Side(corners) => corners,
            Self::Cap(corners) => corners,
        }
    }
}

impl TubeMesh {
    /// Sides, ring by ring, then the two end caps: one at a time, for a long wire has millions.
    pub fn polygons(&self) -> impl Iterator<Item = Polygon> + Clone {
        let (n, rings) = (self.sides as u32, self.rings as u32);
        let sides = (0..rings.saturating_sub(1))
            .flat_map(move |ring| (0..n).map(move |side| (ring * n, side, (side + 1) % n)))
            .map(move |(first, a, b)| [first + a, first + b, first + n + b, first + n + a])
            .map(Polygon::Side);
        let caps = (rings > 1).then(|| {
            [
                (0..n).rev().collect(),
                (0..n).map(|side| (rings - 1) * n + side).collect(),
            ]
        });
        sides.chain(caps.into_iter().flatten().map(Polygon::Cap))
    }
}

/// Sweeps a circle of `radius` (m) with `sides` points along a centreline.
///
/// The circle's zero direction is carried along with the least rotation, so the surface does not
/// twist. Fewer than two points make an empty surface.
pub fn tube_mesh(centreline: &[V3], radius: f64, sides: usize) -> TubeMesh {
    let tangents = tangents(centreline);
    let mut mesh = TubeMesh {
        sides,
        rings: tangents.len(),
        ..TubeMesh::default()
    };
    let Some(first) = tangents.first() else {
        return mesh;
    };
    let mut across = first.cross(&least_axis(*first)).normalize();
    let circle: Vec<(f64, f64)> = (0..sides)
        .map(|side| std::f64::consts::TAU * side as f64 / sides as f64)
        .map(|a| (libm::cos(a), libm::sin(a)))
        .collect();
    for (&centre, tangent) in centreline.iter().zip(&tangents) {
        let carried = across - tangent * across.dot(tangent);
        across = carried.try_normalize(1e-9).unwrap_or_else(|| {
            // Folded back on itself: any direction across will do.
            tangent.cross(&least_axis(*tangent)).normalize()
        });
        let up = tangent.cross(&across);
        for &(c, s) in &circle {
            let normal = across * c + up * s;
            mesh.points.push(centre + normal * radius);
            mesh.normals.push(normal);
        }
    }
    mesh
}

/// Unit tangents at the points: mean direction of the edges on both sides.
fn tangents(points: &[V3]) -> Vec<V3> {
    if points.len() < 2 {
        return Vec::new();
    }
    let mut last = V3::y();
    let edges: Vec<V3> = points
        .windows(2)
        .map(|pair| {
            last = (pair[1] - pair[0]).try_normalize(1e-15).unwrap_or(last);
            last
        })
        .collect();
    (0..points.len())
        .map(|node| {
            let after = edges[node.min(edges.len() - 1)];
            let before = edges[node.saturating_sub(1)];
            (before + after).try_normalize(1e-9).unwrap_or(after)
        })
        .collect()
}

/// The axis most across a direction.
fn least_axis(t: V3) -> V3 {
    let a = t.abs();
    if a.x <= a.y && a.x <= a.z {
        V3::x()
    } else if a.y <= a.z {
        V3::y()
    } else {
        V3::z()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn helix() -> Vec<V3> {
        (0..200)
            .map(|k| 0.05 * f64::from(k))
            .map(|a| V3::new(libm::cos(a), 0.1 * a, libm::sin(a)))
            .collect()
    }

    #[test]
    fn every_point_is_a_radius_from_its_node_and_across_the_wire() {
        let line = helix();
        let mesh = tube_mesh(&line, 0.02, 12);
        assert_eq!((mesh.rings, mesh.points.len()), (200, 2400));
        for (k, (p, n)) in mesh.points.iter().zip(&mesh.normals).enumerate() {
            let centre = line[k / 12];
            assert!((p - centre - n * 0.02).norm() < 1e-14);
            assert!((n.norm() - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn the_surface_encloses_the_wire_volume() {
        // Divergence theorem over all polygons: holds only when all are closed and face outwards.
        let mesh = tube_mesh(&helix(), 0.02, 24);
        let volume: f64 = mesh
            .polygons()
            .flat_map(|p| {
                let p = p.as_ref().to_vec();
                (1..p.len() - 1).map(move |k| [p[0], p[k], p[k + 1]])
            })
            .map(|t| t.map(|i| mesh.points[i as usize]))
            .map(|[a, b, c]| a.dot(&b.cross(&c)) / 6.0)
            .sum();
        let section = 12.0 * libm::sin(std::f64::consts::TAU / 24.0) * 0.02 * 0.02;
        let length: f64 = helix().windows(2).map(|p| (p[1] - p[0]).norm()).sum();
        assert!((volume / (section * length) - 1.0).abs() < 1e-3, "{volume}");
    }

    #[test]
    fn neighbouring_rings_are_not_twisted() {
        let mesh = tube_mesh(&helix(), 0.02, 12);
        for k in 0..mesh.points.len() - 12 {
            assert!(mesh.normals[k].dot(&mesh.normals[k + 12]) > 0.998);
        }
    }

    #[test]
    fn degenerate_wire_makes_no_wrong_numbers() {
        assert!(tube_mesh(&[], 1.0, 12).polygons().next().is_none());
        assert!(tube_mesh(&[V3::x()], 1.0, 12).polygons().next().is_none());
        let folded = [V3::zeros(), V3::x(), V3::zeros(), V3::zeros(), V3::y()];
        let mesh = tube_mesh(&folded, 0.1, 12);
        assert!(mesh.points.iter().all(|p| p.iter().all(|c| c.is_finite())));
    }
}
