//! Tests of what the importer is told: by messages, and by outputs that a message goes with.

use super::{reference, set, started};
use crate::ffi::Status;
use crate::instance::Instance;
use crate::message::Message;
use coilwind::settings::SceneSettings;
use coilwind::signals::{Event, EventKind};
use coilwind_model_description::Category;

fn event(time: f64, kind: EventKind) -> Event {
    Event {
        time,
        turn: 1.0,
        angle: 0.0,
        kind,
        text: format!("{kind:?}"),
    }
}

/// What the solver had to do made a line for each of its steps.
#[test]
fn a_communication_step_has_one_line_of_the_solver() {
    let events = [
        event(0.1, EventKind::Turn),
        event(0.2, EventKind::Solver),
        event(0.3, EventKind::Defect),
        event(0.4, EventKind::Solver),
        event(0.5, EventKind::Solver),
    ];
    let messages = Message::of_events(&events, 10.0);
    let categories: Vec<Category> = messages.iter().map(|m| m.category).collect();
    assert_eq!(
        categories,
        [Category::Events, Category::Solver, Category::Events]
    );
    let text = &messages[1].text;
    assert!(text.starts_with("t = 10.200000 s"), "{text}");
    assert!(
        text.ends_with("Solver; 2 more such in this communication step, up to t = 10.500000 s"),
        "{text}"
    );
    let messages = Message::of_events(&events[..3], 0.0);
    assert!(messages[1].text.ends_with("Solver"), "{}", messages[1].text);
}

/// The end of a run tells what the solver did in all; one that never stepped has nothing to tell.
#[test]
fn the_end_sums_up_what_the_solver_did() {
    let of_solver = |instance: &mut Instance| {
        let messages = instance.end_call().into_iter();
        let told = messages.filter(|m| m.category == Category::Solver);
        told.map(|m| (m.status, m.text)).collect::<Vec<_>>()
    };
    let (mut instance, _) = started(0.0, |_| {});
    instance.terminate().expect("ends");
    assert_eq!(of_solver(&mut instance), []);
    let (mut instance, _) = started(0.0, |i| set(i, "spindle_speed", 30.0));
    instance.do_step(0.0, 5e-3).expect("a step");
    instance.do_step(5e-3, 5e-3).expect("a step");
    assert_eq!(of_solver(&mut instance), []);
    instance.terminate().expect("ends");
    let told = of_solver(&mut instance);
    assert_eq!(told.len(), 1, "{told:?}");
    assert_eq!(told[0].0, Status::Ok);
    let steps = instance
        .get::<f64>(&[reference("solver_steps")])
        .expect("a count");
    let expected = format!("t = 0.010000 s: the solver took {} steps", steps[0]);
    assert!(told[0].1.starts_with(&expected), "{told:?} {expected}");
}

/// A master that only asked for results found a core that stood, and no line said why.
#[test]
fn a_folder_of_results_alone_ends_the_demonstration_with_a_line() {
    let folder = tempfile::tempdir().expect("a folder");
    let place = folder.path().join("out").display().to_string();
    let (_, messages) = started(0.0, |i| {
        i.set(&[reference("output.directory")], [place.clone()])
            .expect("set");
    });
    let told = |text: &str| messages.iter().filter(|m| m.text.contains(text)).count();
    let line = "output.directory is set, so the FMU does not demonstrate";
    assert_eq!(
        (told(line), told("so the FMU demonstrates")),
        (1, 0),
        "{messages:?}"
    );
    let (_, messages) = started(0.0, |i| set(i, "spindle_speed", 30.0));
    assert!(!messages.iter().any(|m| m.text.contains("demonstrate")));
}

/// The warning named another mode than `fmi2GetString` did.
#[test]
fn a_key_without_effect_is_told_with_the_mode_that_is_in_use() {
    let (mut instance, messages) = started(0.0, |i| {
        i.set(&[reference("scene.file")], ["fig8".to_owned()])
            .expect("set");
        set(i, "winding.layers", 2.0);
    });
    let mode = instance
        .get::<String>(&[reference("traverse.mode")])
        .expect("a mode");
    let told: Vec<&str> = messages.iter().map(|m| m.text.as_str()).collect();
    assert!(told.concat().contains("winding.layers = 2"), "{told:?}");
    assert!(
        told.concat()
            .contains(&format!("traverse.mode = {} ", mode[0])),
        "{mode:?} {told:?}"
    );
}

/// Each read of an output before the start ended told the warnings of the scene again, also of what later values mended.
#[test]
fn a_scene_warns_once_and_of_what_it_is_in_the_end() {
    let told_with = |layers: f64, restores: bool| {
        let mut instance = Instance::for_tests();
        instance.enter_initialization_mode().expect("entered");
        let mut told = Vec::new();
        let mut read = |instance: &mut Instance| {
            instance.begin_call();
            instance
                .get::<f64>(&[reference("wire_tension")])
                .expect("a tension");
            told.extend(instance.end_call());
        };
        for value in [2.0, 3.0, layers] {
            set(&mut instance, "winding.layers", value);
            read(&mut instance);
            read(&mut instance);
        }
        if restores {
            let state = instance.snapshot();
            set(&mut instance, "winding.layers", 7.0);
            read(&mut instance);
            instance.restore(&state);
        }
        instance.begin_call();
        instance.exit_initialization_mode().expect("starts");
        told.extend(instance.end_call());
        let texts = told.into_iter().map(|m| m.text);
        texts
            .filter(|text| text.contains("winding.layers"))
            .collect::<Vec<_>>()
    };
    for restores in [false, true] {
        let [text] = &told_with(4.0, restores)[..] else {
            panic!("{:?}", told_with(4.0, restores));
        };
        assert!(text.contains("winding.layers = 4"), "{text}");
    }
}

/// After the step in which the wire parts, the speeds of before it were its slopes: 4 m/s of wire that moves no more.
#[test]
fn wire_that_has_parted_has_no_slopes() {
    for step in [1e-4, 1e-3] {
        let (mut instance, _) = started(0.0, |i| set(i, "spindle_speed", 20.0));
        let broke = reference("defect_break");
        let outputs = [
            "fed_length",
            "tensioner_position",
            "free_length",
            "spindle_angle",
        ]
        .map(reference);
        let mut k = 0;
        while !instance.get::<bool>(&[broke]).expect("a flag")[0] {
            assert!(f64::from(k) * step < 0.05, "it has not broken");
            let pull = if f64::from(k) * step < 5e-3 {
                15.0
            } else {
                90.0
            };
            set(&mut instance, "tension_setpoint", pull);
            instance.do_step(f64::from(k) * step, step).expect("a step");
            k += 1;
        }
        let slopes = instance
            .output_derivatives(&outputs, &[1; 4])
            .expect("slopes");
        assert_eq!(slopes, [0.0, 0.0, 0.0, 20.0]);
        let fed = instance.get::<f64>(&outputs[..3]).expect("lengths");
        instance.do_step(f64::from(k) * step, step).expect("a step");
        assert_eq!(instance.get::<f64>(&outputs[..3]).expect("lengths"), fed);
    }
}

/// A step of 1e-18 s in which the nozzle moved by a tenth of a millimetre was solved for, at 1e14 m/s, and the next one failed.
#[test]
fn what_moves_in_a_step_too_short_to_solve_for_moves_in_the_next() {
    for tiny in [1e-18, 1e-12, 5e-10] {
        let (mut instance, _) = started(0.0, |_| {});
        set(&mut instance, "spindle_speed", 10.0);
        set(&mut instance, "nozzle_position", 1e-6);
        set(&mut instance, "tension_setpoint", 16.0);
        instance.do_step(0.0, tiny).expect("a step");
        instance.do_step(tiny, 1e-4).expect("a step");
        instance.do_step(tiny + 1e-4, 1e-4).expect("a step");
        let outputs = ["nozzle_y", "spindle_angle"].map(reference);
        let now = instance.get::<f64>(&outputs).expect("outputs");
        assert_eq!(now[0], 1e-6);
        assert!((now[1] - 2e-3).abs() < 1e-8, "{tiny}: {now:?}");
    }
    // and what is too short at all changes nothing
    let (mut instance, _) = started(0.0, |i| set(i, "spindle_speed", 10.0));
    let saved = |instance: &mut Instance| {
        let state = instance.snapshot();
        instance.bytes_of(&state).expect("bytes")
    };
    let before = saved(&mut instance);
    for tiny in [1e-20, 1e-300, 5e-324] {
        let refused = instance.do_step(0.0, tiny).expect_err("too short");
        assert!(refused.to_string().contains("1e-18 s or more"), "{refused}");
    }
    assert!(saved(&mut instance) == before);
}

/// The nozzle stood at `nozzle.y_start` and the lead, where the scene's law begins elsewhere, until an input moved it.
#[test]
fn the_nozzle_starts_where_the_law_of_the_scene_begins() {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).expect("written");
        path.display().to_string()
    };
    write("way.csv", "turns,y_m\n0,0.0005\n5,0.004\n");
    let table = "[traverse]\nmode = \"table\"\nfile = \"way.csv\"\n";
    let table = write("table.toml", table);
    let starts = |scene: &str| {
        let (mut instance, _) = started(0.0, |i| {
            i.set(&[reference("scene.file")], [scene.to_owned()])
                .expect("set");
        });
        instance
            .get::<f64>(&[reference("nozzle_y")])
            .expect("a place")[0]
    };
    assert_eq!(starts(&table), 5e-4);
    for scene in ["fig8", "tooth", "bobbin", "fine"] {
        let settings = SceneSettings::load(scene).expect("a scene");
        let law = settings.build().expect("valid").nozzle_law;
        assert_eq!(starts(scene), law.start(), "{scene}");
    }
}
