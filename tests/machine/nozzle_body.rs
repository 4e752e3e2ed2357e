//! The nozzle's body: what it meets ends the winding, and what it passes does not.

use crate::bobbin::small_bobbin;
use coilwind::measure::{Defect, DefectKind, Verdict};
use coilwind::settings::SceneSettings;
use coilwind::signals::{EventKind, Inputs};
use coilwind::simulation::Simulation;
use std::path::Path;

const STEP: f64 = 1e-4;

fn settings(text: &str) -> SceneSettings {
    SceneSettings::from_toml_str(text, "scene.toml", Path::new("")).expect("reads")
}

/// Goes straight to other inputs within `time`, s, while the core turns.
fn go(sim: &mut Simulation, to: Inputs, time: f64) {
    let steps = (time / STEP).round();
    let from = sim.inputs();
    let rate = |a: f64, b: f64| (b - a) / (steps * STEP);
    for k in 0..steps as usize {
        let share = k as f64 / steps;
        let at = |a: f64, b: f64| a + share * (b - a);
        let inputs = Inputs {
            spindle_speed: at(from.spindle_speed, to.spindle_speed),
            nozzle_position: at(from.nozzle_position, to.nozzle_position),
            nozzle_offset_x: at(from.nozzle_offset_x, to.nozzle_offset_x),
            nozzle_offset_z: at(from.nozzle_offset_z, to.nozzle_offset_z),
            ..from
        };
        let rates = Inputs {
            spindle_speed: rate(from.spindle_speed, to.spindle_speed),
            nozzle_position: rate(from.nozzle_position, to.nozzle_position),
            nozzle_offset_x: rate(from.nozzle_offset_x, to.nozzle_offset_x),
            nozzle_offset_z: rate(from.nozzle_offset_z, to.nozzle_offset_z),
            ..Inputs::HELD
        };
        sim.advance_ramped(inputs, rates, STEP).expect("goes on");
    }
}

/// Winds two turns, takes the nozzle beside the core and sends it to `z`, m, from the axis; the collisions and the run.
fn sent_beside(text: &str, distance: f64, y: f64, z: f64) -> (Vec<Defect>, Simulation) {
    let scene = settings(text).build().expect("a scene");
    let mut sim = Simulation::new(&scene).expect("starts");
    let start = sim.inputs();
    let turning = Inputs {
        spindle_speed: 100.0,
        ..start
    };
    go(&mut sim, turning, 0.02);
    let wound = Inputs {
        nozzle_position: y,
        ..turning
    };
    go(&mut sim, wound, 0.12);
    let above = Inputs {
        spindle_speed: 20.0,
        nozzle_offset_z: -14e-3,
        ..wound
    };
    go(&mut sim, above, 0.05);
    let beside = Inputs {
        nozzle_offset_x: -distance,
        ..above
    };
    go(&mut sim, beside, 0.05);
    assert!(
        sim.defects()
            .iter()
            .all(|d| d.kind != DefectKind::Collision)
    );
    let near = Inputs {
        nozzle_offset_z: -z,
        ..beside
    };
    go(&mut sim, near, 0.05);
    let collisions = sim.defects();
    let collisions = collisions
        .into_iter()
        .filter(|d| d.kind == DefectKind::Collision);
    (collisions.collect(), sim)
}

fn told(sim: &mut Simulation) -> Vec<String> {
    let events = sim.drain_events().into_iter();
    events
        .filter(|e| e.kind == EventKind::Collision)
        .map(|e| e.text)
        .collect()
}

fn bare_core(diameter_mm: f64) -> String {
    format!(
        "[core]\nshape = 'cylinder'\nradius_mm = 6\n[nozzle]\ndistance_mm = 20\nouter_diameter_mm = {diameter_mm}\n\
         length_mm = 12\nedge_radius_mm = 0.2\n[solver]\ntolerance_um = 5\n"
    )
}

/// Wire on the core is 6.7 mm from the axis, and the exit ends 8.2 mm beside it.
#[test]
fn a_body_that_reaches_into_the_coil_ends_the_winding() {
    let (collisions, mut sim) = sent_beside(&bare_core(3.6), 20e-3, 1e-3, 8.2e-3);
    let [collision] = &collisions[..] else {
        panic!("one collision: {collisions:?}");
    };
    let [x, _, z] = collision.place_m;
    let off = libm::hypot(x, z);
    assert!((6.3e-3..6.7e-3).contains(&off), "{collision:?}");
    assert!((1..=3).contains(&collision.turn), "{collision:?}");
    assert_eq!(sim.verdict(), Verdict::Collision);
    let texts = told(&mut sim);
    assert!(
        texts.len() == 1
            && texts[0].contains("the nozzle's body has met wire of turn")
            && texts[0].contains("nozzle.outer_diameter"),
        "{texts:?}"
    );
    // the wire's surface and half the body's width
    let exit = exit_z(&texts[0]);
    assert!((exit.abs() - (6.7 + 1.8)).abs() < 0.1, "{exit}");

    // inputs go on through the core, and nothing is there any more to be wound: that was a failed run
    let through = Inputs {
        nozzle_offset_z: 0.0,
        ..sim.inputs()
    };
    go(&mut sim, through, 0.02);
    assert_eq!(sim.verdict(), Verdict::Collision);

    let (collisions, _) = sent_beside(&bare_core(2.8), 20e-3, 1e-3, 8.2e-3);
    assert!(collisions.is_empty(), "{collisions:?}");
}

/// A point of a nozzle that is sent 3 mm from the axis of a core of 6 mm.
#[test]
fn a_nozzle_in_the_circle_of_the_core_is_a_collision_and_no_failed_run() {
    let text = "[core]\nshape = 'cylinder'\nradius_mm = 6\n[nozzle]\ndistance_mm = 20\n[solver]\ntolerance_um = 5\n";
    let mut sim = Simulation::new(&settings(text).build().expect("a scene")).expect("starts");
    let turning = Inputs {
        spindle_speed: 100.0,
        ..sim.inputs()
    };
    go(&mut sim, turning, 0.05);
    let inside = Inputs {
        nozzle_offset_x: -17e-3,
        ..turning
    };
    sim.advance_ramped(inside, Inputs::HELD, STEP)
        .expect("goes on");
    assert_eq!(sim.verdict(), Verdict::Collision);
    let texts = told(&mut sim);
    let [text] = &texts[..] else {
        panic!("{texts:?}")
    };
    let reach = text.split("wire of turn 1 reaches ").nth(1);
    let reach = reach.and_then(|rest| rest.split(' ').next()?.parse::<f64>().ok());
    // (as far as the tolerance lets it sink in, mm)
    assert!((reach.expect("a length") - 6.7).abs() < 5e-3, "{text}");
    assert!(text.contains("nozzle_offset_x"), "{text}");
    let wound = sim.outputs().turns_wound;
    go(&mut sim, turning, 0.02);
    assert_eq!(
        sim.outputs().turns_wound,
        wound,
        "nothing is wound after it"
    );
}

/// The place of the exit along z, mm, in the text of an event.
fn exit_z(text: &str) -> f64 {
    let exit = text.split("exit at (").nth(1).expect("the exit");
    let z = exit.split([',', ')']).nth(2).expect("z");
    z.trim().parse().expect("a number")
}

/// The rim of the flanges is 9 mm from the axis, and they begin at 2.325 mm along it. A body of 2 mm stands between them.
#[test]
fn a_body_beside_a_flange_passes_between_and_not_through() {
    let text = small_bobbin(3, 20.0).replace(
        "distance_mm = 25",
        "distance_mm = 25\nouter_diameter_mm = 2",
    );
    let (collisions, _) = sent_beside(&text, 25e-3, 0.0, 9.5e-3);
    assert!(collisions.is_empty(), "{collisions:?}");
    let (collisions, mut sim) = sent_beside(&text, 25e-3, 2.6e-3, 9.5e-3);
    let [collision] = &collisions[..] else {
        panic!("one collision: {collisions:?}");
    };
    let [x, y, z] = collision.place_m;
    assert!(
        libm::hypot(x, z) < 9e-3 + 1e-6 && y > 2.325e-3 - 1e-6,
        "{collision:?}"
    );
    assert_eq!(sim.verdict(), Verdict::Collision);
    let texts = told(&mut sim);
    assert!(
        texts.len() == 1 && texts[0].contains("has met a flange"),
        "{texts:?}"
    );
}

#[test]
fn a_body_in_front_of_the_coil_changes_nothing() {
    let plain = small_bobbin(1, 20.0);
    let with_body = plain.replace(
        "distance_mm = 25",
        "distance_mm = 25\nouter_diameter_mm = 6\nbore_mm = 1",
    );
    let [a, b] = [plain, with_body].map(|text| {
        let mut sim = Simulation::new(&settings(&text).build().expect("a scene")).expect("starts");
        sim.advance_profile(0.15).expect("goes on");
        *sim.outputs()
    });
    assert_eq!(a, b);
}

fn refused(text: &str) -> String {
    settings(text).build().expect_err("refused").to_string()
}

#[test]
fn what_does_not_fit_in_a_body_is_refused_all_at_once() {
    let with =
        |keys: &str| bare_core(3.0).replace("length_mm = 12", &format!("length_mm = 12\n{keys}"));
    let all = refused(
        &with("bore_mm = 0.7\nexit_radius_mm = 1")
            .replace("edge_radius_mm = 0.2", "edge_radius_mm = 0.3"),
    );
    for word in [
        "nozzle.bore",
        "more than 0.0007 m",
        "nozzle.outer_diameter",
        "at least 0.0033 m",
    ] {
        assert!(all.contains(word), "{all}");
    }
    let rims = refused(&with("").replace("edge_radius_mm = 0.2", "edge_radius_mm = 1.6"));
    assert!(
        rims.contains("nozzle.edge_radius") && rims.contains("0 to 0.0015 m"),
        "{rims}"
    );
    let explicit = refused(&format!(
        "preset = 'paper'\n{}",
        with("exit_radius_mm = 0.5")
    ));
    assert!(
        explicit.contains("nozzle.exit_radius") && explicit.contains("explicit"),
        "{explicit}"
    );
    settings(&with("bore_mm = 0.8\nexit_radius_mm = 0.5"))
        .build()
        .expect("fits");
}

/// Beside each scene that is refused stands one that is not.
#[test]
fn a_nozzle_that_the_programme_brings_to_coil_or_flange_is_refused_before_the_run() {
    let tooth = |distance: f64, layers: u32| {
        format!(
            "[wire]\ndiameter_mm = 0.8\n[core]\nwidth_x_mm = 12\nheight_z_mm = 25\nlength_y_mm = 40\ncorner_radius_mm = 1\n\
             [nozzle]\ndistance_mm = {distance}\ny_start_mm = -15\n[start]\nclamp_y_mm = -15\n\
             [traverse]\nmode = 'orthocyclic'\n[winding]\nlayers = {layers}\nturns_per_layer = 30\n"
        )
    };
    // corners at 13.45 mm from the axis, layers of 0.8 mm, and the wire: 13.45 + 3.2 + 0.8
    let met = refused(&tooth(16.5, 4));
    for word in [
        "nozzle.distance",
        "the coil meets the nozzle in layer 3, from turn 61 at y = -0.015 m on",
        "at most 2 winding.layers",
    ] {
        assert!(met.contains(word), "{met}");
    }
    settings(&tooth(16.5, 2))
        .build()
        .expect("two layers are clear");
    settings(&tooth(17.6, 4)).build().expect("far enough");

    let bobbin = |distance: f64| {
        small_bobbin(3, 20.0).replace("distance_mm = 25", &format!("distance_mm = {distance}"))
    };
    // the rim sweeps 9 mm, and the wire has 0.7
    let swept = refused(&bobbin(9.6));
    for word in [
        "nozzle.distance",
        "the turning flanges need, 0.009 m",
        "more than 0.0097 m",
        "core.flange.height",
    ] {
        assert!(swept.contains(word), "{swept}");
    }
    settings(&bobbin(10.3))
        .build()
        .expect("clear of the flanges");

    let past = refused(
        &small_bobbin(3, 20.0)
            .replace("y_start_mm = -1.975", "y_start_mm = -1.5")
            .replace("distance_mm = 25", "distance_mm = 9.6\nbore_mm = 0.5"),
    );
    for word in [
        "nozzle.y_start",
        "past a flange",
        "nozzle.distance",
        "nozzle.bore",
    ] {
        assert!(past.contains(word), "all at once: {past}");
    }
}

#[test]
fn wire_that_yields_over_the_exit_is_told_with_its_numbers() {
    let warnings = |radius: f64| {
        let text = format!(
            "[core]\nshape = 'cylinder'\nradius_mm = 6\n[nozzle]\ndistance_mm = 20\nexit_radius_mm = {radius}\n"
        );
        let (_, warnings) = settings(&text).build_with_warnings().expect("a scene");
        let of = warnings
            .into_iter()
            .filter(|w| w.key == "nozzle.exit_radius");
        of.map(|w| w.message).collect::<Vec<_>>()
    };
    let told = warnings(50.0);
    assert!(told.len() == 1, "{told:?}");
    // wire lies on the edge: a strain of d / (2 R + d)
    let words = [
        "at 19 deg and 15 N",
        "a radius of 0.05035 m",
        "a strain of 0.70 %",
    ];
    for word in words {
        assert!(told[0].contains(word), "{told:?}");
    }
    // 15 N do not bend it onto a tighter edge
    assert_eq!(warnings(1.0), warnings(10.0));
    assert!(!warnings(1.0)[0].contains("a radius of 0.00135 m"));
    assert!(warnings(400.0).is_empty());
}
