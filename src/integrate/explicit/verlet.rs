//! Velocity Verlet in staggered form: one evaluation a step.
//!
//! Velocities live half a step behind the positions. Symplectic for the springs, so the rod
//! loses no energy to the scheme; stable below `2 / omega_max`. Contact dashpots see the
//! velocity of half a step before.

use crate::system::System;

/// Advances by `dt`: kick, drift, feed, then the forces at the new place.
///
/// The system must hold evaluated forces (`System::evaluate`) on entry; it does again on exit.
pub(super) fn step(sys: &mut System, dt: f64) {
    kick_and_drift(sys, dt);
    sys.state.time += dt;
    sys.state.spindle = sys.state.spindle.after(dt);
    sys.carry_supports(dt);
    sys.place_supports();
    sys.feed_step(dt);
    sys.scratch.velocity_lag = 0.5 * dt;
    sys.evaluate(Some(dt));
    sys.scratch.velocity_lag = 0.0;
}

/// Moves the velocities by the present forces over `half` a step, s: `dt / 2` brings them to the time of
/// the positions, `-dt / 2` back.
///
/// Changes of the wire between steps (inserts, freezes) belong in between. Otherwise the change of force does work
/// over half a step that is in no account of the energy balance.
pub fn shift_velocities(sys: &mut System, half: f64) {
    let per_length = sys.model.section.mass_per_length();
    for i in sys.free_nodes() {
        let m = per_length * sys.state.rod.voronoi(i);
        sys.state.rod.v[i] += sys.state.load.force[i] * (half / m);
    }
    if sys.model.twist.is_carried() {
        let inertia = sys.model.section.spin_inertia_per_length();
        for j in 0..sys.state.rod.edges() {
            sys.state.rod.spin[j] +=
                sys.state.load.torque[j] * (half / (inertia * sys.state.rod.rest[j]));
        }
    }
}

fn kick_and_drift(sys: &mut System, dt: f64) {
    let per_length = sys.model.section.mass_per_length();
    let free = sys.free_nodes();
    let rod = &mut sys.state.rod;
    for i in free.clone() {
        let m = per_length * rod.voronoi(i);
        rod.v[i] += sys.state.load.force[i] * (dt / m);
    }
    for (end, i) in [(0, 0), (1, rod.x.len() - 1)] {
        for a in 0..3 {
            if sys.state.support[end].hold[a] && free.contains(&i) {
                rod.v[i][a] = sys.state.support[end].velocity[a];
            }
        }
    }
    for i in free {
        rod.x[i] += rod.v[i] * dt;
    }
    if sys.model.twist.is_carried() {
        let inertia = sys.model.section.spin_inertia_per_length();
        for j in 0..rod.rest.len() {
            rod.spin[j] += sys.state.load.torque[j] * (dt / (inertia * rod.rest[j]));
            sys.state.roll[j] = rod.spin[j] * dt;
        }
    }
}
