//! Computes how high the wire stands off the core at rest, the reference of the bulge flag.
//!
//! A wire bent round a corner under tension does not lie flat on the faces beside it. The height
//! at rest is that of a loop drawn tight round the core without friction at the set tension.
//! A quarter of the loop is computed, from the middle of one face to the middle of the next. It
//! has the rod, section and contact of the winding.

use super::core_model::core_shape;
use crate::contact::{ContactLaw, LineModel};
use crate::geometry::Surface;
use crate::integrate::{Implicit, Scheme};
use crate::math::frame_along;
use crate::math::polar_angle;
use crate::math::{V3, scaled};
use crate::measure::{Profile, STATION_STEP, STATIONS_PER_TURN};
use crate::rod::Twist;
use crate::rod::{Bend, Rod, Section};
use crate::scene::{Core, Scene};
use crate::system::{Support, System};
use std::sync::Arc;

/// Node spacing of the loop, m, for wire of 0.7 mm; half of it moves the heights by 4 um.
const SPACING: f64 = 0.4e-3;
/// Most edges of the loop: fine wire on a core a thousand times as wide has a coarser one.
const MOST_EDGES: f64 = 2e4;

/// The loop starts this far outside the core, m, for wire of 0.7 mm.
const START_GAP: f64 = 2e-3;

/// Axial softening of the loop; the strain at 15 N stays below half a percent.
const SOFTER: f64 = 10.0;

/// Largest share of its length by which the loop is drawn tight at a time.
const DRAW: f64 = 0.01;
/// Draws after which there is no yardstick.
const MOST_DRAWS: usize = 60;
/// Error of the heights, m, for wire of 0.7 mm, and of the tension, as a share of it.
const TOLERANCE: f64 = 1e-7;
const TENSION: f64 = 1e-2;

/// Height over the core by winding angle, if the core's shape is known and wire bends round it.
pub(super) fn profile(scene: &Scene, surface: &Arc<Surface>) -> Option<Profile> {
    let Core::RoundedBox {
        width_x, height_z, ..
    } = scene.core
    else {
        // a round core has no faces to stand off from; a mesh may have any number of them
        return None;
    };
    let sys = quarter_loop(scene, surface, width_x, height_z)?;
    let radius = scene.wire.radius();
    let quarter: Vec<(f64, f64)> = sys
        .state
        .rod
        .x
        .iter()
        .map(|p| (polar_angle(*p), surface.nearest(*p).distance - radius))
        .collect();
    let at = |angle: f64| {
        // fold into the quarter from +x to +z
        let a = angle.rem_euclid(std::f64::consts::PI);
        let a = a.min(std::f64::consts::PI - a);
        let k = quarter
            .partition_point(|q| q.0 < a)
            .clamp(1, quarter.len() - 1);
        let (p, q) = (quarter[k - 1], quarter[k]);
        p.1 + (q.1 - p.1) * ((a - p.0) / (q.0 - p.0)).clamp(0.0, 1.0)
    };
    Profile::new(
        (0..STATIONS_PER_TURN)
            .map(|k| at(k as f64 * STATION_STEP))
            .collect(),
    )
}

/// Point at `s` along the quarter from (a, 0) to (0, b): a straight and a circle of the shorter axis.
fn outline(a: f64, b: f64, s: f64) -> V3 {
    let r = a.min(b);
    let (rise, reach) = (b - r, a - r);
    let arc = std::f64::consts::FRAC_PI_2 * r;
    if s < rise {
        return V3::new(a, 0.0, s);
    }
    let t = ((s - rise) / r).min(std::f64::consts::FRAC_PI_2);
    let beyond = (s - rise - arc).max(0.0);
    V3::new(
        reach + r * libm::cos(t) - beyond,
        0.0,
        rise + r * libm::sin(t),
    )
}

/// The quarter loop at rest, by the production method whatever the scene winds with.
fn quarter_loop(scene: &Scene, surface: &Arc<Surface>, width: f64, height: f64) -> Option<System> {
    // how far the wire stretches does not matter for its shape: a softer one settles sooner
    let section = Section {
        ea: scene.wire.ea / SOFTER,
        ..scene.wire.clone()
    };
    let r = section.radius();
    let tension = scene.tensioner.tension;
    if tension <= 0.0 || tension >= section.n_y {
        return None;
    }
    // start well outside: straight along the longer face, then a quarter circle
    let gap = scaled(START_GAP, section.diameter);
    let (a, b) = (0.5 * width + r + gap, 0.5 * height + r + gap);
    let (arc, flat) = (std::f64::consts::FRAC_PI_2 * a.min(b), (a - b).abs());
    let edges = (arc + flat) / scaled(SPACING, section.diameter);
    let count = edges.min(MOST_EDGES).ceil() as usize;
    let points: Vec<V3> = (0..=count)
        .map(|k| outline(a, b, (arc + flat) * k as f64 / count as f64))
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
    let law = ContactLaw {
        stiffness: scene.contact.stiffness,
        damping_ratio: 0.0,
        mu_static: 0.0,
        mu_kinetic: 0.0,
        slip_speed: scene.friction.slip_speed,
    };
    let shape = core_shape(&scene.core, surface);
    sys.touch_along(LineModel::new(shape, law, r));
    sys.refresh();
    let mut method = Implicit::new(Scheme::Bdf2, scaled(TOLERANCE, section.diameter), 1e-9, 1.0);
    // the loop is drawn tight by taking wire out evenly; a loose one gives way, a tight one stretches
    let mut stiffness = section.ea;
    let mut before: Option<(f64, f64)> = None;
    let mut drawn = 0.0;
    for _ in 0..MOST_DRAWS {
        // loading is monotonic: the law is a nonlinear elastic one from the virgin wire, not one that
        // remembers how wide the loop once was
        sys.state.rod.bend.fill(Bend::default());
        method.equilibrate(&mut sys).ok()?;
        let pull = sys.state.load.tension.iter().sum::<f64>() / count as f64;
        let missing = tension - pull;
        if missing.abs() < TENSION * tension {
            return Some(sys);
        }
        if let Some((d, p)) = before
            && (pull - p) / (drawn - d) > 0.0
        {
            stiffness = ((pull - p) / (drawn - d)).min(section.ea);
        }
        before = Some((drawn, pull));
        let draw = (missing / stiffness).clamp(-DRAW, DRAW);
        drawn += draw;
        sys.state.rod.rest.iter_mut().for_each(|l| *l *= 1.0 - draw);
    }
    None
}

#[cfg(test)]
mod tests {
    use super::super::core_model::core_surface;
    use super::*;
    use crate::settings::SceneSettings;

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
            let surface = Arc::new(core_surface(&scene.core).expect("a core"));
            let profile = profile(&scene, &surface).expect("a loop at rest");
            let highest = (0..STATIONS_PER_TURN)
                .map(|k| profile.at(k as f64 * STATION_STEP))
                .fold(0.0, f64::max);
            assert!(
                (least..2e-3).contains(&highest),
                "{material} stands {highest} m off"
            );
        }
    }
}
