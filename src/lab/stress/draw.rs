//! A valid scene from a seed and a number, spread over the whole space of parameters.
//!
//! Lengths and forces are drawn relative to what gives them a meaning (wire diameter, strength, room
//! between core and nozzle), in the logarithm where they span decades. What the scene's own rules
//! refuse is drawn again.

use super::case::built;
use super::case_random::CaseRandom;
use super::coils;
use super::parts::{FINEST, TURNS, contact, freeze, spacing};
use super::signal;
use super::{Bobbin, Case, Kind, Layers, Mesh, Prism};
use crate::settings::SceneSettings;
use std::f64::consts::PI;

/// Draws until a scene is valid; nine of ten are at once, so this many never all fail.
const DRAWS: usize = 200;
/// Case `number` of `seed`, or what the rules had against the last draw.
pub fn case(seed: u64, number: u64) -> Result<Case, String> {
    let mut case_random = CaseRandom::new(seed, number);
    let region = Region::of(seed, number);
    let mut refused = String::new();
    for _ in 0..DRAWS {
        let (settings, mesh, layers) = match region {
            Region::Coils => coils::scene(&mut case_random),
            _ => scene(&mut case_random, region),
        };
        let valid = match &mesh {
            // the file of a mesh is not there yet; a box of its size stands in for it
            Some(mesh) => built(&mesh.stand_in(&settings)),
            None => built(&settings),
        };
        match valid {
            Ok(scene) => {
                let kind = case_random.pick(&Kind::ALL);
                let by_law = settings.traverse.mode != "by-angle";
                let (step, inputs) = signal::draw(&mut case_random, kind, &scene, layers, by_law);
                return Ok(Case {
                    seed,
                    number,
                    kind,
                    settings,
                    mesh,
                    layers,
                    step,
                    inputs,
                });
            }
            Err(error) => refused = error.to_string(),
        }
    }
    Err(format!(
        "case {number} of seed {seed}: no valid scene in {DRAWS} draws, at last: {refused}"
    ))
}

/// Seeds from here on draw coils, see `coils`: those below stay what they were, with runs that are recorded.
pub const COILS_FROM: u64 = 1000;

/// Part of the space that a number draws from. Two of ten numbers have one of their own; the scenes of the others are those
/// of the first generator, in which runs are recorded.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Region {
    /// all but the other two
    Main,
    /// the nozzle turns back: 1 to 4 layers, half of them on a bobbin
    Layers,
    /// wire yields and twist is off
    Untwisted,
    /// coils between flanges, by laws of the traverse
    Coils,
}

impl Region {
    fn of(seed: u64, number: u64) -> Self {
        match number % 10 {
            _ if seed >= COILS_FROM => Self::Coils,
            3 => Self::Layers,
            7 => Self::Untwisted,
            _ => Self::Main,
        }
    }
}

/// A scene that is likely valid, the mesh it needs and the layers it is wound in.
fn scene(case_random: &mut CaseRandom, region: Region) -> (SceneSettings, Option<Mesh>, Layers) {
    let mut s = SceneSettings {
        name: "stress".to_owned(),
        ..SceneSettings::default()
    };
    wire(case_random, &mut s);
    let d = s.wire.diameter;
    let (turning_radius, perimeter, mesh) = match region {
        Region::Layers if case_random.chance(0.5) => bobbin(case_random, &mut s),
        _ => core(case_random, &mut s),
    };

    let room = case_random.log(2e-3 + d, 0.3);
    let near = case_random.chance(0.3);
    let room = if near { 2e-3 + d + 0.1 * room } else { room };
    s.nozzle.distance = turning_radius + d + room;
    if case_random.chance(0.3) {
        s.nozzle.exit_friction = case_random.even(0.0, 0.5);
    }
    let beside = if case_random.chance(0.15) {
        0.6 * room
    } else {
        3.0 * d
    };
    s.nozzle.y_start = s.start.clamp_y + beside * case_random.even(-1.0, 1.0);

    spacing(case_random, &mut s, room, perimeter);
    contact(case_random, &mut s);
    freeze(case_random, &mut s);

    // a turn at 1 rad/s takes as long as a hundred at 100: a few of those will do
    s.spindle.speed = match case_random.chance(0.05) {
        true => case_random.log(1.0, 8.0),
        false => case_random.log(8.0, 2000.0),
    };
    s.spindle.turns = case_random.even(0.25, 2.0);
    s.spindle.ramp_turns = s.spindle.turns * case_random.even(0.05, 0.3);
    s.traverse.per_turn = match case_random.even(0.0, 1.0) {
        x if x < 0.1 => 0.0,
        x if x < 0.6 => d * case_random.even(1.0, 1.1),
        _ => d * case_random.log(0.3, 4.0),
    } * case_random.sign();
    let layers = match region {
        Region::Layers => layers(case_random, &mut s, mesh.as_ref()),
        Region::Main | Region::Untwisted | Region::Coils => Layers::ONE,
    };
    if region == Region::Untwisted {
        (s.wire.elastic, s.wire.strength) = (false, SceneSettings::default().wire.strength);
        s.solver.twist = "off".to_owned();
    }
    (s, mesh, layers)
}

/// A traverse that turns back at the flanges, or after a few turns.
fn layers(case_random: &mut CaseRandom, s: &mut SceneSettings, mesh: Option<&Mesh>) -> Layers {
    let d = s.wire.diameter;
    let pitch = d * case_random.even(1.0, 1.1);
    let (count, turns) = match mesh {
        // as far as wire goes that lies beside either flange
        Some(Mesh::Bobbin(bobbin)) => {
            let turns = (bobbin.width - d) / pitch;
            (
                case_random.even(1.0, 5.0_f64.min(1.0 + TURNS / turns)) as u32,
                turns,
            )
        }
        _ => {
            let count = case_random.pick(&[1, 2, 3, 4]);
            (
                count,
                case_random.even(1.0, (TURNS / f64::from(count)).max(1.2)),
            )
        }
    };
    s.solver.tolerance = s.solver.tolerance_for(d).max(FINEST * d);
    let way = pitch * turns;
    let start = match mesh {
        Some(Mesh::Bobbin(_)) => -0.5 * way,
        _ => s.start.clamp_y,
    };
    (s.start.clamp_y, s.nozzle.y_start, s.traverse.per_turn) = (start, start, pitch);
    s.spindle.turns = turns * f64::from(count);
    s.spindle.ramp_turns = s.spindle.turns.min(2.0) * case_random.even(0.05, 0.3);
    Layers { count, turns }
}

/// A bobbin that one to three turns fill; its largest radius and the way round its barrel, m.
fn bobbin(case_random: &mut CaseRandom, s: &mut SceneSettings) -> (f64, f64, Option<Mesh>) {
    let d = s.wire.diameter;
    let barrel = case_random.log((2.0 * d).max(1.5e-3), 15e-3);
    let bobbin = Bobbin {
        barrel,
        flange: barrel + d * case_random.even(2.0, 6.0),
        width: d * case_random.even(2.1, 4.2),
        thickness: d * case_random.even(1.0, 4.0),
    };
    let c = &mut s.core;
    c.shape = "mesh".to_owned();
    c.corner_radius = 0.5 * bobbin.thickness;
    c.length_y = bobbin.length();
    let found = (bobbin.turning_radius(), 2.0 * PI * barrel);
    (found.0, found.1, Some(Mesh::Bobbin(bobbin)))
}

fn wire(case_random: &mut CaseRandom, s: &mut SceneSettings) {
    let w = &mut s.wire;
    if case_random.chance(0.08) {
        w.material = "table1".to_owned();
        w.diameter = 0.7e-3;
    } else {
        w.diameter = case_random.log(0.05e-3, 3e-3);
        if case_random.chance(0.3) {
            w.yield_stress = case_random.log(50e6, 400e6);
            w.flow_stress = w.yield_stress * case_random.even(1.1, 2.5);
        }
    }
    let d = w.diameter;
    let area = 0.25 * PI * d * d;
    let strength = w.metal().flow_stress * area;
    if case_random.chance(0.12) {
        w.elastic = true;
        w.strength = strength;
    }
    let t = &mut s.tensioner;
    t.tension = if case_random.chance(0.3) {
        case_random.log(0.1, 0.98 * strength)
    } else {
        case_random.log((0.02 * strength).max(0.1), 0.98 * strength)
    };
    // a dancer's inertia goes with the pull it has to give: 1 g at 15 N is 7e-5
    t.mass = match case_random.even(0.0, 1.0) {
        x if x < 0.1 => 0.0,
        x if x < 0.2 => 1e-3,
        _ => t.tension * case_random.log(1e-6, 2e-4),
    };
    t.line_length = if case_random.chance(0.1) {
        0.0
    } else {
        case_random.log(0.05, 3.0)
    };
    t.line_damping_ratio = case_random.log(0.02, 1.0);
}

/// Core and clamp; the largest radius it sweeps and the way round it, m.
fn core(case_random: &mut CaseRandom, s: &mut SceneSettings) -> (f64, f64, Option<Mesh>) {
    let d = s.wire.diameter;
    let c = &mut s.core;
    c.corner_radius = case_random.log(0.2e-3, 10e-3);
    let r = c.corner_radius;
    let mut prism = None;
    let (turning_radius, perimeter) = match case_random.even(0.0, 1.0) {
        x if x < 0.55 => {
            c.width_x = 2.0 * r + case_random.log(0.5e-3, 30e-3);
            c.height_z = 2.0 * r + case_random.log(0.5e-3, 30e-3);
            let flat = [0.5 * c.width_x - r, 0.5 * c.height_z - r];
            let around = 4.0 * (flat[0] + flat[1]) + 2.0 * PI * r;
            (libm::hypot(flat[0], flat[1]) + r, around)
        }
        x if x < 0.8 => {
            c.shape = "cylinder".to_owned();
            c.radius = case_random.log(0.8e-3, 25e-3);
            (c.radius, 2.0 * PI * c.radius)
        }
        _ => {
            c.shape = "mesh".to_owned();
            let p = Prism {
                sides: case_random.pick(&[3, 4, 5, 6, 8]),
                corner_radius: r,
                flat: case_random.log(1e-3, 20e-3),
                length: 0.0,
                dent: 0.0,
            };
            let found = (p.turning_radius(), p.perimeter());
            prism = Some(p);
            found
        }
    };
    c.length_y = (8.0 * d).max(case_random.log(5e-3, 60e-3));
    if let Some(p) = &mut prism {
        p.length = c.length_y;
    }
    s.start.clamp_y = 0.3 * c.length_y * case_random.even(-1.0, 1.0);
    (turning_radius, perimeter, prism.map(Mesh::Prism))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_number_gives_a_valid_scene_and_always_the_same() {
        for number in 0..400 {
            let seed = if number < 200 { 5 } else { COILS_FROM };
            let (a, b) = (case(seed, number).unwrap(), case(seed, number).unwrap());
            assert_eq!(a, b);
            let first = a.inputs[0];
            assert!(a.inputs.len() > 2 && a.step > 0.0);
            assert!(first.tension_setpoint >= 0.0);
            let far = a.inputs.iter().all(|i| {
                i.spindle_speed.abs() <= 2000.0
                    && i.tension_setpoint >= 0.0
                    && i.nozzle_position.abs() < 10.0
            });
            assert!(far, "case {number} leaves the range of the inputs");
        }
    }
}
