//! The unknowns of equilibrium, positions of nodes and rolls of edges, and the forces on them.

use crate::math::V3;
use crate::system::System;

/// Unknowns per node: three coordinates and the roll of the edge after it.
pub(super) const PER_NODE: usize = 4;

/// Whether coordinate `a` of node `i` is held.
pub(super) fn held(sys: &System, i: usize, a: usize) -> bool {
    (i == 0 && sys.state.support[0].hold[a])
        || (i + 1 == sys.state.rod.nodes() && sys.state.support[1].hold[a])
}

/// Where the supports want the two end nodes; coordinates that are free stay as they are.
pub(super) fn support_places(sys: &mut System) -> [V3; 2] {
    let last = sys.state.rod.nodes() - 1;
    let before = [sys.state.rod.x[0], sys.state.rod.x[last]];
    sys.place_supports();
    let target = [sys.state.rod.x[0], sys.state.rod.x[last]];
    for (i, x) in [(0, before[0]), (last, before[1])] {
        sys.state.rod.x[i] = x;
        sys.state.rod.v[i] = V3::zeros();
    }
    target
}

pub(super) fn at_supports(sys: &System, target: &[V3; 2]) -> bool {
    let last = sys.state.rod.nodes() - 1;
    (0..3).all(|a| {
        (!held(sys, 0, a) || sys.state.rod.x[0][a] == target[0][a])
            && (!held(sys, last, a) || sys.state.rod.x[last][a] == target[1][a])
    })
}

/// The part of a step that belongs to node `i`.
pub(super) fn part(step: &[f64], i: usize) -> V3 {
    let k = PER_NODE * i;
    V3::new(step[k], step[k + 1], step[k + 2])
}

/// Moves from `start` by a share of `step`.
///
/// Edges turn and stretch by their part of it. Nodes that move along straight lines would stretch a
/// turning edge by half the square of its turn, and the wire is far stiffer in stretch.
pub(super) fn advance(
    sys: &mut System,
    start: &(Vec<V3>, Vec<f64>),
    step: &[f64],
    share: f64,
    target: Option<&[V3; 2]>,
) {
    let (x, roll) = start;
    let last = x.len() - 1;
    sys.state.rod.x[0] = x[0] + part(step, 0) * share;
    for j in 0..last {
        let d = x[j + 1] - x[j];
        let length = d.norm();
        let move_on = (part(step, j + 1) - part(step, j)) * share;
        let stretched = length + move_on.dot(&d) / length;
        let direction = (d + move_on).normalize();
        sys.state.rod.x[j + 1] = sys.state.rod.x[j] + direction * stretched;
        sys.state.roll[j] = roll[j] + share * step[PER_NODE * j + 3] / sys.state.rod.rest[j];
    }
    // a held far end stays where the straight step puts it; the wire shares the difference
    let mut miss = x[last] + part(step, last) * share - sys.state.rod.x[last];
    for a in 0..3 {
        if !held(sys, last, a) {
            miss[a] = 0.0;
        }
    }
    for i in 1..=last {
        sys.state.rod.x[i] += miss * (i as f64 / last as f64);
    }
    for (i, end) in [(0, 0), (last, 1)] {
        for a in 0..3 {
            if held(sys, i, a) {
                // exactly, so that the wire is seen to have arrived
                sys.state.rod.x[i][a] = match target {
                    Some(target) if share == 1.0 => target[end][a],
                    _ => x[i][a] + share * step[PER_NODE * i + a],
                };
            }
        }
    }
}

/// Forces on nodes and torques on edges, these over the edge length so that all are in N.
pub(super) fn residual(sys: &System) -> Vec<f64> {
    let mut r = vec![0.0; PER_NODE * sys.state.rod.nodes()];
    for i in 0..sys.state.rod.nodes() {
        r[PER_NODE * i..PER_NODE * i + 3].copy_from_slice(sys.state.load.force[i].as_slice());
        if i < sys.state.rod.edges() {
            r[PER_NODE * i + 3] = sys.state.load.torque[i] / sys.state.rod.rest[i];
        }
    }
    r
}
