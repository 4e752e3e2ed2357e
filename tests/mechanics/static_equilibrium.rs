//! Equilibrium by the incremental potential of the production method, against that of the joint forces.

use crate::table1;
use coilwind::integrate::{Implicit, Scheme};
use coilwind::lab::statics::{Limits, ramp};
use coilwind::math::{V3, frame_along};
use coilwind::rod::{Rod, Section, Twist};
use coilwind::system::{Support, System};

/// A clamped wire that runs askew to all axes; it carries no twist.
fn cantilever() -> System {
    let section = Section {
        n_y: 38.5,
        m_y: 5.72e-3,
        ..table1::elastic()
    };
    let along = V3::new(0.8, 0.36, 0.48);
    let points: Vec<V3> = (0..=30).map(|i| along * (1e-3 * f64::from(i))).collect();
    let mut sys = System::new(section, Rod::through(&points, None));
    sys.state.support[0] = Support::clamped(points[0], frame_along(&along, None));
    sys.model.twist = Twist::Off;
    sys
}

fn load(sys: &mut System, share: f64) {
    sys.model.loads.nodal = vec![(30, V3::new(-0.3, 0.5, 0.2) * share)];
    sys.model.loads.gravity = V3::new(0.0, 0.0, -50.0 * share);
}

#[test]
fn agrees_with_equilibrium_of_the_joint_forces() {
    let (mut a, mut b) = (cantilever(), cantilever());
    let mut method = Implicit::new(Scheme::Bdf2, 1e-11, 1e-9, 1.0);
    method.follow(&mut a, load).expect("an equilibrium");
    ramp(&mut b, &Limits::default(), load).expect("an equilibrium");
    let yielded = b.state.rod.bend.iter().filter(|k| k.curvature != [0.0; 2]);
    assert!(yielded.count() > 3, "the load shall leave a bend behind");
    let off = a
        .state
        .rod
        .x
        .iter()
        .zip(&b.state.rod.x)
        .map(|(x, y)| (x - y).norm());
    assert!(off.fold(0.0, f64::max) < 1e-7);
}

#[test]
fn forces_are_those_of_the_joints() {
    let mut sys = cantilever();
    for (i, x) in sys.state.rod.x.iter_mut().enumerate().skip(1) {
        let s = i as f64;
        *x += V3::new(0.0, 1e-4 * libm::sin(s), 4e-6 * s * s);
    }
    load(&mut sys, 1.0);
    sys.evaluate(Some(0.0));
    let forces = Implicit::new(Scheme::Bdf2, 1e-11, 1e-9, 1.0).forces(&mut sys);
    let largest = sys
        .state
        .load
        .force
        .iter()
        .map(V3::norm)
        .fold(0.0, f64::max);
    for (a, b) in forces.iter().zip(&sys.state.load.force) {
        assert!((a - b).norm() < 1e-6 * largest, "{a:?} {b:?}");
    }
}
