//! A nozzle that follows the scene's law while the spindle's speed is an input.

use crate::common::fig8;
use coilwind::scene::Scene;
use coilwind::settings::{NozzleFollows, SceneSettings};
use coilwind::signals::{Event, Inputs};
use coilwind::simulation::Simulation;
use std::f64::consts::TAU;
use std::path::Path;

/// Time that a ramp of a quarter of a turn takes, s: a power of two, as are the steps, so that no time is rounded.
const RAMP: f64 = 1.0 / 32.0;
const STEP: f64 = 1.0 / 4096.0;

/// A scene whose ramp takes [`RAMP`].
fn scene(name: &str) -> Scene {
    let mut settings = SceneSettings::load(name).expect("packed");
    for (name, value) in [
        ("spindle.ramp_turns", "0.25"),
        ("spindle.speed", &format!("{}", 0.5 * TAU / RAMP)),
    ] {
        settings.set_text(name, value).expect("a setting");
    }
    settings.build().expect("valid")
}

/// Speed of the scene's own motion at a time, s, and its rate, as a master gives them. Of the tension only the value.
fn inputs(simulation: &Simulation) -> (Inputs, Inputs) {
    let (scene, time) = (simulation.scene(), simulation.time());
    let top = scene.spindle.speed;
    let rises = time < RAMP;
    let inputs = Inputs {
        spindle_speed: if rises { top * time / RAMP } else { top },
        // not looked at
        nozzle_position: 1.0,
        tension_setpoint: scene.tensioner.tension,
        ..Inputs::HELD
    };
    let rates = Inputs {
        spindle_speed: if rises { top / RAMP } else { 0.0 },
        ..Inputs::HELD
    };
    (inputs, rates)
}

/// The wire of a run of the scene's own motion and that of one which is told the speed only, after so many steps.
fn both(scene: &Scene, steps: u32) -> [Simulation; 2] {
    let mut own = Simulation::new(scene).expect("starts");
    let (start, _) = inputs(&own);
    let mut told = Simulation::starting_by_law(scene, start).expect("starts");
    assert!(told.nozzle_follows_law() && !own.nozzle_follows_law());
    for _ in 0..steps {
        own.advance_profile(STEP).expect("goes on");
        let (now, rates) = inputs(&told);
        told.advance_ramped(now, rates, STEP).expect("goes on");
    }
    [own, told]
}

#[test]
fn the_speed_alone_winds_what_the_scene_winds_to_the_bit() {
    let [own, told] = both(&scene("fig8"), 600);
    assert!(own.outputs().turns_settled > 1.0);
    assert_eq!(own.outputs(), told.outputs());
    assert_eq!(own.inputs(), told.inputs());
    assert_eq!(own.centreline().points, told.centreline().points);
}

/// Corners of the law lie within communication steps, at times that two ways of computing round differently.
#[test]
fn layers_are_those_of_the_scene() {
    let [own, told] = both(&scene("bobbin"), 1000);
    let turns = own.outputs().turns_wound;
    assert!(turns > 3.0, "{turns}");
    assert!((own.inputs().nozzle_position - told.inputs().nozzle_position).abs() < 1e-12);
    let (a, b) = (own.centreline().points, told.centreline().points);
    assert_eq!(a.len(), b.len());
    let off = a.iter().zip(&b).map(|(a, b)| (a - b).norm());
    let worst = off.fold(0.0, f64::max);
    println!("largest distance of the wires: {worst:e} m");
    assert!(worst < 1e-7, "{worst:e} m");
}

/// The inputs of `start` with another speed, rad/s, that changes at a `rate`, rad/s2, and the rates of all.
fn turning(start: Inputs, speed: f64, rate: f64) -> (Inputs, Inputs) {
    let now = Inputs {
        spindle_speed: speed,
        ..start
    };
    let rates = Inputs {
        spindle_speed: rate,
        ..Inputs::HELD
    };
    (now, rates)
}

#[test]
fn a_core_that_turns_back_takes_the_nozzle_along() {
    let scene = scene("bobbin");
    let law = scene.nozzle_law.clone();
    let start = inputs(&Simulation::new(&scene).expect("starts")).0;
    let mut told = Simulation::starting_by_law(&scene, start).expect("starts");
    let (mut at_corner, mut farthest) = (0, 0.0_f64);
    for k in 0..400 {
        let time = f64::from(k) * 1e-3;
        let rate = if time < 0.2 { 250.0 } else { -400.0 };
        let speed = if time < 0.2 {
            250.0 * time
        } else {
            50.0 - 400.0 * (time - 0.2)
        };
        let (now, rates) = turning(start, speed, rate);
        told.advance_ramped(now, rates, 1e-3).expect("goes on");
        let angle = told.outputs().spindle_angle.abs();
        farthest = farthest.max(angle);
        let off = told.inputs().nozzle_position - law.position(angle);
        assert!(off.abs() < 1e-12, "{off:e} m at {angle} rad");
        at_corner += usize::from(law.position(angle) != law.position(angle + 0.1));
    }
    assert!(at_corner > 0);
    let fallen = farthest - told.outputs().spindle_angle;
    assert!(fallen > 1.0, "{fallen}");
}

#[test]
fn a_saved_state_goes_on_by_the_law() {
    let scene = scene("bobbin");
    let (start, _) = inputs(&Simulation::new(&scene).expect("starts"));
    let mut told = Simulation::starting_by_law(&scene, start).expect("starts");
    let go = |run: &mut Simulation, steps: u32| {
        for _ in 0..steps {
            let (now, rates) = inputs(run);
            run.advance_ramped(now, rates, STEP).expect("goes on");
        }
    };
    go(&mut told, 200);
    let bytes = told.to_bytes().expect("bytes");
    let mut restored = Simulation::from_bytes(&scene, &bytes).expect("a state");
    go(&mut told, 300);
    go(&mut restored, 300);
    assert!(restored.nozzle_follows_law());
    assert_eq!(told.outputs(), restored.outputs());
}

#[test]
fn the_input_of_the_nozzle_counts_where_no_law_is_asked_for() {
    let scene = fig8(&[("traverse.mode", "by-input")]);
    let mut run = Simulation::new(&scene).expect("starts");
    let to = Inputs {
        nozzle_position: 1e-3,
        ..run.inputs()
    };
    run.advance(to, 1e-3).expect("goes on");
    assert_eq!(run.inputs().nozzle_position, 1e-3);
}

/// The flange that the scene's own law would reach was told of runs in which that law moves nothing, and refused their start.
#[test]
fn a_law_that_nothing_follows_is_not_judged() {
    let told = |follows, name: &str, value: f64| {
        let mut settings = SceneSettings::load("tooth").expect("packed");
        settings
            .set_text(name, &value.to_string())
            .expect("a value");
        match settings.build_for(follows) {
            Ok((_, warnings)) => warnings
                .iter()
                .map(|w| format!("{} {}", w.key, w.message))
                .collect(),
            Err(error) => error.to_string(),
        }
    };
    let past = told(NozzleFollows::Law, "nozzle.y_start", -11e-3);
    assert!(past.contains("past a flange"), "{past}");
    let told = [("nozzle.y_start", -11e-3), ("traverse.per_turn", 8e-4)]
        .map(|(name, value)| told(NozzleFollows::Input, name, value));
    assert!(told[0].starts_with("start.clamp_y"), "{told:?}");
    assert_eq!(
        told[1],
        "traverse.per_turn has no effect: the nozzle follows its input; set traverse.mode = by-angle"
    );
}

/// Winds with the speed alone told, in steps of this length, s, up to a time, s; the wire is taken to that time.
fn told_in(scene: &Scene, step: f64, end: f64, beyond: bool) -> Simulation {
    let (start, _) = inputs(&Simulation::new(scene).expect("starts"));
    let mut told = Simulation::starting_by_law(scene, start).expect("starts");
    told.step_beyond(beyond);
    while told.time() < end {
        let (now, rates) = inputs(&told);
        told.advance_ramped(now, rates, step).expect("goes on");
        let off = told.outputs().nozzle_y - scene.nozzle_law.position(told.outputs().spindle_angle);
        assert!(off.abs() < 1e-12, "{off:e} m at {} s", told.time());
    }
    told
}

/// Each communication step was a step of the method: steps of 20 us cost 6 to 8 times what free ones do.
#[test]
fn fine_steps_by_law_cost_no_solves() {
    let scene = scene("bobbin");
    let end = 800.0 * STEP;
    let mut runs = [STEP, STEP / 8.0, STEP / 64.0].map(|step| told_in(&scene, step, end, true));
    for run in &mut runs {
        run.catch_up().expect("a step");
    }
    let steps = runs.each_ref().map(|run| run.statistics().steps);
    println!("{steps:?} steps of the method");
    let every = told_in(&scene, STEP / 8.0, end, false).statistics().steps;
    assert!(
        steps[2] <= steps[0] + 2 && steps[0] < every / 2,
        "{steps:?}, {every}"
    );
    let corners = scene.nozzle_law.pieces().iter();
    let turned = runs[0].outputs().spindle_angle;
    assert!(corners.filter(|piece| piece.from < turned).count() > 5);
    // (the first step after the ramp ends at a communication point)
    let fed = runs.each_ref().map(|run| run.outputs().fed_length);
    for (one, fed_in_it) in fed.iter().enumerate() {
        let off = fed_in_it - fed[0];
        println!("run {one}: {off:e} m of wire more");
        assert!(off.abs() < scene.solver.tolerance, "{off:e} m");
    }
}

/// As [`a_core_that_turns_back_takes_the_nozzle_along`], with speeds that hold, change and turn within steps ahead.
#[test]
fn steps_ahead_by_law_follow_a_speed_that_changes() {
    let scene = scene("bobbin");
    let law = scene.nozzle_law.clone();
    let start = inputs(&Simulation::new(&scene).expect("starts")).0;
    let mut told = Simulation::starting_by_law(&scene, start).expect("starts");
    told.step_beyond(true);
    let go = |run: &mut Simulation, from: u32, to: u32| {
        for k in from..to {
            let (speed, rate) = match k % 2000 {
                0..500 => (80.0, 0.0),
                500..1000 => (80.0 - 0.2 * f64::from(k % 2000 - 500), -1e4),
                1000..1300 => (-20.0, 0.0),
                _ => (40.0 + f64::from(k % 3), 0.0),
            };
            let (now, rates) = turning(start, speed, rate);
            run.advance_ramped(now, rates, 2e-5).expect("goes on");
            let place = law.position(run.outputs().spindle_angle.abs());
            let off = run.outputs().nozzle_y - place;
            assert!(off.abs() < 1e-12, "{off:e} m in step {k}");
        }
    };
    for k in [700, 1234, 2500, 4001] {
        let from = (told.time() / 2e-5).round();
        go(&mut told, from as u32, k);
        let bytes = told.to_bytes().expect("bytes");
        let mut restored = Simulation::from_bytes(&scene, &bytes).expect("a state");
        restored.step_beyond(true);
        let mut copy = told.clone();
        go(&mut restored, k, k + 300);
        go(&mut copy, k, k + 300);
        assert_eq!(copy.outputs(), restored.outputs());
        assert!(copy.to_bytes().expect("bytes") == restored.to_bytes().expect("bytes"));
    }
}

/// Nothing was said when the planned layers were wound and the spindle went on. `turn_in_layer` counted on from the first layer, and
/// `layer` fell back to the plan's last one.
#[test]
fn a_spindle_that_goes_on_after_the_planned_layers_is_told_so() {
    for (mode, layers, turns) in [("orthocyclic", 1.0, 4.0), ("helical", 2.0, 3.0)] {
        let text = format!(
            "solver.tolerance_um = 10
            nozzle.distance_mm = 18
            tensioner.tension = 5
            traverse.mode = '{mode}'
            [core]
            shape = 'cylinder'
            radius_mm = 6
            flange = {{ inner_distance_mm = {}, height_mm = 4 }}
            [wire]
            material = 'copper-soft'
            diameter_mm = 0.44
            [winding]
            layers = {layers}
            turns_per_layer = {turns}",
            0.45 * turns + 0.25
        );
        let settings = SceneSettings::from_toml_str(&text, "test.toml", Path::new(""));
        let scene = settings.expect("reads").build().expect("valid");
        let start = Inputs {
            spindle_speed: 100.0,
            ..scene.start_inputs()
        };
        let mut sim = Simulation::starting_by_law(&scene, start).expect("starts");
        let mut laid = Vec::new();
        let mut told_by = |sim: &mut Simulation, turns: f64| {
            let mut told = 0;
            while sim.outputs().spindle_angle < turns * TAU {
                sim.advance(sim.inputs(), 1e-3).expect("goes on");
                let goes_on = |e: &&Event| e.text.contains("what is wound now has no place");
                told += sim.drain_events().iter().filter(goes_on).count();
                laid.push(*sim.outputs());
            }
            told
        };
        let held = layers * turns;
        assert_eq!(told_by(&mut sim, held + 0.95), 0);
        assert_eq!(told_by(&mut sim, held + 1.1), 1);
        assert_eq!(told_by(&mut sim, held + 4.7), 0);
        // as the tables have it, once the wire lies still
        let table = sim.turns();
        for o in laid
            .iter()
            .filter(|o| o.turns_wound > held && o.turns_wound % 1.0 > 0.5)
        {
            let Some(turn) = table.get(o.turns_wound as usize) else {
                continue;
            };
            let of_turn = f64::from(turn.turn_in_layer - 1) + o.turns_wound % 1.0;
            assert_eq!(o.layer, turn.layer as i32, "{o:?}");
            assert!((o.turn_in_layer - of_turn).abs() < 0.3, "{of_turn}, {o:?}");
        }
    }
}
