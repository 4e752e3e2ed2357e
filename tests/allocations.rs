//! The implicit step takes no heap once it is warm.
#![allow(missing_docs)]

use coilwind::settings::SceneSettings;
use coilwind::simulation::Simulation;
use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering};

struct Counting;

static COUNT: AtomicUsize = AtomicUsize::new(0);

// SAFETY: hands every call on to the system's allocator and counts.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        COUNT.fetch_add(1, Ordering::Relaxed);
        // SAFETY: the caller's promises are those of the system's allocator
        unsafe { System.alloc(layout) }
    }
    unsafe fn dealloc(&self, p: *mut u8, layout: Layout) {
        // SAFETY: as above
        unsafe { System.dealloc(p, layout) }
    }
    unsafe fn realloc(&self, p: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        COUNT.fetch_add(1, Ordering::Relaxed);
        // SAFETY: as above
        unsafe { System.realloc(p, layout, size) }
    }
}

#[global_allocator]
static COUNTING: Counting = Counting;

/// Steps in contact, wire on wire included. Where the wire itself changes (a node comes in, an edge is
/// halved, nodes freeze) arrays may grow; every other step must not touch the heap.
#[test]
fn a_warm_step_takes_no_heap() {
    // one test: the counter is everybody's
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
    let (mut quiet, mut noisy) = (0, Vec::new());
    for _ in 0..400 {
        let wire = |s: &Simulation| (s.outputs().live_nodes, s.outputs().turns_settled);
        let (before, count) = (wire(&sim), COUNT.load(Ordering::Relaxed));
        sim.advance_profile(2e-5).expect("winds");
        let taken = COUNT.load(Ordering::Relaxed) - count;
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
