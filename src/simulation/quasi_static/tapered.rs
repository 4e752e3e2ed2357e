//! Wire at rest on a core whose section changes along its axis, such as a tooth that is wider at its foot.
//!
//! A loop without friction slides off such a core. So it is drawn round prisms on sections of the core, one after another along the
//! axis, and how high it stands is asked of the core itself.

use crate::geometry::generate::prism;
use crate::geometry::{Hull, Surface};
use crate::measure::{Profile, STATION_STEP, STATIONS_PER_TURN};
use std::sync::Arc;

/// Sections that differ by less, in wire diameters, are the same; a tenth of the largest bulge excess.
const SAME: f64 = 0.05;

/// Largest difference of neighbouring levels, in wire diameters. Heights between them are then within 0.03 diameters of those round a
/// box of that section (a tooth that tapers by 0.15).
const STEP: f64 = 0.5;

/// Most intervals between levels.
const MOST: usize = 16;

/// Sections that are looked at for how the core changes.
const LOOKS: usize = 96;

/// How often a section may change from growing to shrinking along the axis: a barrel between fillets does so three times. A core with
/// grooves does so more often, and wire lies in each groove as in the next.
const TURNS: usize = 3;

/// Height over the core of wire at rest by polar angle and place along the axis; `round` finds that round a prism.
///
/// There is none where the section is the same all along the core, where it has grooves, or where `round` finds none. `diameter` is
/// that of the wire, m.
pub(super) fn profile(
    surface: &Surface,
    diameter: f64,
    round: impl Fn(&Arc<Surface>) -> Option<Profile>,
) -> Option<Profile> {
    let levels = levels(surface, diameter)?;
    let at = |&y: &f64| {
        let hull = surface.mesh().section(y)?;
        let ends = [y - hull.radius(), y + hull.radius()];
        let prism = Arc::new(Surface::new(prism(&hull, ends).ok()?));
        Some((y, round(&prism)?))
    };
    Profile::along(levels.iter().map(at).collect::<Option<_>>()?)
}

/// Places along y, m, for wire of this diameter, m, between which sections differ little; none where one does for all.
fn levels(surface: &Surface, diameter: f64) -> Option<Vec<f64>> {
    let [low, high] = wound(surface, diameter)?;
    let place = |k: usize, of: usize| low + (high - low) * k as f64 / of as f64;
    let looks: Option<Vec<_>> = (0..=LOOKS)
        .map(|k| Some(reaches(&surface.mesh().section(place(k, LOOKS))?)))
        .collect();
    let looks = looks?;
    let same = SAME * diameter;
    let changes = looks.iter().any(|look| differs(look, &looks[0], same));
    let has_grooves = (0..STATIONS_PER_TURN)
        .any(|station| turning_points(looks.iter().map(|look| look[station]), same) > TURNS);
    if !changes || has_grooves {
        return None;
    }
    let chosen = chosen(&looks, (high - low) / LOOKS as f64, STEP * diameter)?;
    Some(chosen.into_iter().map(|k| place(k, LOOKS)).collect())
}

/// Which of these looks, so far apart along y, are levels: neighbouring ones differ by less than `step`, m, where that takes no more than
/// [`MOST`] intervals.
///
/// No wire rests on a flank that rises by more than 45 degrees, such as that of a shoe. No level lies on one, or right beside it.
fn chosen(looks: &[Vec<f64>], apart: f64, step: f64) -> Option<Vec<usize>> {
    let rises = |k: usize| differs(&looks[k], &looks[k + 1], apart);
    let last = looks.len() - 1;
    let on_flank = |k: usize| k > 0 && rises(k - 1) || k < last && rises(k);
    let open: Vec<usize> = (0..=last).filter(|&k| !on_flank(k)).collect();
    let mut levels = vec![*open.first()?, *open.last()?];
    levels.dedup();
    while levels.len() <= MOST {
        let splits = levels.windows(2).filter_map(|pair| {
            let within = open.iter().filter(|&&k| pair[0] < k && k < pair[1]);
            let from_end = |&k: &usize| farthest(&looks[k], &looks[pair[0]]);
            let apart = within
                .clone()
                .chain([&pair[1]])
                .map(from_end)
                .fold(0.0, f64::max);
            let middle = |&&k: &&usize| (2 * k).abs_diff(pair[0] + pair[1]);
            Some((apart, *within.min_by_key(middle)?)).filter(|_| apart > step)
        });
        let Some((_, split)) = splits.max_by(|a, b| a.0.total_cmp(&b.0)) else {
            break;
        };
        levels.insert(levels.partition_point(|&k| k < split), split);
    }
    Some(levels)
}

/// Where along y the middle of the wire may lie on a core, m: between its flanges, or its ends.
fn wound(surface: &Surface, diameter: f64) -> Option<[f64; 2]> {
    let (low, high) = surface.bounds();
    let room = surface.mesh().room(0.5 * (low.y + high.y), diameter);
    let [low, high] = room.map_or([low.y, high.y], |room| room.faces);
    let ends = [low + 0.5 * diameter, high - 0.5 * diameter];
    (ends[0] < ends[1]).then_some(ends)
}

/// How far a section reaches from the axis, m, in the direction of each station of a turn.
fn reaches(section: &Hull) -> Vec<f64> {
    let all = (0..STATIONS_PER_TURN).map(|k| section.reach(k as f64 * STATION_STEP));
    all.collect()
}

fn differs(a: &[f64], b: &[f64], by: f64) -> bool {
    farthest(a, b) > by
}

/// The largest difference of two sections in one direction, m.
fn farthest(a: &[f64], b: &[f64]) -> f64 {
    let apart = a.iter().zip(b).map(|(a, b)| (a - b).abs());
    apart.fold(0.0, f64::max)
}

/// How often values change from rising to falling and back, ups and downs of less than `least` left out.
fn turning_points(values: impl Iterator<Item = f64>, least: f64) -> usize {
    let (mut way, mut found) = (0.0, 0);
    let mut extreme: Option<f64> = None;
    for value in values {
        let from = *extreme.get_or_insert(value);
        let moved = value - from;
        if moved * way > 0.0 {
            extreme = Some(value);
        } else if moved.abs() > least {
            found += usize::from(way != 0.0);
            way = moved.signum();
            extreme = Some(value);
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::generate::sewn;
    use crate::math::V3;
    use crate::scene::{Core, Scene};
    use crate::settings::SceneSettings;
    use crate::simulation::quasi_static;
    use crate::simulation::winding::core_surface;
    use std::f64::consts::FRAC_PI_2;

    const TENSION: f64 = 15.0;
    /// Half widths of the box along x and z, radius of its corners and half its length, m.
    const HALF: [f64; 2] = [6e-3, 12e-3];
    const CORNER: f64 = 2.5e-3;
    const END: f64 = 10e-3;

    /// The scene `fig8` with copper on a box that is everywhere so much wider on each side, m.
    fn on_a_box(wider: f64) -> Scene {
        let settings = SceneSettings::packed("fig8").expect("packed");
        let mut settings = settings.expect("it is read");
        let [x, z] = HALF.map(|half| (2e3 * (half + wider)).to_string());
        for (key, text) in [
            ("wire.material", "copper"),
            ("core.width_x_mm", &x),
            ("core.height_z_mm", &z),
            (
                "core.corner_radius_mm",
                &(1e3 * (CORNER + wider)).to_string(),
            ),
        ] {
            settings.set_text(key, text).expect("there is one");
        }
        settings.build().expect("a scene")
    }

    /// The same on a mesh that is so much wider at each place along y, m, and moved along x by `aside`, m.
    fn on_a_mesh(wider: impl Fn(f64) -> f64, aside: f64) -> (Scene, Arc<Surface>) {
        let ring = |y: f64| -> Vec<V3> {
            let (chords, radius) = (24, CORNER + wider(y));
            let corners = [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]]
                .iter()
                .enumerate();
            let points = corners.flat_map(|(quarter, &[x, z])| {
                (0..=chords).map(move |k| {
                    let turn = quarter as f64 + f64::from(k) / f64::from(chords);
                    let (sin, cos) = libm::sincos(FRAC_PI_2 * turn);
                    let (x, z) = (x * (HALF[0] - CORNER), z * (HALF[1] - CORNER));
                    V3::new(aside + x + radius * cos, y, z + radius * sin)
                })
            });
            points.collect()
        };
        let rings: Vec<Vec<V3>> = (0..=200)
            .map(|k| ring(END * (f64::from(k) / 100.0 - 1.0)))
            .collect();
        let core = Core::Mesh {
            path: "unused".into(),
            unit: 1e-3,
            flange: None,
        };
        let scene = Scene {
            core,
            ..on_a_box(0.0)
        };
        let surface = Surface::new(sewn(&rings).expect("closed"));
        (scene, Arc::new(surface))
    }

    /// Its ends were judged by its middle: wire at rest on a tooth that tapers by 0.15 was half a diameter too high.
    #[test]
    fn wire_on_a_tooth_that_tapers_is_as_high_as_on_boxes_of_its_sections() {
        for slope in [0.05, 0.15] {
            let (scene, surface) = on_a_mesh(|y| slope * y, 0.0);
            let profile = quasi_static::profile(&scene, &surface, TENSION).expect("at rest");
            for y in [-9.5e-3, -7.3e-3, -1.1e-3, 0.4e-3, 4.9e-3, 9.1e-3] {
                let scene = on_a_box(slope * y);
                let surface = Arc::new(core_surface(&scene).expect("a core"));
                let exact = quasi_static::profile(&scene, &surface, TENSION).expect("at rest");
                for k in 0..STATIONS_PER_TURN {
                    let angle = k as f64 * STATION_STEP;
                    let apart = (profile.at(angle, y) - exact.at(angle, 0.0)).abs();
                    let most = SAME * scene.wire.diameter;
                    assert!(apart < most, "{slope} at {y} m, station {k}: {apart} m");
                }
            }
        }
    }

    #[test]
    fn levels_are_where_the_section_changes() {
        let count = |wider: &dyn Fn(f64) -> f64| {
            let (scene, surface) = on_a_mesh(wider, 0.0);
            levels(&surface, scene.wire.diameter).map(|levels| levels.len())
        };
        assert_eq!(count(&|_| 0.0), None, "a prism");
        assert_eq!(count(&|y| 1e-3 * y), None, "as good as one");
        assert_eq!(count(&|y| 0.05 * y), Some(5));
        assert_eq!(count(&|y| 0.12 * y), Some(9));
        let barrel = |y: f64| 0.5e-3 * (1.0 - (y / END).powi(2));
        assert_eq!(count(&barrel), Some(5));
        let grooves = |y: f64| 0.1e-3 * libm::cos(y / 0.8e-3);
        assert_eq!(count(&grooves), None, "grooves");
    }

    /// Levels on the flank of a shoe gave heights of four diameters, and wire beside the shoe was judged by them.
    #[test]
    fn a_shoe_does_not_change_how_high_wire_stands_beside_it() {
        let shoe = |y: f64| 3e-3 * ((y - 6.4e-3) / 0.6e-3).clamp(0.0, 1.0);
        let (scene, surface) = on_a_mesh(shoe, 0.0);
        let profile = quasi_static::profile(&scene, &surface, TENSION).expect("at rest");
        let [exact, on_shoe] = [0.0, 3e-3].map(|wider| {
            let scene = on_a_box(wider);
            let surface = Arc::new(core_surface(&scene).expect("a core"));
            quasi_static::profile(&scene, &surface, TENSION).expect("at rest")
        });
        let same = SAME * scene.wire.diameter;
        for k in 0..STATIONS_PER_TURN {
            let angle = k as f64 * STATION_STEP;
            let apart = (profile.at(angle, 6.0e-3) - exact.at(angle, 0.0)).abs();
            assert!(apart < same, "station {k}: {apart} m");
        }
        let most = exact.highest().max(on_shoe.highest()) + same;
        assert!(profile.highest() < most, "{} m", profile.highest());
    }

    /// Wire on it is a whole turn, which has no mirror planes.
    #[test]
    fn a_tooth_that_tapers_beside_its_axis_has_a_yardstick() {
        let (scene, surface) = on_a_mesh(|y| 0.1 * y, 1e-3);
        let profile = quasi_static::profile(&scene, &surface, TENSION).expect("at rest");
        assert!(levels(&surface, scene.wire.diameter).is_some());
        let heights = [-END, 0.0, END].map(|y| profile.at(0.5, y) / scene.wire.diameter);
        assert!(
            heights.iter().all(|h| (0.02..1.0).contains(h)),
            "{heights:?}"
        );
    }
}
