//! Derivatives of the outputs by the inputs of a communication step, against differences of steps from the same state.

use crate::along::along;
use coilwind::settings::SceneSettings;
use coilwind::signals::{Inputs, Outputs};
use coilwind::simulation::Simulation;
use coilwind::variables::{Access, Value, by_name};
use std::f64::consts::TAU;

const PITCH: f64 = 0.7e-3 / TAU;

fn fig8() -> Simulation {
    let settings = SceneSettings::load("fig8").unwrap();
    Simulation::new(&settings.build().unwrap()).unwrap()
}

fn smooth(o: &Outputs) -> Vec<f64> {
    let value = |name: &&str| match by_name(name).unwrap().access {
        Access::Output(get) => match get(o) {
            Value::Real(x) => x,
            other => panic!("{name} = {other}"),
        },
        _ => panic!("{name} is no output"),
    };
    Outputs::SMOOTH.iter().map(value).collect()
}

/// Winds up to `speed` within a quarter of a turn and calls `look` with the run before a step, and the step's inputs.
fn wind(speed: f64, step: f64, turns: f64, mut look: impl FnMut(usize, &Simulation, Inputs)) {
    let mut sim = fig8();
    let mut inputs = sim.inputs();
    let ramp = 0.5 * TAU / speed;
    for k in 0.. {
        inputs.spindle_speed = speed * (sim.time() / ramp).min(1.0);
        inputs.nozzle_position += PITCH * inputs.spindle_speed * step;
        // shaken as by a controller
        inputs.tension_setpoint = 15.0 + 2.0 * (300.0 * sim.time()).sin();
        look(k, &sim, inputs);
        sim.advance(inputs, step).unwrap();
        if sim.outputs().spindle_angle > turns * TAU {
            break;
        }
    }
}

/// Of the derivatives over a step, five of six are within 2 % of a difference. The others are at landings, where the
/// solver takes a step more on one side, and where an extreme changes its instant.
#[test]
fn derivatives_are_those_of_the_step() {
    for (speed, every) in [(30.0, 150), (300.0, 20)] {
        let (mut met, mut all) = (0, 0);
        wind(speed, 1e-4, 1.0, |k, before, inputs| {
            if k % every != every / 2 {
                return;
            }
            let off = [2e-5 / 1e-4, 5e-7, 0.03];
            for (input, off) in off.into_iter().enumerate() {
                let got = before
                    .step_derivative(inputs, Inputs::HELD, 1e-4, along(input, 1.0))
                    .unwrap()
                    .slopes;
                let after = |by: f64| {
                    let mut run = before.clone();
                    run.advance(inputs.after(&along(input, by), 1.0), 1e-4)
                        .unwrap();
                    smooth(run.outputs())
                };
                let (plus, minus) = (after(off), after(-off));
                for (k, got) in smooth(&got).into_iter().enumerate() {
                    let want = (plus[k] - minus[k]) / (2.0 * off);
                    // what is left of 16 digits
                    let digits = 1e-14 * plus[k].abs() / off + 1e-12;
                    all += 1;
                    met += usize::from((got - want).abs() <= 0.02 * want.abs() + digits);
                    if Outputs::SMOOTH[k] == "spindle_angle" {
                        let exact = if input == 0 { 1e-4 } else { 0.0 };
                        assert!((got - exact).abs() < 1e-9, "{got}");
                    }
                }
            }
        });
        assert!(all > 300, "{all}");
        println!("{speed} rad/s: {met} of {all}");
        assert!(6 * met >= 5 * all, "{speed} rad/s: {met} of {all}");
    }
}

/// A step that can be taken has derivatives, also where the tangent of a single step of the solver does not settle.
#[test]
fn no_step_is_refused() {
    let mut asked = 0;
    wind(500.0, 1e-4, 1.2, |k, before, inputs| {
        if k % 2 == 0 {
            let bytes = before.to_bytes().unwrap();
            for input in [0, 2] {
                let got = before.step_derivative(inputs, Inputs::HELD, 1e-4, along(input, 1.0));
                assert!(got.is_ok(), "at {} s: {got:?}", before.time());
            }
            assert!(
                before.to_bytes().unwrap() == bytes,
                "asking changed the run"
            );
            asked += 1;
        }
    });
    assert!(asked > 80, "{asked}");
}

/// Over a millisecond the tension follows the set value to a large part, where a single step of the solver gave 0.02 to 0.4.
#[test]
fn derivatives_are_not_those_of_the_solvers_next_step() {
    let (mut extremes, mut all) = (0, 0);
    wind(100.0, 1e-3, 0.5, |k, before, inputs| {
        if k % 5 == 4 {
            let pull = along(2, 1.0);
            let got = before
                .step_derivative(inputs, Inputs::HELD, 1e-3, pull)
                .unwrap()
                .slopes;
            assert!(
                (0.5..1.6).contains(&got.wire_tension),
                "{}",
                got.wire_tension
            );
            // an extreme at the beginning of the step does not follow its inputs
            extremes += usize::from(got.wire_tension_max.max(got.wire_tension_min) > 0.3);
            all += 1;
        }
    });
    assert!(2 * extremes > all, "{extremes} of {all}");
}

/// From the third small change of the set tension on the solver keeps its step. So did the steps of a difference, and a controller's gain
/// was 0.
#[test]
fn a_set_tension_that_is_shaken_little_has_a_gain() {
    let (speed, step) = (100.0, 1e-4);
    let mut sim = fig8();
    let mut inputs = sim.inputs();
    let mut asked = 0;
    while sim.time() < 0.04 {
        inputs.spindle_speed = speed * (sim.time() / 0.01).min(1.0);
        inputs.nozzle_position += PITCH * inputs.spindle_speed * step;
        inputs.tension_setpoint = 15.0 + 0.3 * (400.0 * sim.time()).sin();
        if sim.time() > 0.02 {
            let got = sim.step_derivative(inputs, Inputs::HELD, step, along(2, 1.0));
            let gain = got.unwrap().slopes.wire_tension;
            assert!(gain > 0.05, "{gain} at {} s", sim.time());
            asked += 1;
        }
        sim.advance(inputs, step).unwrap();
    }
    assert!(asked > 100, "{asked}");
}

/// What follows from the inputs of the start at once has the derivative of that.
#[test]
fn derivatives_at_the_start_are_those_of_the_start() {
    let sim = fig8();
    let slope =
        |input| Simulation::start_derivative(sim.scene(), sim.inputs(), along(input, 1.0)).unwrap();
    let pull = slope(2).slopes;
    for got in [
        pull.wire_tension,
        pull.wire_tension_min,
        pull.wire_tension_max,
    ] {
        assert!((got - 1.0).abs() < 1e-9, "{got}");
    }
    assert_eq!(smooth(&slope(0).slopes), vec![0.0; Outputs::SMOOTH.len()]);
    let moved = slope(1).slopes;
    assert!(
        (moved.nozzle_angle + 1.0 / 0.0598).abs() < 0.3,
        "{}",
        moved.nozzle_angle
    );
}

/// Where an input is at the end of its range, the difference is taken on the other side.
#[test]
fn a_set_tension_of_zero_has_derivatives() {
    let mut sim = fig8();
    let mut inputs = sim.inputs();
    sim.advance(inputs, 1e-3).unwrap();
    inputs.tension_setpoint = 0.0;
    let slope = sim
        .step_derivative(inputs, Inputs::HELD, 1e-3, along(2, 1.0))
        .unwrap()
        .slopes;
    assert!(slope.tensioner_speed < 0.0, "{}", slope.tensioner_speed);
}

/// A brake is a pull, and a damper is one where wire passes.
#[test]
fn brake_and_damper_have_derivatives() {
    let (mut checked, mut met) = (0, 0);
    wind(100.0, 1e-4, 0.4, |k, before, inputs| {
        if k % 25 != 20 {
            return;
        }
        let slope = |along: Inputs| {
            let got = before.step_derivative(inputs, Inputs::HELD, 1e-4, along);
            smooth(&got.unwrap().slopes)
        };
        let pull = slope(along(2, 1.0));
        let brake = slope(Inputs {
            brake_torque: before.scene().tensioner.radius,
            ..Inputs::HELD
        });
        let damper = slope(Inputs {
            tensioner_damping: 1.0,
            ..Inputs::HELD
        });
        // (the tensioner's speed over the step)
        let speed = before.outputs().tensioner_speed;
        let tension = Outputs::SMOOTH
            .iter()
            .position(|name| *name == "tensioner_speed")
            .unwrap();
        assert!(speed > 0.01, "{speed}");
        let (torque, damped) = (brake[tension], damper[tension] / speed);
        met += u32::from((torque / pull[tension] - 1.0).abs() < 1e-3);
        met += u32::from((damped / pull[tension] - 1.0).abs() < 0.1);
        checked += 2;
    });
    // (where wire lands, the last digit of a pull is enough for another slope)
    assert!(checked > 8 && 5 * met >= 4 * checked, "{met} of {checked}");
}

/// A difference of the tension that is larger than its swing within a step swaps the ends of the step: its slopes had shares of both.
#[test]
fn an_extreme_at_an_end_of_a_step_follows_the_tension_there() {
    let mut sim =
        Simulation::new(&SceneSettings::load("bobbin").unwrap().build().unwrap()).unwrap();
    let mut inputs = sim.inputs();
    let (mut at_end, mut at_begin) = (0, 0);
    for k in 0..600 {
        inputs.spindle_speed = (0.1 * f64::from(k)).min(40.0);
        let begin = sim.outputs().wire_tension;
        if k > 450 && k % 10 == 0 {
            let by_tension = along(2, 1.0);
            let derivative = sim
                .step_derivative(inputs, Inputs::HELD, 1e-4, by_tension)
                .unwrap();
            let mut step = sim.clone();
            step.advance(inputs, 1e-4).unwrap();
            let (o, slopes) = (step.outputs(), derivative.slopes);
            for (extreme, slope) in [
                (o.wire_tension_min, slopes.wire_tension_min),
                (o.wire_tension_max, slopes.wire_tension_max),
            ] {
                if extreme == o.wire_tension {
                    assert_eq!(slope, slopes.wire_tension, "at {k}");
                    at_end += 1;
                } else if extreme == begin {
                    assert_eq!(slope, 0.0, "at {k}");
                    at_begin += 1;
                }
            }
        }
        sim.advance(inputs, 1e-4).unwrap();
    }
    assert!(at_end > 5 && at_begin > 5, "{at_end} {at_begin}");
}
