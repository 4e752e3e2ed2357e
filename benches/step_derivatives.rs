//! Derivatives over a communication step against differences of steps from the same state; prints the table of
//! `docs/fmu/derivatives.md`.
//!
//!     cargo bench --bench step_derivatives              200 instants for each speed and step
//!     cargo bench --bench step_derivatives -- 20        fewer

use coilwind::settings::SceneSettings;
use coilwind::signals::{Inputs, Outputs};
use coilwind::simulation::Simulation;
use coilwind::variables::{Access, Value, by_name};
use std::f64::consts::TAU;
use std::time::Instant;

/// Speeds, rad/s, and communication steps, s.
const SPEEDS: [f64; 4] = [30.0, 100.0, 300.0, 500.0];
const STEPS: [f64; 3] = [1e-4, 1e-3, 4e-3];
/// Outputs of the table.
const SHOWN: [&str; 5] = [
    "wire_tension",
    "spindle_torque",
    "fed_length",
    "free_length",
    "layon_position",
];
/// Difference that the derivatives are held against: rad over the step, m, and share of the set tension.
const OFF: [f64; 3] = [2e-5, 5e-7, 2e-3];
/// What counts as met, over the larger of the two.
const MET: [f64; 2] = [0.02, 0.1];

fn value(name: &str, o: &Outputs) -> f64 {
    match by_name(name).map(|row| row.access) {
        Some(Access::Output(get)) => match get(o) {
            Value::Real(x) => x,
            _ => unreachable!("a number"),
        },
        _ => unreachable!("an output"),
    }
}

fn main() {
    let mut args = std::env::args().skip(1);
    let count = args.find_map(|a| a.parse().ok()).unwrap_or(200_usize);
    let scene = SceneSettings::load("fig8")
        .expect("packed")
        .build()
        .expect("valid");
    let names = ["speed", "nozzle", "tension"];
    println!(
        "share of derivatives within {:.0} % and within {:.0} % of the difference, %",
        100.0 * MET[0],
        100.0 * MET[1]
    );
    print!("| rad/s | step s | by |");
    SHOWN.iter().for_each(|name| print!(" {name} |"));
    println!(" ms a call | refused |");
    for speed in SPEEDS {
        for step in STEPS {
            let mut sim = Simulation::new(&scene).expect("a start");
            let mut inputs = sim.inputs();
            let ramp = 0.5 * TAU / speed;
            let total = (ramp + 2.25 * TAU / speed) / step;
            let mut found = vec![[[0.0; 2]; SHOWN.len()]; 0];
            let (mut refused, mut spent, mut calls) = (0, 0.0, 0);
            let every = (total / count as f64).max(1.0);
            let mut next = 0.5 * every;
            for k in 0..total as usize {
                inputs.spindle_speed = speed * (sim.time() / ramp).min(1.0);
                inputs.nozzle_position += 0.7e-3 * inputs.spindle_speed * step / TAU;
                let before = sim.clone();
                if sim.advance(inputs, step).is_err() {
                    break;
                }
                if (k as f64) < next {
                    continue;
                }
                next += every;
                for input in 0..3 {
                    let along = |by: f64| {
                        let of = |k: usize| if k == input { by } else { 0.0 };
                        Inputs {
                            spindle_speed: of(0),
                            nozzle_position: of(1),
                            tension_setpoint: of(2),
                            ..Inputs::HELD
                        }
                    };
                    let off = [OFF[0] / step, OFF[1], OFF[2] * inputs.tension_setpoint][input];
                    let began = Instant::now();
                    let got = before.step_derivative(inputs, Inputs::HELD, step, along(1.0));
                    spent += began.elapsed().as_secs_f64();
                    calls += 1;
                    let Ok(got) = got else {
                        refused += 1;
                        continue;
                    };
                    let after = |by: f64| {
                        let mut run = before.clone();
                        run.advance(inputs.after(&along(by), 1.0), step)
                            .map(|()| *run.outputs())
                    };
                    let (Ok(plus), Ok(minus)) = (after(off), after(-off)) else {
                        continue;
                    };
                    let mut row = [[0.0; 2]; SHOWN.len()];
                    for (cell, name) in row.iter_mut().zip(SHOWN) {
                        *cell = [
                            value(name, &got),
                            (value(name, &plus) - value(name, &minus)) / (2.0 * off),
                        ];
                    }
                    found.push(row);
                }
            }
            for (input, name) in names.iter().enumerate() {
                print!("| {speed} | {step:e} | {name} |");
                for output in 0..SHOWN.len() {
                    let rows = found.iter().skip(input).step_by(3).map(|row| row[output]);
                    let count = rows.clone().count().max(1) as f64;
                    let share = |met: f64| {
                        let within = rows.clone().filter(|[got, want]| {
                            (got - want).abs() <= met * want.abs().max(got.abs())
                        });
                        100.0 * within.count() as f64 / count
                    };
                    print!(" {:.0}, {:.0} |", share(MET[0]), share(MET[1]));
                }
                println!(
                    " {:.1} | {refused} |",
                    1e3 * spent / f64::from(calls.max(1))
                );
            }
        }
    }
}
