//! What scenes of all kinds draw alike: spacing of nodes, contact, when wire freezes.

use super::case_random::CaseRandom;
use crate::settings::SceneSettings;

/// Edges of one turn on the core that a scene may ask for: bounds the cost of a case, not its kind.
const EDGES_PER_TURN: f64 = 300.0;

/// Turns of a scene with layers, and its finest tolerance in wire diameters: they bound the cost of a case as well.
pub(super) const TURNS: f64 = 5.0;
pub(super) const FINEST: f64 = 1e-3;

/// Tolerance, twist and spacing of a scene with `room` between core and nozzle and a way `perimeter` round the core, m.
pub(super) fn spacing(
    case_random: &mut CaseRandom,
    s: &mut SceneSettings,
    room: f64,
    perimeter: f64,
) {
    let d = s.wire.diameter;
    let v = &mut s.solver;
    if case_random.chance(0.5) {
        v.tolerance = case_random.log(1e-7, (0.1 * d).min(2e-5));
    }
    let pick = case_random.pick(&["auto", "auto", "auto", "off", "quasi-static", "dynamic"]);
    // (wire that yields without twist has a part of the space of its own)
    v.twist = match s.wire.elastic || pick != "off" {
        true => pick.to_owned(),
        false => "auto".to_owned(),
    };
    let coarsest = (10.0 * d).min(1.5e-3).min(room / 4.0);
    if case_random.chance(0.4) {
        v.spacing_near = case_random.log((0.1 * d).max(0.1e-3).min(coarsest), coarsest);
    }
    let near = if v.spacing_near > 0.0 {
        v.spacing_near
    } else {
        0.4e-3
    };
    if near < perimeter / EDGES_PER_TURN {
        v.spacing_near = (perimeter / EDGES_PER_TURN).min(10.0 * d);
    }
    if near < 0.1 * d || near > coarsest {
        v.spacing_near = near.clamp(0.1 * d, coarsest.max(0.1 * d));
    }
    let near = if v.spacing_near > 0.0 {
        v.spacing_near
    } else {
        near
    };
    if room / 3.0 < 3.3e-3 || case_random.chance(0.3) {
        v.spacing_free = case_random.log(near, (room / 3.0).max(near));
    }
}

/// Friction, restitution and stiffness.
pub(super) fn contact(case_random: &mut CaseRandom, s: &mut SceneSettings) {
    s.friction.static_ = if case_random.chance(0.1) {
        0.0
    } else {
        case_random.even(0.0, 1.0)
    };
    s.friction.kinetic = s.friction.static_ * case_random.even(0.3, 1.0);
    s.friction.slip_speed = case_random.log(1e-3, 0.1);
    s.contact.restitution = case_random.even(0.0, 1.0);
    if case_random.chance(0.2) {
        s.contact.stiffness = case_random.log(3e9, 5e10);
    }
}

/// Whether and when wire freezes.
pub(super) fn freeze(case_random: &mut CaseRandom, s: &mut SceneSettings) {
    if case_random.chance(0.1) {
        s.freeze.enabled = false;
    }
    if case_random.chance(0.1) {
        s.freeze.window = case_random.log(0.3, 3.0);
        s.freeze.creep = case_random.log(0.5e-6, 20e-6);
    }
    if case_random.chance(0.1) {
        s.freeze.keep_length = case_random.log(3e-3, 50e-3);
    }
}
