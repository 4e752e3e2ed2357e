use coilwind::scene::SceneSettings;
use coilwind::simulation::Simulation;
use std::io::Write;
fn main() {
    let mut args = std::env::args().skip(1);
    let turns: f64 = args.next().unwrap().parse().unwrap();
    let out = args.next().unwrap();
    let mut s = SceneSettings::load("fig8").unwrap();
    for a in args {
        let (n, v) = a.split_once('=').unwrap();
        s.set_text(n, v).unwrap();
    }
    let scene = s.build().unwrap();
    let mut sim = Simulation::new(&scene).unwrap();
    let end = sim.programme().time_at(turns * std::f64::consts::TAU);
    let n = (turns * 72.0) as usize;
    let t0 = std::time::Instant::now();
    let mut f = std::fs::File::create(format!("{out}.csv")).unwrap();
    let mut prev = 0.0;
    for k in 1..=n {
        let t = sim
            .programme()
            .time_at(turns * std::f64::consts::TAU * k as f64 / n as f64);
        if let Err(e) = sim.advance_programme(t - prev) {
            println!("ERR {e}");
            break;
        }
        prev = t;
        let o = *sim.outputs();
        writeln!(
            f,
            "{},{},{},{},{},{},{},{},{},{}",
            o.spindle_angle,
            o.wire_tension,
            o.wire_tension_min,
            o.wire_tension_max,
            o.spindle_torque,
            o.feed_speed,
            o.free_length,
            o.turns_settled,
            o.live_nodes,
            o.energy_residual
        )
        .unwrap();
        for e in sim.drain_events() {
            println!("{e}");
        }
        if k % 12 == 0 {
            println!(
                "{:6.3} T {:7.3} [{:.2} {:.2}] torque {:8.4} free {:.4} wound {:.3} settled {:.3} live {} pen {:.2e} res {:.2e} wall {:.1}",
                o.spindle_angle,
                o.wire_tension,
                o.wire_tension_min,
                o.wire_tension_max,
                o.spindle_torque,
                o.free_length,
                o.turns_wound,
                o.turns_settled,
                o.live_nodes,
                o.penetration_max,
                o.energy_residual,
                t0.elapsed().as_secs_f64()
            );
        }
    }
    let _ = end;
    println!("{:#?}", sim.energy());
    let c = sim.centreline();
    let mut f = std::fs::File::create(format!("{out}.xyz")).unwrap();
    for (i, p) in c.points.iter().enumerate() {
        writeln!(
            f,
            "{} {} {} {} {} {}",
            p.x,
            p.y,
            p.z,
            c.arc[i],
            c.tension[i],
            (i < c.frozen) as i32
        )
        .unwrap();
    }
    let su = sim.summary();
    println!(
        "steps {} dt {:.3e} ns/node/step {:.1} pen {:?}",
        su.steps,
        su.step_s,
        t0.elapsed().as_nanos() as f64 / su.steps as f64 / sim.outputs().live_nodes as f64,
        su.penetration
    );
    for t in sim.coil_with_live_wire().turns() {
        println!("{t:?}");
    }
}
