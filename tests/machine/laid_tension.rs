//! The tension that wire is laid with, against the one that its height at rest is for.

use crate::common::fig8;
use coilwind::signals::Inputs;
use coilwind::simulation::Simulation;

/// What is said of it in two and a half turns of the scene, with these values and with 200 N set for 10 us on the way or not.
fn told(values: &[(&str, &str)], jump: bool) -> Vec<String> {
    let scene = fig8(values);
    let still = Inputs {
        tension_setpoint: 15.0,
        nozzle_position: scene.nozzle_law.start(),
        ..Inputs::HELD
    };
    let mut run = Simulation::starting_by_law(&scene, still).expect("starts");
    run.step_beyond(true);
    let turning = Inputs {
        spindle_speed: 100.0,
        ..still
    };
    let mut told = Vec::new();
    for k in 0..160 {
        if jump && k == 60 {
            let pulled = Inputs {
                tension_setpoint: 200.0,
                ..turning
            };
            run.advance(pulled, 1e-5).expect("goes on");
        }
        run.advance(turning, 1e-3).expect("goes on");
        told.extend(run.drain_events().into_iter().map(|event| event.text));
    }
    assert!(run.outputs().turns_settled > 1.5, "{:?}", run.outputs());
    told.retain(|text| text.contains("height at rest under"));
    told
}

/// The set tension was taken for that of the wire: a controller's jump was told as tight wire, and a damper that holds it was not.
#[test]
fn tight_wire_is_told_by_its_own_tension() {
    assert_eq!(told(&[], false), [""; 0]);
    assert_eq!(told(&[], true), [""; 0]);
    let damped = told(&[("tensioner.damping", "8")], false);
    assert_eq!(damped.len(), 1, "{damped:?}");
    assert!(damped[0].contains("under 15.0 N"), "{damped:?}");
}
