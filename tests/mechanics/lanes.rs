//! As many numbers at once as the machine has room for: no result hangs on it.

use crate::common::fig8;
use coilwind::math::simd::{Width, at_most, width};
use coilwind::simulation::Simulation;

/// A test of its own file, since the width is that of the whole process.
#[test]
fn a_run_is_the_same_to_the_bit_at_any_width() {
    let mut widths = Vec::new();
    let [one, four, eight] = [Width::One, Width::Four, Width::Eight].map(|most| {
        at_most(most);
        widths.push(width());
        let scene = fig8(&[("spindle.speed", "300")]);
        let mut sim = Simulation::new(&scene).expect("the scene starts");
        let end = sim.motion_profile().time_at(0.8 * std::f64::consts::TAU);
        sim.advance_profile(end).expect("the run goes on");
        assert!(sim.outputs().turns_wound > 0.5);
        sim.to_bytes().expect("a state can be saved")
    });
    assert_eq!(widths[0], Width::One);
    assert!(one == four && four == eight, "widths {widths:?}");
}
