//! The implicit step takes no heap once it is warm.
#![allow(missing_docs)]

use coilwind::settings::SceneSettings;
use coilwind::simulation::Simulation;
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

struct Counting;

thread_local! {
    /// of this thread: that of the test runner takes heap when it tells that a test takes long
    static COUNT: Cell<usize> = const { Cell::new(0) };
}

/// Calls for heap so far.
fn calls() -> usize {
    COUNT.get()
}

// SAFETY: hands every call on to the system's allocator and counts.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        COUNT.set(COUNT.get() + 1);
        // SAFETY: the caller's promises are those of the system's allocator
        unsafe { System.alloc(layout) }
    }
    unsafe fn dealloc(&self, p: *mut u8, layout: Layout) {
        // SAFETY: as above
        unsafe { System.dealloc(p, layout) }
    }
    unsafe fn realloc(&self, p: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        COUNT.set(COUNT.get() + 1);
        // SAFETY: as above
        unsafe { System.realloc(p, layout, size) }
    }
}

#[global_allocator]
static COUNTING: Counting = Counting;

/// Steps in contact, wire on wire included. Where the wire itself changes (a node comes in, an edge is
/// halved, nodes freeze, wire at rest is measured again for its tension) arrays may grow; every other step must not touch the heap.
#[test]
fn a_warm_step_takes_no_heap() {
    for twist in ["off", "quasi-static", "dynamic"] {
        warm_steps(twist);
    }
}

fn warm_steps(twist: &str) {
    let mut settings = SceneSettings::load("fig8").expect("packed");
    settings.spindle.speed = 100.0;
    settings.solver.twist = twist.to_owned();
    let scene = settings.build().expect("valid");
    let mut sim = Simulation::new(&scene).expect("starts");
    let warm = sim.motion_profile().time_at(1.3 * std::f64::consts::TAU);
    sim.advance_profile(warm).expect("winds");
    assert!(calls() > 100, "the way to there takes heap");
    let (mut quiet, mut noisy) = (0, Vec::new());
    for _ in 0..400 {
        let at_rest = |s: &Simulation| s.system().state.frozen.tension.iter().sum::<f64>();
        let wire = |s: &Simulation| {
            (
                s.outputs().live_nodes,
                s.outputs().turns_settled,
                at_rest(s),
            )
        };
        let (before, count) = (wire(&sim), calls());
        sim.advance_profile(2e-5).expect("winds");
        let taken = calls() - count;
        if wire(&sim) == before {
            quiet += 1;
            if taken > 0 {
                noisy.push((sim.time(), taken));
            }
        }
    }
    assert!(
        quiet > 200,
        "{twist}: only {quiet} steps without a change of the wire"
    );
    assert!(noisy.is_empty(), "{twist}: steps that took heap: {noisy:?}");
}
