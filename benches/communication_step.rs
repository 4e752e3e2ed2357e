//! Cost and effect of the communication step: the same wind, half a turn at 300 rad/s with a ramp, in
//! communication steps of one length. `cargo bench --bench communication_step`

use coilwind::settings::SceneSettings;
use coilwind::signals::Inputs;
use coilwind::simulation::Simulation;
use cpu_time::ThreadTime;
use std::error::Error;
use std::f64::consts::TAU;

/// rad/s
const SPEED: f64 = 300.0;
/// until when it speeds up and until when it runs, s
const RAMP: f64 = 4e-3;
const END: f64 = 12e-3;
const PITCH: f64 = 0.7e-3;

/// Inputs at a time and their rates until the next kink.
fn signals(t: f64) -> (Inputs, Inputs) {
    let a = SPEED / RAMP;
    let (speed, rate) = if t < RAMP { (a * t, a) } else { (SPEED, 0.0) };
    let angle = if t < RAMP {
        0.5 * a * t * t
    } else {
        SPEED * (t - 0.5 * RAMP)
    };
    let inputs = Inputs {
        spindle_speed: speed,
        nozzle_position: PITCH * angle / TAU,
        tension_setpoint: 15.0,
        ..Inputs::HELD
    };
    let rates = Inputs {
        spindle_speed: rate,
        nozzle_position: PITCH * speed / TAU,
        tension_setpoint: 0.0,
        ..Inputs::HELD
    };
    (inputs, rates)
}

fn main() -> Result<(), Box<dyn Error>> {
    let scene = SceneSettings::load("fig8")?.build()?;
    let start = Simulation::new(&scene)?;
    let mut finest: Option<Simulation> = None;
    println!(
        "step/s   solver steps  evaluations per step  CPU s  us per step  angle/rad  fed/um  tension/N  wire rms/um (max)"
    );
    for step in [1e-6, 1e-5, 5e-5, 1e-4, 2e-4, 1e-3, 2e-3, 4e-3] {
        let mut sim = start.clone();
        let began = ThreadTime::now();
        let count = (END / step).round() as usize;
        for k in 0..count {
            let t = k as f64 * step;
            let (inputs, mut rates) = signals(t);
            // the nozzle arrives where its signal does, though that is no straight line in the ramp
            let target = signals(t + step).0.nozzle_position;
            rates.nozzle_position = (target - inputs.nozzle_position) / step;
            sim.advance_ramped(inputs, rates, step)?;
        }
        let cpu = began.elapsed().as_secs_f64();
        let e = sim.statistics();
        let o = *sim.outputs();
        let reference = finest.get_or_insert_with(|| sim.clone());
        let r = *reference.outputs();
        let (rms, most) = apart(&sim, reference);
        println!(
            "{step:.0e}  {:12}  {:20.2}  {cpu:5.3}  {:11.1}  {:9.1e}  {:6.2}  {:9.4}  {:11.2} ({:.2})",
            e.steps,
            e.evaluations as f64 / e.steps as f64,
            cpu * 1e6 / count as f64,
            o.spindle_angle - r.spindle_angle,
            (o.fed_length - r.fed_length) * 1e6,
            o.wire_tension - r.wire_tension,
            rms * 1e6,
            most * 1e6,
        );
    }
    Ok(())
}

/// Distance of the wire of one run from that of another, at equal lengths from the clamp: root mean square
/// and largest, m.
fn apart(a: &Simulation, b: &Simulation) -> (f64, f64) {
    let (p, q) = (a.centreline(), b.centreline());
    let at = |line: &coilwind::simulation::Centreline, s: f64| {
        let k = line.arc.partition_point(|x| *x <= s);
        let k = k.clamp(1, line.arc.len() - 1);
        let share = (s - line.arc[k - 1]) / (line.arc[k] - line.arc[k - 1]);
        line.points[k - 1] + (line.points[k] - line.points[k - 1]) * share
    };
    let end = p.arc[p.arc.len() - 1].min(q.arc[q.arc.len() - 1]);
    let count = (end / 2e-4) as usize;
    let (mut sum, mut most) = (0.0, 0.0f64);
    for k in 0..count {
        let d = (at(&p, k as f64 * 2e-4) - at(&q, k as f64 * 2e-4)).norm();
        sum += d * d;
        most = most.max(d);
    }
    ((sum / count as f64).sqrt(), most)
}
