//! A nozzle that follows the scene's law while the spindle's speed is an input.

mod common;

use coilwind::scene::Scene;
use coilwind::settings::{NozzleFollows, SceneSettings};
use coilwind::signals::Inputs;
use coilwind::simulation::Simulation;
use common::fig8;
use std::f64::consts::TAU;

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
        let now = Inputs {
            spindle_speed: speed,
            ..start
        };
        let rates = Inputs {
            spindle_speed: rate,
            ..Inputs::HELD
        };
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
