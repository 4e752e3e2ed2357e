//! A core that winds about -y.
//!
//! A machine starts at rest, and nothing in its speed says which way round it will wind.

use coilwind::measure::Verdict;
use coilwind::settings::SceneSettings;
use coilwind::signals::{Event, Inputs};
use coilwind::simulation::Simulation;
use std::f64::consts::TAU;

/// Five turns on the packed bobbin that winds about this axis.
fn bobbin(direction: &str) -> SceneSettings {
    let mut settings = SceneSettings::load("bobbin").expect("packed");
    for (name, value) in [
        ("traverse.mode", "orthocyclic"),
        ("winding.turns_per_layer", "5"),
        ("winding.layers", "1"),
        ("winding.pitch", "0.71e-3"),
        ("spindle.speed", "60"),
        ("spindle.direction", direction),
    ] {
        settings.set_text(name, value).expect("a valid setting");
    }
    settings
}

/// Winds by inputs from rest to 60 rad/s about -y; the nozzle follows its law.
fn from_rest(direction: &str) -> (Simulation, Vec<Event>) {
    let scene = bobbin(direction).build().expect("a scene");
    let mut sim = Simulation::starting_by_law(&scene, scene.start_inputs()).expect("starts");
    let mut events = Vec::new();
    let step = 1e-3;
    while sim.outputs().spindle_angle > -4.5 * TAU {
        let inputs = Inputs {
            spindle_speed: (sim.inputs().spindle_speed - 3.0).max(-60.0),
            ..sim.inputs()
        };
        sim.advance(inputs, step).expect("goes on");
        events.extend(sim.drain_events());
    }
    (sim, events)
}

fn told(events: &[Event]) -> Vec<&str> {
    let texts = events.iter().map(|event| event.text.as_str());
    texts
        .filter(|text| text.contains("winds about -y"))
        .collect()
}

#[test]
fn a_native_run_is_the_mirror_image() {
    let [there, back] = ["+y", "-y"].map(|direction| {
        let scene = bobbin(direction).build().expect("a scene");
        let mut sim = Simulation::new(&scene).expect("starts");
        let end = sim.motion_profile().end();
        sim.advance_profile(0.2 * end).expect("goes on");
        let before = *sim.outputs();
        sim.advance_profile(0.8 * end).expect("goes on");
        let verdict = sim.verdict();
        ((before, Verdict::Unsettled), (*sim.outputs(), verdict))
    });
    for ((there, verdict), (back, mirrored)) in [(there.0, back.0), (there.1, back.1)] {
        let off = |a: f64, b: f64| (a - b).abs() / a.abs().max(1e-3);
        assert!(there.spindle_angle > 0.0);
        assert!(off(there.spindle_angle, -back.spindle_angle) < 1e-12);
        assert!(off(there.spindle_torque, -back.spindle_torque) < 1e-3);
        assert!(off(there.wire_tension, back.wire_tension) < 1e-3);
        assert!(off(there.turns_wound, back.turns_wound) < 1e-3);
        assert!(off(there.layon_position, back.layon_position) < 1e-3);
        assert!(off(there.fed_length, back.fed_length) < 1e-4);
        assert_eq!(verdict, mirrored);
    }
}

/// A core that stood for winding about +y wound gaps and a double turn, and nothing was said.
#[test]
fn a_machine_that_starts_at_rest_winds_as_the_scene_says() {
    let (sim, events) = from_rest("-y");
    assert_eq!(told(&events), [""; 0]);
    assert!(sim.verdict() <= Verdict::Marginal, "{:?}", sim.verdict());
    let there = sim.outputs().layon_angle;
    assert!((there - 4.5 * TAU).abs() < 0.5, "{there}");
}

#[test]
fn it_is_told_that_the_core_stands_for_the_other_way_round() {
    let (_, events) = from_rest("auto");
    let told = told(&events);
    assert_eq!(told.len(), 1, "{told:?}");
    assert!(told[0].contains("set spindle.direction = -y"), "{told:?}");
    // arccos(half width over distance of the nozzle), twice
    let scene = bobbin("+y").build().expect("a scene");
    let radius = 1e3 * scene.wire.radius();
    let idle = 2.0
        * ((8.0 + radius) / (1e3 * scene.nozzle.distance))
            .acos()
            .to_degrees();
    assert!(
        told[0].contains(&format!("only after {idle:.0} degrees")),
        "{idle} {told:?}"
    );
}
