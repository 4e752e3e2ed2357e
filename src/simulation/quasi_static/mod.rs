//! Computes how high the wire stands off the core at rest, the reference of the bulge flag.
//!
//! A wire bent round a corner under tension does not lie flat on the faces beside it. The height
//! at rest is that of a loop drawn tight round the core without friction at the set tension.
//! A quarter of the loop is computed, from the middle of one face to the middle of the next; round a core
//! without two mirror planes, a whole turn. It has the rod, section and contact of the winding.

mod drawn_loop;
mod tapered;
mod whole_turn;

use crate::geometry::generate::prism;
use crate::geometry::{Hull, Surface};
use crate::math::{V3, frame_along, scaled};
use crate::measure::{Profile, STATION_STEP, STATIONS_PER_TURN};
use crate::rod::{Rod, Section, Twist};
use crate::scene::{Core, Scene};
use crate::system::{Support, System};
use drawn_loop::{
    MOST_EDGES, SPACING, draw_tight, heights, loop_section, profile_of, stiffened, touching_core,
};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI, SQRT_2};
use std::sync::Arc;

/// The loop starts this far outside the core, m, for wire of 0.7 mm.
const START_GAP: f64 = 2e-3;

/// Largest difference of the two sides of a mesh, diameters; a tenth of the largest bulge excess.
const SYMMETRIC: f64 = 0.05;
/// Error of the heights, m, for wire of 0.7 mm.
const TOLERANCE: f64 = 1e-7;

/// Height over the core by polar angle of wire at rest under `tension`, N. There is none without tension, for a mesh that its
/// axis does not go through, and where no loop is found.
///
/// On a cylinder wire has no faces to stand off from: its helix lies on the core.
pub(super) fn profile(scene: &Scene, surface: &Arc<Surface>, tension: f64) -> Option<Profile> {
    if tension <= 0.0 {
        return None;
    }
    match scene.core {
        Core::Cylinder { .. } => Profile::new(vec![0.0]),
        Core::RoundedBox {
            width_x,
            height_z,
            corner_radius,
            ..
        } => {
            let section = CoreSection {
                half: [0.5 * width_x, 0.5 * height_z],
                corner: corner_radius,
                y: 0.0,
            };
            round_section(scene, surface, surface, &section, tension)
        }
        Core::Mesh { .. } => tapered::profile(surface, scene.wire.diameter, |prism| {
            round_mesh(scene, prism, surface, tension)
        })
        .or_else(|| round_mesh(scene, surface, surface, tension))
        .or_else(|| {
            let prism = prism_at_waist(surface, scene.wire.diameter)?;
            let prism = Arc::new(prism);
            round_mesh(scene, &prism, &prism, tension)
        }),
    }
}

/// The same round the middle of a mesh, and over that of another.
fn round_mesh(
    scene: &Scene,
    surface: &Arc<Surface>,
    over: &Surface,
    tension: f64,
) -> Option<Profile> {
    match CoreSection::of(surface, SYMMETRIC * scene.wire.diameter) {
        Some(section) => round_section(scene, surface, over, &section, tension),
        None => whole_turn::profile(scene, surface, over, tension),
    }
}

/// The same round a section with two mirror planes.
fn round_section(
    scene: &Scene,
    surface: &Arc<Surface>,
    over: &Surface,
    section: &CoreSection,
    tension: f64,
) -> Option<Profile> {
    let sys = quarter_loop(scene, surface, section, tension)?;
    let quarter = heights(scene, over, &sys.state.rod.x);
    profile_of(&quarter, |angle| {
        // fold into the quarter from +x to +z
        let a = angle.rem_euclid(PI);
        a.min(PI - a)
    })
}

/// A prism on the section in the middle of a mesh, where that is a shallow waist; `diameter` of the wire, m.
///
/// Wire lies right on the edges of such a section, between faces that push it this way and that, and finds no rest but by
/// friction. Round the prism it does, and lies as high.
fn prism_at_waist(surface: &Surface, diameter: f64) -> Option<Surface> {
    let (low, high) = surface.bounds();
    let y = 0.5 * (low.y + high.y);
    let points = [0.0, -0.5, 0.5].map(|aside| surface.mesh().section_points(y + aside * diameter));
    let is_waist = (0..STATIONS_PER_TURN).all(|k| {
        let [here, below, above] = points
            .each_ref()
            .map(|at| reach(at, k as f64 * STATION_STEP));
        let rises = 0.0..=SYMMETRIC * diameter;
        rises.contains(&(below - here)) && rises.contains(&(above - here))
    });
    if !is_waist {
        return None;
    }
    let hull = Hull::of(points[0].iter().map(|p| [p.x, p.z]).collect())?;
    let mesh = prism(&hull, [y - hull.radius(), y + hull.radius()]).ok()?;
    Some(Surface::new(mesh))
}

/// How far points reach from the axis in a direction, rad from +x to +z, m.
fn reach(points: &[V3], angle: f64) -> f64 {
    let (x, z) = (libm::cos(angle), libm::sin(angle));
    let along = points.iter().map(|p| x * p.x + z * p.z);
    along.fold(f64::NEG_INFINITY, f64::max)
}

/// The core's section square to its axis, as far as a loop round it needs it.
#[derive(Clone, Copy, Debug)]
struct CoreSection {
    /// half its width along x and z, m
    half: [f64; 2],
    /// radius of its corners, m
    corner: f64,
    /// where along y, m
    y: f64,
}

impl CoreSection {
    /// That of a mesh at the middle of its length, if it is the same on both sides of x and z but for `tolerance`, m.
    fn of(surface: &Surface, tolerance: f64) -> Option<Self> {
        let (low, high) = surface.bounds();
        let y = 0.5 * (low.y + high.y);
        let points = surface.mesh().section_points(y);
        let reach = |angle: f64| reach(&points, angle);
        let is_symmetric = (0..=STATIONS_PER_TURN / 4).all(|k| {
            let angle = k as f64 * STATION_STEP;
            let here = reach(angle);
            [PI - angle, PI + angle, -angle]
                .iter()
                .all(|&mirrored| (reach(mirrored) - here).abs() <= tolerance)
        });
        let half = [reach(0.0), reach(FRAC_PI_2)];
        if !is_symmetric || half[0].min(half[1]) <= 0.0 {
            return None;
        }
        // a rounded rectangle reaches (a + b - 2 r) / sqrt 2 + r at 45 degrees
        let corner = (half[0] + half[1] - SQRT_2 * reach(FRAC_PI_4)) / (2.0 - SQRT_2);
        let corner = corner.clamp(0.0, half[0].min(half[1]));
        Some(Self { half, corner, y })
    }
}

/// The quarter loop before it is drawn: from (`a`, 0) to (0, `b`) at `y`, a circle of `radius` between straights, m.
#[derive(Clone, Copy, Debug)]
struct Outline {
    a: f64,
    b: f64,
    radius: f64,
    y: f64,
}

impl Outline {
    fn length(&self) -> f64 {
        self.a + self.b - 2.0 * self.radius + FRAC_PI_2 * self.radius
    }

    /// Point at `s` along the quarter.
    fn at(&self, s: f64) -> V3 {
        let (rise, reach) = (self.b - self.radius, self.a - self.radius);
        let arc = FRAC_PI_2 * self.radius;
        if s < rise {
            return V3::new(self.a, self.y, s);
        }
        let t = ((s - rise) / self.radius).min(FRAC_PI_2);
        let beyond = (s - rise - arc).max(0.0);
        V3::new(
            reach + self.radius * libm::cos(t) - beyond,
            self.y,
            rise + self.radius * libm::sin(t),
        )
    }
}

/// The quarter loop at rest, by the production method whatever the scene winds with.
///
/// Two ways lead there. Wire that starts loose and well outside is drawn tight. On long faces such a loop buckles or finds no
/// rest; there, wire that starts tight and as limp as a string is stiffened.
fn quarter_loop(
    scene: &Scene,
    surface: &Arc<Surface>,
    core: &CoreSection,
    tension: f64,
) -> Option<System> {
    let [loose, tight] = starts(scene, surface, core);
    let section = loose.model.section.clone();
    draw_tight(loose, tension, TOLERANCE).or_else(|| stiffened(tight, &section, tension, TOLERANCE))
}

/// Both loops to start with: loose and well outside, and tight on the core.
fn starts(scene: &Scene, surface: &Arc<Surface>, core: &CoreSection) -> [System; 2] {
    let section = loop_section(scene);
    let r = section.radius();
    let gap = scaled(START_GAP, section.diameter);
    let [a, b] = core.half.map(|half| half + r + gap);
    let loose = Outline {
        a,
        b,
        radius: a.min(b),
        y: core.y,
    };
    let tight = Outline {
        a: a - gap,
        b: b - gap,
        radius: core.corner + r,
        y: core.y,
    };
    [loose, tight].map(|outline| touching_core(laid_out(outline, &section), scene, surface))
}

/// The loop without load, held by the mirror planes at its ends.
fn laid_out(outline: Outline, section: &Section) -> System {
    let length = outline.length();
    let edges = length / scaled(SPACING, section.diameter);
    let count = edges.min(MOST_EDGES).ceil() as usize;
    let points: Vec<V3> = (0..=count)
        .map(|k| outline.at(length * k as f64 / count as f64))
        .collect();
    let mut sys = System::new(section.clone(), Rod::through(&points, None));
    let mirror = |point: V3, hold: [bool; 3], along: V3| Support {
        hold,
        point,
        velocity: V3::zeros(),
        frame: Some(frame_along(&along, None)),
        turning: false,
    };
    sys.model.twist = Twist::Off;
    sys.state.support[0] = mirror(points[0], [false, true, true], V3::z());
    sys.state.support[1] = mirror(points[count], [true, true, false], -V3::x());
    sys
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::TriMesh;
    use crate::geometry::generate::sewn;
    use crate::math::Spin;
    use crate::settings::SceneSettings;
    use crate::simulation::winding::core_surface;

    /// Joints that meet their cap in one increment need a potential, or Newton's method cannot descend in it.
    #[test]
    fn a_loop_of_copper_is_drawn_tight() {
        for (material, least) in [("table1", 0.5e-3), ("copper", 0.1e-3)] {
            let mut settings = SceneSettings::packed("fig8")
                .expect("a packed scene")
                .expect("it is read");
            settings
                .set_text("wire.material", material)
                .expect("there is one");
            let scene = settings.build().expect("a scene");
            let surface = Arc::new(core_surface(&scene).expect("a core"));
            let profile =
                profile(&scene, &surface, scene.tensioner.tension).expect("a loop at rest");
            let highest = (0..STATIONS_PER_TURN)
                .map(|k| profile.at(k as f64 * STATION_STEP, 0.0))
                .fold(0.0, f64::max);
            assert!(
                (least..2e-3).contains(&highest),
                "{material} stands {highest} m off"
            );
        }
    }

    fn copper(core: [f64; 3], tension: f64) -> (Scene, Arc<Surface>) {
        let mut settings = SceneSettings::packed("fig8")
            .expect("a packed scene")
            .expect("it is read");
        let [width, height, corner] = core.map(|mm| mm.to_string());
        for (key, text) in [
            ("wire.material", "copper"),
            ("core.width_x_mm", &width),
            ("core.height_z_mm", &height),
            ("core.corner_radius_mm", &corner),
            ("tensioner.tension", &tension.to_string()),
        ] {
            settings.set_text(key, text).expect("there is one");
        }
        let scene = settings.build().expect("a scene");
        let surface = Arc::new(core_surface(&scene).expect("a core"));
        (scene, surface)
    }

    /// 33 of 42 such settings had no yardstick, so that their bulge was not judged.
    #[test]
    fn copper_has_a_yardstick_on_common_boxes() {
        let boxes = [
            [12.0, 30.0, 2.0],
            [10.0, 10.0, 1.0],
            [16.0, 24.0, 3.0],
            [12.0, 40.0, 1.0],
            [20.0, 20.0, 5.0],
            [8.0, 60.0, 1.0],
            [30.0, 12.0, 2.0],
        ];
        for core in boxes {
            let mut before = f64::INFINITY;
            for tension in [3.0, 8.0, 15.0, 25.0, 40.0, 60.0] {
                let (scene, surface) = copper(core, tension);
                let profile = profile(&scene, &surface, tension);
                let heights = profile.unwrap_or_else(|| panic!("{core:?} at {tension} N"));
                let highest = heights.heights().iter().copied().fold(0.0, f64::max);
                assert!(
                    (0.05 * scene.wire.diameter..before).contains(&highest),
                    "{core:?} at {tension} N: {highest}, at less {before}"
                );
                before = highest;
            }
        }
    }

    #[test]
    fn both_ways_to_the_loop_at_rest_end_at_the_same_one() {
        let (scene, surface) = copper([12.0, 30.0, 2.0], 15.0);
        let core = CoreSection {
            half: [6e-3, 15e-3],
            corner: 2e-3,
            y: 0.0,
        };
        let [one, other] = starts(&scene, &surface, &core);
        let section = one.model.section.clone();
        let highest = |sys: System| {
            let heights = sys.state.rod.x.iter().map(|p| surface.nearest(*p).distance);
            heights.fold(0.0, f64::max) - scene.wire.radius()
        };
        let drawn = highest(draw_tight(one, 15.0, TOLERANCE).expect("drawn"));
        let stiffened = highest(stiffened(other, &section, 15.0, TOLERANCE).expect("stiffened"));
        // A tenth of the excess that is a bulge: corners have few nodes, which lie elsewhere.
        let apart = (drawn - stiffened).abs();
        assert!(apart < 0.05 * section.diameter, "{drawn} {stiffened}");
    }

    #[test]
    fn a_mesh_with_two_mirror_planes_has_the_yardstick_of_its_shape() {
        let (scene, surface) = copper([12.0, 30.0, 2.0], 15.0);
        let as_box = profile(&scene, &surface, 15.0).expect("a loop");
        let mesh = Scene {
            core: Core::Mesh {
                path: "unused".into(),
                unit: 1e-3,
                flange: None,
            },
            ..scene
        };
        let as_mesh = profile(&mesh, &surface, 15.0).expect("a loop round the mesh");
        for (a, b) in as_box.heights().iter().zip(as_mesh.heights()) {
            assert!((a - b).abs() < 10e-6, "{a} {b}");
        }
    }

    /// A ring of edges round the narrowest place had no yardstick: wire on it was judged against a whole diameter.
    #[test]
    fn a_waist_with_its_edges_in_the_middle_has_the_yardstick_of_its_section() {
        let (scene, surface) = copper([12.0, 30.0, 2.0], 15.0);
        let known = profile(&scene, &surface, 15.0).expect("a box");
        let core = Core::Mesh {
            path: "unused".into(),
            unit: 1e-3,
            flange: None,
        };
        let scene = Scene { core, ..scene };
        let points = surface.mesh().section_points(0.0);
        let hull = Hull::of(points.iter().map(|p| [p.x, p.z]).collect()).expect("convex");
        let corners = hull.outline(0.0, 1);
        // narrowest in the middle, and so much wider at both ends; one is turned as well
        for (wider, degrees) in [(2e-3, 0.0), (20e-3, 0.0), (5e-3, 25.0)] {
            let spin = Spin::new(f64::to_radians(degrees));
            let ring = |y: f64, size: f64| -> Vec<V3> {
                let at = |&[x, z]: &[f64; 2]| spin.to_lab(V3::new(size * x, y, size * z));
                corners.iter().map(at).collect()
            };
            let rings = [
                ring(-8e-3, 1.0 + wider),
                ring(0.0, 1.0),
                ring(8e-3, 1.0 + wider),
            ];
            let waist = sewn(&rings).expect("closed");
            let found = profile(&scene, &Arc::new(Surface::new(waist)), 15.0);
            let found = found.unwrap_or_else(|| panic!("no rest: {wider}, {degrees} deg"));
            let largest = |p: &Profile| p.heights().iter().copied().fold(0.0, f64::max);
            let apart = (largest(&found) - largest(&known)).abs();
            assert!(
                apart < 0.05 * scene.wire.diameter,
                "{wider}, {degrees} deg: {apart} m"
            );
        }
    }

    /// A box turned about its axis had no yardstick: wire on it was judged against a whole diameter.
    #[test]
    fn a_turned_box_has_the_yardstick_of_the_box_turned() {
        let (scene, surface) = copper([12.0, 30.0, 2.0], 15.0);
        let known = profile(&scene, &surface, 15.0).expect("two mirror planes");
        let stations = 20;
        let spin = Spin::new(f64::from(stations) * STATION_STEP);
        let mesh = surface.mesh();
        let vertices = mesh.vertices.iter().map(|p| spin.to_lab(*p)).collect();
        let turned = TriMesh::new(vertices, mesh.triangles.clone()).expect("closed");
        let core = Core::Mesh {
            path: "unused".into(),
            unit: 1e-3,
            flange: None,
        };
        let scene = Scene { core, ..scene };
        let turned = Arc::new(Surface::new(turned));
        let found = profile(&scene, &turned, 15.0).expect("a whole turn");
        // about y, z turns towards x: the polar angle falls
        for (k, height) in found.heights().iter().enumerate() {
            let expected = known.at((k as f64 + f64::from(stations)) * STATION_STEP, 0.0);
            // a tenth of the excess that is a bulge: corners have few nodes, which lie elsewhere
            let apart = (height - expected).abs();
            assert!(apart < 0.05 * scene.wire.diameter, "{k}: {apart}");
        }
    }

    #[test]
    fn wire_on_a_cylinder_lies_on_it() {
        let (mut scene, surface) = copper([12.0, 30.0, 2.0], 15.0);
        scene.core = Core::Cylinder {
            radius: 10e-3,
            length_y: 20e-3,
            flange: None,
        };
        let profile = profile(&scene, &surface, 15.0).expect("a helix");
        assert_eq!(profile.at(1.0, 0.0), 0.0);
    }
}
