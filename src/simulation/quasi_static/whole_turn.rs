//! Wire at rest round a core that two mirror planes do not divide: the middle one of three turns.
//!
//! The ends of the wire are held on the core's longest face. What that does to the height fades within a corner or two, so a turn
//! to either side keeps it from the middle one.

use super::drawn_loop::{
    MOST_EDGES, SPACING, heights, loop_section, profile_of, stiffened, touching_core,
};
use crate::geometry::{Hull, Surface};
use crate::math::{V3, frame_along, scaled};
use crate::measure::Profile;
use crate::rod::{Rod, Section, Twist};
use crate::scene::Scene;
use crate::system::{Support, System};
use std::f64::consts::TAU;
use std::sync::Arc;

/// Turns of the wire. With five, the heights of the middle one differ by no more than with other nodes.
const TURNS: usize = 3;

/// Error of the heights, m, for wire of 0.7 mm. Ten times that of a quarter: nodes that hop from facet to facet of a mesh leave as much.
const TOLERANCE: f64 = 1e-6;

/// Shares of the usual number of nodes that are tried in turn. A node that comes to lie on an edge of the mesh may hop from facet to
/// facet and find no rest; other nodes lie elsewhere.
const SPREADS: [f64; 4] = [1.0, 0.93, 0.87, 0.81];

/// Chords to a right angle of the wire's way round a corner, before it finds its own.
const CHORDS: usize = 32;

/// Height over the core by polar angle of wire at rest under `tension`, N, in the middle of a mesh. There is none where the axis
/// does not go through the mesh, or no rest is found.
///
/// It is the height over `over`, which may be another mesh than the one that the wire lies on.
pub(super) fn profile(
    scene: &Scene,
    surface: &Arc<Surface>,
    over: &Surface,
    tension: f64,
) -> Option<Profile> {
    of_turns(scene, surface, over, tension, TURNS)
}

/// The same from so many turns.
fn of_turns(
    scene: &Scene,
    surface: &Arc<Surface>,
    over: &Surface,
    tension: f64,
    turns: usize,
) -> Option<Profile> {
    let mut turn = middle_turn(scene, surface, over, tension, turns)?;
    turn.sort_by(|a, b| a.0.total_cmp(&b.0));
    // the first and the last once more, a turn on and a turn back
    let (first, last) = (turn[0], turn[turn.len() - 1]);
    turn.insert(0, (last.0 - TAU, last.1));
    turn.push((first.0 + TAU, first.1));
    profile_of(&turn, crate::math::wrap_to_pi)
}

/// Polar angles, rad, and heights, m, of the middle one of so many turns of wire at rest.
fn middle_turn(
    scene: &Scene,
    surface: &Arc<Surface>,
    over: &Surface,
    tension: f64,
    turns: usize,
) -> Option<Vec<(f64, f64)>> {
    let section = loop_section(scene);
    let path = Path::round(surface, section.radius())?;
    let most = path.length / scaled(SPACING, section.diameter);
    let most = most.min(MOST_EDGES / turns as f64);
    SPREADS.iter().find_map(|share| {
        let per_turn = (share * most).ceil() as usize;
        let points: Vec<V3> = (0..=turns * per_turn)
            .map(|k| path.at(k % per_turn, per_turn))
            .collect();
        let tight = touching_core(held(&points, &section), scene, surface);
        let rest = stiffened(tight, &section, tension, TOLERANCE)?;
        let before = turns / 2 * per_turn;
        let middle = &rest.state.rod.x[before..before + per_turn];
        Some(heights(scene, over, middle))
    })
}

/// Wire through these points, held where it begins and ends.
fn held(points: &[V3], section: &Section) -> System {
    let last = points.len() - 1;
    let mut sys = System::new(section.clone(), Rod::through(points, None));
    let end = |point: V3, along: V3| Support {
        hold: [true; 3],
        point,
        velocity: V3::zeros(),
        frame: Some(frame_along(&along.normalize(), None)),
        turning: false,
    };
    sys.model.twist = Twist::Off;
    sys.state.support[0] = end(points[0], points[1] - points[0]);
    sys.state.support[1] = end(points[last], points[last] - points[last - 1]);
    sys
}

/// The way of a string round a core, closed.
struct Path {
    /// corners of the way from the middle of its longest straight on, back to there, and how far along each is, m
    points: Vec<(V3, f64)>,
    length: f64,
}

impl Path {
    /// The way at this distance (m) round the section in the middle of a mesh.
    fn round(surface: &Surface, out: f64) -> Option<Self> {
        let (low, high) = surface.bounds();
        let y = 0.5 * (low.y + high.y);
        let section = surface.mesh().section_points(y);
        let hull = Hull::of(section.iter().map(|p| [p.x, p.z]).collect())?;
        let at = |&[x, z]: &[f64; 2]| V3::new(x, y, z);
        let mut ring: Vec<V3> = hull.outline(out, CHORDS).iter().map(at).collect();
        let straight = |k: usize| (ring[(k + 1) % ring.len()] - ring[k]).norm();
        let longest = (0..ring.len()).max_by(|a, b| straight(*a).total_cmp(&straight(*b)))?;
        let next = (longest + 1) % ring.len();
        let middle = 0.5 * (ring[longest] + ring[next]);
        ring.rotate_left(next);
        let mut points = vec![(middle, 0.0)];
        let mut length = 0.0;
        for point in ring.into_iter().chain([middle]) {
            length += (point - points[points.len() - 1].0).norm();
            points.push((point, length));
        }
        Some(Self { points, length })
    }

    /// The `k`th of `count` points spread evenly over it.
    fn at(&self, k: usize, count: usize) -> V3 {
        let s = self.length * k as f64 / count as f64;
        let next = self.points.partition_point(|(_, along)| *along <= s);
        let next = next.clamp(1, self.points.len() - 1);
        let [(a, from), (b, to)] = [self.points[next - 1], self.points[next]];
        a.lerp(&b, ((s - from) / (to - from)).clamp(0.0, 1.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::TriMesh;
    use crate::scene::Core;
    use crate::settings::SceneSettings;
    use crate::simulation::winding::core_surface;

    const TENSION: f64 = 15.0;

    /// The scene `fig8` with a mesh for a core, and the surface of its box.
    fn on_a_mesh() -> (Scene, Surface) {
        let settings = SceneSettings::packed("fig8").expect("packed");
        let scene = settings.expect("it is read").build().expect("a scene");
        let surface = core_surface(&scene).expect("a core");
        let core = Core::Mesh {
            path: "unused".into(),
            unit: 1e-3,
            flange: None,
        };
        (Scene { core, ..scene }, surface)
    }

    /// The same core with its points moved.
    fn moved(surface: &Surface, to: impl Fn(V3) -> V3) -> Arc<Surface> {
        let mesh = surface.mesh();
        let vertices = mesh.vertices.iter().map(|p| to(*p)).collect();
        let mesh = TriMesh::new(vertices, mesh.triangles.clone()).expect("closed");
        Arc::new(Surface::new(mesh))
    }

    fn largest(heights: impl Iterator<Item = f64>) -> f64 {
        heights.fold(0.0, |largest: f64, height| largest.max(height.abs()))
    }

    /// Such cores had no yardstick at all.
    #[test]
    fn copper_has_a_yardstick_on_common_wedges() {
        let (mut scene, surface) = on_a_mesh();
        let mut settings = SceneSettings::packed("fig8")
            .expect("packed")
            .expect("read");
        settings
            .set_text("wire.material", "copper")
            .expect("there is one");
        scene.wire = settings.build().expect("a scene").wire;
        let mut none = Vec::new();
        for share in [0.1, 0.3, 0.5] {
            for across in [0.6, 1.0, 2.0] {
                let wedge = moved(&surface, |p| {
                    V3::new(across * p.x * (1.0 + share * p.z / 15e-3) + 1e-3, p.y, p.z)
                });
                let mut before = f64::INFINITY;
                for tension in [3.0, 8.0, 15.0, 25.0, 40.0, 60.0] {
                    let Some(heights) = profile(&scene, &wedge, &wedge, tension) else {
                        none.push((share, across, tension));
                        continue;
                    };
                    let highest = largest(heights.heights().iter().copied());
                    assert!(
                        (0.05 * scene.wire.diameter..before).contains(&highest),
                        "{share}, {across} at {tension} N: {highest}, at less {before}"
                    );
                    before = highest;
                }
            }
        }
        assert_eq!(none, []);
    }

    #[test]
    fn further_turns_do_not_move_the_middle_one() {
        let (scene, surface) = on_a_mesh();
        // a trapezoid, wider on one side by a third
        let tapered = moved(&surface, |p| V3::new(p.x * (1.0 + p.z / 60e-3), p.y, p.z));
        let [three, five] = [3, 5]
            .map(|turns| of_turns(&scene, &tapered, &tapered, TENSION, turns).expect("at rest"));
        let [three, five] = [three.heights(), five.heights()];
        let apart = largest(three.iter().zip(five).map(|(a, b)| a - b));
        assert!(apart < 0.05 * scene.wire.diameter, "{apart}");
        let highest = largest(three.iter().copied());
        assert!(highest > 0.1e-3, "{highest}");
    }
}
