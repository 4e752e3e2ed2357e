#![allow(missing_docs, clippy::unwrap_used)]
use coilwind::settings::SceneSettings;
use coilwind::signals::Inputs;
use coilwind::simulation::Simulation;
use cpu_time::ThreadTime;
fn main() {
    let tol = std::env::args().nth(1).unwrap_or("2e-6".into());
    for speed in ["30", "100", "300", "500"] {
        let mut s = SceneSettings::load("fig8").unwrap();
        s.set_text("spindle.speed", speed).unwrap();
        s.set_text("solver.tolerance", &tol).unwrap();
        let scene = s.build().unwrap();
        let mut sim = Simulation::new(&scene).unwrap();
        let profile = sim.motion_profile().clone();
        let end = profile.end();
        let t0 = ThreadTime::now();
        sim.advance_profile(end).unwrap();
        let native = t0.elapsed().as_secs_f64();
        let n0 = sim.statistics();
        print!(
            "{speed}: native {native:.3} s {} steps {} ev;",
            n0.steps, n0.evaluations
        );
        for dt in [2e-5, 1e-4, 1e-3] {
            for mode in [true, false] {
                let mut sim = Simulation::new(&scene).unwrap();
                sim.look_ahead(mode);
                let n = (end / dt) as usize;
                let t0 = ThreadTime::now();
                let mut keep = Vec::new();
                for k in 0..n {
                    let (a, b) = (k as f64 * dt, (k + 1) as f64 * dt);
                    let rate = (profile.speed(b) - profile.speed(a)) / dt;
                    let (ya, yb) = (profile.nozzle(a), profile.nozzle(b));
                    let i = Inputs {
                        spindle_speed: profile.speed(a),
                        nozzle_position: ya,
                        tension_setpoint: 15.0,
                    };
                    let r = Inputs {
                        spindle_speed: rate,
                        nozzle_position: (yb - ya) / dt,
                        tension_setpoint: 0.0,
                    };
                    if mode {
                        keep = vec![sim.clone()];
                    }
                    sim.advance_ramped(i, r, dt).unwrap();
                }
                drop(keep);
                let t = t0.elapsed().as_secs_f64();
                print!(
                    " {}{:.0}us {:.2}x {} steps",
                    if mode { "ahead " } else { "plain " },
                    dt * 1e6,
                    t / native,
                    sim.statistics().steps
                );
            }
        }
        println!();
    }
}
