//! A brake on the wheel that the wire comes over: its pull, and its largest torque.

use crate::common::fig8;
use coilwind::signals::Inputs;
use coilwind::simulation::Simulation;

/// A brake on the wheel pulls as the set tension does, and inputs read back as they were given.
#[test]
fn a_brake_pulls_by_its_torque_over_the_radius_of_its_wheel() {
    let wound = |set: f64, torque: f64| {
        let mut run = Simulation::new(&fig8(&[("tensioner.radius", "0.25")])).expect("starts");
        run.step_beyond(true);
        let rates = Inputs {
            tension_setpoint: if torque > 0.0 { 0.0 } else { 20.0 },
            brake_torque: if torque > 0.0 { 5.0 } else { 0.0 },
            ..Inputs::HELD
        };
        let mut now = Inputs {
            spindle_speed: 100.0,
            tension_setpoint: set,
            brake_torque: torque,
            ..run.inputs()
        };
        run.set_start(Inputs {
            spindle_speed: 0.0,
            ..now
        })
        .expect("starts");
        for _ in 0..40 {
            run.advance_ramped(now, rates, 1e-3).expect("goes on");
            now = now.after(&rates, 1e-3);
            assert_eq!(run.inputs(), now);
        }
        *run.outputs()
    };
    let (by_force, by_brake) = (wound(15.0, 0.0), wound(13.0, 0.5));
    // (2 N more from the start, and 20 N/s)
    assert!(by_brake.wire_tension > 14.0, "{}", by_brake.wire_tension);
    assert!((by_force.wire_tension - by_brake.wire_tension).abs() < 1e-9);
    assert!((by_force.fed_length - by_brake.fed_length).abs() < 1e-12);
    assert!(by_force.turns_wound > 0.3, "{}", by_force.turns_wound);
}

/// A run at rest at 10 N with a brake of at most 0.2 N m on a wheel of 50 mm, and its inputs while the brake is asked for `torque`.
fn braked(torque: f64) -> (Simulation, Inputs) {
    let scene = fig8(&[
        ("tensioner.tension", "10"),
        ("tensioner.brake_torque_max", "0.2"),
    ]);
    let still = Inputs {
        tension_setpoint: 10.0,
        nozzle_position: scene.nozzle_law.start(),
        brake_torque: torque,
        ..Inputs::HELD
    };
    let run = Simulation::starting_with(&scene, still).expect("starts");
    (run, still)
}

fn rising(rate: f64) -> Inputs {
    Inputs {
        brake_torque: rate,
        ..Inputs::HELD
    }
}

/// A brake asked for more than it has holds by the most it has, at a rate too.
#[test]
fn a_brake_holds_by_its_largest_torque_at_most() {
    for (asked, rate, tension) in [
        (0.1, 0.0, 12.0),
        (0.2, 0.0, 14.0),
        (0.9, 0.0, 14.0),
        (0.2, 40.0, 14.0),
    ] {
        let (mut run, still) = braked(asked);
        for _ in 0..20 {
            run.advance_ramped(still, rising(rate), 1e-3)
                .expect("goes on");
        }
        assert_eq!(run.inputs().brake_torque, asked + 1e-3 * rate);
        let found = run.outputs().wire_tension;
        assert!((found - tension).abs() < 0.02, "{asked}: {found}");
    }
}

/// A brake told to rise past its largest torque within a communication step pulled by the whole of the rise at its end.
#[test]
fn a_brake_that_reaches_its_largest_torque_within_a_step() {
    for (asked, rate, tension) in [
        (0.1, 10.0, 13.0),
        (0.1, 40.0, 14.0),
        (0.3, -10.0, 14.0),
        (0.3, -30.0, 13.0),
    ] {
        let (mut run, still) = braked(asked);
        for _ in 0..20 {
            run.advance(still, 1e-3).expect("goes on");
        }
        run.advance_ramped(still, rising(rate), 5e-3)
            .expect("goes on");
        let found = run.outputs().wire_tension;
        assert!((found - tension).abs() < 0.1, "{asked} {rate}: {found}");
    }
}

/// At its largest torque, one end of a difference changed nothing and went on as before: d tension / d torque was -90 to 134 1/m.
#[test]
fn the_derivative_at_the_largest_torque_is_that_from_below() {
    let (mut run, still) = braked(0.2);
    let turning = Inputs {
        spindle_speed: 30.0,
        ..still
    };
    let step = 1e-4;
    for k in 0..300_u32 {
        let now = Inputs {
            spindle_speed: 30.0 * f64::from(k.min(100)) / 100.0,
            ..turning
        };
        run.advance(now, step).expect("goes on");
    }
    for _ in 0..5 {
        let along = rising(1.0);
        let found = run
            .step_derivative(turning, Inputs::HELD, step, along)
            .expect("a derivative");
        let below = Inputs {
            tension_setpoint: 1.0,
            ..Inputs::HELD
        };
        let away = Inputs {
            brake_torque: 0.19,
            tension_setpoint: 10.2,
            ..turning
        };
        // the same pull below the limit, by the set tension
        let wanted = run
            .step_derivative(away, Inputs::HELD, step, below)
            .expect("a derivative");
        let [found, wanted] = [found.slopes.wire_tension, 20.0 * wanted.slopes.wire_tension];
        // (differences go with the pull, which is 2 % larger there)
        let off = (found - wanted).abs();
        assert!(off < 1e-3 * wanted.abs(), "{found} {wanted}");
        run.advance(turning, step).expect("goes on");
    }
}
