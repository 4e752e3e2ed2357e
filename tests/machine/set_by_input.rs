//! Coils whose tension comes by the input alone.

use coilwind::measure::DefectKind;
use coilwind::settings::SceneSettings;
use coilwind::signals::Inputs;
use coilwind::simulation::Simulation;
use std::f64::consts::TAU;
use std::path::Path;

/// A layer on a cylinder, without its tension.
const LAYER: &str = "wire.material = 'copper'\nwire.diameter_mm = 0.5\ncore.shape = 'cylinder'\ncore.radius_mm = 10\n\
                     nozzle.distance_mm = 40\nspindle.speed = 60\nspindle.turns = 4.5\ntraverse.per_turn_mm = 0.5\n";

/// The layer with more settings, wound under the tension that the input has at each time, N.
fn wound(settings: &str, tension: impl Fn(f64) -> f64) -> Simulation {
    let text = format!("{LAYER}{settings}");
    let settings = SceneSettings::from_toml_str(&text, "input.toml", Path::new("")).expect("reads");
    let scene = settings.build().expect("a scene");
    let start = Inputs {
        tension_setpoint: tension(0.0),
        ..scene.start_inputs()
    };
    let mut run = Simulation::starting_with(&scene, start).expect("starts");
    let (profile, step) = (run.motion_profile().clone(), 5e-4);
    while run.time() < profile.end() {
        let time = run.time() + step;
        let inputs = Inputs {
            spindle_speed: profile.speed(run.time()),
            nozzle_position: profile.nozzle(time),
            tension_setpoint: tension(time),
            ..run.inputs()
        };
        run.advance(inputs, step).expect("goes on");
    }
    run
}

fn is_loose(run: &Simulation) -> bool {
    run.defects()
        .iter()
        .any(|defect| defect.kind == DefectKind::LooseTurn)
}

/// A master set 5 N by the input. The default of 15 N, which nobody had given, made every turn a loose one.
#[test]
fn a_default_that_nobody_gave_makes_no_turn_loose() {
    let run = wound("", |_| 5.0);
    assert_eq!(run.defects(), [], "{:?}", run.reasons());
    // what a scene says counts, and the reason names it
    let run = wound("tensioner.tension = 15\n", |_| 5.0);
    assert!(is_loose(&run), "{:?}", run.reasons());
    let names = |reason: &String| {
        reason.contains("defects.loose_tension") && reason.contains("tensioner.tension")
    };
    assert!(run.reasons().iter().any(names), "{:?}", run.reasons());
}

/// Wire that started without tension never came to rest, however it was pulled later: "wind more turns".
#[test]
fn wire_that_starts_without_tension_comes_to_rest() {
    let run = wound("tensioner.tension = 0\n", |time| {
        10.0 * (time / 5e-3).min(1.0)
    });
    let outputs = run.outputs();
    let behind = outputs.turns_wound - outputs.turns_settled;
    // (a few free spans of wire at most)
    assert!(behind < 4.0 * 40e-3 / (TAU * 10e-3) + 0.5, "{outputs:?}");
}
