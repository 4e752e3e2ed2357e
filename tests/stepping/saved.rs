//! A run saved as bytes goes on, to the bit, as if nothing had happened.

use crate::common::fig8;
use crate::stl::write_revolved;
use coilwind::scene::Scene;
use coilwind::signals::Inputs;
use coilwind::simulation::{RestoreError, Simulation};
use std::f64::consts::TAU;

/// A machine that speeds up evenly over a quarter of the steps and runs on at `speed`, rad/s.
struct Machine {
    speed: f64,
    step: f64,
    steps: usize,
}

impl Machine {
    /// Advances a run that has made `k` steps by one more.
    fn advance(&self, sim: &mut Simulation, k: usize) {
        let ramp = 0.25 * self.steps as f64;
        let speed = self.speed * ((k + 1) as f64 / ramp).min(1.0);
        let now = sim.inputs();
        let inputs = Inputs {
            spindle_speed: speed,
            nozzle_position: now.nozzle_position + 0.7e-3 * speed * self.step / TAU,
            tension_setpoint: 15.0 - 3.0 * k as f64 / self.steps as f64,
            ..Inputs::HELD
        };
        sim.advance(inputs, self.step).expect("the run goes on");
        sim.drain_events();
    }
}

fn bytes(sim: &Simulation) -> Vec<u8> {
    sim.to_bytes().expect("a state")
}

/// Saves at many instants, unevenly spaced, and lets every restored run and every copy reach the next.
/// States as bytes are equal exactly where everything that decides about the run is.
fn goes_on(scene: &Scene, machine: &Machine, stops: usize) -> Simulation {
    let mut sim = Simulation::new(scene).expect("starts");
    let mut others: Vec<Simulation> = Vec::new();
    // multiples of the golden section lie everywhere and repeat nowhere
    let mut stops: Vec<usize> = (1..=stops)
        .map(|k| ((k as f64 * 0.618_033_988_75).fract() * machine.steps as f64) as usize)
        .collect();
    stops.push(0);
    for k in 0..machine.steps {
        if stops.contains(&k) {
            let now = bytes(&sim);
            for other in &others {
                let outputs = format!("{:?}", other.outputs());
                assert_eq!(outputs, format!("{:?}", sim.outputs()), "step {k}");
                assert!(bytes(other) == now, "state differs at step {k}");
            }
            let restored = Simulation::from_bytes(scene, &now).expect("restores");
            assert!(bytes(&restored) == now, "a restored state is the same");
            others = vec![restored, sim.clone()];
        }
        machine.advance(&mut sim, k);
        for other in &mut others {
            machine.advance(other, k);
        }
    }
    let now = bytes(&sim);
    assert!(others.iter().all(|other| bytes(other) == now));
    sim
}

#[test]
fn a_wind_goes_on_from_anywhere() {
    for speed in [100.0, 500.0] {
        let machine = Machine {
            speed,
            step: 0.02 / speed,
            steps: 800,
        };
        let sim = goes_on(&fig8(&[]), &machine, 30);
        let o = sim.outputs();
        assert!(o.turns_wound > 2.0 && o.turns_settled > 1.0, "{o:?}");
    }
}

#[test]
fn wire_that_hardens_along_points_goes_on() {
    let machine = Machine {
        speed: 200.0,
        step: 1e-4,
        steps: 400,
    };
    let points = "[[0.0008, 92e6], [0.02, 115e6], [0.08, 160e6], [0.16, 190e6]]";
    let scene = fig8(&[
        ("wire.material", "copper"),
        ("wire.yield_stress", "0"),
        ("wire.stress_strain", points),
    ]);
    assert!(scene.wire.hardening.bend.is_some());
    let sim = goes_on(&scene, &machine, 15);
    let rod = &sim.system().state.rod;
    let yielded = rod.bend.iter().filter(|bend| bend.rise > 0.0).count();
    assert!(yielded > 10, "{yielded}");
}

#[test]
fn without_twist_and_with_all_of_it() {
    for twist in ["off", "dynamic"] {
        let machine = Machine {
            speed: 300.0,
            step: 1e-4,
            steps: 400,
        };
        goes_on(&fig8(&[("solver.twist", twist)]), &machine, 15);
    }
}

#[test]
fn explicit_methods_as_well() {
    for method in ["verlet", "rk4"] {
        let scene = fig8(&[
            ("solver.integrator", method),
            ("solver.spacing_near_mm", "1.5"),
            ("solver.spacing_free_mm", "1.5"),
        ]);
        let machine = Machine {
            speed: 500.0,
            step: 2e-5,
            steps: 500,
        };
        let sim = goes_on(&scene, &machine, 12);
        let o = sim.outputs();
        assert!(o.turns_wound > 0.5, "{o:?}");
    }
}

/// Frozen wire that thaws again, and a machine that stands.
#[test]
fn unwinding_and_standing() {
    let scene = fig8(&[]);
    let mut sim = Simulation::new(&scene).expect("starts");
    let step = 2e-4;
    let plan = |k: usize| match k {
        0..300 => 200.0,
        300..550 => -120.0,
        _ => 0.0,
    };
    let advance = |sim: &mut Simulation, k: usize| {
        let mut inputs = sim.inputs();
        inputs.spindle_speed = plan(k);
        inputs.nozzle_position += 0.7e-3 * inputs.spindle_speed * step / TAU;
        sim.advance(inputs, step).expect("the run goes on");
        sim.drain_events();
    };
    let mut other: Option<Simulation> = None;
    let mut most = 0.0f64;
    let mut least = f64::INFINITY;
    for k in 0..900 {
        if k % 70 == 0 {
            let now = bytes(&sim);
            assert!(other.is_none_or(|o| bytes(&o) == now), "step {k}");
            other = Some(Simulation::from_bytes(&scene, &now).expect("restores"));
        }
        for sim in [&mut sim].into_iter().chain(&mut other) {
            advance(sim, k);
        }
        most = most.max(sim.outputs().turns_settled);
        if k >= 300 {
            least = least.min(sim.outputs().turns_settled);
        }
    }
    assert!(most > 0.5 && least < most - 0.2, "{most} {least}");
    assert_eq!(bytes(&sim), bytes(&other.expect("restored")));
}

/// Tunable parameters change between steps; the scene that is handed over with the bytes has them.
#[test]
fn tuned_runs_go_on() {
    let (scene, slippery) = (
        fig8(&[]),
        fig8(&[("friction.kinetic", "0.05"), ("friction.static", "0.06")]),
    );
    let machine = Machine {
        speed: 400.0,
        step: 5e-5,
        steps: 500,
    };
    let mut sim = Simulation::new(&scene).expect("starts");
    (0..250).for_each(|k| machine.advance(&mut sim, k));
    let mut untuned = sim.clone();
    sim.retune(&slippery).expect("nothing is owed");
    let mut restored = Simulation::from_bytes(&slippery, &bytes(&sim)).expect("restores");
    for k in 250..500 {
        for sim in [&mut sim, &mut restored, &mut untuned] {
            machine.advance(sim, k);
        }
    }
    assert_eq!(bytes(&sim), bytes(&restored));
    assert_ne!(bytes(&sim), bytes(&untuned), "friction matters");
}

fn half_a_turn() -> (Scene, Simulation) {
    let scene = fig8(&[]);
    let mut sim = Simulation::new(&scene).expect("starts");
    let machine = Machine {
        speed: 500.0,
        step: 1e-4,
        steps: 260,
    };
    (0..260).for_each(|k| machine.advance(&mut sim, k));
    assert!(sim.outputs().turns_settled > 0.0);
    (scene, sim)
}

#[test]
fn no_other_bytes_are_taken() {
    let (scene, sim) = half_a_turn();
    let good = bytes(&sim);
    for length in (0..good.len()).step_by(97).chain([0, 1, good.len() - 1]) {
        let part = Simulation::from_bytes(&scene, &good[..length]);
        assert!(part.is_err(), "{length} of {} bytes", good.len());
    }
    let mut long = good.clone();
    long.push(0);
    let error = Simulation::from_bytes(&scene, &long).expect_err("too long");
    assert!(
        matches!(error, RestoreError::TooLong { left: 1 }),
        "{error}"
    );
    let mut newer = good.clone();
    newer[0] += 1;
    let error = Simulation::from_bytes(&scene, &newer).expect_err("another version");
    assert!(error.to_string().contains("version 33"), "{error}");
    let wider = fig8(&[("core.width_x_mm", "14")]);
    let error = Simulation::from_bytes(&wider, &good).expect_err("another core");
    assert!(
        matches!(error, RestoreError::OtherCore { file: None }),
        "{error}"
    );
    let faster = fig8(&[("spindle.ramp_turns", "0.3")]);
    let error = Simulation::from_bytes(&faster, &good).expect_err("another motion");
    assert!(
        matches!(&error, RestoreError::OtherMotion { files } if files.is_empty()),
        "{error}"
    );
    let verlet = fig8(&[("solver.integrator", "verlet")]);
    let error = Simulation::from_bytes(&verlet, &good).expect_err("another method");
    assert!(matches!(error, RestoreError::Impossible(_)), "{error}");
}

/// "the core's surface is not the one that the state was saved with; put the file of the mesh back" named no file.
#[test]
fn a_mesh_that_has_changed_is_named() {
    let file = std::env::temp_dir().join(format!("coilwind_mesh_{}.stl", std::process::id()));
    let path = file.display().to_string();
    let drum = |radius: f64| [[-15.0, radius], [15.0, radius]];
    write_revolved(&file, &drum(10.0), 48);
    let scene = fig8(&[("core.shape", "mesh"), ("core.file", &path)]);
    let saved = bytes(&Simulation::new(&scene).expect("starts"));
    Simulation::from_bytes(&scene, &saved).expect("restores");
    write_revolved(&file, &drum(9.5), 48);
    let error = Simulation::from_bytes(&scene, &saved).expect_err("another core");
    std::fs::remove_file(&file).expect("removed");
    assert!(error.to_string().contains(&path), "{error}");
    assert!(error.to_string().contains("core.file"), "{error}");
}

/// Changed bytes are refused or run; nothing in them makes the program fall over.
#[test]
fn changed_bytes_do_no_harm() {
    let (scene, sim) = half_a_turn();
    let good = bytes(&sim);
    let mut random = 1u64;
    let mut refused = 0;
    for _ in 0..400 {
        // Knuth's generator; the high bits are the random ones
        random = random
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        let place = (random >> 33) as usize % good.len();
        let mut bad = good.clone();
        bad[place] ^= 1 << (random >> 61);
        match Simulation::from_bytes(&scene, &bad) {
            Err(_) => refused += 1,
            Ok(mut sim) => {
                let inputs = sim.inputs();
                for _ in 0..2 {
                    if sim.advance(inputs, 1e-6).is_err() {
                        break;
                    }
                }
            }
        }
    }
    assert!(refused > 0);
}
