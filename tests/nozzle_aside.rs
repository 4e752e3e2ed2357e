//! A nozzle that moves along x and z: it is where its inputs have it, and a machine turned about its axis winds the same.

mod common;

use coilwind::signals::Inputs;
use coilwind::simulation::Simulation;
use common::fig8;

/// Winds for `steps` milliseconds with a nozzle on the circle of the scene's, `turned` (rad) round the core from +x.
fn wound(turned: f64, steps: u32) -> Simulation {
    let scene = fig8(&[]);
    let distance = scene.nozzle.distance;
    let at_rest = Inputs {
        tension_setpoint: scene.tensioner.tension,
        nozzle_position: scene.nozzle_law.start(),
        nozzle_offset_x: distance * turned.cos() - distance,
        nozzle_offset_z: -distance * turned.sin(),
        ..Inputs::HELD
    };
    let mut run = Simulation::starting_with(&scene, at_rest).expect("starts");
    for k in 0..steps {
        let now = Inputs {
            spindle_speed: (4.0 * f64::from(k)).min(100.0),
            ..at_rest
        };
        run.advance(now, 1e-3).expect("goes on");
    }
    run
}

#[test]
fn a_nozzle_elsewhere_on_its_circle_winds_the_same_coil() {
    let [here, there] = [0.0, 0.8].map(|turned| wound(turned, 60));
    let (a, b) = (here.outputs(), there.outputs());
    assert!(a.turns_wound > 0.5, "{}", a.turns_wound);
    for (name, a, b, close) in [
        ("spindle_angle", a.spindle_angle, b.spindle_angle, 1e-12),
        ("wire_tension", a.wire_tension, b.wire_tension, 1e-3),
        ("free_length", a.free_length, b.free_length, 1e-5),
        ("layon_angle", a.layon_angle, b.layon_angle, 1e-3),
        ("turns_wound", a.turns_wound, b.turns_wound, 1e-4),
    ] {
        assert!((a - b).abs() < close, "{name}: {a} and {b}");
    }
    // the wire meets the coil at a place that is turned as the nozzle is
    let radius = |o: &coilwind::signals::Outputs| o.layon_x.hypot(o.layon_z);
    assert!((radius(a) - radius(b)).abs() < 1e-5);
    let turned = (-b.layon_z).atan2(b.layon_x) - (-a.layon_z).atan2(a.layon_x);
    assert!((turned - 0.8).abs() < 1e-3, "{turned}");
}

/// A nozzle that backs off draws wire out: as much as the free span becomes longer.
#[test]
fn a_nozzle_that_backs_off_draws_wire() {
    let mut run = wound(0.0, 0);
    let start = run.inputs();
    let before = *run.outputs();
    let rates = Inputs {
        nozzle_offset_x: 0.1,
        nozzle_offset_z: 0.05,
        ..Inputs::HELD
    };
    let mut now = start;
    for _ in 0..50 {
        run.advance_ramped(now, rates, 1e-3).expect("goes on");
        now = now.after(&rates, 1e-3);
    }
    for _ in 0..100 {
        run.advance(now, 1e-3).expect("goes on");
    }
    let is = run.inputs();
    assert!((is.nozzle_offset_x - start.nozzle_offset_x - 5e-3).abs() < 1e-12);
    assert!((is.nozzle_offset_z - start.nozzle_offset_z - 2.5e-3).abs() < 1e-12);
    let o = run.outputs();
    let (drawn, longer) = (
        o.fed_length,
        o.free_length + o.wire_length - before.free_length - before.wire_length,
    );
    assert!(
        drawn > 3e-3 && (drawn - longer).abs() < 0.05 * drawn,
        "{drawn} {longer}"
    );
    let scene = run.scene();
    assert!(
        (o.wire_tension - scene.tensioner.tension).abs() < 0.1,
        "{}",
        o.wire_tension
    );
}

#[test]
fn a_nozzle_is_not_sent_into_the_core() {
    let mut run = wound(0.0, 0);
    let into = Inputs {
        nozzle_offset_x: -run.scene().nozzle.distance,
        ..run.inputs()
    };
    let error = run
        .advance(into, 1e-3)
        .expect_err("there is the core")
        .to_string();
    assert!(error.contains("nozzle_offset_x"), "{error}");
    assert_eq!(run.time(), 0.0);
    let scene = fig8(&[]);
    assert!(Simulation::starting_with(&scene, into).is_err());
}
