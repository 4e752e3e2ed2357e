//! Outputs at communication points within a step of the method.

use coilwind::math::wrap_to_pi;
use coilwind::settings::SceneSettings;
use coilwind::signals::Inputs;
use coilwind::simulation::Simulation;
use std::f64::consts::TAU;

/// A scene with these settings, wound by inputs from rest to `speed`, rad/s, over 0.1 s; the nozzle follows its law.
fn wound(scene: &str, changes: &[(&str, &str)], speed: f64) -> Simulation {
    let mut settings = SceneSettings::load(scene).expect("packed");
    for (name, value) in changes {
        settings.set_text(name, value).expect("a valid setting");
    }
    let scene = settings.build().expect("a scene");
    let mut sim = Simulation::starting_by_law(&scene, scene.start_inputs()).expect("starts");
    sim.step_beyond(true);
    for k in 0..100 {
        let now = Inputs {
            spindle_speed: speed * f64::from(k) / 100.0,
            ..sim.inputs()
        };
        let rates = Inputs {
            spindle_speed: speed / 0.1,
            ..Inputs::HELD
        };
        sim.advance_ramped(now, rates, 1e-3).expect("goes on");
    }
    sim
}

/// Where a drive raised its speed every few communication points, nearly all of the coil's inertia was left out: it was that of the
/// acceleration within a step of the method, at whose start the speed jumps.
#[test]
fn a_speed_that_jumps_now_and_then_speeds_the_coil_up() {
    for (step, every) in [(20e-6, 10), (0.1e-3, 10), (50e-6, 20)] {
        let mut sim = wound("fig8", &[], 60.0);
        let (mut told, mut taken) = (0.0, 0.0);
        for k in 0..400 {
            let before = sim.inputs().spindle_speed;
            let now = Inputs {
                spindle_speed: if k % every == 0 { before + 0.5 } else { before },
                ..sim.inputs()
            };
            sim.advance(now, step).expect("goes on");
            let o = sim.outputs();
            told += (o.spindle_torque - o.spindle_torque_total) * step;
            taken += o.coil_inertia * (now.spindle_speed - before);
        }
        assert!(taken > 0.0);
        assert!((told / taken - 1.0).abs() < 1e-9, "{told:e} {taken:e}");
    }
}

/// Without mass of the tensioner the tension at the nozzle is the set one. Where that was sampled every few communication points, it came
/// along a line from the one before.
#[test]
fn a_tension_that_is_sampled_now_and_then_is_there_at_once() {
    let changes = [
        ("core.shape", "cylinder"),
        ("core.radius", "15e-3"),
        ("tensioner.mass", "0"),
        ("nozzle.exit_friction", "0"),
    ];
    for (step, every) in [(20e-6, 10), (10e-6, 20), (0.1e-3, 5)] {
        let mut sim = wound("fig8", &changes, 60.0);
        let mut worst: f64 = 0.0;
        for k in 0..400 {
            let now = Inputs {
                tension_setpoint: if k / every % 2 == 0 { 17.0 } else { 15.0 },
                ..sim.inputs()
            };
            sim.advance(now, step).expect("goes on");
            let off = sim.outputs().wire_tension - now.tension_setpoint;
            worst = worst.max(off.abs());
        }
        assert!(worst < 1e-6, "{worst} N in steps of {step} s");
    }
}

/// In steps in which wire landed on the next corner the place of the lay-on went along a line and its angle along another: together they
/// gave an angle of the core that was up to 20 degrees off.
#[test]
fn the_place_where_wire_is_laid_tells_the_angle_of_the_core() {
    for speed in [100.0, 300.0] {
        let mut sim = wound("fig8", &[], speed);
        let told = |sim: &Simulation| {
            let o = sim.outputs();
            o.layon_angle - o.layon_z.atan2(o.layon_x) - o.spindle_angle
        };
        let mut worst: f64 = 0.0;
        let start = told(&sim);
        while sim.outputs().turns_wound < 1.9 {
            sim.advance(sim.inputs(), 20e-6).expect("goes on");
            worst = worst.max(wrap_to_pi(told(&sim) - start).abs());
        }
        assert!(worst < 0.01, "{worst} rad at {speed} rad/s");
    }
}

/// A core that had wound the other way round was told to have stood for that at the start.
#[test]
fn a_core_that_winds_as_at_the_start_again_is_told_so() {
    let changes = [
        ("core.shape", "cylinder"),
        ("core.radius", "15e-3"),
        ("spindle.direction", "+y"),
    ];
    let mut sim = wound("fig8", &changes, 30.0);
    let mut events = sim.drain_events();
    for (speed, turns) in [(-60.0, -1.5), (60.0, 1.5)] {
        let now = Inputs {
            spindle_speed: speed,
            ..sim.inputs()
        };
        while (sim.outputs().spindle_angle / TAU - turns) * speed < 0.0 {
            sim.advance(now, 1e-3).expect("goes on");
            events.extend(sim.drain_events());
        }
    }
    let told = events.iter().map(|event| event.text.as_str());
    let told: Vec<&str> = told.filter(|text| text.contains("winds about")).collect();
    assert_eq!(told.len(), 2, "{told:?}");
    assert!(told[0].contains("winds about -y, and stood for winding about +y"));
    assert_eq!(told[1], "the core winds about +y again, as at the start");
}
