//! A valid scene from a seed and a number, spread over the whole space of parameters.
//!
//! Lengths and forces are drawn relative to what gives them a meaning (wire diameter, strength, room
//! between core and nozzle), in the logarithm where they span decades. What the scene's own rules
//! refuse is drawn again.

use super::dice::Dice;
use super::prism::Prism;
use super::signal;
use super::{Case, Kind};
use crate::scene::SceneSettings;
use std::f64::consts::PI;

/// Draws until a scene is valid; nine of ten are at once, so this many never all fail.
const DRAWS: usize = 200;
/// Edges of one turn on the core that a scene may ask for: bounds the cost of a case, not its kind.
const EDGES_PER_TURN: f64 = 300.0;

/// Case `number` of `seed`, or what the rules had against the last draw.
pub fn case(seed: u64, number: u64) -> Result<Case, String> {
    let mut dice = Dice::new(seed, number);
    let mut refused = String::new();
    for _ in 0..DRAWS {
        let (settings, prism) = scene(&mut dice);
        let valid = match &prism {
            // the file of a mesh is not there yet; a box of its size stands in for it
            Some(prism) => prism.stand_in(&settings).build(),
            None => settings.build(),
        };
        match valid {
            Ok(scene) => {
                let kind = dice.pick(&Kind::ALL);
                let (step, inputs) = signal::draw(&mut dice, kind, &scene);
                return Ok(Case {
                    seed,
                    number,
                    kind,
                    settings,
                    prism,
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

/// A scene that is likely valid, and the mesh it needs.
fn scene(dice: &mut Dice) -> (SceneSettings, Option<Prism>) {
    let mut s = SceneSettings::default();
    s.name = "stress".to_owned();
    wire(dice, &mut s);
    let d = s.wire.diameter;
    let (turning_radius, perimeter, prism) = core(dice, &mut s);

    let room = dice.log(2e-3 + d, 0.3);
    let near = dice.chance(0.3);
    let room = if near { 2e-3 + d + 0.1 * room } else { room };
    s.nozzle.distance = turning_radius + d + room;
    if dice.chance(0.3) {
        s.nozzle.exit_friction = dice.even(0.0, 0.5);
    }
    let beside = if dice.chance(0.15) {
        0.6 * room
    } else {
        3.0 * d
    };
    s.nozzle.y_start = s.start.clamp_y + beside * dice.even(-1.0, 1.0);

    spacing(dice, &mut s, room, perimeter);
    contact(dice, &mut s);
    freeze(dice, &mut s);

    // a turn at 1 rad/s takes as long as a hundred at 100: a few of those will do
    s.spindle.speed = match dice.chance(0.05) {
        true => dice.log(1.0, 8.0),
        false => dice.log(8.0, 2000.0),
    };
    s.spindle.turns = dice.even(0.25, 2.0);
    s.spindle.ramp_turns = s.spindle.turns * dice.even(0.05, 0.3);
    s.traverse.per_turn = match dice.even(0.0, 1.0) {
        x if x < 0.1 => 0.0,
        x if x < 0.6 => d * dice.even(1.0, 1.1),
        _ => d * dice.log(0.3, 4.0),
    } * dice.sign();
    (s, prism)
}

fn wire(dice: &mut Dice, s: &mut SceneSettings) {
    let w = &mut s.wire;
    if dice.chance(0.08) {
        w.material = "table1".to_owned();
        w.diameter = 0.7e-3;
    } else {
        w.diameter = dice.log(0.05e-3, 3e-3);
        if dice.chance(0.3) {
            w.yield_stress = dice.log(50e6, 400e6);
            w.flow_stress = w.yield_stress * dice.even(1.1, 2.5);
        }
    }
    let d = w.diameter;
    let area = 0.25 * PI * d * d;
    let strength = w.flow_stress * area;
    if dice.chance(0.12) {
        w.elastic = true;
        w.strength = strength;
    }
    let t = &mut s.tensioner;
    t.tension = if dice.chance(0.3) {
        dice.log(0.1, 0.98 * strength)
    } else {
        dice.log((0.02 * strength).max(0.1), 0.98 * strength)
    };
    // a dancer's inertia goes with the pull it has to give: 1 g at 15 N is 7e-5
    t.mass = match dice.even(0.0, 1.0) {
        x if x < 0.1 => 0.0,
        x if x < 0.2 => 1e-3,
        _ => t.tension * dice.log(1e-6, 2e-4),
    };
    t.line_length = if dice.chance(0.1) {
        0.0
    } else {
        dice.log(0.05, 3.0)
    };
    t.line_damping_ratio = dice.log(0.02, 1.0);
}

/// Core and clamp; the largest radius it sweeps and the way round it, m.
fn core(dice: &mut Dice, s: &mut SceneSettings) -> (f64, f64, Option<Prism>) {
    let d = s.wire.diameter;
    let c = &mut s.core;
    c.corner_radius = dice.log(0.2e-3, 10e-3);
    let r = c.corner_radius;
    let mut prism = None;
    let (turning_radius, perimeter) = match dice.even(0.0, 1.0) {
        x if x < 0.55 => {
            c.width_x = 2.0 * r + dice.log(0.5e-3, 30e-3);
            c.height_z = 2.0 * r + dice.log(0.5e-3, 30e-3);
            let flat = [0.5 * c.width_x - r, 0.5 * c.height_z - r];
            let around = 4.0 * (flat[0] + flat[1]) + 2.0 * PI * r;
            (libm::hypot(flat[0], flat[1]) + r, around)
        }
        x if x < 0.8 => {
            c.shape = "cylinder".to_owned();
            c.radius = dice.log(0.8e-3, 25e-3);
            (c.radius, 2.0 * PI * c.radius)
        }
        _ => {
            c.shape = "mesh".to_owned();
            let p = Prism {
                sides: dice.pick(&[3, 4, 5, 6, 8]),
                corner_radius: r,
                flat: dice.log(1e-3, 20e-3),
                length: 0.0,
            };
            let found = (p.turning_radius(), p.perimeter());
            prism = Some(p);
            found
        }
    };
    c.length_y = (8.0 * d).max(dice.log(5e-3, 60e-3));
    if let Some(p) = &mut prism {
        p.length = c.length_y;
    }
    s.start.clamp_y = 0.3 * c.length_y * dice.even(-1.0, 1.0);
    (turning_radius, perimeter, prism)
}

fn spacing(dice: &mut Dice, s: &mut SceneSettings, room: f64, perimeter: f64) {
    let d = s.wire.diameter;
    let v = &mut s.solver;
    if dice.chance(0.5) {
        v.tolerance = dice.log(1e-7, (0.1 * d).min(2e-5));
    }
    let pick = dice.pick(&["auto", "auto", "auto", "off", "quasi-static", "dynamic"]);
    // without twist the set of wire that yields turns into nothing that balances
    v.twist = match s.wire.elastic || pick != "off" {
        true => pick.to_owned(),
        false => "auto".to_owned(),
    };
    let coarsest = (10.0 * d).min(1.5e-3).min(room / 4.0);
    if dice.chance(0.4) {
        v.spacing_near = dice.log((0.1 * d).max(0.1e-3).min(coarsest), coarsest);
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
    if room / 3.0 < 3.3e-3 || dice.chance(0.3) {
        v.spacing_free = dice.log(near, (room / 3.0).max(near));
    }
}

fn contact(dice: &mut Dice, s: &mut SceneSettings) {
    s.friction.static_ = if dice.chance(0.1) {
        0.0
    } else {
        dice.even(0.0, 1.0)
    };
    s.friction.kinetic = s.friction.static_ * dice.even(0.3, 1.0);
    s.friction.slip_speed = dice.log(1e-3, 0.1);
    s.contact.restitution = dice.even(0.0, 1.0);
    if dice.chance(0.2) {
        s.contact.stiffness = dice.log(3e9, 5e10);
    }
}

fn freeze(dice: &mut Dice, s: &mut SceneSettings) {
    if dice.chance(0.1) {
        s.freeze.enabled = false;
    }
    if dice.chance(0.1) {
        s.freeze.window = dice.log(0.3, 3.0);
        s.freeze.creep = dice.log(0.5e-6, 20e-6);
    }
    if dice.chance(0.1) {
        s.freeze.keep_length = dice.log(3e-3, 50e-3);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_number_gives_a_valid_scene_and_always_the_same() {
        for number in 0..200 {
            let (a, b) = (case(5, number).unwrap(), case(5, number).unwrap());
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
