//! Where slack is told: where wire lay on the coil as it lost its tension.

use coilwind::measure::{Defect, DefectKind};
use coilwind::settings::{NozzleFollows, SceneSettings};
use coilwind::signals::{EventKind, Inputs};
use coilwind::simulation::Simulation;
use std::path::Path;

const SCENE: &str = "[wire]\ndiameter_mm = 0.3\nmaterial = 'aluminium'\n[core]\nshape = 'cylinder'\nradius_mm = 6\nlength_y_mm = 15\n\
                     [nozzle]\ndistance_mm = 35\n[tensioner]\ntension = 1.5\nmass_g = 0.3\n[traverse]\nmode = 'by-angle'\nper_turn_mm = -0.35\n";

/// Turns wound as the spindle turns back, the slack that this leaves, and what is told of it, in communication steps of `step`, s.
fn turned_back(step: f64) -> (f64, Defect, String) {
    let settings = SceneSettings::from_toml_str(SCENE, "slack.toml", Path::new("")).expect("reads");
    let (scene, _) = settings
        .build_for(NozzleFollows::LawByInputs)
        .expect("a scene");
    let mut sim = Simulation::new(&scene).expect("starts");
    let mut wound = 0.0;
    for (speed, time) in [(30.0, 0.02), (200.0, 0.02), (-200.0, 0.002), (120.0, 0.004)] {
        let inputs = Inputs {
            spindle_speed: speed,
            ..sim.inputs()
        };
        if speed == -200.0 {
            wound = sim.outputs().turns_wound;
        }
        for _ in 0..(time / step).round() as usize {
            sim.advance(inputs, step).expect("goes on");
        }
    }
    let slack = sim
        .defects()
        .into_iter()
        .find(|d| d.kind == DefectKind::Slack);
    let told = sim.drain_events().into_iter();
    let told = told.filter(|event| event.kind == EventKind::Slack);
    let told: Vec<String> = told.map(|event| event.text).collect();
    (wound, slack.expect("slack"), told.join("\n"))
}

/// Wire springs off the core while it is slack, and the place was that of what still touched when the slack counted: half a turn off,
/// and another one for each communication step.
#[test]
fn slack_is_told_where_wire_lay_as_it_lost_its_tension() {
    for step in [1e-4, 1e-3, 2e-3] {
        let (wound, slack, _) = turned_back(step);
        let told = f64::from(slack.turn - 1) + slack.angle_deg / 360.0;
        assert!(
            (told - wound).abs() < 0.06,
            "{step}: told at {told}, wound {wound} turns"
        );
    }
}

/// Slack counts once it has lasted, and its line in the log said no other instant than that.
#[test]
fn the_log_says_when_and_where_the_wire_went_slack() {
    let (_, slack, told) = turned_back(1e-3);
    let place = format!(
        "at t = {:.6} s, in turn {} at {:.0} deg",
        slack.time_s, slack.turn, slack.angle_deg
    );
    assert!(told.contains(&place), "{told}, not {place}");
}
