//! Derivatives over a communication step against differences of steps from the same state; prints the tables of
//! `docs/fmu/derivatives.md`.
//!
//!     cargo bench --bench step_derivatives              200 instants for each speed and step, 10,000 calls
//!     cargo bench --bench step_derivatives -- 20        fewer instants, as many calls for each

#[path = "../tests/common/along.rs"]
mod along;

use along::{INPUTS, along};
use coilwind::scene::Scene;
use coilwind::settings::SceneSettings;
use coilwind::signals::{Inputs, Outputs};
use coilwind::simulation::{Simulation, StepTrail};
use coilwind::variables::{Access, Value, by_name};
use cpu_time::ThreadTime;
use std::f64::consts::TAU;

/// Speeds, rad/s, and communication steps, s.
const SPEEDS: [f64; 4] = [30.0, 100.0, 300.0, 500.0];
const STEPS: [f64; 3] = [1e-4, 1e-3, 4e-3];
/// Changes of the inputs: rad of core angle over the step, m of nozzle, and share of the pull.
const OFF: [f64; 3] = [2e-5, 5e-7, 2e-3];
/// Sizes of the differences that the derivatives are held against, over those.
const SIZES: [f64; 4] = [0.02, 0.2, 2.0, 20.0];
/// Size that the tables by output and by cause are for.
const MIDDLE: usize = 1;
/// What counts as met, over the larger of two.
const CLOSE: f64 = 0.02;
/// Inputs beside the three main ones are asked for at every so many instants.
const SIDE: usize = 4;
/// The first so many inputs are the main ones.
const MAIN: usize = 3;
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

/// What the two runs of a difference did otherwise.
const CAUSES: [&str; 7] = [
    "nothing",
    "iterations of the solver",
    "steps of the solver",
    "mesh",
    "a touch more or less",
    "slip",
    "yield",
];

/// The first of the causes that holds, physical ones first.
fn cause(one: &[StepTrail], other: &[StepTrail]) -> usize {
    let differ = |what: &dyn Fn(&StepTrail, &StepTrail) -> bool| {
        one.iter().zip(other).any(|(a, b)| what(a, b))
    };
    if differ(&|a, b| a.touching != b.touching && a.nodes == b.nodes) {
        return 4;
    }
    if differ(&|a, b| a.sliding != b.sliding && a.nodes == b.nodes) {
        return 5;
    }
    if differ(&|a, b| a.yielding != b.yielding && a.nodes == b.nodes) {
        return 6;
    }
    if differ(&|a, b| a.nodes != b.nodes) {
        return 3;
    }
    let tried = |s: &StepTrail| (s.taken.rejects, s.taken.newton_failures);
    if one.len() != other.len() || differ(&|a, b| tried(a) != tried(b)) {
        return 2;
    }
    usize::from(differ(&|a, b| a.taken != b.taken))
}

/// How many comparisons there were, and how many derivatives were met.
#[derive(Clone, Copy, Default)]
struct Tally {
    all: u32,
    met: u32,
}

impl Tally {
    fn add(&mut self, met: bool) {
        self.all += 1;
        self.met += u32::from(met);
    }

    fn plus(self, other: Self) -> Self {
        Self {
            all: self.all + other.all,
            met: self.met + other.met,
        }
    }

    fn share(&self) -> String {
        match self.all {
            0 => String::new(),
            all => format!("{:.0}", 100.0 * f64::from(self.met) / f64::from(all)),
        }
    }
}

/// What came out at one speed and step.
#[derive(Clone)]
struct Column {
    /// by output, for the middle size and the three main inputs
    by_output: Vec<Tally>,
    /// by size, for the three main inputs
    by_size: [Tally; SIZES.len()],
    /// by input, for the middle size
    by_input: [Tally; INPUTS.len()],
    /// by cause, for the middle size and the three main inputs
    by_cause: [Tally; CAUSES.len()],
    /// CPU time of a call, and of a step, s
    spent: [f64; 2],
}

/// Compares at `count` random instants in steps of `step`, s.
fn compare(scene: &Scene, speed: f64, step: f64, count: usize) -> Column {
    let mut random = Random((speed / step) as u64);
    let mut wind = Wind::new(scene, speed);
    let last = wind.end() - step;
    let mut times: Vec<f64> = (0..count).map(|_| random.next() * last).collect();
    times.sort_by(f64::total_cmp);
    let mut column = Column {
        by_output: vec![Tally::default(); Outputs::SMOOTH.len()],
        by_size: Default::default(),
        by_input: Default::default(),
        by_cause: Default::default(),
        spent: [0.0; 2],
    };
    let (mut calls, mut steps) = (0, 0);
    for (instant, time) in times.into_iter().enumerate() {
        if !wind.go_to(time) {
            break;
        }
        let (before, inputs) = (&wind.sim, wind.inputs(step));
        let inputs_asked = if instant % SIDE == 0 {
            INPUTS.len()
        } else {
            MAIN
        };
        for input in 0..inputs_asked {
            let passing = before.outputs().tensioner_speed.abs().max(0.1);
            let pull = OFF[2] * inputs.tension_setpoint;
            let off = match input {
                0 => OFF[0] / step,
                1 | 3 | 4 => OFF[1],
                2 => pull,
                5 => pull * scene.tensioner.radius,
                _ => pull / passing,
            };
            let began = ThreadTime::now();
            let got = before.step_derivative(inputs, Inputs::HELD, step, along(input, 1.0));
            column.spent[0] += began.elapsed().as_secs_f64();
            calls += 1;
            let mut after = |by: f64| {
                let mut run = before.clone();
                run.begin_trail();
                let began = ThreadTime::now();
                let gone = run.advance(inputs.after(&along(input, by), 1.0), step);
                column.spent[1] += began.elapsed().as_secs_f64();
                steps += 1;
                gone.map(|()| run)
            };
            let mut ends = Vec::new();
            for size in SIZES {
                // (a brake and a damper of 0 have no other side)
                let (most, least) = match input > 4 {
                    true => (2.0 * size * off, size * off),
                    false => (size * off, -size * off),
                };
                if let (Ok(plus), Ok(minus)) = (after(most), after(least)) {
                    ends.push((plus, minus, most - least));
                }
            }
            let Ok(got) = got else { continue };
            if ends.len() < SIZES.len() {
                continue;
            }
            let got = smooth(&got.slopes);
            for (size, (plus, minus, way)) in ends.iter().enumerate() {
                let why = cause(plus.trail(), minus.trail());
                let (plus, minus) = (smooth(plus.outputs()), smooth(minus.outputs()));
                for (k, name) in Outputs::SMOOTH.iter().enumerate() {
                    // (these follow from the inputs alone)
                    if ["spindle_angle", "nozzle_y"].contains(name) {
                        continue;
                    }
                    let want = (plus[k] - minus[k]) / way;
                    // what is left of 16 digits
                    let digits = 1e-14 * plus[k].abs() / (0.02 * off) + 1e-12;
                    let most = got[k].abs().max(want.abs());
                    let met = (got[k] - want).abs() <= CLOSE * most + digits;
                    if size == MIDDLE {
                        column.by_input[input].add(met);
                    }
                    if input < MAIN {
                        column.by_size[size].add(met);
                        if size == MIDDLE {
                            column.by_output[k].add(met);
                            column.by_cause[why].add(met);
                        }
                    }
                }
            }
        }
    }
    column.spent = [
        column.spent[0] / f64::from(calls.max(1)),
        column.spent[1] / f64::from(steps.max(1)),
    ];
    column
}

/// Prints a table of `rows` by step and speed.
fn table(
    first: &str,
    rows: &[&str],
    columns: &[[Column; 4]],
    cell: impl Fn(&Column, usize) -> String,
) {
    let heads = STEPS.map(|step| {
        SPEEDS
            .map(|speed| format!("{} ms, {speed}", 1e3 * step))
            .join(" | ")
    });
    println!("\n| {first} | {} |", heads.join(" | "));
    println!("|---|{}", "---:|".repeat(STEPS.len() * SPEEDS.len()));
    for (k, row) in rows.iter().enumerate() {
        let cells: Vec<String> = columns.iter().flatten().map(|c| cell(c, k)).collect();
        println!("| {row} | {} |", cells.join(" | "));
    }
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
            let got = before.step_derivative(inputs, Inputs::HELD, step, along(asked % MAIN, 1.0));
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
    let columns: Vec<[Column; 4]> = STEPS
        .iter()
        .map(|step| SPEEDS.map(|speed| compare(&scene, speed, *step, count)))
        .collect();
    println!("Share met within 2 %, in %, by step and speed in rad/s.");
    let sizes = SIZES.map(|size| {
        format!(
            "{:.0e} rad, {:.0e} m, {:.0e} of the pull",
            size * OFF[0],
            size * OFF[1],
            size * OFF[2]
        )
    });
    table(
        "size",
        &sizes.each_ref().map(String::as_str),
        &columns,
        |c, k| c.by_size[k].share(),
    );
    table("output", Outputs::SMOOTH, &columns, |c, k| {
        c.by_output[k].share()
    });
    table("input", &INPUTS, &columns, |c, k| c.by_input[k].share());
    println!("\nWhat the two runs of a difference did otherwise: share of all, share met.");
    let all = |c: &Column| c.by_cause.iter().fold(Tally::default(), |a, b| a.plus(*b));
    table("otherwise", &CAUSES, &columns, |c, k| {
        let share = 100.0 * f64::from(c.by_cause[k].all) / f64::from(all(c).all.max(1));
        format!("{share:.0}, {}", c.by_cause[k].share())
    });
    println!("\nAll together:");
    let sum = |k: usize| {
        let of = columns.iter().flatten().map(|c| c.by_cause[k]);
        of.fold(Tally::default(), Tally::plus)
    };
    let whole = (0..CAUSES.len())
        .map(sum)
        .fold(Tally::default(), Tally::plus);
    println!(
        "\n| otherwise | share of all % | met % | share of those not met % |\n|---|---:|---:|---:|"
    );
    for (k, name) in CAUSES.iter().enumerate() {
        let of = sum(k);
        println!(
            "| {name} | {:.0} | {} | {:.0} |",
            100.0 * f64::from(of.all) / f64::from(whole.all),
            of.share(),
            100.0 * f64::from(of.all - of.met) / f64::from(whole.all - whole.met)
        );
    }
    table("CPU time ms", &["call", "step"], &columns, |c, k| {
        format!("{:.1}", 1e3 * c.spent[k])
    });
    let each = CALLS / SPEEDS.len();
    let refused: usize = SPEEDS
        .iter()
        .map(|speed| refused(&scene, *speed, each))
        .sum();
    println!("\n{refused} of {CALLS} calls refused");
}
