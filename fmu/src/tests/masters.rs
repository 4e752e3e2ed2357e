//! Tests of what masters stumbled over: times, precedence, folders, parameters one at a time, derivatives.

use super::{reference, set, started};
use crate::error::Error;
use crate::instance::Instance;
use crate::lifecycle::State;
use crate::message::Message;
use coilwind::signals::Outputs;
use coilwind_model_description::{Category, DEFAULT_STOP_TIME, DEFAULT_TOLERANCE};

fn set_text(instance: &mut Instance, name: &str, value: &str) {
    let value = value.to_owned();
    instance.set(&[reference(name)], [value]).expect("set");
}

fn real(instance: &mut Instance, name: &str) -> f64 {
    instance.get::<f64>(&[reference(name)]).expect("a value")[0]
}

fn warnings(messages: &[Message]) -> Vec<&str> {
    let warnings = messages.iter().filter(|m| m.category == Category::Warning);
    warnings.map(|m| m.text.as_str()).collect()
}

#[test]
fn events_tell_the_time_of_the_experiment() {
    let (mut instance, _) = started(100.0, |i| set(i, "tension_setpoint", 120.0));
    instance.do_step(100.0, 1e-3).expect("a step");
    let messages = instance.end_call();
    let text = warnings(&messages).join("\n");
    assert!(
        text.contains("t = 100.00") && text.contains("broke"),
        "{text}"
    );
}

#[test]
fn a_failed_step_tells_the_time_of_the_experiment() {
    let (mut instance, _) = started(50.0, |i| set(i, "solver.step", 0.01));
    set(&mut instance, "spindle_speed", 300.0);
    let mut time = 50.0;
    let error = loop {
        match instance.do_step(time, 0.013) {
            Ok(()) => time += 0.013,
            Err(error) => break error.to_string(),
        }
        assert!(time < 52.0);
    };
    assert!(
        error.contains("at t = 50.") && !error.contains("at t = 0."),
        "{error}"
    );
    let asked = [reference("wire_tension")];
    let refused = instance.directional_derivative(&asked, &[reference("tension_setpoint")], &[1.0]);
    assert!(matches!(refused, Err(Error::NoLastStep)), "{refused:?}");
}

/// An importer that writes every start value overrules the scene; it reads so, with both values.
#[test]
fn a_value_that_contradicts_the_scene_is_told() {
    let (_, messages) = started(0.0, |i| {
        set_text(i, "scene.file", "fig8_gap");
        set_text(i, "wire.material", "copper");
    });
    let told = warnings(&messages).join("\n");
    assert!(
        told.contains("wire.material = copper") && told.contains("fig8_gap has table1"),
        "{told}"
    );
    let (mut instance, messages) = started(0.0, |i| {
        set(i, "tensioner.tension", 9.0);
        set(i, "tension_setpoint", 15.0);
    });
    let told = warnings(&messages).join("\n");
    assert!(
        told.contains("tension_setpoint = 15 N") && told.contains("9 N, by tensioner.tension"),
        "{told}"
    );
    assert!((real(&mut instance, "wire_tension") - 15.0).abs() < 1e-9);
    let (_, messages) = started(0.0, |i| {
        set_text(i, "scene.file", "fig8");
        set(i, "spindle_speed", 3.0);
    });
    assert!(warnings(&messages).is_empty(), "{messages:?}");
}

/// A start value that left a scene without its flanges ended the start, and no word said that the scene's own values were lost.
#[test]
fn values_that_overrule_the_scene_are_told_where_it_cannot_start() {
    let mut instance = Instance::for_tests();
    set_text(&mut instance, "scene.file", "bobbin");
    set_text(&mut instance, "traverse.mode", "orthocyclic");
    set(&mut instance, "core.flange.inner_distance", 0.0);
    set(&mut instance, "winding.turns_per_layer", 0.0);
    instance.enter_initialization_mode().expect("enters");
    instance
        .exit_initialization_mode()
        .expect_err("no flanges, no turns");
    let told = warnings(&instance.end_call()).join("\n");
    assert!(told.contains("scene.file bobbin has 20"), "{told}");
}

/// The nozzle's input was told to hold where a law moves the nozzle.
#[test]
fn an_input_that_a_law_leaves_unused_is_told_so() {
    let (mut instance, messages) = started(0.0, |i| {
        set_text(i, "scene.file", "bobbin");
        set_text(i, "traverse.mode", "orthocyclic");
        set(i, "nozzle_position", 1e-3);
    });
    let told = warnings(&messages).join("\n");
    assert!(
        told.contains("nozzle_position = 0.001 m was set and has no effect"),
        "{told}"
    );
    assert!((real(&mut instance, "nozzle_y") - 1e-3).abs() > 1e-3);
}

#[test]
fn friction_can_be_lowered_one_call_at_a_time() {
    let (mut instance, _) = started(0.0, |i| set(i, "spindle_speed", 10.0));
    set(&mut instance, "friction.static", 0.1);
    let refused = instance
        .do_step(0.0, 1e-3)
        .expect_err("static below kinetic");
    assert!(refused.to_string().contains("friction"), "{refused}");
    assert_eq!(instance.state(), State::StepComplete);
    set(&mut instance, "friction.kinetic", 0.05);
    assert_eq!(real(&mut instance, "friction.static"), 0.1);
    instance.do_step(0.0, 1e-3).expect("a step");
    let (mut other, _) = started(0.0, |i| set(i, "spindle_speed", 10.0));
    let both = [reference("friction.static"), reference("friction.kinetic")];
    other.set(&both, [0.1, 0.05]).expect("set");
    other.do_step(0.0, 1e-3).expect("a step");
    let torque = |i: &mut Instance| real(i, "spindle_torque").to_bits();
    assert_eq!(torque(&mut instance), torque(&mut other));
}

/// The folder of one run is not that of another: its history and its scene stay as they are.
#[test]
fn a_second_run_in_a_folder_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let into = folder.path().to_str().expect("UTF-8").to_owned();
    let (mut first, _) = started(0.0, |i| {
        set_text(i, "output.directory", &into);
        set(i, "spindle_speed", 1.0);
    });
    let read = |name: &str| std::fs::read(folder.path().join(name)).expect("a file");
    let scene = read("scene.toml");
    let (mut second, messages) = started(0.0, |i| {
        set_text(i, "output.directory", &into);
        set(i, "wire.diameter", 0.5e-3);
    });
    let told = warnings(&messages).join("\n");
    assert!(told.contains("another run writes here"), "{told}");
    assert!(read("scene.toml") == scene);
    for k in 0..5 {
        let time = f64::from(k) * 1e-3;
        first.do_step(time, 1e-3).expect("a step");
        second.do_step(time, 1e-3).expect("a step");
    }
    second.terminate().expect("ends");
    // (nor has one that goes back to a state of the first)
    let state = first.snapshot();
    second.restore(&state);
    let messages = second.end_call();
    let told = warnings(&messages).join("\n");
    assert!(told.contains("another run writes here"), "{told}");
    second.do_step(5e-3, 1e-3).expect("a step");
    first.snapshot();
    let rows = read("history.csv").iter().filter(|b| **b == b'\n').count();
    assert_eq!(rows, 7);
}

/// Derivatives belong to the last communication step: another input in it gives another end of it.
#[test]
fn directional_derivatives_are_those_of_the_last_step() {
    let (mut instance, _) = started(0.0, |i| set(i, "spindle_speed", 30.0));
    let outputs = ["spindle_angle", "wire_tension", "fed_length"].map(reference);
    let knowns = ["spindle_speed", "nozzle_position", "tension_setpoint"].map(reference);
    let ask = |instance: &mut Instance, known: usize| {
        let known = [knowns[known]];
        instance
            .directional_derivative(&outputs, &known, &[1.0])
            .expect("derivatives")
    };
    // before the first step: by the inputs of the start
    assert!((ask(&mut instance, 2)[1] - 1.0).abs() < 1e-9);
    for k in 0..8 {
        instance.do_step(f64::from(k) * 1e-3, 1e-3).expect("a step");
    }
    let before = instance.snapshot();
    instance.do_step(8e-3, 1e-3).expect("a step");
    let got = [ask(&mut instance, 0), ask(&mut instance, 2)];
    assert!((got[0][0] - 1e-3).abs() < 1e-9, "{got:?}");
    for (which, name, by) in [(0, "spindle_speed", 0.02), (1, "tension_setpoint", 0.04)] {
        let base = [30.0, 15.0][which];
        let mut after = |by: f64| {
            instance.restore(&before);
            set(&mut instance, name, base + by);
            instance.do_step(8e-3, 1e-3).expect("a step");
            instance.get::<f64>(&outputs).expect("outputs")
        };
        let (plus, minus) = (after(by), after(-by));
        // the little wire that the tension draws is lost in the error of a step
        let compared = [3, 2][which];
        for k in 0..compared {
            let want = (plus[k] - minus[k]) / (2.0 * by);
            let slack = 0.02 * want.abs() + 1e-9;
            assert!(
                (got[which][k] - want).abs() < slack,
                "{name} {k}: {} {want}",
                got[which][k]
            );
        }
    }
    // a saved state knows its last step, as bytes too
    instance.restore(&before);
    let asked = ask(&mut instance, 2);
    let bytes = instance.bytes_of(&before).expect("bytes");
    let mut other = Instance::for_tests();
    let carried = other.snapshot_from(&bytes).expect("a state");
    other.restore(&carried);
    assert_eq!(ask(&mut other, 2), asked);
}

#[test]
fn outputs_with_derivatives_declare_their_dependencies() {
    let text = coilwind_model_description::model_description().expect("valid");
    let structure = &text[text.find("<Outputs>").expect("a structure")
        ..text.find("<InitialUnknowns>").expect("the next")];
    let declared = structure.matches(r#"dependencies="1 2 3 4 5 6 7""#).count();
    assert_eq!(declared, Outputs::SMOOTH.len() + Outputs::SETTLED.len());
    assert!(!text.contains("layers closed"));
}

#[test]
fn a_mesh_is_looked_for_among_the_resources_first() {
    let (mut instance, _) = started(0.0, |_| {});
    instance.reset().expect("resets");
    set_text(&mut instance, "core.shape", "mesh");
    set_text(&mut instance, "core.file", "no such core.stl");
    instance.setup_experiment(None, 0.0, None).expect("valid");
    instance.enter_initialization_mode().expect("enters");
    let error = instance
        .exit_initialization_mode()
        .expect_err("no file")
        .to_string();
    let here = std::env::current_dir().expect("a folder");
    assert!(
        error.contains("no such core.stl") && error.contains(here.to_str().expect("UTF-8")),
        "{error}"
    );
}

/// An importer that only simulates sees a coil; one that sets anything drives the machine.
#[test]
fn the_default_experiment_winds() {
    let (mut instance, messages) = started(0.0, |_| {});
    assert!(
        messages.iter().any(|m| m.text.contains("demonstrates")),
        "{messages:?}"
    );
    let steps = (DEFAULT_STOP_TIME / 1e-3).round() as u32;
    let mut halfway = None;
    for k in 0..steps {
        if k == steps / 2 {
            halfway = Some(instance.snapshot());
        }
        instance.do_step(f64::from(k) * 1e-3, 1e-3).expect("a step");
    }
    let turns = real(&mut instance, "spindle_angle") / std::f64::consts::TAU;
    assert!((turns - 2.5).abs() < 1e-3, "{turns}");
    assert!(real(&mut instance, "turns_wound") > 2.3);
    assert_eq!(real(&mut instance, "spindle_speed"), 0.0);
    let nozzle = real(&mut instance, "nozzle_position");
    assert!((nozzle - 2.5 * 0.7e-3).abs() < 1e-5, "{nozzle}");
    // a saved state goes on with it, until an input is set
    instance.restore(&halfway.expect("a state"));
    let time = f64::from(steps / 2) * 1e-3;
    instance.do_step(time, 1e-3).expect("a step");
    assert!(real(&mut instance, "spindle_speed") > 99.0);
    instance.begin_call();
    set(&mut instance, "spindle_speed", 50.0);
    let told = |m: &Message| m.text.contains("demonstration ends");
    assert!(instance.end_call().iter().any(told));
    let (nozzle, angle) = (
        real(&mut instance, "nozzle_position"),
        real(&mut instance, "spindle_angle"),
    );
    instance.do_step(time + 1e-3, 1e-3).expect("a step");
    assert_eq!(real(&mut instance, "nozzle_position"), nozzle);
    assert!((real(&mut instance, "spindle_angle") - angle - 0.05).abs() < 1e-9);
    for set_up in [
        &(|i: &mut Instance| set(i, "tension_setpoint", 14.0)) as &dyn Fn(&mut Instance),
        &|i: &mut Instance| set_text(i, "scene.file", "fig8"),
        &|i: &mut Instance| set(i, "wire.diameter", 0.5e-3),
    ] {
        let (mut instance, messages) = started(0.0, set_up);
        assert!(!messages.iter().any(|m| m.text.contains("demonstrates")));
        instance.do_step(0.0, 1e-2).expect("a step");
        assert_eq!(real(&mut instance, "spindle_angle"), 0.0);
    }
}

/// What a master asks for beyond a range is held at its end. The call returns a warning, so that the run can go on.
#[test]
fn inputs_beyond_their_range_are_held() {
    let (mut instance, _) = started(0.0, |_| ());
    let names = ["tension_setpoint", "spindle_speed"].map(reference);
    instance.begin_call();
    instance.set(&names, [-1.0, 1e9]).expect("held");
    assert!(instance.has_warned());
    let messages = instance.end_call();
    assert_eq!(warnings(&messages).len(), 2, "{messages:?}");
    assert!(warnings(&messages)[0].contains("tension_setpoint = -1 is held at 0"));
    assert_eq!(instance.get::<f64>(&names).expect("inputs"), [0.0, 2000.0]);
    instance.begin_call();
    instance.set(&names, [15.0, 0.0]).expect("allowed");
    assert!(!instance.has_warned());
    // derivatives that lead beyond the range
    for (step, rate, end) in [(1e-3, -1e6, 0.0), (0.3e-3, 1e9, 1e4), (0.7e-3, 1e8, 1e4)] {
        let (mut instance, _) = started(0.0, |i| set(i, "tension_setpoint", 15.3));
        instance
            .set_input_derivatives(&names, &[1, 1], &[rate, 0.0])
            .expect("finite");
        instance.begin_call();
        instance.do_step(0.0, step).expect("the tension is held");
        assert!(instance.has_warned());
        let reached = real(&mut instance, "tension_setpoint");
        let within = (reached - end).abs() < 1e-9 && (0.0..=1e4).contains(&reached);
        assert!(within, "{reached:e} for {end}");
    }
}

/// Parameters stay refused: a wire of another diameter than the one asked for is no help.
#[test]
fn parameters_beyond_their_range_are_refused() {
    let mut instance = Instance::for_tests();
    let both = ["tension_setpoint", "wire.diameter"].map(reference);
    instance.begin_call();
    let error = instance.set(&both, [-1.0, -1.0]).expect_err("no diameter");
    assert!(matches!(
        error,
        Error::NotAllowed {
            name: "wire.diameter",
            ..
        }
    ));
    assert!(!instance.has_warned() && instance.end_call().is_empty());
}

/// The tolerance that importers pass by default changes nothing, another one scales the solver's and is told.
#[test]
fn the_tolerance_of_the_experiment_scales_that_of_the_solver() {
    let solver = |tolerance: Option<f64>, set_up: &dyn Fn(&mut Instance)| {
        let mut instance = Instance::for_tests();
        instance
            .setup_experiment(tolerance, 0.0, None)
            .expect("a tolerance");
        set_up(&mut instance);
        instance.enter_initialization_mode().expect("enters");
        instance.exit_initialization_mode().expect("starts");
        let told = warnings(&instance.end_call()).len();
        (real(&mut instance, "solver.tolerance"), told)
    };
    let none = |_: &mut Instance| ();
    // as the wire's diameter, and the experiment is not blamed for that
    assert_eq!(solver(None, &none), (0.0, 0));
    let thinner = |i: &mut Instance| set(i, "wire.diameter", 5e-4);
    assert_eq!(solver(Some(DEFAULT_TOLERANCE), &thinner), (0.0, 0));
    let (tolerance, told) = solver(Some(5e-4), &none);
    assert!((tolerance - 1e-5).abs() < 1e-18 && told == 1, "{tolerance}");
    // a tenth of the wire's diameter at most
    assert_eq!(solver(Some(1e9), &none), (0.1 * 0.7e-3, 1));
    // a fine one made a tolerance that no scene may have, and the instance did not start
    assert_eq!(solver(Some(1e-9), &none), (1e-9, 1));
    // whichever is set first, a parameter overrules the experiment
    let explicit = |i: &mut Instance| set(i, "solver.tolerance", 4e-6);
    assert_eq!(solver(Some(1e-3), &explicit), (4e-6, 0));
    for wrong in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let refused = Instance::for_tests().setup_experiment(Some(wrong), 0.0, None);
        assert!(matches!(refused, Err(Error::Tolerance { .. })));
    }
}

/// A file that the importer set was looked for "relative to the scene file", where there may be none.
#[test]
fn a_missing_file_is_told_by_the_way_of_the_fmu() {
    let refused = |set_up: &dyn Fn(&mut Instance)| {
        let mut instance = Instance::for_tests();
        set_up(&mut instance);
        instance.setup_experiment(None, 0.0, None).expect("valid");
        instance.enter_initialization_mode().expect("enters");
        let error = instance.exit_initialization_mode().expect_err("no file");
        error.to_string()
    };
    let text = refused(&|i| {
        set_text(i, "traverse.mode", "table");
        set_text(i, "traverse.file", "none.csv");
    });
    let here = std::env::current_dir().expect("a folder");
    let here = format!("is no file; looked in {}", here.display());
    assert!(
        text.contains("traverse.file = none.csv") && text.contains(&here),
        "{text}"
    );
    let folder = refused(&|i| {
        set_text(i, "core.shape", "mesh");
        set_text(i, "core.file", &std::env::temp_dir().to_string_lossy());
    });
    assert!(folder.contains("is no file"), "{folder}");
    for (name, key) in [("core.shape", "mesh"), ("traverse.mode", "table")] {
        let text = refused(&|i| set_text(i, name, key));
        let way = "by its name among the FMU's resources, or else as given";
        assert!(
            text.contains(way) && !text.contains("relative to"),
            "{text}"
        );
    }
}

/// The results of an earlier run went without a word.
#[test]
fn a_run_that_overwrites_another_one_says_so() {
    let folder = tempfile::tempdir().expect("a folder");
    let place = folder.path().to_str().expect("UTF-8");
    let told = || {
        let (mut instance, messages) = started(0.0, |i| set_text(i, "output.directory", place));
        instance.do_step(0.0, 1e-4).expect("a step");
        instance.terminate().expect("terminates");
        warnings(&messages).join("\n")
    };
    assert_eq!(told(), "");
    let text = told();
    assert!(
        text.contains(place) && text.contains("which this run overwrites"),
        "{text}"
    );
}

/// A scene's own traverse is for its own motion: only a mode that the importer sets moves the nozzle by a law.
#[test]
fn the_nozzle_follows_a_law_where_the_importer_asks_for_one() {
    let wound = |mode: Option<&str>| {
        let (mut instance, messages) = started(0.0, |i| {
            set_text(i, "scene.file", "bobbin");
            if let Some(mode) = mode {
                set_text(i, "traverse.mode", mode);
            }
        });
        for k in 0..40 {
            let time = f64::from(k) * 2e-3;
            set(&mut instance, "spindle_speed", 100.0);
            instance.do_step(time, 2e-3).expect("a step");
        }
        let mode = instance
            .get::<String>(&[reference("traverse.mode")])
            .expect("a mode");
        (
            mode[0].clone(),
            real(&mut instance, "nozzle_y"),
            warnings(&messages).len(),
        )
    };
    assert_eq!(wound(None), ("by-input".to_owned(), -6.9e-3, 0));
    assert_eq!(wound(Some("by-input")), ("by-input".to_owned(), -6.9e-3, 0));
    let (mode, at, _) = wound(Some("orthocyclic"));
    assert!(mode == "orthocyclic" && at > -6.3e-3, "{mode} {at}");
    let (_, helical, told) = wound(Some("helical"));
    assert!(helical > at && told >= 1, "{helical} {told}");
}

/// The scene's own way, whose layers fill the window, refused the start of a nozzle that does not follow it.
#[test]
fn a_nozzle_that_follows_its_input_starts_anywhere() {
    let (_, messages) = started(0.0, |i| {
        set_text(i, "scene.file", "tooth");
        set(i, "nozzle.y_start", 2e-3);
        set(i, "start.clamp_y", 2e-3);
    });
    let told = warnings(&messages);
    let holds = told.iter().all(|text| text.contains("was set and holds"));
    assert!(holds, "{told:?}");
}

/// Importers that set no texts choose by number; a number wins over the text, and 0 leaves it.
#[test]
fn a_choice_can_be_made_by_its_number() {
    let number = |value: i32| {
        move |i: &mut Instance| {
            i.set(&[reference("core.shape_number")], [value])
                .expect("a choice");
        }
    };
    let shape = |i: &mut Instance| {
        i.get::<String>(&[reference("core.shape")])
            .expect("a shape")[0]
            .clone()
    };
    let (mut instance, messages) = started(0.0, number(2));
    assert_eq!(shape(&mut instance), "cylinder");
    assert_eq!(
        instance
            .get::<i32>(&[reference("core.shape_number")])
            .expect("a number"),
        [2]
    );
    assert!(warnings(&messages).is_empty());
    let (mut instance, _) = started(0.0, number(0));
    assert_eq!(shape(&mut instance), "rounded-box");
    // in whatever order, and it is told
    for text_first in [true, false] {
        let (mut instance, messages) = started(0.0, |i| {
            if text_first {
                set_text(i, "core.shape", "rounded-box");
            }
            number(2)(i);
            set_text(i, "core.shape", "rounded-box");
        });
        assert_eq!(shape(&mut instance), "cylinder");
        let told = warnings(&messages).join("\n");
        assert!(
            told.contains("core.shape = cylinder was set by core.shape_number = 2"),
            "{told}"
        );
    }
    for wrong in [-1, 4] {
        let mut instance = Instance::for_tests();
        let refused = instance.set(&[reference("core.shape_number")], [wrong]);
        assert!(
            refused
                .expect_err("no such choice")
                .to_string()
                .contains("0 to 3")
        );
    }
}

/// Numbers and texts are the same choices, in the order of the text's.
#[test]
fn every_choice_has_a_number() {
    use coilwind::variables::{Access, Value, choice, table};
    for row in table().iter().filter(|row| !row.choices.is_empty()) {
        let number = table()
            .iter()
            .find(|other| matches!(other.access, Access::Choice(text) if text == row.name));
        let number = number.unwrap_or_else(|| panic!("{} has no number", row.name));
        assert_eq!(
            number.max,
            Some(row.choices.len() as f64),
            "{}",
            number.name
        );
        for (place, text) in (1..).zip(row.choices) {
            let (row_of, value) = choice(number, &Value::Integer(place)).expect("a choice");
            assert_eq!(
                (row_of.name, value),
                (row.name, Value::String((*text).to_owned()))
            );
            assert!(
                number.description.contains(&format!("{place} {text}")),
                "{}",
                number.name
            );
        }
        assert!(choice(number, &Value::Integer(0)).is_none());
    }
}

#[test]
fn where_the_nozzle_follows_a_law_nothing_follows_its_input() {
    let (mut instance, _) = started(0.0, |i| set_text(i, "traverse.mode", "by-angle"));
    let [angle, layon] = ["spindle_angle", "layon_position"].map(reference);
    let nozzle = [reference("nozzle_position"); 2];
    let slopes = |i: &mut Instance| {
        i.directional_derivative(&[angle, layon], &nozzle, &[1.0, 1.0])
            .expect("derivatives")
    };
    assert_eq!(slopes(&mut instance), [0.0; 2]);
    set(&mut instance, "spindle_speed", 100.0);
    set(&mut instance, "nozzle_position", 5.0);
    instance.do_step(0.0, 1e-2).expect("a step");
    assert_eq!(slopes(&mut instance), [0.0; 2]);
    assert!(real(&mut instance, "nozzle_y").abs() < 1e-3);
}
