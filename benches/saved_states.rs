//! What a saved state costs on the way through a long wind: bytes, CPU time to save and restore, memory of copies that share
//! settled wire, and the CPU time of a directional derivative beside that of the step it is for. `cargo bench --bench saved_states [-- TURNS]`

use coilwind::settings::SceneSettings;
use coilwind::signals::Inputs;
use coilwind::simulation::Simulation;
use cpu_time::ThreadTime;
use std::error::Error;
use std::f64::consts::TAU;

const SPEED: f64 = 500.0;
const STEP: f64 = 1e-3;
const PITCH: f64 = 0.75e-3;
const COPIES: usize = 200;

/// Resident memory, MB; 0 where the system does not say.
fn resident() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find(|line| line.starts_with("VmRSS:"));
    let kb = line.and_then(|line| line.split_whitespace().nth(1)?.parse::<f64>().ok());
    kb.unwrap_or(0.0) / 1024.0
}

fn main() -> Result<(), Box<dyn Error>> {
    // Cargo adds `--bench`.
    let given = std::env::args()
        .skip(1)
        .find(|word| !word.starts_with("--"));
    let turns: f64 = given.map_or(Ok(100.0), |word| word.parse())?;
    let mut settings = SceneSettings::load("fig8")?;
    settings.set_text("core.length_y_mm", "160")?;
    settings.set_text("start.clamp_y_mm", "-70")?;
    settings.set_text("nozzle.y_start_mm", "-70")?;
    let scene = settings.build()?;
    let mut sim = Simulation::new(&scene)?;
    let mut inputs = sim.inputs();
    println!(
        "turns  settled  bytes/kB  save/ms  restore/ms  copy/us  MB per copy  step/ms  derivative/ms"
    );
    let mut next = 1.0;
    while sim.outputs().turns_wound < turns {
        let speed = (inputs.spindle_speed + 5e4 * STEP).min(SPEED);
        inputs = Inputs {
            spindle_speed: speed,
            nozzle_position: inputs.nozzle_position + PITCH * speed * STEP / TAU,
            ..inputs
        };
        let last = sim.clone();
        let began = ThreadTime::now();
        sim.advance(inputs, STEP)?;
        let step = began.elapsed();
        if sim.outputs().turns_wound < next {
            continue;
        }
        next = (next * 10.0_f64.sqrt()).min(turns);
        let began = ThreadTime::now();
        let bytes = sim.to_bytes()?;
        let save = began.elapsed();
        let began = ThreadTime::now();
        let restored = Simulation::from_bytes(&scene, &bytes)?;
        let restore = began.elapsed();
        assert!(
            restored.to_bytes()? == bytes,
            "a restored state is the same"
        );
        drop(restored);
        let before = resident();
        let began = ThreadTime::now();
        let copies: Vec<Simulation> = (0..COPIES).map(|_| sim.clone()).collect();
        let copy = began.elapsed() / COPIES as u32;
        let memory = (resident() - before) / copies.len() as f64;
        drop(copies);
        let along = Inputs {
            tension_setpoint: 1.0,
            ..Inputs::HELD
        };
        let began = ThreadTime::now();
        last.step_derivative(inputs, Inputs::HELD, STEP, along)?;
        let derivative = began.elapsed();
        println!(
            "{:5.1}  {:7.1}  {:8.1}  {:7.2}  {:10.2}  {:7.1}  {:11.3}  {:7.2}  {:13.1}",
            sim.outputs().turns_wound,
            sim.outputs().turns_settled,
            bytes.len() as f64 / 1024.0,
            save.as_secs_f64() * 1e3,
            restore.as_secs_f64() * 1e3,
            copy.as_secs_f64() * 1e6,
            memory,
            step.as_secs_f64() * 1e3,
            derivative.as_secs_f64() * 1e3,
        );
    }
    Ok(())
}
