//! Frozen wire that comes back after the wire ahead of it went on to yield.

use crate::common::fig8;
use coilwind::rod::Joint;
use coilwind::simulation::Simulation;
use coilwind::system::System;

/// Elastic curvature at a node, along the bend of the wire there, 1/m.
fn elastic(sys: &System, node: usize) -> f64 {
    let rod = &sys.state.rod;
    let before = match node {
        0 => sys.clamp_frame(0).expect("a clamp"),
        _ => rod.frame[node - 1],
    };
    let joint = Joint::between(&before, &rod.frame[node]);
    let set = rod.bend[node].curvature;
    let size = libm::hypot(joint.bend[0], joint.bend[1]);
    let way = |a: usize| (joint.bend[a] / rod.voronoi(node) - set[a]) * joint.bend[a] / size;
    way(0) + way(1)
}

/// Plastic bend of a node, rad.
fn set(sys: &System, node: usize) -> [f64; 2] {
    let own = sys.state.rod.voronoi(node);
    sys.state.rod.bend[node].curvature.map(|k| k * own)
}

/// Wire on the corner of a core, of which the node that bends most has become the clamp; and that node's number before.
fn clamped_at_the_corner(twist: &str) -> (System, usize) {
    let changes = [("solver.twist", twist), ("wire.material", "copper")];
    let mut sim = Simulation::new(&fig8(&changes)).expect("the scene starts");
    sim.advance_profile(0.6 * sim.motion_profile().end())
        .expect("the run goes on");
    let mut sys = sim.system().clone();
    let bends = |sys: &System, node: usize| {
        let rod = &sys.state.rod;
        rod.tangent(node - 1).dot(&rod.tangent(node))
    };
    let corner = (2..sys.state.rod.edges() / 2)
        .min_by(|a, b| bends(&sys, *a).total_cmp(&bends(&sys, *b)))
        .expect("some wire");
    assert!(bends(&sys, corner) < 0.995, "a bend");
    sys.freeze_front(corner);
    sys.refresh();
    (sys, corner)
}

/// Turns all live wire about its clamp, in the plane of the bend there, by an angle, rad.
fn fold(sys: &mut System, angle: f64) {
    let clamp = sys.state.rod.x[0];
    let along = sys.clamp_direction(0).expect("a clamp");
    let axis = along.cross(&sys.state.rod.tangent(0)).normalize();
    for x in &mut sys.state.rod.x[1..] {
        let d = *x - clamp;
        let turned = d * angle.cos() + axis.cross(&d) * angle.sin();
        *x = clamp + turned + axis * (axis.dot(&d) * (1.0 - angle.cos()));
    }
    sys.refresh();
}

/// What a clamp yielded by counted for its whole length when the wire before it thawed: moments of folded wire changed sides.
#[test]
fn a_clamp_that_yielded_thaws_with_the_moment_it_had() {
    for twist in ["off", "quasi-static"] {
        let (mut sys, corner) = clamped_at_the_corner(twist);
        let (frozen, before) = (elastic(&sys, 0), set(&sys, 0));
        let booked = sys.state.balance.plastic[0];
        fold(&mut sys, 0.1);
        assert!(sys.state.balance.plastic[0] > booked, "it yields");
        let (live, after) = (elastic(&sys, 0), set(&sys, 0));
        let half = sys.state.rod.rest[0];
        sys.thaw_front(corner);
        let rod = &sys.state.rod;
        let share = half / (rod.rest[corner - 1] + half);
        let expected = frozen + (live - frozen) * share;
        let size = frozen.abs().max(live.abs());
        let off = elastic(&sys, corner) - expected;
        assert!(off.abs() < 0.01 * size, "{twist}: {off} of {expected} 1/m");
        let own = before.map(|angle| angle / share);
        for a in 0..2 {
            let way = set(&sys, corner)[a] - own[a];
            let yielded = after[a] - before[a];
            let bend = libm::hypot(after[0] - before[0], after[1] - before[1]);
            assert!((way - yielded).abs() < 1e-9 * bend, "{way} {yielded} rad");
        }
    }
}

/// A clamp that turned along with wire folded over it took the plastic bend of that fold away for good.
#[test]
fn a_clamp_that_turned_thaws_with_the_set_of_the_fold() {
    let (mut sys, corner) = clamped_at_the_corner("off");
    fold(&mut sys, 2.8);
    let mut turned = sys.clone();
    assert!(turned.turn_folded_clamp(), "it is folded");
    for sys in [&mut sys, &mut turned] {
        assert_eq!(sys.thaw_front(corner), corner);
    }
    let [a, b] = [&sys, &turned].map(|sys| set(sys, corner));
    let off = libm::hypot(a[0] - b[0], a[1] - b[1]);
    assert!(off < 1e-9, "{a:?} {b:?} rad");
}
