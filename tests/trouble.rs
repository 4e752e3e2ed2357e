//! What machines do besides winding evenly: stop, stand, reverse, pull too much or not at all.

use coilwind::scene::{Scene, SceneSettings};
use coilwind::simulation::{Event, EventKind, Inputs, Outputs, Simulation};
use std::f64::consts::TAU;

/// The packed default scene with these changes.
fn fig8(changes: &[(&str, &str)]) -> Scene {
    let mut settings = SceneSettings::load("fig8").expect("packed");
    for (name, value) in changes {
        settings.set_text(name, value).expect("a valid setting");
    }
    settings.build().expect("a valid scene")
}

/// A machine that runs the simulation from outside, step by step.
struct Machine {
    sim: Simulation,
    inputs: Inputs,
    /// communication step, s
    step: f64,
    events: Vec<Event>,
    lowest: f64,
}

impl Machine {
    fn new(changes: &[(&str, &str)]) -> Self {
        let sim = Simulation::new(&fig8(changes)).expect("the scene starts");
        Self {
            inputs: sim.inputs(),
            sim,
            step: 2.5e-4,
            events: Vec::new(),
            lowest: f64::INFINITY,
        }
    }

    fn out(&self) -> &Outputs {
        self.sim.outputs()
    }

    fn wait(&mut self, steps: usize) {
        for _ in 0..steps {
            self.sim
                .advance(self.inputs, self.step)
                .expect("the run goes on");
            self.events.extend(self.sim.drain_events());
            let o = self.out();
            assert!(o.wire_tension_min >= 0.0 && o.wire_tension_min <= o.wire_tension_max);
            assert!(o.free_length.is_finite() && o.fed_length.is_finite());
            self.lowest = self.lowest.min(o.wire_tension_min);
        }
    }

    /// Turns the spindle by this many turns at this speed, the nozzle along with it.
    fn turn(&mut self, turns: f64, speed: f64) {
        let pieces = (turns * TAU / (speed.abs() * self.step)).ceil();
        self.inputs.spindle_speed = speed;
        for _ in 0..pieces as usize {
            self.inputs.nozzle_position += 0.7e-3 * speed * self.step / TAU;
            self.wait(1);
        }
    }

    /// Changes the speed evenly over a time, s.
    fn ramp(&mut self, speed: f64, time: f64) {
        let from = self.inputs.spindle_speed;
        let pieces = (time / self.step).ceil();
        for k in 1..=pieces as usize {
            self.inputs.spindle_speed = from + (speed - from) * k as f64 / pieces;
            self.inputs.nozzle_position += 0.7e-3 * self.inputs.spindle_speed * self.step / TAU;
            self.wait(1);
        }
    }

    fn count(&self, kind: EventKind) -> usize {
        self.events.iter().filter(|e| e.kind == kind).count()
    }
}

#[test]
fn explore_reversal() {
    let mut m = Machine::new(&[]);
    let t = std::time::Instant::now();
    let show = |what: &str, m: &Machine| {
        let o = m.out();
        eprintln!(
            "{what:10} {:6.2}s t {:.4} angle {:.2} wound {:.3} settled {:.3} live {} T {:.2} [{:.2},{:.2}] steps {} rej {} res {:.1e} strain {:.1e} fed {:.4} free {:.4} frozen {} num {:.1e} plast {:.2e}",
            t.elapsed().as_secs_f64(),
            m.sim.time(),
            o.spindle_angle / TAU,
            o.turns_wound,
            o.turns_settled,
            o.live_nodes,
            o.wire_tension,
            o.wire_tension_min,
            o.wire_tension_max,
            o.solver_steps,
            o.solver_rejects,
            o.energy_residual,
            o.wire_strain,
            o.fed_length,
            o.free_length,
            m.sim.centreline().frozen,
            m.sim.energy().numerical_J,
            m.sim.energy().plastic_J
        );
    };
    m.ramp(100.0, 0.02);
    for _ in 0..4 {
        m.turn(0.4, 100.0);
        show("wind", &m);
    }
    m.ramp(0.0, 0.02);
    show("stop", &m);
    m.wait(400);
    show("stand", &m);
    m.ramp(-100.0, 0.02);
    show("back", &m);
    for _ in 0..6 {
        m.turn(0.3, -100.0);
        show("unwind", &m);
    }
    m.ramp(0.0, 0.02);
    show("stop", &m);
    m.ramp(100.0, 0.02);
    for _ in 0..4 {
        m.turn(0.3, 100.0);
        show("again", &m);
    }
}
