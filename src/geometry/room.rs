//! The winding window of a mesh that has flanges of its own.

use super::flank::FLANGE_FACE;
use super::hull::Hull;
use super::mesh::TriMesh;
use crate::math::V3;

/// Places round the core at which its flanges are looked for.
const PLACES: usize = 72;

/// Share of the places that a flange may leave open, as where wire comes in.
const OPEN: f64 = 0.1;

/// Sections that are tried where the given one lies between no flanges.
const SECTIONS: usize = 64;

/// Halvings of the interval in which a flange ends: its height is found to a four-thousandth of the mesh's radius.
const HALVINGS: u32 = 12;

/// Heights, up to the middle of a wire on the core, at which faces are looked for that its side meets.
const ROUND: u32 = 8;

/// A face of 45 degrees is nearer to the side of a wire than to its middle by the difference in height. Facets and chords may add
/// this share to that; a face that is nearer still is another one.
const SAME_FACE: f64 = 0.05;

/// Part of a normal along y below which a face is taken to be radial, as a rim that is rounded by an STL file's numbers.
const RADIAL: f64 = 1e-3;

/// Chords to a right angle of the way round a corner.
const CHORDS: usize = 8;

/// The room between two flanges. Lengths in m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Room {
    /// the inner faces along y, where they are nearest to each other
    pub faces: [f64; 2],
    /// the same where they are farthest from each other
    pub widest: [f64; 2],
    /// how far the lower flange stands above the core
    pub height: f64,
    /// largest distance of the core between them from the axis
    pub radius: f64,
}

impl TriMesh {
    /// The room round the place `y` between two flanges that are at least `least` high, m.
    ///
    /// Its faces are where wire as thick as that, laid on the core, ends that touches them.
    ///
    /// A flange is what a straight line along y meets in a face steeper than 45 degrees, from nearly everywhere round the core. So
    /// the ribs of a core with grooves are none as long as they are lower. Where `y` lies in a flange, the room is the nearest.
    pub fn room(&self, y: f64, least: f64) -> Option<Room> {
        let (low, high) = super::bodies::bounds(&self.vertices, &self.triangles);
        let at = |k: usize| low.y + (high.y - low.y) * (k as f64 + 0.5) / SECTIONS as f64;
        let mut places: Vec<f64> = (0..SECTIONS).map(at).collect();
        places.sort_by(|a, b| (a - y).abs().total_cmp(&(b - y).abs()));
        places.insert(0, y);
        let found = places.into_iter().find_map(|y| self.room_round(y, least))?;
        // the core may be wider at `y`, in a fillet or towards a slanted flange, than it is between them
        let middle = 0.5 * (found.faces[0] + found.faces[1]);
        self.room_round(middle, least).or(Some(found))
    }

    /// Another axis than y about which this mesh has flanges as those of a [`Self::room`].
    pub(crate) fn flanged_about(&self, least: f64) -> Option<char> {
        // x, y, z in turn, which keeps what is outside
        let turned = |along: usize| {
            let about = |v: &V3| V3::new(v[(along + 2) % 3], v[along], v[(along + 1) % 3]);
            let vertices = self.vertices.iter().map(about).collect();
            Self::new(vertices, self.triangles.clone()).ok()
        };
        let has_room = |along| turned(along).is_some_and(|mesh| mesh.room(0.0, least).is_some());
        let axes = [(0, 'x'), (2, 'z')].into_iter();
        axes.filter(|(along, _)| has_room(*along))
            .map(|(_, axis)| axis)
            .next()
    }

    /// The convex hull of the section at `y`; none where the axis does not go through it.
    pub(crate) fn section(&self, y: f64) -> Option<Hull> {
        Hull::of(self.section_points(y).iter().map(|p| [p.x, p.z]).collect())
    }

    fn room_round(&self, y: f64, least: f64) -> Option<Room> {
        let section = self.section(y)?;
        let faces_from = |steepness| [-1.0, 1.0].map(|side| self.faces_back(y, side, steepness));
        let flange_faces = faces_from(FLANGE_FACE);
        let met = |out| met_by(&flange_faces, &evenly(&section.outline(out, CHORDS)));
        let flanges = met(least)?;
        // a round wire of that diameter on the core meets a slanted face at the side, and one in a fillet under its middle
        let (mut reach, radius) = (flanges.clone(), 0.5 * least);
        for k in 1..=ROUND {
            let over = (f64::from(k) / f64::from(ROUND) - 1.0) * radius;
            let short = radius - (radius * radius - over * over).sqrt();
            // a face of 45 degrees is so much nearer there; what is nearer still is a rib before it
            let nearer = (1.0 + SAME_FACE) * (radius - over);
            let Some(met) = met(radius + over) else {
                continue;
            };
            for (side, met) in met.iter().enumerate() {
                for (place, met) in met.iter().enumerate() {
                    if let (Some(met), Some(flange)) = (met, flanges[side][place])
                        && met + nearer >= flange
                        && let Some(reach) = &mut reach[side][place]
                    {
                        *reach = reach.min(met + short);
                    }
                }
            }
        }
        let [down, up] = reach.map(|reach| ends(reach.into_iter().flatten().collect(), least));
        // the rim of a flange may be rounded, and is not steep up to its top
        let all_faces = faces_from(RADIAL);
        let (mut height, mut too_high) = (least, self.radius_about_y());
        for _ in 0..HALVINGS {
            let middle = 0.5 * (height + too_high);
            match met_by(&all_faces, &evenly(&section.outline(middle, CHORDS))) {
                Some(_) => height = middle,
                None => too_high = middle,
            }
        }
        Some(Room {
            faces: [y - down[0], y + up[0]],
            widest: [y - down[1], y + up[1]],
            height,
            radius: section.radius(),
        })
    }

    /// Where wire of the thickness `least` (m) first meets what stands in its way, as it is laid on from `y` towards -y and +y, m.
    ///
    /// There is one place for each that is looked at round the core; it is infinite where nothing stands.
    /// Where that is nearly all round, it is a flange of a [`Self::room`]; else a shoe, a collar's end or a boss.
    pub(crate) fn in_the_way(&self, y: f64, least: f64) -> Option<[Vec<f64>; 2]> {
        let ring = evenly(&self.section(y)?.outline(0.5 * least, CHORDS));
        Some([-1.0, 1.0].map(|side| {
            let faces = self.faces_back(y, side, FLANGE_FACE);
            let far = ring.iter().map(|&place| first(&faces, place));
            far.map(|far| y + side * far.unwrap_or(f64::INFINITY))
                .collect()
        }))
    }

    fn radius_about_y(&self) -> f64 {
        let far = self.vertices.iter().map(|v| libm::hypot(v.x, v.z));
        far.fold(0.0, f64::max)
    }

    /// The faces that look back to `y` from one side of it, with a normal that has more than this part along y.
    fn faces_back(&self, y: f64, side: f64, steepness: f64) -> Vec<Face> {
        let steep = (0..self.len() as u32).filter(|&t| side * self.normal(t).y < -steepness);
        let corners = |t: u32| self.triangles[t as usize].map(|v| self.vertices[v as usize]);
        let face = |t: u32| Face {
            corners: corners(t).map(|p| [p.x, p.z]),
            away: corners(t).map(|p| side * (p.y - y)),
        };
        steep
            .map(face)
            .filter(|face| face.away.iter().any(|&away| away > 0.0))
            .collect()
    }
}

/// A triangle as seen along y.
struct Face {
    /// corners as (x, z), m
    corners: [[f64; 2]; 3],
    /// how far along y each is, m
    away: [f64; 3],
}

impl Face {
    /// How far along y it is at (x, z), m, if it is there.
    fn at(&self, [x, z]: [f64; 2]) -> Option<f64> {
        let [a, b, c] = self.corners;
        let twice =
            |[ax, az]: [f64; 2], [bx, bz]: [f64; 2]| (ax - x) * (bz - z) - (az - z) * (bx - x);
        let parts = [twice(b, c), twice(c, a), twice(a, b)];
        let inside = parts.iter().all(|&p| p >= 0.0) || parts.iter().all(|&p| p <= 0.0);
        let whole: f64 = parts.iter().sum();
        let share = |k: usize| parts[k] / whole * self.away[k];
        (inside && whole != 0.0).then(|| share(0) + share(1) + share(2))
    }
}

/// The nearest and the farthest place of a flange. Not counted are few places that are nearer than all others by more than the wire is
/// thick, `least`, m: something stands on the core before the flange there.
fn ends(mut far: Vec<f64>, least: f64) -> [f64; 2] {
    far.sort_by(f64::total_cmp);
    let few = (OPEN * PLACES as f64) as usize;
    let stands_apart = |k: &usize| far.get(*k).is_some_and(|far_k| far_k - far[k - 1] >= least);
    let before = (1..=few).rev().find(stands_apart).unwrap_or(0);
    let counted = &far[before.min(far.len())..];
    [counted.first(), counted.last()].map(|end| end.copied().unwrap_or_default())
}

/// How far away the faces on either side are, along y from each place of a ring, m; none where one side is open at too many of them.
fn met_by(sides: &[Vec<Face>; 2], ring: &[[f64; 2]]) -> Option<[Vec<Option<f64>>; 2]> {
    let [down, up] = sides.each_ref().map(|faces| -> Option<Vec<_>> {
        let far: Vec<_> = ring.iter().map(|&p| first(faces, p)).collect();
        let open = far.iter().filter(|far| far.is_none()).count();
        (open as f64 <= OPEN * ring.len() as f64).then_some(far)
    });
    Some([down?, up?])
}

/// How far along y the first of these faces is at a place, m.
fn first(faces: &[Face], place: [f64; 2]) -> Option<f64> {
    let far = faces.iter().filter_map(|face| face.at(place));
    far.filter(|&far| far > 0.0).min_by(f64::total_cmp)
}

/// Places spread evenly over a closed outline.
fn evenly(outline: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let ahead = |k: usize| outline[(k + 1) % outline.len()];
    let length = |k: usize| {
        let ([ax, az], [bx, bz]) = (outline[k], ahead(k));
        libm::hypot(bx - ax, bz - az)
    };
    let step = (0..outline.len()).map(length).sum::<f64>() / PLACES as f64;
    let mut places = Vec::with_capacity(PLACES);
    let (mut passed, mut next) = (0.0, 0.5 * step);
    for k in 0..outline.len() {
        let ([ax, az], [bx, bz], edge) = (outline[k], ahead(k), length(k));
        while next < passed + edge {
            let share = (next - passed) / edge;
            places.push([ax + share * (bx - ax), az + share * (bz - az)]);
            next += step;
        }
        passed += edge;
    }
    places
}

#[cfg(test)]
mod tests {
    use super::super::generate;
    use super::super::mesh::TriMesh;
    use crate::math::V3;

    /// A box of 12 x 20 mm with flanges 3 mm high, their faces at -4 and 5 mm, 1 mm thick.
    fn tooth() -> TriMesh {
        joined(&[
            ([-6.0, 6.0], [-6.0, 7.0], [-10.0, 10.0]),
            ([-9.0, 9.0], [-5.0, -4.0], [-13.0, 13.0]),
            ([-9.0, 9.0], [5.0, 6.0], [-13.0, 13.0]),
        ])
    }

    /// A round core of 8 mm radius, 6 mm between flanges that rise by this angle from it, 12 mm high; faceted.
    fn slanted(angle: f64) -> TriMesh {
        let rise = 4e-3 / libm::tan(angle);
        let profile = [
            [-9e-3, 12e-3],
            [-3e-3 - rise, 12e-3],
            [-3e-3, 8e-3],
            [3e-3, 8e-3],
            [3e-3 + rise, 12e-3],
            [9e-3, 12e-3],
        ];
        revolved(&profile, 360)
    }

    /// What a profile of y and radius, m, makes when it is turned about y, with lids.
    fn revolved(profile: &[[f64; 2]], sides: u32) -> TriMesh {
        let mut vertices = Vec::new();
        for [y, radius] in profile {
            for k in 0..sides {
                let angle = std::f64::consts::TAU * f64::from(k) / f64::from(sides);
                vertices.push(V3::new(
                    radius * libm::cos(angle),
                    *y,
                    -radius * libm::sin(angle),
                ));
            }
        }
        let rings = profile.len() as u32;
        let ends = [0, rings - 1].map(|ring| {
            vertices.push(V3::new(0.0, profile[ring as usize][0], 0.0));
            vertices.len() as u32 - 1
        });
        let mut triangles = Vec::new();
        for k in 0..sides {
            let next = (k + 1) % sides;
            for ring in 0..rings - 1 {
                let [a, b] = [ring * sides + k, ring * sides + next];
                triangles.push([a, b, b + sides]);
                triangles.push([a, b + sides, a + sides]);
            }
            let last = (rings - 1) * sides;
            triangles.push([ends[0], next, k]);
            triangles.push([ends[1], last + k, last + next]);
        }
        TriMesh::new(vertices, triangles).expect("closed")
    }

    /// Between slanted flanges turns were planned that had no place, and another window was found for each place of the clamp.
    #[test]
    fn between_slanted_flanges_the_room_is_that_of_the_wire() {
        let diameter = 0.7e-3;
        for degrees in [50.0_f64, 60.0, 80.0] {
            let angle = degrees.to_radians();
            let mesh = slanted(angle);
            let wide = 6e-3 + diameter * (1.0 - libm::tan(0.5 * angle));
            for y in [-3.2e-3, -2.9e-3, 0.0, 1.0e-3, 3.1e-3] {
                let room = mesh.room(y, diameter).expect("flanges");
                for faces in [room.faces, room.widest] {
                    let found = faces[1] - faces[0];
                    // (heights are looked at one by one, and the ring has sides)
                    assert!(
                        (found - wide).abs() < 0.02 * diameter,
                        "{degrees} {y}: {found} {wide}"
                    );
                }
                assert!((room.height - 4e-3).abs() < 0.02e-3, "{room:?}");
            }
        }
    }

    /// The rim counted up to where it is less steep than 45 degrees: flanges of 3.5 mm with a radius of 1 mm were 3.2 mm high.
    #[test]
    fn flanges_with_rounded_rims_are_as_high_as_their_rims() {
        for rim in [0.05e-3, 0.5e-3, 1.0e-3] {
            let flange = |side: f64| {
                let round = (0..=24).map(move |k| {
                    let (sin, cos) =
                        libm::sincos(std::f64::consts::FRAC_PI_2 * f64::from(k) / 24.0);
                    [
                        side * (3e-3 + rim * (1.0 - cos)),
                        11.5e-3 - rim * (1.0 - sin),
                    ]
                });
                round.collect::<Vec<_>>()
            };
            let mut profile = vec![[-6e-3, 11.5e-3]];
            profile.extend(flange(-1.0).into_iter().rev());
            profile.extend([[-3e-3, 8e-3], [3e-3, 8e-3]]);
            profile.extend(flange(1.0));
            profile.push([6e-3, 11.5e-3]);
            let room = revolved(&profile, 180).room(0.0, 0.7e-3).expect("flanges");
            assert!((room.height - 3.5e-3).abs() < 0.01e-3, "{rim}: {room:?}");
            assert!(near(room.faces, [-3e-3, 3e-3]), "{rim}: {room:?}");
        }
    }

    /// A boss that is as high as the wire was taken for a flange, and the coil for a quarter of it.
    #[test]
    fn a_boss_before_a_flange_is_none() {
        let with_boss = joined(&[
            ([-6.0, 6.0], [-6.0, 7.0], [-10.0, 10.0]),
            ([-9.0, 9.0], [-5.0, -4.0], [-13.0, 13.0]),
            ([-9.0, 9.0], [5.0, 6.0], [-13.0, 13.0]),
            ([5.0, 6.6], [1.0, 2.0], [-2.0, 2.0]),
        ]);
        for y in [-3.0e-3, 1.4e-3, 4.0e-3] {
            let room = with_boss.room(y, 0.5e-3).expect("flanges");
            assert!(near(room.faces, [-4e-3, 5e-3]), "{y}: {room:?}");
        }
        let [down, up] = with_boss.in_the_way(-3.0e-3, 0.5e-3).expect("a section");
        assert!(down.iter().all(|&y| (y + 4e-3).abs() < 1e-9), "{down:?}");
        let at_boss = up.iter().filter(|&&y| (y - 1e-3).abs() < 1e-9).count();
        let share = at_boss as f64 / up.len() as f64;
        assert!((share - 4.0 / 64.0).abs() < 0.03, "{share}");
    }

    /// Boxes, mm, that overlap.
    fn joined(boxes: &[([f64; 2], [f64; 2], [f64; 2])]) -> TriMesh {
        let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
        for &(x, y, z) in boxes {
            let base = vertices.len() as u32;
            for corner in 0..8 {
                let [i, j, k] = [corner >> 2 & 1, corner >> 1 & 1, corner & 1];
                vertices.push(V3::new(x[i], y[j], z[k]) * 1e-3);
            }
            for [a, b, c, d] in [
                [0, 1, 3, 2],
                [4, 6, 7, 5],
                [0, 4, 5, 1],
                [2, 3, 7, 6],
                [0, 2, 6, 4],
                [1, 5, 7, 3],
            ] {
                triangles.push([base + a, base + b, base + c]);
                triangles.push([base + a, base + c, base + d]);
            }
        }
        TriMesh::new(vertices, triangles).expect("closed")
    }

    fn near(got: [f64; 2], want: [f64; 2]) -> bool {
        (0..2).all(|k| (got[k] - want[k]).abs() < 1e-9)
    }

    #[test]
    fn flanges_that_a_mesh_has_bound_its_room() {
        let room = tooth().room(0.1e-3, 0.5e-3).expect("between flanges");
        assert!(near(room.faces, [-4e-3, 5e-3]), "{room:?}");
        assert!(near(room.widest, room.faces), "{room:?}");
        assert!((room.height - 3e-3).abs() < 1e-4, "{room:?}");
        assert!(
            (room.radius - 1e-3 * 136_f64.sqrt()).abs() < 1e-9,
            "{room:?}"
        );
    }

    #[test]
    fn a_place_in_a_flange_has_the_room_beside_it() {
        let tooth = tooth();
        let inside = tooth.room(0.1e-3, 0.5e-3).expect("between flanges");
        let on_rim = tooth.room(-4.6e-3, 0.5e-3).expect("found all the same");
        assert!(near(on_rim.faces, inside.faces), "{on_rim:?}");
    }

    #[test]
    fn of_two_chambers_the_one_with_the_place_counts() {
        let mut boxes = vec![([-6.0, 6.0], [-9.0, 9.0], [-10.0, 10.0])];
        for y in [-8.0, 0.0, 7.0] {
            boxes.push(([-9.0, 9.0], [y, y + 1.0], [-13.0, 13.0]));
        }
        let core = joined(&boxes);
        let lower = core.room(-3e-3, 0.5e-3).expect("a chamber");
        assert!(near(lower.faces, [-7e-3, 0.0]), "{lower:?}");
        let upper = core.room(4e-3, 0.5e-3).expect("a chamber");
        assert!(near(upper.faces, [1e-3, 7e-3]), "{upper:?}");
    }

    #[test]
    fn faces_that_lean_are_wider_apart_outside() {
        let mut leaning = tooth();
        for v in &mut leaning.vertices {
            // the upper flange leans along x
            v.y += if v.y > 4.5e-3 && v.x.abs() > 8e-3 {
                0.1 * v.x
            } else {
                0.0
            };
        }
        let leaning = TriMesh::new(leaning.vertices, leaning.triangles).expect("closed");
        let room = leaning.room(0.0, 0.5e-3).expect("between flanges");
        assert!(room.widest[1] > room.faces[1] + 1e-3, "{room:?}");
    }

    #[test]
    fn there_is_none_without_flanges_or_between_low_ribs() {
        let (plain, ribs) = (
            joined(&[([-6.0, 6.0], [-6.0, 7.0], [-10.0, 10.0])]),
            joined(&[
                ([-6.0, 6.0], [-6.0, 7.0], [-10.0, 10.0]),
                ([-6.4, 6.4], [-3.0, -2.0], [-10.4, 10.4]),
                ([-6.4, 6.4], [2.0, 3.0], [-10.4, 10.4]),
            ]),
        );
        assert_eq!(plain.room(0.1e-3, 0.5e-3), None);
        assert_eq!(ribs.room(0.1e-3, 0.5e-3), None);
        assert!(ribs.room(0.1e-3, 0.3e-3).is_some());
        let bar = generate::cylinder(8e-3, 20e-3, 64).expect("a bar");
        assert_eq!(bar.room(0.0, 0.5e-3), None);
    }
}
