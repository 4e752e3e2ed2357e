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
    s.x0.clone_from(&sys.state.rod.x);
    s.v0.clone_from(&sys.state.rod.v);
    s.spin0.clone_from(&sys.state.rod.spin);
    for a in [&mut s.dx, &mut s.dv] {
        a.clear();
        a.resize(sys.state.rod.nodes(), V3::zeros());
    }
    for a in [&mut s.droll, &mut s.dspin] {
        a.clear();
        a.resize(sys.state.rod.edges(), 0.0);
    }
    let start = sys.state.spindle;
    let support = sys.state.support;
    // the wire keeps coming during the stages, such that the last edge holds its tension (the line
    // behind it is soft); with its length held instead, the far node would pull on wire that does
    // not give
    let inlet_edge = sys.state.rod.edges() - 1;
    let inlet = sys.state.feed.map(|_| {
        (
            sys.state.rod.rest[inlet_edge],
            sys.state.load.tension[inlet_edge],
        )
    });
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
        sys.state.spindle = start.after(reach * dt);
        sys.state.support = support;
        sys.carry_supports(reach * dt);
        sys.place_supports();
        if let Some((_, tension)) = inlet {
            let length = (sys.state.rod.x[inlet_edge + 1] - sys.state.rod.x[inlet_edge]).norm();
            let stretch =
                tension / sys.model.laws.stretch.modulus + sys.state.rod.stretch[inlet_edge].strain;
            sys.state.rod.rest[inlet_edge] = length / (1.0 + stretch);
        }
        sys.evaluate(None);
    }
    if let Some((rest, _)) = inlet {
        sys.state.rod.rest[inlet_edge] = rest;
    }
    let free = sys.free_nodes();
    for i in free {
        sys.state.rod.x[i] = s.x0[i] + s.dx[i];
        sys.state.rod.v[i] = s.v0[i] + s.dv[i];
    }
    for j in 0..sys.state.rod.edges() {
        sys.state.roll[j] = s.droll[j];
        sys.state.rod.spin[j] = s.spin0[j] + s.dspin[j];
    }
    sys.state.time += dt;
    sys.state.spindle = start.after(dt);
    sys.state.support = support;
    sys.carry_supports(dt);
    sys.place_supports();
    sys.feed_step(dt);
    sys.evaluate(Some(dt));
}

/// Adds `share` of this stage's slopes and, unless it is the last, moves to the next stage's place.
fn accumulate(sys: &mut System, s: &mut Stages, share: f64, dt: f64, reach: Option<f64>) {
    let per_length = sys.model.section.mass_per_length();
    let inertia = sys.model.section.spin_inertia_per_length();
    let free = sys.free_nodes();
    let hold = |i: usize, nodes: usize, a: usize| {
        (i == 0 && sys.state.support[0].hold[a]) || (i + 1 == nodes && sys.state.support[1].hold[a])
    };
    let nodes = sys.state.rod.nodes();
    for i in free {
        let v = sys.state.rod.v[i];
        let mut a = sys.state.load.force[i] / (per_length * sys.state.rod.voronoi(i));
        for k in 0..3 {
            if hold(i, nodes, k) {
                a[k] = 0.0;
            }
        }
        s.dx[i] += v * (share * dt);
        s.dv[i] += a * (share * dt);
        if let Some(reach) = reach {
            sys.state.rod.x[i] = s.x0[i] + v * (reach * dt);
            sys.state.rod.v[i] = s.v0[i] + a * (reach * dt);
        }
    }
    if sys.model.twist.is_carried() {
        for j in 0..sys.state.rod.edges() {
            let w = sys.state.rod.spin[j];
            let dw = sys.state.load.torque[j] / (inertia * sys.state.rod.rest[j]);
            s.droll[j] += w * (share * dt);
            s.dspin[j] += dw * (share * dt);
            if let Some(reach) = reach {
                sys.state.roll[j] = w * (reach * dt);
                sys.state.rod.spin[j] = s.spin0[j] + dw * (reach * dt);
            }
        }
    }
}
