//! Meshes of the shapes a scene can name without a file.
//!
//! Vertices lie *on* the true surface. So flats are exact and join the arcs without a step, and
//! the arcs are chords. The mesh lies inside the true surface by at most the [`sagitta`], by two
//! thirds of it on average. (Moving the vertices out to balance the error would lift the flats.)
//! [`segments_for_sagitta`] chooses the number of chords.
//!
//! Sides are two triangles per chord over the whole length, caps are fans around the axis.

use super::error::MeshError;
use super::flange::Flanges;
use super::hull::Hull;
use super::mesh::TriMesh;
use super::shape::Shape;
use crate::math::V3;
use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};

/// Most chords of a full turn. Chosen: a sagitta of 3e-6 radii at most is lost.
const MOST_SEGMENTS: usize = 4096;

/// Share of a plate's thickness that is nothing but rounding.
const ROUNDING: f64 = 1e-9;

/// Share of its distance by which the section at a flange's inner face is taken before it: single precision in an STL file.
const AT_FACE: f64 = 1e-6;

/// Height of an arc of `radius` (m) over its chord, for `segments` chords in a full turn, m.
#[cfg(any(test, feature = "lab"))]
pub fn sagitta(radius: f64, segments: usize) -> f64 {
    // 1 - cos(a) = 2 sin^2(a / 2) keeps its digits for small angles.
    let half = libm::sin(0.5 * PI / segments.max(1) as f64);
    2.0 * radius * half * half
}

/// Chords in a full turn, a multiple of 4, so that arcs of `radius` (m) stand at most `sagitta`
/// (m) over them; 8 to 4096. A [`rounded_box`] takes a quarter of it per corner.
pub fn segments_for_sagitta(radius: f64, sagitta: f64) -> usize {
    let share = 0.5 * sagitta / radius;
    let quarters = if share > 0.0 && share < 0.5 {
        (0.5 * PI / libm::asin(share.sqrt()) / 4.0 - 1e-9).ceil()
    } else if share > 0.0 {
        2.0
    } else {
        MOST_SEGMENTS as f64
    };
    // Casting saturates, so an enormous or NaN count is safe.
    (4 * quarters as usize).clamp(8, MOST_SEGMENTS)
}

/// Rounded rectangle `width_x` by `height_z` (m) extruded over `length_y` (m), centred at the
/// origin; its four long edges are arcs of `corner_radius` (m, 0: sharp) in `corner_segments`
/// chords each.
pub fn rounded_box(
    width_x: f64,
    height_z: f64,
    length_y: f64,
    corner_radius: f64,
    corner_segments: usize,
) -> Result<TriMesh, MeshError> {
    for (name, value) in [
        ("width_x", width_x),
        ("height_z", height_z),
        ("length_y", length_y),
    ] {
        check_positive(name, value)?;
    }
    let (half_x, half_z) = (0.5 * width_x, 0.5 * height_z);
    let most = half_x.min(half_z);
    if !(0.0..=most).contains(&corner_radius) {
        let allowed = format!("0 to {most} m, half of the smaller side");
        return Err(MeshError::Dimension {
            name: "corner_radius",
            value: corner_radius,
            allowed,
        });
    }
    check_count("corner_segments", corner_segments, 1, MOST_SEGMENTS / 4)?;

    let chords = if corner_radius > 0.0 {
        corner_segments
    } else {
        0
    };
    let mut section = rounded_rectangle([half_x, half_z], corner_radius, chords);
    // A radius of half a side leaves no flat there, and neighbouring arcs share a vertex.
    section.dedup();
    if section.len() > 1 && section.first() == section.last() {
        section.pop();
    }
    extrude(&section, length_y)
}

/// Vertices of a rounded rectangle, m, from +x towards +z, each corner in so many chords. Vertices of arcs that meet come twice.
fn rounded_rectangle(half: [f64; 2], corner_radius: f64, chords: usize) -> Vec<[f64; 2]> {
    let (centre_x, centre_z) = (half[0] - corner_radius, half[1] - corner_radius);
    let signs = [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)];
    let mut section: Vec<[f64; 2]> = Vec::with_capacity(4 * (chords + 1));
    for (quarter, (sign_x, sign_z)) in signs.into_iter().enumerate() {
        for step in 0..=chords {
            // One quarter's values mirrored, so that opposite sides agree to the bit.
            let step = if quarter % 2 == 0 {
                step
            } else {
                chords - step
            };
            let (cos, sin) = unit_in_quarter(step, chords);
            let x = centre_x + corner_radius * cos;
            let z = centre_z + corner_radius * sin;
            section.push([sign_x * x, sign_z * z]);
        }
    }
    section
}

/// A core between flanges as one surface; `corner_chords` to a right angle round the axis, `edge_chords` round the edges of
/// the flanges.
pub fn flanged(
    flanges: &Flanges,
    corner_chords: usize,
    edge_chords: usize,
) -> Result<TriMesh, MeshError> {
    let (half, corner_radius) = match flanges.core {
        Shape::RoundedBox {
            half_x,
            half_z,
            corner_radius,
            ..
        } => ([half_x, half_z], corner_radius),
        Shape::Cylinder { radius, .. } => ([radius; 2], radius),
        Shape::Mesh(_) => {
            return Err(MeshError::Dimension {
                name: "core",
                value: f64::NAN,
                allowed: "a box or a cylinder; plates beside a mesh are part of it".to_owned(),
            });
        }
    };
    let plates = Plates {
        half_inner: flanges.half_inner,
        height: flanges.height,
        thickness: flanges.thickness,
        edge_radius: flanges.edge_radius,
    };
    plates.check(corner_chords, edge_chords)?;
    let wall = plates.wall(edge_chords);
    let mirrored = wall.iter().rev().map(|&[y, s]| [-y, s]);
    let profile: Vec<[f64; 2]> = mirrored.chain(wall.iter().copied()).collect();
    let ring = |s: f64| {
        let half = half.map(|h| h + s);
        let radius = corner_radius + s;
        let chords = if corner_radius + flanges.height > 0.0 {
            corner_chords
        } else {
            0
        };
        rounded_rectangle(half, radius, chords)
    };
    let rings: Vec<Vec<V3>> = profile
        .iter()
        .map(|&[y, s]| ring(s).iter().map(|&[x, z]| V3::new(x, y, z)).collect())
        .collect();
    sewn(&rings)
}

/// Two plates beside a core, the same on both sides of y = 0, m.
#[derive(Clone, Copy, Debug)]
pub struct Plates {
    /// half the distance between their inner faces
    pub half_inner: f64,
    /// how far the rim stands above the core
    pub height: f64,
    /// along y
    pub thickness: f64,
    /// radius of the edges of the rim
    pub edge_radius: f64,
}

impl Plates {
    /// From the core to the outer face on +y: place along y and height over the core, m.
    fn wall(&self, edge_chords: usize) -> Vec<[f64; 2]> {
        let (inner, outer) = (self.half_inner, self.half_inner + self.thickness);
        let edge = self.edge_radius;
        if edge == 0.0 {
            return vec![[inner, 0.0], [inner, self.height], [outer, self.height]];
        }
        let rim = self.height - edge;
        let mut wall = vec![[inner, 0.0]];
        for step in 0..=edge_chords {
            let (cos, sin) = unit_in_quarter(step, edge_chords);
            wall.push([inner + edge - edge * cos, rim + edge * sin]);
        }
        for step in 0..=edge_chords {
            let (cos, sin) = unit_in_quarter(step, edge_chords);
            wall.push([outer - edge + edge * sin, rim + edge * cos]);
        }
        // where edges meet each other or the core, two sums put one point apart by rounding
        let apart = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).abs().max((a[1] - b[1]).abs());
        wall.dedup_by(|a, b| apart(*a, *b) <= ROUNDING * self.thickness);
        wall
    }

    fn check(&self, corner_chords: usize, edge_chords: usize) -> Result<(), MeshError> {
        for (name, value) in [
            ("inner_distance", self.half_inner),
            ("height", self.height),
            ("thickness", self.thickness),
        ] {
            check_positive(name, value)?;
        }
        check_count("corner_segments", corner_chords, 1, MOST_SEGMENTS / 4)?;
        check_count("edge_segments", edge_chords, 1, MOST_SEGMENTS / 4)
    }
}

/// A core and two plates beside it as one surface; chords as in [`flanged`]. Each plate has the hull of the core's section at its
/// inner face, and its rim stands the same height further out all round.
pub fn with_plates(
    core: &TriMesh,
    plates: &Plates,
    corner_chords: usize,
    edge_chords: usize,
) -> Result<TriMesh, MeshError> {
    plates.check(corner_chords, edge_chords)?;
    let wall = plates.wall(edge_chords);
    let mut parts = vec![core.clone()];
    for side in [-1.0, 1.0] {
        // (a core that ends at the inner face has a section just before it)
        let section = core.section_points(side * plates.half_inner * (1.0 - AT_FACE));
        let hull = Hull::of(section.iter().map(|p| [p.x, p.z]).collect());
        let Some(hull) = hull else {
            return Err(MeshError::Dimension {
                name: "inner_distance",
                value: 2.0 * plates.half_inner,
                allowed: "such that the core goes round its axis at both inner faces".to_owned(),
            });
        };
        let ring = |&[y, out]: &[f64; 2]| -> Vec<V3> {
            let outline = hull.outline(out, corner_chords);
            let at = |&[x, z]: &[f64; 2]| V3::new(x, side * y, z);
            outline.iter().map(at).collect()
        };
        let mut rings: Vec<Vec<V3>> = wall.iter().map(ring).collect();
        if side < 0.0 {
            rings.reverse();
        }
        parts.push(sewn(&rings)?);
    }
    TriMesh::together(&parts)
}

/// A prism along y on this section, from one place (m) to another.
pub(crate) fn prism(section: &Hull, [low, high]: [f64; 2]) -> Result<TriMesh, MeshError> {
    let corners = section.outline(0.0, 1);
    let ring = |y: f64| corners.iter().map(|&[x, z]| V3::new(x, y, z)).collect();
    sewn(&[ring(low), ring(high)])
}

/// Pulley about y with a V groove at y = 0, `bottom_radius` (m) at its lowest, walls that include `angle` (rad) and rise by
/// `depth` (m), in `segments` flat sides.
#[cfg(any(feature = "lab", test))]
pub fn grooved_pulley(
    bottom_radius: f64,
    angle: f64,
    depth: f64,
    segments: usize,
) -> Result<TriMesh, MeshError> {
    check_positive("bottom_radius", bottom_radius)?;
    check_positive("depth", depth)?;
    if !(angle > 0.0 && angle < PI) {
        return Err(MeshError::Dimension {
            name: "angle",
            value: angle,
            allowed: "above 0 and below pi rad".to_owned(),
        });
    }
    check_count("segments", segments, 3, MOST_SEGMENTS)?;
    let half_width = depth * libm::tan(0.5 * angle);
    let rim = bottom_radius + depth;
    let ring = |y: f64, radius: f64| -> Vec<V3> {
        let at = |i: usize| {
            let a = TAU * i as f64 / segments as f64;
            V3::new(radius * libm::cos(a), y, radius * libm::sin(a))
        };
        // From +x towards +z, as `sewn` wants them.
        (0..segments).map(at).collect()
    };
    sewn(&[
        ring(-half_width, rim),
        ring(0.0, bottom_radius),
        ring(half_width, rim),
    ])
}

/// The closed surface through rings of as many points each, from low to high y, with a fan round the axis at both ends. Points of a
/// ring may coincide.
pub(crate) fn sewn(rings: &[Vec<V3>]) -> Result<TriMesh, MeshError> {
    let mut vertices: Vec<V3> = Vec::new();
    let mut known = BTreeMap::new();
    let mut number = |p: V3| {
        // -0 is 0
        let key = [p.x, p.y, p.z].map(|c| (c + 0.0).to_bits());
        *known.entry(key).or_insert_with(|| {
            vertices.push(p);
            vertices.len() as u32 - 1
        })
    };
    let numbers: Vec<Vec<u32>> = rings
        .iter()
        .map(|ring| ring.iter().map(|&p| number(p)).collect())
        .collect();
    let hub = |ring: &Vec<V3>| V3::new(0.0, ring[0].y, 0.0);
    let hubs = [number(hub(&rings[0])), number(hub(&rings[rings.len() - 1]))];
    let mut triangles = Vec::new();
    let mut triangle = |corners: [u32; 3]| {
        let [a, b, c] = corners;
        if a != b && b != c && c != a {
            triangles.push(corners);
        }
    };
    let count = numbers[0].len();
    for k in 0..count {
        let next = (k + 1) % count;
        for pair in numbers.windows(2) {
            let (low, high) = (&pair[0], &pair[1]);
            triangle([low[k], high[k], high[next]]);
            triangle([low[k], high[next], low[next]]);
        }
        let (first, last) = (&numbers[0], &numbers[numbers.len() - 1]);
        triangle([hubs[1], last[next], last[k]]);
        triangle([hubs[0], first[k], first[next]]);
    }
    TriMesh::new(vertices, triangles)
}

/// Cylinder of `radius` (m) about y over `length_y` (m), centred at the origin, in `segments`
/// flat sides.
pub fn cylinder(radius: f64, length_y: f64, segments: usize) -> Result<TriMesh, MeshError> {
    check_positive("radius", radius)?;
    check_positive("length_y", length_y)?;
    check_count("segments", segments, 3, MOST_SEGMENTS)?;
    let on_circle = |i: usize| {
        let angle = TAU * i as f64 / segments as f64;
        [radius * libm::cos(angle), radius * libm::sin(angle)]
    };
    let section: Vec<[f64; 2]> = (0..segments).map(on_circle).collect();
    extrude(&section, length_y)
}

/// Extrudes a section, star-shaped about the origin and running from +x towards +z, along y.
fn extrude(section: &[[f64; 2]], length_y: f64) -> Result<TriMesh, MeshError> {
    let count = section.len() as u32;
    let half = 0.5 * length_y;
    let ring = |y: f64| section.iter().map(move |&[x, z]| V3::new(x, y, z));
    let mut vertices: Vec<V3> = ring(-half).chain(ring(half)).collect();
    let (low_hub, high_hub) = (2 * count, 2 * count + 1);
    vertices.push(V3::new(0.0, -half, 0.0));
    vertices.push(V3::new(0.0, half, 0.0));
    let mut triangles = Vec::with_capacity(4 * section.len());
    for low in 0..count {
        let next_low = (low + 1) % count;
        let (high, next_high) = (low + count, next_low + count);
        triangles.push([low, high, next_high]);
        triangles.push([low, next_high, next_low]);
        triangles.push([high_hub, next_high, high]);
        triangles.push([low_hub, low, next_low]);
    }
    TriMesh::new(vertices, triangles)
}

/// Cosine and sine of `step / chords` of a right angle, exact at both ends.
fn unit_in_quarter(step: usize, chords: usize) -> (f64, f64) {
    if step == 0 {
        (1.0, 0.0)
    } else if step == chords {
        (0.0, 1.0)
    } else {
        let angle = 0.5 * PI * step as f64 / chords as f64;
        (libm::cos(angle), libm::sin(angle))
    }
}

fn check_positive(name: &'static str, value: f64) -> Result<(), MeshError> {
    if value > 0.0 && value.is_finite() {
        return Ok(());
    }
    Err(MeshError::Dimension {
        name,
        value,
        allowed: "above 0 m".to_owned(),
    })
}

fn check_count(
    name: &'static str,
    value: usize,
    least: usize,
    most: usize,
) -> Result<(), MeshError> {
    if (least..=most).contains(&value) {
        return Ok(());
    }
    Err(MeshError::Dimension {
        name,
        value: value as f64,
        allowed: format!("{least} to {most}"),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounded_box_has_the_volume_of_its_polygon() {
        let (w, h, l, r, n) = (0.012, 0.03, 0.04, 0.002, 6);
        let mesh = rounded_box(w, h, l, r, n).unwrap();
        let chord_angle = 0.5 * PI / n as f64;
        let corners = 4.0 * n as f64 * 0.5 * r * r * chord_angle.sin();
        let section = w * h - 4.0 * r * r + corners;
        assert!((mesh.volume() - section * l).abs() < 1e-12 * section * l);
        assert!(mesh.is_convex());
        // Two triangles per side, one per side and cap.
        assert_eq!(mesh.len(), 4 * 4 * (n + 1));
        let high = mesh.vertices.iter().fold(V3::zeros(), |m, v| m.sup(v));
        assert_eq!(high, V3::new(0.5 * w, 0.5 * l, 0.5 * h));
    }

    /// One flange of ten with edges of half its thickness was refused as a mesh: its two edges met in points that rounding put apart.
    #[test]
    fn edges_of_flanges_may_meet() {
        for step in 0..200 {
            let width = 0.01 + 1.37e-5 * f64::from(step);
            let core = Shape::Cylinder {
                radius: 0.5 * width,
                half_y: 0.01,
            };
            for (height, edge_radius) in [(1.5e-3, 0.5e-3), (0.5e-3, 0.5e-3)] {
                let flanges = Flanges {
                    core: core.clone(),
                    half_inner: 0.5 * width - 1.1e-3,
                    height,
                    thickness: 1e-3,
                    edge_radius,
                };
                let mesh = flanged(&flanges, 8, 4).expect("it has corners");
                let least = |t: usize| {
                    let [a, b, c] = mesh.triangles[t].map(|k| mesh.vertices[k as usize]);
                    (b - a).cross(&(c - a)).norm()
                };
                assert!((0..mesh.len()).all(|t| least(t) > 1e-12), "{width}");
            }
        }
    }

    #[test]
    fn limits_of_the_corner_radius() {
        // Sharp: a box of 4 sides; half the width: two half cylinders and two flats; both: a
        // circle.
        assert_eq!(rounded_box(0.02, 0.02, 0.04, 0.0, 9).unwrap().len(), 16);
        assert_eq!(
            rounded_box(0.01, 0.02, 0.04, 0.005, 3).unwrap().len(),
            4 * (4 * 3 + 2)
        );
        assert_eq!(
            rounded_box(0.02, 0.02, 0.04, 0.01, 3).unwrap().len(),
            4 * 4 * 3
        );
        for (radius, ok) in [
            (0.0101, false),
            (-1e-9, false),
            (f64::NAN, false),
            (0.01, true),
        ] {
            assert_eq!(
                rounded_box(0.02, 0.03, 0.04, radius, 3).is_ok(),
                ok,
                "{radius}"
            );
        }
    }

    #[test]
    fn bad_dimensions_are_refused_by_name() {
        let name = |result: Result<TriMesh, MeshError>| match result {
            Err(MeshError::Dimension { name, .. }) => name,
            other => panic!("{other:?}"),
        };
        assert_eq!(name(rounded_box(0.0, 0.02, 0.04, 0.0, 9)), "width_x");
        assert_eq!(name(rounded_box(0.02, f64::NAN, 0.04, 0.0, 9)), "height_z");
        assert_eq!(
            name(rounded_box(0.02, 0.02, 0.04, 0.001, 0)),
            "corner_segments"
        );
        assert_eq!(name(cylinder(-1.0, 0.04, 9)), "radius");
        assert_eq!(name(cylinder(1.0, f64::INFINITY, 9)), "length_y");
        assert_eq!(name(cylinder(1.0, 0.04, 2)), "segments");
        assert!(rounded_box(1e300, 1e300, 1.0, 0.0, 1).is_err());
        assert!(cylinder(1e-200, 1e-200, 8).is_err());
    }

    #[test]
    fn sagitta_is_kept() {
        for radius in [1e-3, 0.01, 0.3] {
            for wanted in [1e-7, 1e-6, 2e-5] {
                let n = segments_for_sagitta(radius, wanted);
                assert_eq!(n % 4, 0);
                assert!(sagitta(radius, n) <= wanted * (1.0 + 1e-6) || n == MOST_SEGMENTS);
                // and no finer than needed
                assert!(n == 8 || sagitta(radius, n - 4) > wanted);
            }
        }
        assert_eq!(segments_for_sagitta(0.01, 1.0), 8);
        for nonsense in [0.0, -1.0, f64::NAN] {
            assert_eq!(segments_for_sagitta(0.01, nonsense), MOST_SEGMENTS);
        }
        let n = 12;
        let middle_of_chord = 0.01 * libm::cos(PI / n as f64);
        assert!((0.01 - middle_of_chord - sagitta(0.01, n)).abs() < 1e-16);
    }
}
