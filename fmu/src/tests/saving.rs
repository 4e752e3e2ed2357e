//! Tests of saved states: continuation to the bit, bytes that are refused, files.

use super::{reference, set};
use crate::error::{BytesError, Error};
use crate::ffi;
use crate::ffi::Status;
use crate::instance::Instance;
use crate::lifecycle::State;
use crate::state::Snapshot;
use coilwind_model_description::guid;

const STEP: f64 = 1e-4;

/// Returns an instance at its first communication point, with parameters and inputs set.
fn at_first_point() -> Instance {
    let mut instance = Instance::for_tests();
    instance
        .setup_experiment(None, 1.0, None)
        .expect("an experiment");
    set(&mut instance, "friction.static", 0.31);
    instance.enter_initialization_mode().expect("enters");
    set(&mut instance, "tension_setpoint", 12.0);
    instance.exit_initialization_mode().expect("exits");
    instance
}

/// Makes steps `from..to` of a machine whose speed and tension follow their derivatives.
fn wind(instance: &mut Instance, from: u32, to: u32) {
    for k in from..to {
        let t = f64::from(k) * STEP;
        let rate = if t < 5e-3 { 8e4 } else { 0.0 };
        set(instance, "spindle_speed", (8e4 * t).min(400.0));
        let inputs = ["spindle_speed", "tension_setpoint"].map(reference);
        instance
            .set_input_derivatives(&inputs, &[1, 1], &[rate, -50.0])
            .expect("derivatives");
        instance.do_step(1.0 + t, STEP).expect("a step");
    }
}

fn bytes(snapshot: &Snapshot) -> Vec<u8> {
    snapshot
        .to_bytes(guid().expect("a description"))
        .expect("bytes")
}

fn read(data: &[u8]) -> Result<Snapshot, Error> {
    Snapshot::from_bytes(data, guid().expect("a description"), None)
}

#[test]
fn an_instance_goes_on_from_a_copy_from_bytes_and_after_a_reset() {
    let mut instance = at_first_point();
    wind(&mut instance, 0, 150);
    let saved = instance.snapshot();
    let data = bytes(&saved);
    wind(&mut instance, 150, 250);
    let end = bytes(&instance.snapshot());
    // Back to the saved state, and forth again.
    instance.restore(&saved);
    assert!(bytes(&instance.snapshot()) == data);
    wind(&mut instance, 150, 250);
    assert!(bytes(&instance.snapshot()) == end);
    // After a reset, from bytes.
    instance.reset().expect("resets");
    instance.restore(&read(&data).expect("a state"));
    wind(&mut instance, 150, 250);
    assert!(bytes(&instance.snapshot()) == end);
    // In an instance that never started.
    let mut other = Instance::for_tests();
    other.restore(&read(&data).expect("a state"));
    wind(&mut other, 150, 250);
    assert!(bytes(&other.snapshot()) == end);
}

#[test]
fn states_before_the_start_and_after_the_end_are_states() {
    let mut instance = Instance::for_tests();
    set(&mut instance, "spindle_speed", 3.0);
    let instantiated = bytes(&instance.snapshot());
    instance
        .setup_experiment(None, 2.0, Some(3.0))
        .expect("valid");
    instance.enter_initialization_mode().expect("enters");
    let initialization = bytes(&instance.snapshot());
    instance.exit_initialization_mode().expect("exits");
    instance.do_step(2.0, STEP).expect("a step");
    instance.terminate().expect("terminates");
    let terminated = bytes(&instance.snapshot());
    let mut other = Instance::for_tests();
    for (data, state) in [
        (&terminated, State::Terminated),
        (&initialization, State::Initialization),
        (&instantiated, State::Instantiated),
    ] {
        other.restore(&read(data).expect("a state"));
        assert_eq!(other.state(), state);
        assert!(&bytes(&other.snapshot()) == data);
    }
    assert_eq!(
        other
            .get::<f64>(&[reference("spindle_speed")])
            .expect("an input"),
        [3.0]
    );
}

#[test]
fn other_bytes_are_refused_with_the_reason() {
    let mut instance = at_first_point();
    wind(&mut instance, 0, 3);
    let good = bytes(&instance.snapshot());
    let refused = |data: &[u8]| match read(data) {
        Err(Error::Bytes(error)) => error,
        other => panic!("{other:?}"),
    };
    assert!(matches!(refused(b""), BytesError::Foreign { size: 0 }));
    assert!(matches!(refused(&[7; 500]), BytesError::Foreign { .. }));
    let changed = |at: usize| {
        let mut data = good.clone();
        data[at] ^= 1;
        refused(&data)
    };
    assert!(matches!(changed(0), BytesError::Foreign { .. }));
    assert!(matches!(
        changed(8),
        BytesError::Version {
            found: 9,
            expected: 8
        }
    ));
    assert!(matches!(changed(20), BytesError::Guid { .. }));
    assert!(matches!(changed(good.len() - 1), BytesError::Damaged));
    assert!(matches!(changed(200), BytesError::Damaged));
    for size in [61, 62, 100, good.len() / 2, good.len() - 1] {
        let error = refused(&good[..size]);
        let short = matches!(
            error,
            BytesError::Truncated { .. } | BytesError::Foreign { .. }
        );
        assert!(short, "{size}: {error}");
    }
}

/// Bytes behind a state were passed over, and with them the sign that something else was written there.
#[test]
fn a_byte_behind_a_state_is_refused() {
    let good = bytes(&at_first_point().snapshot());
    for more in [&[7][..], &[0, 0, 1], &[9; 10]] {
        let long = [&good, more].concat();
        let error = read(&long).expect_err("more than a state");
        assert!(matches!(error, Error::Bytes(BytesError::Longer { .. })));
        let needed = format!("takes {} of {} bytes", good.len(), long.len());
        assert!(error.to_string().contains(&needed), "{error}");
    }
    assert!(read(&good).is_ok());
    // a master whose buffers are larger than a state reads back what it had written into one
    assert!(read(&[&good[..], &[0; 100]].concat()).is_ok());
}

#[test]
fn derivatives_are_checked_before_anything_changes() {
    let mut instance = at_first_point();
    let before = bytes(&instance.snapshot());
    let (speed, tension) = (reference("spindle_speed"), reference("wire_tension"));
    for (variable, order, value) in [
        (speed, 0, 1.0),
        (speed, 2, 1.0),
        (speed, 1, f64::NAN),
        (tension, 1, 1.0),
    ] {
        let both = instance.set_input_derivatives(&[speed, variable], &[1, order], &[5.0, value]);
        assert!(both.is_err());
    }
    assert!(bytes(&instance.snapshot()) == before);
}

#[test]
fn inputs_follow_their_derivatives_for_one_step() {
    let mut instance = at_first_point();
    let inputs = ["spindle_speed", "tension_setpoint", "nozzle_position"].map(reference);
    instance
        .set_input_derivatives(&inputs, &[1; 3], &[1000.0, -100.0, 0.01])
        .expect("derivatives");
    instance.do_step(1.0, 1e-3).expect("a step");
    let now: Vec<f64> = instance.get(&inputs).expect("inputs");
    assert_eq!(now, [1.0, 12.0 - 0.1, 1e-5]);
    let angle = reference("spindle_angle");
    let turned = instance.get::<f64>(&[angle]).expect("an output")[0];
    assert!((turned - 0.5e-3).abs() < 1e-12, "{turned}");
    let slope = instance
        .output_derivatives(&[angle], &[1])
        .expect("order 1");
    assert_eq!(slope, [1.0]);
    // The inputs are held from now on.
    instance.do_step(1.001, 1e-3).expect("a step");
    assert_eq!(instance.get::<f64>(&inputs).expect("inputs"), now);
}

/// The history of a run that went back to a saved state is that of a run that never left it.
#[test]
fn the_history_is_cut_back() {
    let folder = tempfile::tempdir().expect("a folder");
    let record = |name: &str, work: &dyn Fn(&mut Instance)| {
        let directory = folder.path().join(name);
        let mut instance = Instance::for_tests();
        let path = directory.to_str().expect("UTF-8").to_owned();
        instance
            .set(&[reference("output.directory")], [path])
            .expect("set");
        instance.setup_experiment(None, 1.0, None).expect("valid");
        instance.enter_initialization_mode().expect("enters");
        instance.exit_initialization_mode().expect("exits");
        work(&mut instance);
        // A snapshot puts the history on disk. Without an end no pictures are drawn.
        instance.snapshot();
        let messages = instance.end_call();
        let text = std::fs::read(directory.join("history.csv")).expect("a history");
        (text, messages)
    };
    let (plain, _) = record("plain", &|i| wind(i, 0, 20));
    let (back, _) = record("back", &|i| {
        wind(i, 0, 8);
        let saved = i.snapshot();
        wind(i, 8, 15);
        i.restore(&saved);
        wind(i, 8, 20);
    });
    assert!(plain == back);
    let (other, messages) = record("other", &|i| {
        wind(i, 0, 8);
        let data = bytes(&i.snapshot());
        wind(i, 8, 15);
        *i = Instance::for_tests();
        i.restore(&read(&data).expect("a state"));
        wind(i, 8, 20);
    });
    assert!(plain == other && messages.is_empty(), "{messages:?}");
    // Another file is in its place: a new one begins, and the importer is told.
    let (anew, messages) = record("anew", &|i| {
        wind(i, 0, 8);
        let data = bytes(&i.snapshot());
        *i = Instance::for_tests();
        std::fs::write(folder.path().join("anew/history.csv"), "mine").expect("written");
        i.restore(&read(&data).expect("a state"));
        wind(i, 8, 20);
    });
    let rows = |text: &[u8]| text.iter().filter(|b| **b == b'\n').count();
    assert_eq!((rows(&plain), rows(&anew)), (22, 13));
    assert!(messages[0].text.contains("begins anew"), "{messages:?}");
}

/// A step that the solver cannot take gives `fmi2Discard`. Outputs and clock are those of what was
/// reached, and a saved state can be gone on from.
#[test]
fn a_failed_step_can_be_taken_back() {
    let mut instance = Instance::for_tests();
    set(&mut instance, "solver.step", 0.01);
    instance.setup_experiment(None, 1.0, None).expect("valid");
    instance.enter_initialization_mode().expect("enters");
    instance.exit_initialization_mode().expect("exits");
    instance.do_step(1.0, 0.02).expect("standing is easy");
    let saved = instance.snapshot();
    set(&mut instance, "spindle_speed", 300.0);
    // Half a turn a step cannot go on.
    let (mut time, size) = (1.02, 0.013);
    let error = loop {
        match instance.do_step(time, size) {
            Ok(()) => time += size,
            Err(error) => break error,
        }
        assert!(time < 2.0);
    };
    assert_eq!(error.status().0, Status::Discard, "{error}");
    let text = error.to_string();
    assert!(text.contains("turn") && text.contains("core at"), "{text}");
    assert_eq!(instance.state(), State::StepFailed);
    let reached = instance
        .real_status(ffi::LAST_SUCCESSFUL_TIME)
        .expect("a time");
    assert!(
        (time - 1e-9..time + size).contains(&reached),
        "{reached} {time}"
    );
    let angle = instance
        .get::<f64>(&[reference("spindle_angle")])
        .expect("an output")[0];
    assert!(
        (angle - 300.0 * (reached - 1.02)).abs() < 1e-9,
        "{angle} at {reached}"
    );
    assert_eq!(instance.boolean_status(ffi::TERMINATED).ok(), Some(true));
    // Back to the saved state, and another way.
    instance.restore(&saved);
    assert_eq!(instance.state(), State::StepComplete);
    assert_eq!(
        instance.real_status(ffi::LAST_SUCCESSFUL_TIME).ok(),
        Some(1.02)
    );
    set(&mut instance, "spindle_speed", 0.0);
    instance.do_step(1.02, 0.02).expect("standing is easy");
}

/// Bytes held what was set, and not what the simulation had taken over by then: the last step was gone through again with the friction
/// of the next, and wire that the old friction held at rest stayed there.
#[test]
fn what_the_next_step_takes_over_is_pending_in_bytes_too() {
    let mut instance = at_first_point();
    wind(&mut instance, 0, 200);
    let time = 1.0 + 200.0 * STEP;
    set(&mut instance, "friction.kinetic", 0.02);
    set(&mut instance, "friction.static", 0.03);
    let saved = instance.snapshot();
    let mut other = Instance::for_tests();
    other.restore(&read(&bytes(&saved)).expect("a state"));
    let asked = ["wire_tension", "fed_length", "spindle_torque"].map(reference);
    let known = [reference("tension_setpoint")];
    let ask = |i: &mut Instance| i.directional_derivative(&asked, &known, &[1.0]);
    let (here, there) = (ask(&mut instance), ask(&mut other));
    assert_eq!(here.expect("derivatives"), there.expect("derivatives"));
    let outputs = [
        "wire_tension",
        "fed_length",
        "spindle_torque",
        "solver_steps",
    ]
    .map(reference);
    for k in 0..20 {
        let now = time + f64::from(k) * STEP;
        for i in [&mut instance, &mut other] {
            i.do_step(now, STEP).expect("a step");
        }
        let read = |i: &mut Instance| i.get::<f64>(&outputs).expect("outputs");
        assert_eq!(read(&mut instance), read(&mut other), "step {k}");
    }
}
