//! Equilibrium of wire by relaxation, and against the implicit method.

use super::*;
use crate::integrate::{Implicit, Scheme};
use crate::math::{align, frame_along};
use crate::rod::{Rod, Section, Twist};
use crate::system::Support;

fn section() -> Section {
    Section {
        n_y: 38.5,
        m_y: 5.72e-3,
        t_y: 5.18e-3,
        ..Section::table1_elastic()
    }
}

/// A clamped piece that runs askew to all axes.
fn cantilever(section: Section) -> System {
    let along = V3::new(0.6, 0.48, 0.64);
    let points: Vec<V3> = (0..=20).map(|i| along * (1e-3 * i as f64)).collect();
    let mut sys = System::new(section, Rod::through(&points, None));
    sys.support[0] = Support::clamped(V3::zeros(), frame_along(&along, None));
    sys
}

/// Bends, twists and pulls it past all limits.
fn push(sys: &mut System, share: f64) {
    let force = V3::new(20.0, 25.0, 30.0) + V3::new(0.8, -0.6, 0.0);
    sys.loads.nodal = vec![(20, force * share)];
    sys.loads.moments = vec![(19, V3::new(4e-3, 3.2e-3, 4.2e-3) * share)];
}

#[test]
fn the_tangent_is_the_derivative_of_the_forces_where_all_laws_yield() {
    let mut sys = cantilever(section());
    ramp(&mut sys, &Limits::default(), push).expect("the load is carried");
    assert!(
        sys.rod.stretch[5].strain > 0.0
            && sys.rod.twist[5].strain != 0.0
            && sys.rod.bend[1].rise > 0.0
    );
    push(&mut sys, 1.05);
    sys.evaluate(None);
    // move on into yield, away from the kink that the committed state sits on
    newton_step(&mut sys, &[V3::zeros(); 2]).expect("forces are finite");
    // forces are derivatives with the frames carried along from where the wire is now
    for j in 0..20 {
        let t = sys.rod.tangent(j);
        sys.rod.frame[j] = align(&sys.rod.frame[j], &t, sys.roll[j]);
        sys.roll[j] = 0.0;
    }
    let mut band = tangent(&mut sys);
    let (x, roll) = (sys.rod.x.clone(), sys.roll.clone());
    let mut worst = 0.0_f64;
    for k in [9usize, 10, 11] {
        for a in 0..PER_NODE {
            let mut sides = [Vec::new(), Vec::new()];
            for (side, sign) in [(0, 1.0), (1, -1.0)] {
                if a < 3 {
                    sys.rod.x[k][a] += sign * 1e-10;
                } else {
                    sys.roll[k] += sign * 1e-7;
                }
                sys.evaluate(None);
                sides[side] = residual(&sys);
                sys.rod.x.clone_from(&x);
                sys.roll.clone_from(&roll);
            }
            let column = PER_NODE * k + a;
            let diagonal = band.at(column, column).abs();
            for row in PER_NODE * (k - 2)..PER_NODE * (k + 2) {
                let by_force = (sides[1][row] - sides[0][row]) / 2e-10;
                worst = worst.max((*band.at(row, column) - by_force).abs() / diagonal);
            }
        }
    }
    assert!(worst < 1e-3, "relative difference {worst}");
}

#[test]
fn a_ramp_leaves_the_same_yielding_however_it_is_cut() {
    let strains = |largest: f64| {
        let mut sys = cantilever(section());
        let limits = Limits {
            largest,
            first: largest,
            ..Limits::default()
        };
        ramp(&mut sys, &limits, |sys, share| {
            // in one plane, where the law does not depend on the path
            sys.loads.nodal = vec![(20, V3::new(0.8, -0.6, 0.0).cross(&V3::z()) * share)];
        })
        .expect("the load is carried");
        (sys.rod.x[20], sys.rod.bend[0].rise)
    };
    let (coarse, fine) = (strains(0.5), strains(0.02));
    assert!(fine.1 > 1e-4, "{fine:?}");
    assert!((coarse.0 - fine.0).norm() < 1e-5, "{coarse:?} {fine:?}");
    assert!(
        (coarse.1 - fine.1).abs() < 1e-2 * fine.1,
        "{coarse:?} {fine:?}"
    );
}

#[test]
fn what_has_no_equilibrium_is_an_error() {
    let mut sys = cantilever(section());
    sys.support[0] = Support::free();
    sys.loads.nodal = vec![(20, V3::x())];
    assert!(relax(&mut sys, &Limits::default()).is_err());
    let mut sys = cantilever(section());
    sys.loads.nodal = vec![(20, V3::x() * f64::NAN)];
    assert!(matches!(
        relax(&mut sys, &Limits::default()),
        Err(RelaxError::Broken { .. })
    ));
    let mut sys = cantilever(section());
    let hurried = Limits {
        iterations: 1,
        ..Limits::default()
    };
    push(&mut sys, 1.0);
    assert!(matches!(
        relax(&mut sys, &hurried),
        Err(RelaxError::NotConverged { iterations: 1, .. })
    ));
}

/// A clamped wire that runs askew to all axes and yields in tension and bending; it carries no twist.
fn askew() -> System {
    let section = Section {
        n_y: 38.5,
        m_y: 5.72e-3,
        ..Section::table1_elastic()
    };
    let along = V3::new(0.8, 0.36, 0.48);
    let points: Vec<V3> = (0..=30).map(|i| along * (1e-3 * f64::from(i))).collect();
    let mut sys = System::new(section, Rod::through(&points, None));
    sys.support[0] = Support::clamped(points[0], frame_along(&along, None));
    sys.twist = Twist::Off;
    sys
}

#[test]
fn agrees_with_the_implicit_method() {
    let load = |sys: &mut System, share: f64| {
        sys.loads.nodal = vec![(30, V3::new(-0.3, 0.5, 0.2) * share)];
        sys.loads.gravity = V3::new(0.0, 0.0, -50.0 * share);
    };
    let (mut a, mut b) = (askew(), askew());
    let mut method = Implicit::new(Scheme::Bdf2, 1e-11, 1e-9, 1.0);
    method.follow(&mut a, load).expect("an equilibrium");
    ramp(&mut b, &Limits::default(), load).expect("an equilibrium");
    let yielded = b.rod.bend.iter().filter(|k| k.curvature != [0.0; 2]);
    assert!(yielded.count() > 3, "the load shall leave a bend behind");
    let off = a.rod.x.iter().zip(&b.rod.x).map(|(x, y)| (x - y).norm());
    assert!(off.fold(0.0, f64::max) < 1e-7);
}
