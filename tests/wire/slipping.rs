//! Wire that slips off the end of a core without flanges.

use coilwind::settings::SceneSettings;
use coilwind::signals::EventKind;
use coilwind::simulation::Simulation;
use std::path::Path;

/// What a run along the axis tells as a warning, and the reasons of its verdict. The core ends at 4 mm on either side.
fn wound(core: &str, from_mm: f64, per_turn_mm: f64) -> (Vec<String>, Vec<String>) {
    let text = format!(
        "[wire]\ndiameter_mm = 0.6\nmaterial = 'copper-soft'\n[core]\n{core}\nlength_y_mm = 8\n\
         [nozzle]\ndistance_mm = 20\ny_start_mm = {from_mm}\n[start]\nclamp_y_mm = {from_mm}\n[tensioner]\ntension = 9\n\
         [spindle]\nspeed = 60\nramp_turns = 0.2\nturns = 2\n[traverse]\nmode = 'by-angle'\nper_turn_mm = {per_turn_mm}\n"
    );
    let settings = SceneSettings::from_toml_str(&text, "scene.toml", Path::new("")).expect("reads");
    let mut run = Simulation::new(&settings.build().expect("a scene")).expect("starts");
    run.advance_profile(run.motion_profile().end())
        .expect("a way there");
    let events = run.drain_events().into_iter();
    let warnings = events.filter(|event| event.kind == EventKind::Judgement);
    let told = warnings.map(|event| event.text).collect();
    (told, run.winding().reasons())
}

/// It was told as slack and a kink, with the advice to pull more.
#[test]
fn wire_off_the_end_of_the_core_is_told_with_the_end_and_what_to_do() {
    for (core, side) in [
        ("shape = 'cylinder'\nradius_mm = 6", 1.0),
        ("shape = 'cylinder'\nradius_mm = 6", -1.0),
        (
            "width_x_mm = 12\nheight_z_mm = 10\ncorner_radius_mm = 2",
            1.0,
        ),
    ] {
        let (told, reasons) = wound(core, side * 3.4, side * 1.2);
        let slipped: Vec<_> = told.iter().filter(|t| t.contains("slipped off")).collect();
        assert_eq!(slipped.len(), 1, "{told:?}");
        for part in [
            format!("the end of the core at y = {} m", side * 4e-3),
            "keep the nozzle away from the end".to_owned(),
            "core.flange.inner_distance".to_owned(),
        ] {
            assert!(slipped[0].contains(&part), "{part}: {slipped:?}");
        }
        let end = format!("y = {:.3} mm", side * 4.0);
        let reason = |r: &&String| r.contains("slipped off") && r.contains(&end);
        assert!(reasons.iter().any(|r| reason(&r)), "{reasons:?}");
    }
}

#[test]
fn wire_that_stays_on_the_core_up_to_its_end_has_not_slipped() {
    for (from_mm, per_turn_mm) in [(1.6, 0.9), (-3.6, 0.7)] {
        let (told, reasons) = wound("shape = 'cylinder'\nradius_mm = 6", from_mm, per_turn_mm);
        assert!(
            told.iter().chain(&reasons).all(|t| !t.contains("slipped")),
            "{told:?} {reasons:?}"
        );
    }
}
