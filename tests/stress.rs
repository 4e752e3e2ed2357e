//! Scenes that once failed, replayed; and a random draw judged like `coilwind stress` does.

use coilwind::lab::stress::case_files;
use coilwind::lab::stress::case_files::Files;
use coilwind::lab::stress::invariants::judge;
use coilwind::lab::stress::{Invariant, Outcome, draw};
use std::path::{Path, PathBuf};

/// The scenes kept in `tests/stress`.
fn kept() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/stress");
    let mut scenes: Vec<PathBuf> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|e| e == "toml"))
        .collect();
    scenes.sort();
    scenes
}

#[test]
fn what_once_failed_holds_now() {
    let scenes = kept();
    assert!(scenes.len() >= 3, "only {} kept", scenes.len());
    for scene in scenes {
        let case = case_files::read(&scene).unwrap();
        let verdict = judge(&case);
        let name = scene.file_name().unwrap().to_string_lossy().into_owned();
        assert!(!verdict.outcome.is_trouble(), "{name}: {}", verdict.outcome);
    }
}

/// What was written reads back to a case that runs to the bit as the first did.
#[test]
fn a_kept_case_runs_as_it_was_drawn() {
    let folder = tempfile::tempdir().unwrap();
    let mut seen = [false; 2];
    for number in 0..40 {
        let mut case = draw::case(11, number).unwrap();
        case.inputs.truncate(60);
        if std::mem::replace(&mut seen[usize::from(case.mesh.is_some())], true) {
            continue;
        }
        let files = Files::new(folder.path(), &format!("case{number}"));
        files.write_mesh(&mut case).unwrap();
        files.write(&case, "two\nlines").unwrap();
        let again = case_files::read(&files.scene).unwrap();
        assert_eq!(again.inputs, case.inputs);
        assert_eq!(again.step.to_bits(), case.step.to_bits());
        assert_eq!(judge(&again), judge(&case));
    }
    assert_eq!(seen, [true; 2], "a core with a mesh and one without");
}

/// A case that must break an invariant does: the judge is no rubber stamp.
#[test]
fn the_judge_sees_what_is_wrong() {
    let mut case = draw::case(1, 0).unwrap();
    let mut number = 0;
    while case.settings.core.shape != "cylinder" {
        number += 1;
        case = draw::case(1, number).unwrap();
    }
    case.inputs.truncate(40);
    // contact as soft as a scene may have it: in motion wire sinks in by more than at rest
    let wire = case.settings.build().unwrap().wire;
    case.settings.tensioner.tension = 0.5 * wire.strength;
    let bend = case.settings.core.radius + wire.radius();
    case.settings.contact.stiffness = 1.01 * case.settings.tensioner.tension / bend / wire.radius();
    for i in &mut case.inputs {
        i.tension_setpoint = case.settings.tensioner.tension;
        i.spindle_speed = 20.0;
    }
    case.step = 4e-3;
    match judge(&case).outcome {
        Outcome::Invariant { what, .. } => assert_eq!(what, Invariant::Penetration),
        other => panic!("{other}"),
    }
}
