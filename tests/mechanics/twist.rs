//! Twist in the implicit method: modes stepped in time, and agreement with the explicit methods.

use crate::table1;
use coilwind::integrate::{Explicit, ExplicitMethod, Implicit, Scheme, highest_frequency};
use coilwind::lab::statics::{Limits, ramp};
use coilwind::math::{Quat, V3};
use coilwind::math::{frame_along, rotate};
use coilwind::rod::Twist;
use coilwind::rod::{Joint, Rod, Section};
use coilwind::system::{Support, System};

/// The paper's wire; elastic but for torsion, which yields at `t_y`.
fn section(t_y: f64) -> Section {
    Section {
        gj_p: 9e-4,
        t_y,
        ..table1::elastic()
    }
}

/// Stretched along +x between two clamps under `tension`.
fn stretched(section: Section, length: f64, n: usize, tension: f64) -> System {
    let points: Vec<V3> = (0..=n)
        .map(|i| V3::x() * (length * i as f64 / n as f64))
        .collect();
    let rest = length / n as f64 / (1.0 + tension / section.ea);
    let rod = Rod::through(&points, Some(vec![rest; n]));
    let frame = rod.frame[0];
    let mut sys = System::new(section, rod);
    sys.state.support = [
        Support::clamped(points[0], frame),
        Support::clamped(points[n], frame),
    ];
    sys
}

/// The frame along +x, rolled.
fn rolled(angle: f64) -> Quat {
    let (s, c) = (libm::sin(0.5 * angle), libm::cos(0.5 * angle));
    Quat::new(c, s, 0.0, 0.0) * frame_along(&V3::x(), None)
}

fn twists(sys: &System) -> Vec<f64> {
    (1..sys.state.rod.edges())
        .map(|i| Joint::between(&sys.state.rod.frame[i - 1], &sys.state.rod.frame[i]).twist)
        .collect()
}

fn apart(a: &System, b: &System) -> f64 {
    let both = a.state.rod.x.iter().zip(&b.state.rod.x);
    both.map(|(a, b)| (a - b).norm()).fold(0.0, f64::max)
}

/// A wire held at one end: a quarter of a shear wave. The midpoint rule turns the frequency by
/// `(omega h)^2 / 12` and keeps the amplitude.
#[test]
fn torsion_has_the_frequency_of_theory_and_keeps_its_amplitude() {
    let section = section(f64::INFINITY);
    let (length, n) = (0.1, 60);
    let mut sys = stretched(section.clone(), length, n, 0.0);
    sys.state.support[1] = Support::pinned(V3::x() * length);
    let speed = (section.gj / section.spin_inertia_per_length()).sqrt();
    let theory = 0.25 * speed / length;
    let shape = |j: usize| libm::sin(0.5 * std::f64::consts::PI * (j as f64 + 0.5) / n as f64);
    for j in 0..n {
        sys.state.rod.spin[j] = shape(j);
    }
    let mut method = Implicit::new(Scheme::Midpoint, 1e-12, 1e-9, 1.0);
    let h = 1.0 / theory / 60.0;
    method.fixed = Some(h);
    sys.refresh();
    let energy = |sys: &System| sys.stored() + sys.kinetic();
    let start = energy(&sys);
    let seen = |sys: &System| -> f64 { (0..n).map(|j| sys.state.rod.spin[j] * shape(j)).sum() };
    let (mut last, mut zeros) = (seen(&sys), Vec::new());
    while zeros.len() < 5 {
        method.step(&mut sys, h).expect("steps");
        let now = seen(&sys);
        if last * now < 0.0 {
            zeros.push(sys.state.time - h * now / (now - last));
        }
        last = now;
    }
    let frequency = 2.0 / (zeros[4] - zeros[0]);
    assert!(
        (frequency / theory - 1.0).abs() < 2e-3,
        "{frequency} {theory}"
    );
    assert!((energy(&sys) / start - 1.0).abs() < 1e-6);
}

/// BDF2 at steps that resolve the wave, both against each other's own explicit twin: nodes and frames.
#[test]
fn a_torsional_wave_runs_as_in_the_explicit_method() {
    let start = || {
        let mut sys = stretched(section(f64::INFINITY), 0.05, 25, 5.0);
        let arch = |s: f64| libm::sin(s * std::f64::consts::PI);
        for i in 0..25 {
            sys.state.rod.spin[i] = 500.0 * arch((i as f64 + 0.5) / 25.0).powi(4);
            sys.state.rod.v[i] = V3::new(0.0, 2.0, 1.0) * arch(i as f64 / 25.0);
        }
        sys
    };
    let end = 2e-5;
    let (mut a, mut b) = (start(), start());
    let limit = 2.0 / highest_frequency(&b.model.section, b.state.rod.rest[0], 0.0, true);
    let steps = (end / (0.1 * limit)).ceil();
    b.evaluate(Some(0.0));
    let mut verlet = Explicit::new(ExplicitMethod::Verlet);
    for _ in 0..steps as usize {
        verlet.step(&mut b, end / steps);
    }
    let mut method = Implicit::new(Scheme::Bdf2, 1e-12, 1e-12, 1.0);
    method.fixed = Some(end / 1000.0);
    a.refresh();
    while a.state.time < end * (1.0 - 1e-9) {
        let left = end - a.state.time;
        method.step(&mut a, left).expect("steps");
    }
    assert!(apart(&a, &b) < 1e-9, "{}", apart(&a, &b));
    let (ta, tb) = (twists(&a), twists(&b));
    let largest = tb.iter().fold(0.0, |m: f64, t| m.max(t.abs()));
    for (x, y) in ta.iter().zip(&tb) {
        assert!((x - y).abs() < 0.01 * largest, "{x} {y} of {largest}");
    }
}

/// A stretched wire, its far end turned by five turns and pulled down by weight: what is left when all
/// has come to rest does not depend on the method or the level of twist. The weight couples bending
/// and twist.
#[test]
fn twisted_under_tension_all_come_to_the_same_rest() {
    let turned = 10.0;
    let make = || {
        let mut sys = stretched(section(f64::INFINITY), 0.06, 30, 15.0);
        sys.model.loads.gravity = V3::new(0.0, -2e4, 0.0);
        sys
    };
    let mut still = make();
    ramp(&mut still, &Limits::default(), |sys, share| {
        sys.state.support[1].frame = Some(rolled(turned * share));
        sys.model.loads.gravity = V3::new(0.0, -2e4 * share, 0.0);
    })
    .expect("an equilibrium");
    let sag = still.state.rod.x[15].y;
    let off_plane = still.state.rod.x[10].z.abs();
    assert!(sag < -5e-5 && off_plane > 1e-6, "{sag} {off_plane}");

    // the explicit method, braked
    let mut moved = make();
    moved.model.loads.drag = 5e3;
    let dt = 1.8 / highest_frequency(&moved.model.section, moved.state.rod.rest[0], 0.0, true);
    moved.evaluate(Some(0.0));
    let mut verlet = Explicit::new(ExplicitMethod::Verlet);
    let steps = (12e-3 / dt) as usize;
    for k in 0..steps {
        let share = (3.0 * k as f64 / steps as f64).min(1.0);
        moved.state.support[1].frame = Some(rolled(turned * share));
        verlet.step(&mut moved, dt);
    }
    assert!(apart(&moved, &still) < 1e-7, "{}", apart(&moved, &still));

    for level in [Twist::QuasiStatic, Twist::Dynamic] {
        // in time
        let mut sys = make();
        sys.model.twist = level;
        sys.model.loads.drag = 5e3;
        let mut method = Implicit::new(Scheme::Bdf2, 1e-8, 1e-9, 1e-4);
        sys.refresh();
        while sys.state.time < 12e-3 {
            let share = (sys.state.time / 4e-3).min(1.0);
            sys.state.support[1].frame = Some(rolled(turned * share));
            method.step(&mut sys, 1e-4).expect("steps");
        }
        assert!(
            apart(&sys, &still) < 1e-7,
            "{level:?} {}",
            apart(&sys, &still)
        );
        for (x, y) in twists(&sys).iter().zip(&twists(&still)) {
            assert!((x - y).abs() < 1e-5, "{level:?} {x} {y}");
        }
        let (m, e) = (sys.state.load.clamp_moment, still.state.load.clamp_moment);
        for end in 0..2 {
            assert!((m[end] - e[end]).norm() < 1e-4 * e[end].norm());
        }
        // and as a static solve
        let mut sys = make();
        sys.model.twist = level;
        Implicit::new(Scheme::Bdf2, 1e-9, 1e-9, 1.0)
            .follow(&mut sys, |sys, share| {
                sys.state.support[1].frame = Some(rolled(turned * share));
                sys.model.loads.gravity = V3::new(0.0, -2e4 * share, 0.0);
            })
            .expect("an equilibrium");
        assert!(apart(&sys, &still) < 1e-8, "{}", apart(&sys, &still));
    }
}

/// Torque beyond yield, and back: the plastic twist is that of the explicit path.
#[test]
fn twist_stays_after_yield() {
    let make = || stretched(section(6e-3), 0.06, 30, 15.0);
    let (mut a, mut b) = (make(), make());
    // there and back, in pieces: between two solves a clamp must turn by less than half a turn
    let largest = 200.0 * 0.06;
    let angle = |at: f64| largest * (1.0 - (at / 20.0 - 1.0).abs());
    a.model.twist = Twist::QuasiStatic;
    let mut method = Implicit::new(Scheme::Bdf2, 1e-9, 1e-9, 1.0);
    for k in 0..40 {
        let turn = |sys: &mut System, share: f64| {
            sys.state.support[1].frame = Some(rolled(angle(f64::from(k) + share)));
        };
        ramp(&mut b, &Limits::default(), turn).expect("an equilibrium");
        method.follow(&mut a, turn).expect("an equilibrium");
    }
    let set = b.state.rod.twist[15].strain;
    assert!(set.abs() > 10.0, "{set}");
    for (x, y) in a.state.rod.twist.iter().zip(&b.state.rod.twist) {
        assert!(
            (x.strain - y.strain).abs() < 0.05 * set.abs(),
            "{x:?} {y:?}"
        );
    }
    let spent = [a.state.balance.plastic[1], b.state.balance.plastic[1]];
    assert!((spent[0] / spent[1] - 1.0).abs() < 0.01, "{spent:?}");
}

/// One joint is softer than the rest and yields alone. Rolls have no inertia, so no step is too short for them to cross
/// the knee of its law, there or back: each must settle within a step, with one couple along the wire.
#[test]
fn rolls_cross_the_knee_of_torsion_within_a_step() {
    let torsion = 6e-3;
    let mut sys = stretched(
        Section {
            gj_p: 9e-5,
            ..section(torsion)
        },
        0.06,
        60,
        15.0,
    );
    for (i, joint) in sys.state.rod.twist.iter_mut().enumerate() {
        joint.rise = if i == 30 { 0.0 } else { 1.0 };
    }
    sys.model.twist = Twist::QuasiStatic;
    sys.refresh();
    let mut method = Implicit::new(Scheme::Bdf2, 2e-5, 1e-9, 1e-9);
    method.fixed = Some(1e-9);
    // turn at which the weak joint yields
    let yield_branch = torsion / sys.model.section.gj * 0.06;
    let length: f64 = sys.state.rod.rest.iter().sum();
    for share in [0.9, 1.3, 1.1, 1.6, 0.4, 1.8, 2.5] {
        sys.state.support[1].frame = Some(rolled(share * yield_branch));
        method.step(&mut sys, 1e-9).expect("settles");
        let off = sys
            .state
            .load
            .torque
            .iter()
            .fold(0.0, |m: f64, t| m.max(t.abs()));
        assert!(off < 1e-6 * torsion, "{share}: {off}");
        // the couple turns the whole wire elastically, and the weak joint for good
        let weak = sys.state.rod.twist[30];
        let set = weak.strain * sys.state.rod.voronoi(30);
        let couple = (share * yield_branch - set) / length * sys.model.section.gj;
        let limit = torsion + weak.rise;
        assert!(
            couple < limit * (1.0 + 1e-6),
            "{share}: {couple} of {limit}"
        );
        if [1.3, 1.6, 1.8, 2.5].contains(&share) {
            assert!(
                couple > limit * (1.0 - 1e-6),
                "{share}: {couple} of {limit}"
            );
        }
    }
}

/// Wire fixed to a turning core turns with it: in the lab its edges spin about themselves, in the core
/// nothing happens.
#[test]
fn wire_at_rest_on_a_turning_core_stays_there() {
    for level in [Twist::QuasiStatic, Twist::Dynamic] {
        let along = V3::new(0.5, 0.7, -0.3).normalize();
        let n = 20;
        let points: Vec<V3> = (0..=n)
            .map(|i| V3::new(1e-3, 0.0, 0.0) + along * (1e-3 * i as f64))
            .collect();
        let rod = Rod::through(&points, None);
        let frame = rod.frame[0];
        let mut sys = System::new(section(f64::INFINITY), rod);
        sys.model.twist = level;
        sys.state.support = [0, n].map(|i| Support {
            turning: true,
            ..Support::clamped(points[i], frame)
        });
        sys.state.spindle.speed = 100.0;
        for i in 0..=n {
            sys.state.rod.v[i] = coilwind::math::spin_velocity(100.0, points[i]);
            if i < n && level == Twist::Dynamic {
                sys.state.rod.spin[i] = 100.0 * along.y;
            }
        }
        let mut method = Implicit::new(Scheme::Bdf2, 1e-7, 1e-9, 1e-4);
        sys.refresh();
        while sys.state.time < 0.02 {
            method.step(&mut sys, 1e-4).expect("steps");
        }
        let clamp = sys.clamp_frame(0).expect("clamped");
        for f in &sys.state.rod.frame {
            let off = rotate(&(clamp.conjugate() * f), &V3::x()) - V3::x();
            assert!(off.norm() < 1e-3, "{level:?} {off:?}");
        }
    }
}

/// Set in one plane, then pulled out of it: a joint's set turns with the wire, which rolls to where its
/// torques balance. Without twist nothing says how it rolls, and the tip ends up elsewhere.
#[test]
fn set_wire_pulled_out_of_its_plane_is_that_of_the_explicit_forces() {
    let make = || {
        let section = Section {
            m_y: 5.72e-3,
            ..section(f64::INFINITY)
        };
        let mut sys = stretched(section, 0.04, 40, 0.0);
        sys.state.support[1] = Support::free();
        sys
    };
    let paths: [fn(f64) -> V3; 3] = [
        |s| V3::new(0.0, -1.2 * s, 0.0),
        |s| V3::new(0.0, -1.2 * (1.0 - s), 0.6 * s),
        |s| V3::new(0.6 * s, 0.0, 0.6),
    ];
    let mut joints = make();
    for path in paths {
        ramp(&mut joints, &Limits::default(), |sys, share| {
            sys.model.loads.nodal = vec![(40, path(share))];
        })
        .expect("an equilibrium");
    }
    let off = [Twist::QuasiStatic, Twist::Dynamic, Twist::Off].map(|level| {
        let mut sys = make();
        sys.model.twist = level;
        let mut method = Implicit::new(Scheme::Bdf2, 1e-9, 1e-9, 1.0);
        for path in paths {
            method
                .follow(&mut sys, |sys, share| {
                    sys.model.loads.nodal = vec![(40, path(share))];
                })
                .expect("an equilibrium");
        }
        apart(&sys, &joints)
    });
    let yielded = joints
        .state
        .rod
        .bend
        .iter()
        .filter(|b| b.curvature != [0.0; 2]);
    assert!(yielded.count() > 5);
    // (both ramps choose their increments, and what is set depends on them in the sixth digit)
    assert!(off[0] < 5e-6 && off[1] < 5e-6 && off[2] > 1e-3, "{off:?}");
}
