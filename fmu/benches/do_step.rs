//! What one `fmi2DoStep` costs beyond the step itself.
//!
//! The spindle stands and the wire has come to rest, so that a native step costs next to nothing.
//! The difference of the two rows is the cost of the C boundary. Run `cargo bench -p coilwind-fmu`.
#![allow(missing_docs)]

use CoilWinding::exports::{
    fmi2DoStep, fmi2EnterInitializationMode, fmi2ExitInitializationMode, fmi2FreeInstance,
    fmi2Instantiate, fmi2SetupExperiment,
};
use CoilWinding::ffi::{Status, fmi2Component};
use coilwind::settings::SceneSettings;
use coilwind::signals::Inputs;
use coilwind::simulation::Simulation;
use coilwind_model_description::guid;
use criterion::{Criterion, criterion_group, criterion_main};
use std::ffi::CString;
use std::hint::black_box;

/// Communication step, s. A power of two, so that communication points carry no rounding.
const STEP: f64 = 1.0 / 1024.0;
/// Number of steps after which everything is at rest.
const STEPS_TO_REST: usize = 1000;

fn resting_simulation() -> (Simulation, Inputs) {
    let settings = SceneSettings::default();
    let scene = settings.build().expect("valid");
    let inputs = Inputs {
        spindle_speed: 0.0,
        ..settings.start_inputs()
    };
    let mut simulation = Simulation::starting_with(&scene, inputs).expect("a start");
    for _ in 0..STEPS_TO_REST {
        simulation.advance(inputs, STEP).expect("a step");
    }
    let before = simulation.outputs().solver_steps;
    simulation.advance(inputs, STEP).expect("a step");
    assert_eq!(simulation.outputs().solver_steps, before, "still awake");
    (simulation, inputs)
}

/// Returns an instance with everything at rest, and the number of its next step.
fn resting_instance() -> (fmi2Component, u64) {
    let guid = CString::new(guid().expect("a description")).expect("no NUL");
    let ok = Status::Ok.code();
    // SAFETY: all strings live until the calls have returned; the instance is used here only.
    unsafe {
        let (none, name) = (std::ptr::null(), c"bench".as_ptr());
        let c = fmi2Instantiate(name, 1, guid.as_ptr(), none, std::ptr::null(), 0, 0);
        assert!(!c.is_null());
        assert_eq!(fmi2SetupExperiment(c, 0, 0.0, 0.0, 0, 0.0), ok);
        assert_eq!(fmi2EnterInitializationMode(c), ok);
        assert_eq!(fmi2ExitInitializationMode(c), ok);
        for k in 0..STEPS_TO_REST {
            assert_eq!(fmi2DoStep(c, k as f64 * STEP, STEP, 1), ok);
        }
        (c, STEPS_TO_REST as u64)
    }
}

fn steps(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("step at rest");
    let (mut simulation, inputs) = resting_simulation();
    group.bench_function("native", |bencher| {
        bencher.iter(|| {
            simulation
                .advance(black_box(inputs), black_box(STEP))
                .expect("a step");
        });
    });
    let (c, mut k) = resting_instance();
    group.bench_function("fmi2DoStep", |bencher| {
        bencher.iter(|| {
            // SAFETY: the instance is freed below only.
            let status = unsafe { fmi2DoStep(black_box(c), k as f64 * STEP, STEP, 1) };
            assert_eq!(status, Status::Ok.code());
            k += 1;
        });
    });
    group.finish();
    // SAFETY: not used again.
    unsafe { fmi2FreeInstance(c) };
}

criterion_group!(benches, steps);
criterion_main!(benches);
