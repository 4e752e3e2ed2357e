//! Classical Runge-Kutta of order four, as the paper uses it.
//!
//! Unknowns are positions, velocities, the roll of each edge since the step began, and spins;
//! frames follow from the tangents. Plastic state and friction anchors stay those of the step's
//! start during its stages and move on at its end, so that a rejected stage leaves no trace. The
//! feed takes its own implicit step at the end of each step (first order in the line's dashpot).
//! Stable below `2.83 / omega_max` on the imaginary axis.

use crate::math::V3;
use crate::system::System;

/// Work arrays of the stages; no state.
#[derive(Debug, Default)]
pub(super) struct Stages {
    x0: Vec<V3>,
    v0: Vec<V3>,
    spin0: Vec<f64>,
    dx: Vec<V3>,
    dv: Vec<V3>,
    droll: Vec<f64>,
    dspin: Vec<f64>,
}

/// Advances by `dt`, s. Forces must be evaluated on entry and are on exit.
pub(super) fn step(sys: &mut System, s: &mut Stages, dt: f64) {
    s.x0.clone_from(&sys.rod.x);
    s.v0.clone_from(&sys.rod.v);
    s.spin0.clone_from(&sys.rod.spin);
    for a in [&mut s.dx, &mut s.dv] {
        a.clear();
        a.resize(sys.rod.nodes(), V3::zeros());
    }
    for a in [&mut s.droll, &mut s.dspin] {
        a.clear();
        a.resize(sys.rod.edges(), 0.0);
    }
    let start = sys.spindle;
    let support = sys.support;
    // the wire keeps coming during the stages, such that the last edge holds its tension (the line
    // behind it is soft); with its length held instead, the far node would pull on wire that does
    // not give
    let inlet_edge = sys.rod.edges() - 1;
    let inlet = sys
        .feed
        .map(|_| (sys.rod.rest[inlet_edge], sys.load.tension[inlet_edge]));
    // the forces of the first stage are those of the last evaluation
    for (stage, (weight, reach)) in [(1.0, 0.5), (2.0, 0.5), (2.0, 1.0), (1.0, 0.0)]
        .into_iter()
        .enumerate()
    {
        let last = stage == 3;
        accumulate(
            sys,
            s,
            weight / 6.0,
            dt,
            if last { None } else { Some(reach) },
        );
        if last {
            break;
        }
        sys.spindle = start.after(reach * dt);
        sys.support = support;
        sys.carry_supports(reach * dt);
        sys.place_supports();
        if let Some((_, tension)) = inlet {
            let length = (sys.rod.x[inlet_edge + 1] - sys.rod.x[inlet_edge]).norm();
            let stretch = tension / sys.laws.stretch.modulus + sys.rod.stretch[inlet_edge].strain;
            sys.rod.rest[inlet_edge] = length / (1.0 + stretch);
        }
        sys.evaluate(None);
    }
    if let Some((rest, _)) = inlet {
        sys.rod.rest[inlet_edge] = rest;
    }
    let free = sys.free_nodes();
    for i in free {
        sys.rod.x[i] = s.x0[i] + s.dx[i];
        sys.rod.v[i] = s.v0[i] + s.dv[i];
    }
    for j in 0..sys.rod.edges() {
        sys.roll[j] = s.droll[j];
        sys.rod.spin[j] = s.spin0[j] + s.dspin[j];
    }
    sys.time += dt;
    sys.spindle = start.after(dt);
    sys.support = support;
    sys.carry_supports(dt);
    sys.place_supports();
    sys.feed_step(dt);
    sys.evaluate(Some(dt));
}

/// Adds `share` of this stage's slopes and, unless it is the last, moves to the next stage's place.
fn accumulate(sys: &mut System, s: &mut Stages, share: f64, dt: f64, reach: Option<f64>) {
    let per_length = sys.section.mass_per_length();
    let inertia = sys.section.spin_inertia_per_length();
    let free = sys.free_nodes();
    let hold = |i: usize, nodes: usize, a: usize| {
        (i == 0 && sys.support[0].hold[a]) || (i + 1 == nodes && sys.support[1].hold[a])
    };
    let nodes = sys.rod.nodes();
    for i in free {
        let v = sys.rod.v[i];
        let mut a = sys.load.force[i] / (per_length * sys.rod.voronoi(i));
        for k in 0..3 {
            if hold(i, nodes, k) {
                a[k] = 0.0;
            }
        }
        s.dx[i] += v * (share * dt);
        s.dv[i] += a * (share * dt);
        if let Some(reach) = reach {
            sys.rod.x[i] = s.x0[i] + v * (reach * dt);
            sys.rod.v[i] = s.v0[i] + a * (reach * dt);
        }
    }
    if sys.twist.is_carried() {
        for j in 0..sys.rod.edges() {
            let w = sys.rod.spin[j];
            let dw = sys.load.torque[j] / (inertia * sys.rod.rest[j]);
            s.droll[j] += w * (share * dt);
            s.dspin[j] += dw * (share * dt);
            if let Some(reach) = reach {
                sys.roll[j] = w * (reach * dt);
                sys.rod.spin[j] = s.spin0[j] + dw * (reach * dt);
            }
        }
    }
}
