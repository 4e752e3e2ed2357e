//! A wire that lands at winding speed is stopped by what it lands on, in steps of any length that the
//! method chooses or is given.

use coilwind::contact::{ContactLaw, LineModel};
use coilwind::geometry::Shape;
use coilwind::integrate::{Implicit, Scheme, StepError};
use coilwind::math::V3;
use coilwind::rod::Rod;
use coilwind::rod::Twist;
use coilwind::scene::Scene;
use coilwind::settings::SceneSettings;
use coilwind::system::System;

/// Speed of a wire that is drawn onto a flat, m/s.
const SPEED: f64 = 10.0;
/// Nodes and their spacing, m.
const NODES: usize = 41;
const SPACING: f64 = 0.5e-3;
/// Way to fall, m: not a whole number of steps of any kind; and one long enough for steps to grow.
const FALL: f64 = 1.137e-3;
const LONG_FALL: f64 = 61.37e-3;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Onto {
    Flat,
    Corner,
    Wire,
}

fn scene() -> Scene {
    SceneSettings::load("fig8")
        .expect("packed")
        .build()
        .expect("valid")
}

/// A free straight wire over a core, on its way down along x.
///
/// Wire along y on the flat or along the corner, along z across a frozen wire that lies along y.
fn falling(scene: &Scene, onto: Onto, fall: f64) -> System {
    let r = scene.wire.radius();
    let shape = Shape::RoundedBox {
        half_x: 6e-3,
        half_z: 15e-3,
        half_y: 30e-3,
        corner_radius: 2e-3,
    };
    let law = ContactLaw {
        stiffness: scene.contact.stiffness,
        damping_ratio: 0.0,
        mu_static: scene.friction.static_,
        mu_kinetic: scene.friction.kinetic,
        slip_speed: scene.friction.slip_speed,
    };
    let along = |i: usize| SPACING * (i as f64 - 0.5 * (NODES - 1) as f64);
    let point = |i: usize| match onto {
        Onto::Flat => V3::new(6e-3 + r + fall, along(i), 0.3e-3),
        // over the middle of the arc, which turns away to one side
        Onto::Corner => V3::new(
            4e-3 + 0.8 * (2e-3 + r) + fall,
            along(i),
            13e-3 + 0.6 * (2e-3 + r),
        ),
        Onto::Wire => V3::new(6e-3 + 3.0 * r + fall, 0.1e-3, along(i)),
    };
    let points: Vec<V3> = (0..NODES).map(point).collect();
    let mut sys = System::new(scene.wire.clone(), Rod::through(&points, None));
    sys.model.twist = Twist::Off;
    sys.state.rod.v.fill(-V3::x() * SPEED);
    sys.touch_along(LineModel::new(shape, law, r));
    let mut line = sys.line_contact().expect("contact");
    if onto == Onto::Wire {
        for i in 0..NODES {
            line.lay(V3::new(6e-3 + r, along(i), 0.2e-3), SPACING * i as f64);
        }
    }
    // nothing is the falling wire's own neighbourhood
    sys.state.arc0 = 1.0;
    sys.refresh();
    sys
}

/// Deepest touch of any step over the diameter, and whether any node is inside afterwards.
fn land(
    scene: &Scene,
    onto: Onto,
    fall: f64,
    fixed: Option<f64>,
    longest: f64,
) -> Result<(f64, bool), StepError> {
    let mut sys = falling(scene, onto, fall);
    let mut method = Implicit::new(Scheme::Bdf2, scene.solver.tolerance, 1e-9, longest);
    method.fixed = fixed;
    let mut left = fall / SPEED + 1.4e-3;
    while left > 0.0 {
        match method.step(&mut sys, left) {
            Ok(h) => left = if h >= left { 0.0 } else { left - h },
            Err(stopped) => return Err(stopped),
        }
    }
    let line = sys.model.contact.as_line().expect("contact");
    let r = scene.wire.radius();
    let through = sys.state.rod.x.iter().any(|x| {
        let core = line.shape.nearness(*x).distance < 0.5 * r;
        let past = onto == Onto::Wire && x.z.abs() < 0.3e-3 && x.x < 6e-3 + 2.0 * r;
        core || past
    });
    Ok((sys.state.deepest / scene.wire.diameter, through))
}

#[test]
fn with_steps_of_its_own_choice() {
    let scene = scene();
    for onto in [Onto::Flat, Onto::Corner, Onto::Wire] {
        for longest in [20e-6, 50e-6, 0.1] {
            let (depth, through) = land(&scene, onto, FALL, None, longest).expect("steps");
            assert!(!through && depth < 0.05, "{onto:?} {longest}: {depth} d");
        }
    }
}

/// Steps of up to 1.5 mm of way: where the method gives up it says so, and nothing is passed through.
#[test]
fn with_steps_prescribed() {
    let scene = scene();
    for onto in [Onto::Flat, Onto::Corner, Onto::Wire] {
        for fixed in [1e-6, 5e-6, 20e-6, 50e-6, 100e-6, 150e-6] {
            match land(&scene, onto, FALL, Some(fixed), 0.1) {
                Ok((depth, through)) => {
                    assert!(!through && depth < 0.05, "{onto:?} {fixed}: {depth} d");
                }
                // wire crossing wire: Newton's method needs shorter steps to settle there
                Err(_) => assert!(onto == Onto::Wire && fixed > 5e-6, "{onto:?} {fixed}"),
            }
        }
    }
}

/// Steps that have grown in the flight to 10 mm of way. One that ends in contact takes a node a radius
/// deep at most; a single node may stay that deep for an instant where wire crosses wire.
#[test]
fn after_a_long_flight() {
    let scene = scene();
    for onto in [Onto::Flat, Onto::Corner, Onto::Wire] {
        let limit = if onto == Onto::Wire { 0.5 } else { 0.05 };
        for longest in [50e-6, 100e-6, 300e-6, 1e-3] {
            let (depth, through) = land(&scene, onto, LONG_FALL, None, longest).expect("steps");
            assert!(!through && depth < limit, "{onto:?} {longest}: {depth} d");
        }
    }
}

/// Free flight has no error that would bound the step, but a way that it may take.
#[test]
fn after_a_long_flight_in_steps_of_any_length() {
    let scene = scene();
    for onto in [Onto::Flat, Onto::Corner, Onto::Wire] {
        let (depth, _) = land(&scene, onto, LONG_FALL, None, 0.1).expect("steps");
        let limit = if onto == Onto::Wire { 0.5 } else { 0.05 };
        assert!(0.0 < depth && depth < limit, "{onto:?}: {depth} d");
    }
}

/// The energy balance books what a landing takes from the motion as lost, whatever the length of its step. By the forces at the ends
/// of the step alone, up to half of the motion would be unexplained.
#[test]
fn the_energy_balance_holds_through_a_landing() {
    let scene = scene();
    for fixed in [2e-6, 10e-6, 27e-6, 60e-6] {
        let mut sys = falling(&scene, Onto::Flat, FALL);
        let motion = sys.kinetic();
        sys.state.balance.initial = motion;
        let mut method = Implicit::new(Scheme::Bdf2, scene.solver.tolerance, 1e-9, 0.1);
        method.fixed = Some(fixed);
        while sys.state.deepest == 0.0 {
            method.step(&mut sys, 1.0).expect("a step");
        }
        let unexplained = sys.energy_residual(None) / motion;
        assert!(
            unexplained.abs() < 1e-3,
            "steps of {fixed} s: {unexplained}"
        );
        let balance = sys.state.balance;
        assert!(
            balance.damping > 0.1 * motion && balance.damping + balance.numerical < motion,
            "steps of {fixed} s: {balance:?}"
        );
    }
}

/// A landing takes what its restitution leaves of the speed that the core sees, on a standing core and on one that turns into
/// wire at rest. There, the spindle gives what the wire gets. Booked by mean forces, a third of it was numerical.
#[test]
fn a_landing_takes_what_its_restitution_says() {
    let scene = scene();
    for (e, turning, fixed) in [0.0, 0.5]
        .into_iter()
        .flat_map(|e| [false, true].map(|turning| (e, turning)))
        .flat_map(|(e, turning)| [0.3e-6, 3e-6, 27e-6].map(|fixed| (e, turning, fixed)))
    {
        let mut sys = falling(&scene, Onto::Flat, FALL);
        let mut line = sys.model.contact.as_line().expect("contact").clone();
        (line.restitution, line.law.mu_static, line.law.mu_kinetic) = (e, 0.0, 0.0);
        sys.touch_along(line);
        let spindle = SPEED / 10e-3;
        let mut speed = SPEED;
        if turning {
            // the flat comes at the wire by the spindle's speed times the way to its middle
            sys.state.rod.v.fill(V3::zeros());
            sys.state.spindle.speed = spindle;
            let way = V3::new(0.0, 0.0, 10e-3);
            sys.state.rod.x.iter_mut().for_each(|x| *x += way);
            let (reach, height) = (sys.state.rod.x[0], 6e-3 + scene.wire.radius());
            let far = reach.x * reach.x + reach.z * reach.z;
            speed = spindle.abs() * (far - height * height).sqrt();
        }
        sys.refresh();
        sys.state.balance.initial = sys.kinetic();
        let mut method = Implicit::new(Scheme::Bdf2, scene.solver.tolerance, 1e-9, 0.1);
        method.fixed = Some(fixed);
        while sys.state.deepest == 0.0 {
            method.step(&mut sys, 1.0).expect("a step");
        }
        // until what the contact stored has come back
        for _ in 0..(5e-6 / fixed).ceil().max(1.0) as usize {
            method.step(&mut sys, 1.0).expect("a step");
        }
        let mass: f64 = (0..NODES).map(|i| sys.state.rod.mass(&scene.wire, i)).sum();
        let motion = 0.5 * mass * speed * speed;
        let balance = sys.state.balance;
        let [taken, numerical, unexplained] = [
            balance.damping,
            balance.numerical,
            sys.energy_residual(None),
        ]
        .map(|e| e / motion);
        let case = format!("restitution {e}, turning {turning}, steps of {fixed} s");
        // (while it slides over a flat that turns, its speed along the normal changes by some percent)
        let off = if turning { 0.05 } else { 0.005 };
        assert!((taken - (1.0 - e * e)).abs() < off, "{case}: {taken} taken");
        assert!(numerical.abs() < off, "{case}: {numerical} numerical");
        let (given, momentum) = (balance.spindle / motion, 2.0 * (1.0 + e));
        assert!(
            !turning || (given / momentum - 1.0).abs() < 0.03,
            "{case}: {given} given"
        );
        assert!(
            unexplained.abs() < 0.005,
            "{case}: {unexplained} unexplained"
        );
    }
}

/// Speed at which wire of restitution `e` leaves the flat that it fell on, over its impact speed, in steps of `fixed`.
fn rebound(scene: &Scene, e: f64, fixed: f64) -> f64 {
    let mut sys = falling(scene, Onto::Flat, FALL);
    let mut line = sys.model.contact.as_line().expect("contact").clone();
    line.restitution = e;
    sys.touch_along(line);
    sys.refresh();
    let mut method = Implicit::new(Scheme::Bdf2, scene.solver.tolerance, 1e-9, 0.1);
    method.fixed = Some(fixed);
    let mean = |sys: &System| sys.state.rod.v.iter().map(|v| v.x).sum::<f64>() / NODES as f64;
    while sys.state.deepest == 0.0 {
        method.step(&mut sys, 1.0).expect("a step");
    }
    // long enough for what the contact stores to come back
    for _ in 0..(20e-6 / fixed).ceil().max(4.0) as usize {
        method.step(&mut sys, 1.0).expect("a step");
    }
    mean(&sys) / SPEED
}

/// `contact.restitution` made no difference, and a landing lost what the length of its step happened to take.
#[test]
fn wire_gives_back_what_the_restitution_says_in_steps_of_any_length() {
    let scene = scene();
    for e in [0.0, 0.3, 0.6] {
        for fixed in [0.1e-6, 1e-6, 7e-6, 30e-6, 100e-6] {
            let got = rebound(&scene, e, fixed);
            assert!((got - e).abs() < 0.02, "{e} in steps of {fixed} s: {got}");
        }
    }
}

/// A step far longer than a blow threw wire to and fro: its speed along the normal after a landing was up to half of that before.
#[test]
fn landed_wire_has_no_speed_into_or_out_of_what_it_touches() {
    let scene = scene();
    for fixed in [0.5e-6, 3e-6, 20e-6, 60e-6] {
        let mut sys = falling(&scene, Onto::Flat, FALL);
        let mut method = Implicit::new(Scheme::Bdf2, scene.solver.tolerance, 1e-9, 0.1);
        method.fixed = Some(fixed);
        while sys.state.deepest == 0.0 {
            method.step(&mut sys, 1.0).expect("a step");
        }
        let fastest = sys.state.rod.v[1..NODES - 1]
            .iter()
            .map(|v| v.x.abs())
            .fold(0.0, f64::max);
        assert!(fastest < 0.01 * SPEED, "steps of {fixed} s: {fastest} m/s");
    }
}

/// Load on a lightly pressed wire as an acceleration, m/s^2, and the longest step that a master leaves, s.
const LOAD: f64 = 15e3;
const OFTEN: f64 = 7.6e-6;

/// What a solve leaves was the same in steps of any length: it pushed wire at rest over the core, step by step, by up to
/// 1.6 mm/s, even against its load.
#[test]
fn short_steps_push_no_lightly_pressed_wire_that_friction_holds() {
    for (mu, held) in [(0.116, 0.5), (0.07, 0.3), (0.07, 0.69)] {
        let mut scene = scene();
        (scene.friction.static_, scene.friction.kinetic) = (mu, mu);
        let mut sys = falling(&scene, Onto::Flat, 1e-6);
        sys.state.rod.v.fill(V3::z() * 0.1);
        sys.model.loads.gravity = V3::new(-1.0, 0.0, held * mu) * LOAD;
        sys.refresh();
        let mut method = Implicit::new(Scheme::Bdf2, scene.solver.tolerance, 1e-9, OFTEN);
        let mut place_after = |steps: usize| {
            for _ in 0..steps {
                let mut left = OFTEN;
                while left > 0.0 {
                    left -= method.step(&mut sys, left).expect("a step");
                }
            }
            sys.state.rod.x[NODES / 2].z
        };
        let at_rest = place_after(200);
        let crept = (place_after(400) - at_rest).abs();
        assert!(
            crept < 1e-3 * scene.solver.tolerance,
            "{crept} m, held by {held} of {mu}"
        );
    }
}
