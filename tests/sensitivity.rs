//! Derivatives of the outputs by the inputs against differences of runs that start from the same state.

use coilwind::settings::SceneSettings;
use coilwind::signals::{Inputs, Outputs};
use coilwind::simulation::Simulation;

/// Communication step and step of the solver, s.
const STEP: f64 = 1e-5;

/// The scene of Fig. 8, wound as ever and then handed to a solver whose steps are so well solved that their
/// differences mean something.
fn wound(turns: f64, speed: f64, others: &[(&str, &str)]) -> (Simulation, Inputs) {
    let scene = |more: &[(&str, &str)]| {
        let mut settings = SceneSettings::load("fig8").unwrap();
        for (name, value) in others.iter().chain(more) {
            settings.set_text(name, value).unwrap();
        }
        settings.build().unwrap()
    };
    let mut sim = Simulation::new(&scene(&[])).unwrap();
    let ramp = 2e-3;
    let mut inputs = sim.inputs();
    while sim.outputs().spindle_angle < turns * std::f64::consts::TAU {
        inputs.spindle_speed = speed * (sim.time() / ramp).min(1.0);
        inputs.nozzle_position += 0.7e-3 * inputs.spindle_speed * STEP / std::f64::consts::TAU;
        sim.advance(inputs, STEP).unwrap();
    }
    let tight = scene(&[("solver.step", "1e-5"), ("solver.tolerance", "1e-9")]);
    let mut sim = Simulation::from_bytes(&tight, &sim.to_bytes().unwrap()).unwrap();
    sim.advance(inputs, STEP).unwrap();
    (sim, inputs)
}

/// The outputs that have a derivative, by name, with a size that counts.
fn seen(o: &Outputs) -> [(&'static str, f64); 9] {
    [
        ("wire_tension", o.wire_tension),
        ("spindle_torque", o.spindle_torque),
        ("fed_length", o.fed_length),
        ("feed_speed", o.feed_speed),
        ("free_length", o.free_length),
        ("layon_position", o.layon_position),
        ("layon_angle", o.layon_angle),
        ("turns_wound", o.turns_wound),
        ("spindle_angle", o.spindle_angle),
    ]
}

fn off(inputs: Inputs, input: usize, by: f64) -> Inputs {
    let mut inputs = inputs;
    match input {
        0 => inputs.spindle_speed += by,
        1 => inputs.nozzle_position += by,
        _ => inputs.tension_setpoint += by,
    }
    inputs
}

/// Holds the tangent against central differences of one step, each output and input.
fn check(sim: &Simulation, inputs: Inputs, what: &str) {
    let mut asked = sim.clone();
    let slopes = asked.sensitivities(inputs).unwrap();
    let to_bytes = |s: &Simulation| s.to_bytes().unwrap();
    assert!(
        to_bytes(&asked) == to_bytes(sim),
        "{what}: asking changed the run"
    );
    let mut told = 0;
    // rad/s, m, N
    for (input, by) in [(0, 0.05), (1, 2e-7), (2, 0.05)] {
        let after = |by: f64| {
            let mut sim = sim.clone();
            let before = sim.outputs().solver_steps;
            sim.advance(off(inputs, input, by), STEP).unwrap();
            assert_eq!(sim.outputs().solver_steps, before + 1.0, "one step");
            *sim.outputs()
        };
        let (plus, minus, still) = (after(by), after(-by), after(0.0));
        let all = seen(&plus).into_iter().zip(seen(&minus)).zip(seen(&still));
        for ((((name, a), (_, b)), (_, c)), (_, got)) in all.zip(seen(&slopes[input])) {
            let want = (a - b) / (2.0 * by);
            // how far from straight the answer is over the difference, and the digits of the outputs
            let bent = ((a - c) - (c - b)).abs() / by;
            let digits = 1e-9 * (1.0 + a.abs()) / by;
            let allowed = 2e-3 * want.abs() + 2.0 * bent + digits;
            told += usize::from(want.abs() > 10.0 * allowed);
            assert!(
                (got - want).abs() < allowed,
                "{what}: {name} by input {input}: {got:.6e}, differences {want:.6e}, allowed {allowed:.1e}"
            );
        }
    }
    // the others are 0 or as good as: no input but the speed turns the core, and the nozzle is far away
    assert!(
        told > 7,
        "{what}: {told} of 27 derivatives stand out of the noise"
    );
}

/// At 0.4 mm: with other spacings the derivative of the tension by the speed is off by up to 15 %.
#[test]
fn the_tangent_is_that_of_the_next_step() {
    for (turns, speed) in [(0.02, 100.0), (0.3, 300.0), (0.62, 300.0)] {
        let (sim, inputs) = wound(turns, speed, &[("solver.spacing_near", "0.0004")]);
        check(&sim, inputs, &format!("{turns} turns at {speed} rad/s"));
    }
}

#[test]
fn without_twist_and_without_line_too() {
    let others = [
        ("solver.twist", "off"),
        ("tensioner.line_length", "0"),
        ("wire.elastic", "true"),
    ];
    let (sim, inputs) = wound(0.2, 200.0, &others);
    check(&sim, inputs, "elastic wire, rigid line");
}

#[test]
fn live_wire_on_live_wire() {
    let (sim, inputs) = wound(1.35, 500.0, &[]);
    check(&sim, inputs, "1.35 turns at 500 rad/s");
}

#[test]
fn what_no_input_moves_has_no_derivative() {
    let (mut sim, inputs) = wound(0.2, 300.0, &[]);
    let slopes = sim.sensitivities(inputs).unwrap();
    for s in &slopes {
        assert_eq!(
            (s.gap_width, s.turns_settled, s.coil_width),
            (0.0, 0.0, 0.0)
        );
    }
    // a step is a hundredth of a millisecond, and only the spindle turns the core
    assert!((slopes[0].spindle_angle - STEP).abs() < 1e-12);
    assert_eq!(
        (slopes[1].spindle_angle, slopes[2].spindle_angle),
        (0.0, 0.0)
    );
    assert!(slopes[2].wire_tension > 0.0);
}

#[test]
fn at_the_start_and_for_explicit_methods() {
    let settings = SceneSettings::load("fig8").unwrap();
    let mut sim = Simulation::new(&settings.build().unwrap()).unwrap();
    let slopes = sim.sensitivities(sim.inputs()).unwrap();
    assert!(slopes[2].wire_tension > 0.0 && slopes[2].wire_tension < 1.0);
    let mut settings = settings;
    settings.set_text("solver.integrator", "verlet").unwrap();
    let mut sim = Simulation::new(&settings.build().unwrap()).unwrap();
    let refused = sim.sensitivities(sim.inputs()).unwrap_err().to_string();
    assert!(refused.contains("solver.integrator"), "{refused}");
}
