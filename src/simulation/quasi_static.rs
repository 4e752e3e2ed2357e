//! How high this wire stands off this core when nothing moves: the yardstick of the bulge flag.
//!
//! A wire bent round a corner under tension does not lie flat on the faces beside it. The height
//! at rest is that of a loop drawn tight round the core without friction at the set tension:
//! a quarter of it from the middle of one face to the middle of the next, with the same rod,
//! section and contact as the winding. Loading is monotonic, so the plastic law acts like a
//! nonlinear elastic one and is evaluated from the virgin state.

use crate::contact::{ContactLaw, Contacts};
use crate::core_shape::Surface;
use crate::integrate::{Support, System, VERLET_LIMIT, highest_frequency, verlet};
use crate::math::V3;
use crate::measure::{Profile, STATIONS_PER_TURN, STATION_STEP, polar_angle};
use crate::rod::{Rod, frame_along};
use crate::scene::{Core, Scene};
use std::sync::Arc;

/// Node spacing of the loop, m; 0.4 mm instead moves the heights by less than 2 % of a diameter.
const SPACING: f64 = 0.8e-3;

/// Height over the core by winding angle, if the core's shape is known and wire bends round it.
pub(super) fn profile(scene: &Scene, surface: &Arc<Surface>) -> Option<Profile> {
    let Core::RoundedBox { width_x, height_z, .. } = scene.core else {
        // a round core has no faces to stand off from; a mesh may have any number of them
        return None;
    };
    let sys = settle(scene, surface, width_x, height_z)?;
    let radius = scene.wire.radius();
    let quarter: Vec<(f64, f64)> =
        sys.rod.x.iter().map(|p| (polar_angle(*p), surface.nearest(*p).distance - radius)).collect();
    let at = |angle: f64| {
        // fold into the quarter from +x to +z
        let a = angle.rem_euclid(std::f64::consts::PI);
        let a = a.min(std::f64::consts::PI - a);
        let k = quarter.partition_point(|q| q.0 < a).clamp(1, quarter.len() - 1);
        let (p, q) = (quarter[k - 1], quarter[k]);
        p.1 + (q.1 - p.1) * ((a - p.0) / (q.0 - p.0)).clamp(0.0, 1.0)
    };
    Profile::new((0..STATIONS_PER_TURN).map(|k| at(k as f64 * STATION_STEP)).collect())
}

/// The quarter loop at rest.
fn settle(scene: &Scene, surface: &Arc<Surface>, width: f64, height: f64) -> Option<System> {
    let section = scene.wire.clone();
    let r = section.radius();
    let tension = scene.tensioner.tension;
    if tension <= 0.0 || tension >= section.n_y {
        return None;
    }
    // start well outside, on an ellipse
    let (a, b) = (0.5 * width + r + 4e-3, 0.5 * height + r + 4e-3);
    let count = ((a + b) / SPACING.max(scene.solver.spacing_near)).ceil() as usize;
    let points: Vec<V3> = (0..=count)
        .map(|k| {
            let t = std::f64::consts::FRAC_PI_2 * k as f64 / count as f64;
            V3::new(a * libm::cos(t), 0.0, b * libm::sin(t))
        })
        .collect();
    let shortest = points.windows(2).map(|p| (p[1] - p[0]).norm()).fold(f64::INFINITY, f64::min);
    let mut sys = System::new(section.clone(), Rod::through(&points, None));
    let mirror = |point: V3, hold: [bool; 3], along: V3| Support {
        hold,
        point,
        velocity: V3::zeros(),
        frame: Some(frame_along(&along, None)),
        turning: false,
    };
    sys.twist = false;
    sys.holonomic = true;
    sys.support[0] = mirror(points[0], [false, true, true], V3::z());
    sys.support[1] = mirror(points[count], [true, true, false], -V3::x());
    let law = ContactLaw {
        stiffness: scene.contact.stiffness,
        damping_ratio: 1.0,
        mu_static: 0.0,
        mu_kinetic: 0.0,
        slip_speed: scene.friction.slip_speed,
    };
    sys.contacts = Some(Contacts::new(surface.clone(), law, r, section.diameter, sys.rod.nodes()));
    let dt = 0.8 * VERLET_LIMIT / highest_frequency(&section, 0.75 * shortest, scene.contact.stiffness, false);
    // drag near critical for the slowest bending wave of the quarter
    let length = a + b;
    let slow = (std::f64::consts::PI / length).powi(2)
        * ((section.ei + tension * (length / std::f64::consts::PI).powi(2)) / section.mass_per_length()).sqrt();
    sys.loads.drag = 2.0 * slow;
    sys.evaluate(Some(0.0));
    let period = std::f64::consts::TAU / slow;
    let steps = (12.0 * period / dt) as usize;
    // the loop is drawn tight by taking wire out evenly, against its own wave impedance
    let impedance = (section.ea * section.mass_per_length()).sqrt();
    for _ in 0..steps {
        let pull = tension - sys.load.tension[count - 1];
        let change = 1.0 - dt * pull / (impedance * length);
        sys.rod.rest.iter_mut().for_each(|l| *l *= change);
        verlet::step(&mut sys, dt);
    }
    let calm = sys.kinetic() < 1e-9 * tension * length && sys.rod.x.iter().all(|p| p.sum().is_finite());
    calm.then_some(sys)
}
