//! Derivatives over a communication step against differences of steps from the same state; prints the tables of
//! `docs/fmu/derivatives.md`.
//!
//!     cargo bench --bench step_derivatives              200 instants for each speed and step, 10,000 calls
//!     cargo bench --bench step_derivatives -- 20        fewer instants, as many calls for each

#[path = "../tests/common/along.rs"]
mod along;

use along::along;
use coilwind::scene::Scene;
use coilwind::settings::SceneSettings;
use coilwind::signals::{Inputs, Outputs};
use coilwind::simulation::Simulation;
use coilwind::variables::{Access, Value, by_name};
use std::f64::consts::TAU;
use std::time::Instant;

/// Speeds, rad/s, and communication steps, s.
const SPEEDS: [f64; 4] = [30.0, 100.0, 300.0, 500.0];
const STEPS: [f64; 3] = [1e-4, 1e-3, 4e-3];
/// Difference that the derivatives are held against: rad over the step, m, and share of the set tension.
const OFF: [f64; 3] = [2e-5, 5e-7, 2e-3];
/// Its sizes: where differences of these disagree, wire lands, slips or sticks between them, and there is no derivative.
const SIZES: [f64; 3] = [0.5, 1.0, 2.0];
/// What counts as agreeing, over the larger of two.
const CLOSE: f64 = 0.02;
/// Time from one change of the inputs to the next between instants, s.
const PACE: f64 = 1e-4;
/// Calls in all that are counted for refusals.
const CALLS: usize = 10_000;

/// Numbers from 0 to 1 (Knuth's generator; the high bits are the random ones).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// Outputs with derivatives, in the order of their names.
fn smooth(o: &Outputs) -> Vec<f64> {
    let value = |name: &&str| match by_name(name).map(|row| row.access) {
        Some(Access::Output(get)) => match get(o) {
            Value::Real(x) => x,
            _ => unreachable!("a number"),
        },
        _ => unreachable!("an output"),
    };
    Outputs::SMOOTH.iter().map(value).collect()
}

/// A wind of `fig8` up to `speed`, rad/s, in half a turn, and on for two and a quarter.
struct Wind {
    sim: Simulation,
    speed: f64,
    ramp: f64,
}

impl Wind {
    fn new(scene: &Scene, speed: f64) -> Self {
        let mut sim = Simulation::new(scene).expect("a start");
        sim.step_beyond(true);
        let ramp = 0.5 * TAU / speed;
        Self { sim, speed, ramp }
    }

    fn end(&self) -> f64 {
        self.ramp + 2.25 * TAU / self.speed
    }

    /// Inputs held over a step of `dt`, s, from now on.
    fn inputs(&self, dt: f64) -> Inputs {
        let mut inputs = self.sim.inputs();
        let middle = self.sim.time() + 0.5 * dt;
        inputs.spindle_speed = self.speed * (middle / self.ramp).min(1.0);
        inputs.nozzle_position += 0.7e-3 * inputs.spindle_speed * dt / TAU;
        inputs
    }

    /// Goes on to `time`, s; false where the run ended before.
    fn go_to(&mut self, time: f64) -> bool {
        while self.sim.time() < time - 1e-9 {
            let dt = PACE.min(time - self.sim.time());
            if self.sim.advance(self.inputs(dt), dt).is_err() {
                return false;
            }
        }
        true
    }
}

/// How often the differences of an output agreed, and how often the derivative was one of them then.
#[derive(Clone, Copy, Default)]
struct Tally {
    all: u32,
    agreed: u32,
    met: u32,
}

impl Tally {
    fn add(&mut self, got: f64, differences: &[f64], digits: f64) {
        let close = |a: f64, b: f64| (a - b).abs() <= CLOSE * a.abs().max(b.abs()) + digits;
        let pairs = differences.iter().zip(&differences[1..]);
        let agreed = pairs.into_iter().all(|(a, b)| close(*a, *b))
            && close(differences[0], differences[differences.len() - 1]);
        self.all += 1;
        self.agreed += u32::from(agreed);
        self.met += u32::from(agreed && close(got, differences[1]));
    }

    fn cell(&self) -> String {
        let share = |part: u32, of: u32| 100.0 * f64::from(part) / f64::from(of.max(1));
        match self.agreed {
            0 => "0".to_owned(),
            agreed => format!(
                "{:.0}, {:.0}",
                share(agreed, self.all),
                share(self.met, agreed)
            ),
        }
    }
}

/// Compares at `count` random instants in steps of `step`, s; a tally for each output, and the time of a call, s.
fn compare(scene: &Scene, speed: f64, step: f64, count: usize) -> (Vec<Tally>, f64) {
    let mut random = Random((speed / step) as u64);
    let mut wind = Wind::new(scene, speed);
    let last = wind.end() - step;
    let mut times: Vec<f64> = (0..count).map(|_| random.next() * last).collect();
    times.sort_by(f64::total_cmp);
    let mut tallies = vec![Tally::default(); Outputs::SMOOTH.len()];
    let (mut spent, mut calls) = (0.0, 0);
    for time in times {
        if !wind.go_to(time) {
            break;
        }
        let (before, inputs) = (&wind.sim, wind.inputs(step));
        for input in 0..3 {
            let off = [OFF[0] / step, OFF[1], OFF[2] * inputs.tension_setpoint][input];
            let began = Instant::now();
            let got = before.step_derivative(inputs, Inputs::HELD, step, along(input, 1.0));
            spent += began.elapsed().as_secs_f64();
            calls += 1;
            let after = |by: f64| {
                let mut run = before.clone();
                run.advance(inputs.after(&along(input, by), 1.0), step)
                    .map(|()| smooth(run.outputs()))
            };
            let ends: Result<Vec<_>, _> = SIZES
                .iter()
                .map(|size| {
                    Ok::<_, coilwind::simulation::SimError>((
                        after(size * off)?,
                        after(-size * off)?,
                    ))
                })
                .collect();
            let (Ok(got), Ok(ends)) = (got, ends) else {
                continue;
            };
            for (k, (tally, got)) in tallies.iter_mut().zip(smooth(&got)).enumerate() {
                let differences: Vec<f64> = ends
                    .iter()
                    .zip(SIZES)
                    .map(|((plus, minus), size)| (plus[k] - minus[k]) / (2.0 * size * off))
                    .collect();
                // what is left of 16 digits
                let digits = 1e-14 * ends[0].0[k].abs() / (SIZES[0] * off) + 1e-12;
                tally.add(got, &differences, digits);
            }
        }
    }
    (tallies, spent / f64::from(calls.max(1)))
}

/// Calls that are refused, of so many, while a controller shakes the tension.
fn refused(scene: &Scene, speed: f64, calls: usize) -> usize {
    let step = 1e-4;
    let (mut refused, mut asked) = (0, 0);
    while asked < calls {
        let mut wind = Wind::new(scene, speed);
        while asked < calls && wind.sim.time() < wind.end() {
            let mut inputs = wind.inputs(step);
            inputs.tension_setpoint = 15.0 + 3.0 * (0.7 * asked as f64).sin();
            let before = wind.sim.clone();
            if wind.sim.advance(inputs, step).is_err() {
                break;
            }
            let got = before.step_derivative(inputs, Inputs::HELD, step, along(asked % 3, 1.0));
            refused += usize::from(got.is_err());
            asked += 1;
        }
    }
    refused
}

fn main() {
    let mut args = std::env::args().skip(1);
    let count = args.find_map(|a| a.parse().ok()).unwrap_or(200_usize);
    let scene = SceneSettings::load("fig8")
        .expect("packed")
        .build()
        .expect("valid");
    for step in STEPS {
        let columns = SPEEDS.map(|speed| compare(&scene, speed, step, count));
        println!(
            "\nSteps of {step:e} s; ms a call: {}",
            columns
                .each_ref()
                .map(|c| format!("{:.1}", 1e3 * c.1))
                .join(", ")
        );
        println!(
            "\n| output | {} |",
            SPEEDS.map(|speed| format!("{speed} rad/s")).join(" | ")
        );
        println!("|---|---:|---:|---:|---:|");
        for (k, name) in Outputs::SMOOTH.iter().enumerate() {
            let cells = columns.each_ref().map(|column| column.0[k].cell());
            println!("| `{name}` | {} |", cells.join(" | "));
        }
    }
    let each = CALLS / SPEEDS.len();
    let refused: usize = SPEEDS
        .iter()
        .map(|speed| refused(&scene, *speed, each))
        .sum();
    println!("\n{refused} of {CALLS} calls refused");
}
