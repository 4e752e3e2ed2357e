//! A run of the scene's own motion profile goes through the same door as one driven by inputs.

use crate::common::fig8;
use coilwind::math::V3;
use coilwind::signals::{EventKind, Inputs};
use coilwind::simulation::Simulation;

/// A fixed step of 0.3 ms is too long for Newton's method once the spindle is fast; the first steps of the ramp are
/// short ways and go through.
fn too_long_a_step() -> Simulation {
    let changes = [
        ("solver.step", "0.0003"),
        ("spindle.speed", "300"),
        ("spindle.ramp_turns", "1"),
    ];
    Simulation::new(&fig8(&changes)).expect("a fixed step is taken as it is")
}

#[test]
fn a_profile_run_that_fails_stands_at_the_last_good_step() {
    let mut sim = too_long_a_step();
    let end = sim.motion_profile().end();
    let before = *sim.outputs();
    let error = sim.advance_profile(end).expect_err("too long a step");
    let reached = sim.system().state.time;
    assert!(reached > 0.0 && reached < end, "{reached}");
    assert_eq!((sim.time(), error.time), (reached, reached));
    let o = sim.outputs();
    assert!(o.solver_steps > before.solver_steps && o.spindle_angle > 0.0);
    let turned = sim.system().state.spindle.angle - 1.464764;
    assert!((o.spindle_angle - turned).abs() < 1e-6, "{turned}");
    assert_eq!(
        sim.system().state.spindle.acceleration,
        0.0,
        "nothing drives on"
    );
}

/// Where a step failed, all derivatives by time were 0, whatever turned.
#[test]
fn a_step_that_fails_leaves_the_derivatives_of_its_last_instant() {
    let mut sim = too_long_a_step();
    let mut inputs = sim.inputs();
    while sim.advance(inputs, 1e-3).is_ok() {
        inputs.spindle_speed += 2.0;
        inputs.nozzle_position += 1e-5;
    }
    let (rates, o) = (sim.output_rates(), sim.outputs());
    assert_eq!(rates.spindle_angle, inputs.spindle_speed);
    assert_eq!(rates.fed_length, o.feed_speed);
    assert!(rates.fed_length > 0.1, "{}", rates.fed_length);
    assert_eq!(rates.tensioner_position, o.tensioner_speed);
    assert!((rates.nozzle_y - 0.01).abs() < 1e-6, "{}", rates.nozzle_y);
    assert!(sim.system().state.support[1].velocity == V3::zeros());
}

#[test]
fn a_profile_run_tells_of_solver_trouble() {
    let mut sim = too_long_a_step();
    let end = sim.motion_profile().end();
    sim.advance_profile(end).expect_err("too long a step");
    let events = sim.drain_events();
    let told = events.iter().filter(|e| e.kind == EventKind::Solver);
    assert_eq!(told.count(), 1, "{events:?}");
}

#[test]
fn a_profile_run_refuses_a_step_that_is_no_number() {
    for dt in [f64::NAN, f64::INFINITY, -1e-3] {
        let mut sim = Simulation::new(&fig8(&[])).expect("the scene starts");
        let before = *sim.outputs();
        let error = sim.advance_profile(dt).expect_err("no step").to_string();
        assert!(error.contains("communication step"), "{error}");
        assert_eq!((sim.time(), sim.outputs()), (0.0, &before));
        let inputs = sim.inputs();
        let error = sim.advance(inputs, dt).expect_err("no step").to_string();
        assert!(error.contains("communication step"), "{error}");
    }
}

/// A thousand steps of a tenth of a nanosecond are as much time by either way in.
#[test]
fn short_steps_of_the_profile_add_up_without_loss() {
    let mut profile = Simulation::new(&fig8(&[])).expect("the scene starts");
    let mut held = profile.clone();
    let inputs = Inputs {
        spindle_speed: 0.0,
        ..held.inputs()
    };
    for _ in 0..1_000 {
        profile.advance_profile(1e-10).expect("goes on");
        held.advance(inputs, 1e-10).expect("goes on");
    }
    assert_eq!(profile.time(), held.time());
    assert!((profile.time() - 1e-7).abs() < 1e-22, "{}", profile.time());
    assert!(profile.outputs().spindle_angle > 0.0);
}
