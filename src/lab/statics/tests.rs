//! Tangent against differences of forces, ramps against finer ramps, and refusals.

use super::newton::newton_step;
use super::tangent::tangent;
use super::unknowns::{PER_NODE, residual};
use super::{Limits, RelaxError, ramp, relax};
use crate::math::V3;
use crate::math::{align, frame_along};
use crate::rod::{Rod, Section};
use crate::system::{Support, System};

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
    sys.state.support[0] = Support::clamped(V3::zeros(), frame_along(&along, None));
    sys
}

/// Bends, twists and pulls it past all limits.
fn push(sys: &mut System, share: f64) {
    let force = V3::new(20.0, 25.0, 30.0) + V3::new(0.8, -0.6, 0.0);
    sys.model.loads.nodal = vec![(20, force * share)];
    sys.model.loads.moments = vec![(19, V3::new(4e-3, 3.2e-3, 4.2e-3) * share)];
}

#[test]
fn the_tangent_is_the_derivative_of_the_forces_where_all_laws_yield() {
    let mut sys = cantilever(section());
    ramp(&mut sys, &Limits::default(), push).expect("the load is carried");
    assert!(
        sys.state.rod.stretch[5].strain > 0.0
            && sys.state.rod.twist[5].strain != 0.0
            && sys.state.rod.bend[1].rise > 0.0
    );
    push(&mut sys, 1.05);
    sys.evaluate(None);
    // move on into yield, away from the kink that the committed state sits on
    newton_step(&mut sys, &[V3::zeros(); 2]).expect("forces are finite");
    // forces are derivatives with the frames carried along from where the wire is now
    for j in 0..20 {
        let t = sys.state.rod.tangent(j);
        sys.state.rod.frame[j] = align(&sys.state.rod.frame[j], &t, sys.state.roll[j]);
        sys.state.roll[j] = 0.0;
    }
    let mut band = tangent(&mut sys);
    let (x, roll) = (sys.state.rod.x.clone(), sys.state.roll.clone());
    let mut worst = 0.0_f64;
    for k in [9usize, 10, 11] {
        for a in 0..PER_NODE {
            let mut sides = [Vec::new(), Vec::new()];
            for (side, sign) in [(0, 1.0), (1, -1.0)] {
                if a < 3 {
                    sys.state.rod.x[k][a] += sign * 1e-10;
                } else {
                    sys.state.roll[k] += sign * 1e-7;
                }
                sys.evaluate(None);
                sides[side] = residual(&sys);
                sys.state.rod.x.clone_from(&x);
                sys.state.roll.clone_from(&roll);
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
            sys.model.loads.nodal = vec![(20, V3::new(0.8, -0.6, 0.0).cross(&V3::z()) * share)];
        })
        .expect("the load is carried");
        (sys.state.rod.x[20], sys.state.rod.bend[0].rise)
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
    sys.state.support[0] = Support::free();
    sys.model.loads.nodal = vec![(20, V3::x())];
    assert!(relax(&mut sys, &Limits::default()).is_err());
    let mut sys = cantilever(section());
    sys.model.loads.nodal = vec![(20, V3::x() * f64::NAN)];
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
