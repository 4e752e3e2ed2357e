//! Cost and effect of the communication step: the same wind, half a turn at 300 rad/s with a ramp, in communication steps of
//! one length, and `fig8` at four speeds against free steps. `cargo bench --bench communication_step`

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

/// What a wind took, and where it ended.
struct Wound {
    sim: Simulation,
    cpu: f64,
}

/// The wind above in communication steps of `step`, s.
fn wound(start: &Simulation, step: f64, beyond: bool) -> Result<Wound, Box<dyn Error>> {
    let mut sim = start.clone();
    sim.step_beyond(beyond);
    let began = ThreadTime::now();
    for k in 0..(END / step).round() as usize {
        let t = k as f64 * step;
        let (inputs, mut rates) = signals(t);
        // the nozzle arrives where its signal does, though that is no straight line in the ramp
        let target = signals(t + step).0.nozzle_position;
        rates.nozzle_position = (target - inputs.nozzle_position) / step;
        sim.advance_ramped(inputs, rates, step)?;
    }
    let cpu = began.elapsed().as_secs_f64();
    sim.catch_up()?;
    Ok(Wound { sim, cpu })
}

/// CPU time of `fig8` in fine communication steps over that in free steps, with the speed and the nozzle of the scene's own
/// motion and their derivatives. Last with a controller of the tension.
fn against_free_steps() -> Result<(), Box<dyn Error>> {
    println!(
        "rad/s  free: CPU s, steps   over free (steps), by communication step and whether steps reach beyond it"
    );
    for speed in ["30", "100", "300", "500"] {
        let mut settings = SceneSettings::load("fig8")?;
        settings.set_text("spindle.speed", speed)?;
        let start = Simulation::new(&settings.build()?)?;
        let mut free = start.clone();
        let began = ThreadTime::now();
        free.advance_profile(start.motion_profile().end())?;
        let cpu = began.elapsed().as_secs_f64();
        print!("{speed:5}  {cpu:.3}, {}", free.statistics().steps);
        for (step, gain) in [
            (2e-5, 0.0),
            (1e-4, 0.0),
            (1e-3, 0.0),
            (2e-5, 0.3),
            (1e-4, 0.3),
        ] {
            for beyond in [true, false] {
                let wound = in_steps(&start, step, beyond, gain)?;
                let way = if beyond { "beyond" } else { "to it" };
                let set = if gain > 0.0 { " controlled" } else { "" };
                let (over, steps) = (wound.cpu / cpu, wound.sim.statistics().steps);
                print!("  {:.0} us{set} {way} {over:.2} ({steps})", step * 1e6);
            }
        }
        println!();
    }
    Ok(())
}

/// The scene's own motion in communication steps of `step`, s, with its derivatives. Every 0.1 ms a controller sets the tension anew,
/// with so much of what it is off by as `gain` says.
fn in_steps(
    start: &Simulation,
    step: f64,
    beyond: bool,
    gain: f64,
) -> Result<Wound, Box<dyn Error>> {
    let profile = start.motion_profile().clone();
    let mut sim = start.clone();
    sim.step_beyond(beyond);
    let (mut last, mut integral, mut set) = (None, 0.0, 15.0);
    let between = (1e-4 / step).round() as usize;
    let began = ThreadTime::now();
    for k in 0..(profile.end() / step) as usize {
        let (from, to) = (k as f64 * step, (k + 1) as f64 * step);
        if gain > 0.0 && k % between == 0 {
            let error = 15.0 - sim.outputs().wire_tension;
            integral += 0.1 * gain * error;
            set = 15.0 + gain * error + integral;
        }
        let inputs = Inputs {
            spindle_speed: profile.speed(from),
            nozzle_position: profile.nozzle(from),
            tension_setpoint: set,
            ..Inputs::HELD
        };
        let rates = Inputs {
            spindle_speed: (profile.speed(to) - inputs.spindle_speed) / step,
            nozzle_position: (profile.nozzle(to) - inputs.nozzle_position) / step,
            ..Inputs::HELD
        };
        // as the FMU keeps the step for derivatives
        last.replace(sim.clone());
        sim.advance_ramped(inputs, rates, step)?;
    }
    let cpu = began.elapsed().as_secs_f64();
    Ok(Wound { sim, cpu })
}

fn main() -> Result<(), Box<dyn Error>> {
    let scene = SceneSettings::load("fig8")?.build()?;
    let start = Simulation::new(&scene)?;
    let exact = wound(&start, 1e-6, false)?.sim;
    println!(
        "step/s   solver steps: to it, beyond  CPU s: to it, beyond  fed/um  tension/N  wire rms/um (max)"
    );
    for step in [1e-6, 1e-5, 5e-5, 1e-4, 2e-4, 1e-3, 2e-3, 4e-3] {
        let [to_it, beyond] = [false, true].map(|ahead| wound(&start, step, ahead));
        let (to_it, beyond) = (to_it?, beyond?);
        let steps = [&to_it, &beyond].map(|wound| wound.sim.statistics().steps);
        let (o, r) = (*beyond.sim.outputs(), *exact.outputs());
        let (rms, most) = apart(&beyond.sim, &exact);
        println!(
            "{step:.0e}  {:12} {:12}  {:8.3} {:8.3}  {:9.1}  {:9.2}  {:9.0} ({:.0})",
            steps[0],
            steps[1],
            to_it.cpu,
            beyond.cpu,
            (o.fed_length - r.fed_length) * 1e6,
            o.wire_tension - r.wire_tension,
            rms * 1e6,
            most * 1e6,
        );
    }
    against_free_steps()
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
