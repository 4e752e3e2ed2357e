//! Coils between flanges: layers by a law of the traverse, enamelled and fine wire, cores with hollow sides.
//!
//! Everything goes with the wire's outer diameter, so that the finest wire winds what the thickest does.

use super::case_random::CaseRandom;
use super::parts::{self, TURNS};
use super::{Bobbin, Layers, Mesh, Prism};
use crate::settings::SceneSettings;
use std::f64::consts::PI;

/// What is to be wound: outer diameter of the wire and width of the winding, m, and layers.
#[derive(Clone, Copy)]
struct Coil {
    outer: f64,
    window: f64,
    count: u32,
}

/// A core: the largest radius that it sweeps and the way round it, m, and its file.
type Core = (f64, f64, Option<Mesh>);

/// A scene that is likely valid, the mesh it needs and the layers it is wound in.
pub(super) fn scene(case_random: &mut CaseRandom) -> (SceneSettings, Option<Mesh>, Layers) {
    let mut s = SceneSettings {
        name: "stress".to_owned(),
        ..SceneSettings::default()
    };
    wire(case_random, &mut s);
    let outer = s.wire.diameter.max(s.wire.enamelled_diameter);
    let count = case_random.pick(&[1, 1, 2, 2, 3, 4]);
    let most = (TURNS / f64::from(count)).max(1.0);
    // half a turn more fits than there are, or as much as turns take that lie loose
    let turns = case_random.even(1.0, most + 1.0).floor().min(most.ceil());
    let pitch = outer * case_random.even(1.0, 1.06);
    let window = pitch * (turns - 0.5) + outer + outer * case_random.even(0.0, 0.2);
    let coil = Coil {
        outer,
        window,
        count,
    };
    let (radius, perimeter, mesh) = match case_random.even(0.0, 1.0) {
        x if x < 0.4 => {
            s.core.shape = "cylinder".to_owned();
            s.core.radius = sized(case_random, outer, 4.0);
            flanges(case_random, &mut s, coil);
            let rim = s.core.radius + s.core.flange.height;
            (rim, 2.0 * PI * s.core.radius, None)
        }
        x if x < 0.75 => rounded_box(case_random, &mut s, coil),
        x if x < 0.9 => bobbin(case_random, &mut s, coil),
        _ => hollow(case_random, &mut s, outer),
    };
    s.core.length_y = s.core.length_y.max(window + 8.0 * outer);

    let room = outer * case_random.log(10.0, 150.0) + 2e-3;
    s.nozzle.distance = radius + outer + room;
    let start = 0.5 * (outer - window);
    (s.start.clamp_y, s.nozzle.y_start) = (start, start);
    s.traverse.per_turn = pitch;
    let t = &mut s.traverse;
    t.mode = case_random
        .pick(&["orthocyclic", "orthocyclic", "helical", "by-angle"])
        .to_owned();
    t.crossover = case_random.even(0.3, 2.0);
    t.advance = case_random.even(0.0, 2.0);
    t.dwell_turns = case_random.even(0.0, 0.5);
    s.winding.layers = f64::from(count);
    if s.core.flange.inner_distance == 0.0 {
        (s.winding.turns_per_layer, s.winding.pitch) = (turns, pitch);
    }
    parts::spacing(case_random, &mut s, room, perimeter);
    s.solver.tolerance = s.solver.tolerance_for(outer).max(parts::FINEST * outer);
    parts::contact(case_random, &mut s);
    parts::freeze(case_random, &mut s);
    s.spindle.speed = case_random.log(8.0, 1500.0);
    s.spindle.turns = turns * f64::from(count) * case_random.even(0.6, 1.0);
    s.spindle.ramp_turns = s.spindle.turns.min(2.0) * case_random.even(0.05, 0.3);
    (s, mesh, Layers { count, turns })
}

/// Wire from 0.02 mm on, most of it enamelled.
fn wire(case_random: &mut CaseRandom, s: &mut SceneSettings) {
    let w = &mut s.wire;
    w.diameter = case_random.log(0.02e-3, 2e-3);
    if case_random.chance(0.7) {
        w.enamelled_diameter = w.diameter * case_random.even(1.03, 1.3);
    }
    if case_random.chance(0.3) {
        w.yield_stress = case_random.log(50e6, 400e6);
        w.flow_stress = w.yield_stress * case_random.even(1.1, 2.5);
    }
    let strength = w.metal().flow_stress * 0.25 * PI * w.diameter * w.diameter;
    if case_random.chance(0.1) {
        (w.elastic, w.strength) = (true, strength);
    }
    let t = &mut s.tensioner;
    t.tension = strength * case_random.log(0.03, 0.9);
    t.mass = t.tension * case_random.log(1e-6, 2e-4);
    t.line_length = case_random.log(0.05, 3.0);
    t.line_damping_ratio = case_random.log(0.02, 1.0);
}

/// So many diameters or a length that is worth winding on, m.
fn sized(case_random: &mut CaseRandom, outer: f64, least: f64) -> f64 {
    (outer * case_random.log(least, 60.0)).clamp(0.5e-3, 15e-3)
}

fn flanges(case_random: &mut CaseRandom, s: &mut SceneSettings, coil: Coil) {
    let Coil {
        outer,
        window,
        count,
    } = coil;
    let f = &mut s.core.flange;
    f.inner_distance = window;
    f.height = outer * (f64::from(count) + case_random.even(0.5, 2.5));
    f.thickness = outer * case_random.even(1.0, 4.0);
    f.edge_radius = f.thickness * case_random.even(0.1, 0.45);
    if case_random.chance(0.2) {
        f.insulation = outer * case_random.even(0.05, 0.3);
        f.inner_distance += 2.0 * f.insulation;
    }
}

fn rounded_box(case_random: &mut CaseRandom, s: &mut SceneSettings, coil: Coil) -> Core {
    let outer = coil.outer;
    let r = outer * case_random.log(1.0, 8.0);
    s.core.corner_radius = r;
    s.core.width_x = 2.0 * r + sized(case_random, outer, 2.0);
    s.core.height_z = 2.0 * r + sized(case_random, outer, 2.0);
    flanges(case_random, s, coil);
    let flat = [0.5 * s.core.width_x - r, 0.5 * s.core.height_z - r];
    let around = 4.0 * (flat[0] + flat[1]) + 2.0 * PI * r;
    (
        libm::hypot(flat[0], flat[1]) + r + s.core.flange.height,
        around,
        None,
    )
}

fn bobbin(case_random: &mut CaseRandom, s: &mut SceneSettings, coil: Coil) -> Core {
    let Coil {
        outer,
        window,
        count,
    } = coil;
    let barrel = sized(case_random, outer, 4.0);
    let bobbin = Bobbin {
        barrel,
        flange: barrel + outer * (f64::from(count) + case_random.even(0.5, 2.5)),
        width: window,
        thickness: outer * case_random.even(1.0, 4.0),
    };
    s.core.shape = "mesh".to_owned();
    s.core.corner_radius = 0.5 * bobbin.thickness;
    s.core.length_y = bobbin.length();
    (
        bobbin.turning_radius(),
        2.0 * PI * barrel,
        Some(Mesh::Bobbin(bobbin)),
    )
}

/// A prism whose sides are hollow: wire spans them.
fn hollow(case_random: &mut CaseRandom, s: &mut SceneSettings, outer: f64) -> Core {
    let sides = case_random.pick(&[3, 4, 5, 6]);
    let corner_radius = outer * case_random.log(1.0, 8.0);
    let flat = 2.0 * sized(case_random, outer, 4.0);
    let to_flat = 0.5 * flat / libm::tan(PI / f64::from(sides));
    let prism = Prism {
        sides,
        corner_radius,
        flat,
        length: outer * case_random.even(12.0, 30.0),
        dent: to_flat.min(0.3 * flat) * case_random.even(0.05, 0.8),
    };
    s.core.shape = "mesh".to_owned();
    (s.core.corner_radius, s.core.length_y) = (corner_radius, prism.length);
    (
        prism.turning_radius(),
        prism.perimeter(),
        Some(Mesh::Prism(prism)),
    )
}
