//! The same scene in other clothes: results go with the scene.
//!
//! All lengths, times and masses of a scene are multiplied such that density and elastic moduli stay: lengths and times by a
//! power of four, masses by its cube. A power of four rounds nothing, not even where a square root is drawn, so that
//! the scaled wire is the same to the bit. A length or a time that is not the scene's shows at once.

use coilwind::settings::SceneSettings;
use coilwind::signals::Outputs;
use coilwind::simulation::Simulation;
use coilwind::variables::{Access, Causality, Unit, Value, table, units};

/// Power of the length with which values of a unit grow.
fn exponent(unit: &str) -> i32 {
    let known = |u: &&Unit| u.name == unit;
    let base = units().iter().find(known).map_or(&[][..], |u| u.base);
    let powers = base.iter().map(|(name, power)| match *name {
        "kg" => 3 * power,
        "m" | "s" => *power,
        _ => 0,
    });
    powers.sum()
}

/// `fig8` with all that is zero for "by itself" and a length or a time spelled out, and these changes.
fn settings(changes: &[(&str, &str)]) -> SceneSettings {
    let mut settings = SceneSettings::load("fig8").expect("packed");
    let explicit = [
        ("solver.spacing_near", "0.4e-3"),
        ("solver.spacing_free", "3.2e-3"),
        ("solver.refine_distance", "3e-3"),
        ("spindle.turns", "1.6"),
        // the rigidities of the paper's wire are those of one diameter
        ("wire.material", "copper"),
        ("wire.resistivity", "1e-7"),
    ];
    for (name, value) in explicit.iter().chain(changes) {
        settings.set_text(name, value).expect("a valid setting");
    }
    settings
}

/// Winds a scene of which all lengths are `scale` times those of `settings`; its outputs in lengths of the original, by name.
fn wound(settings: &SceneSettings, scale: f64) -> Vec<(&'static str, f64)> {
    let mut scaled = settings.clone();
    for row in table() {
        if let (Causality::Parameter, Access::Parameter { get, .. }) = (row.causality, &row.access)
            && let Value::Real(value) = get(settings)
            && value != 0.0
        {
            let value = value * scale.powi(exponent(row.unit));
            scaled.set(row.name, Value::Real(value)).expect(row.name);
        }
    }
    let mut sim = Simulation::new(&scaled.build().expect("a scene")).expect("starts");
    let end = sim.motion_profile().end();
    while sim.time() < end {
        let left = end - sim.time();
        sim.advance_profile(left.min(1e-3 * scale))
            .expect("goes on");
    }
    outputs(sim.outputs(), scale)
}

fn outputs(of: &Outputs, scale: f64) -> Vec<(&'static str, f64)> {
    let rows = table().iter().filter_map(|row| match row.access {
        Access::Output(get) => match get(of) {
            Value::Real(x) => Some((row.name, x / scale.powi(exponent(row.unit)))),
            Value::Integer(n) => Some((row.name, f64::from(n))),
            Value::Boolean(b) => Some((row.name, f64::from(u8::from(b)))),
            Value::String(_) => None,
        },
        _ => None,
    });
    rows.collect()
}

fn is_the_same_at_every_scale(changes: &[(&str, &str)]) {
    let settings = settings(changes);
    let original = wound(&settings, 1.0);
    for scale in [0.25, 4.0] {
        for (a, b) in original.iter().zip(wound(&settings, scale)) {
            assert_eq!(*a, b, "at {scale} times the length");
        }
    }
}

/// A fixed onset of contact and a fixed reach of Newton's steps moved fed wire by 2.6 % of a diameter.
#[test]
fn every_inner_length_goes_with_the_scene() {
    is_the_same_at_every_scale(&[("spindle.speed", "100")]);
}

#[test]
fn fast_wire_too() {
    is_the_same_at_every_scale(&[("spindle.speed", "500")]);
}

#[test]
fn a_cylinder_too() {
    is_the_same_at_every_scale(&[
        ("core.shape", "cylinder"),
        ("core.radius", "8e-3"),
        ("spindle.speed", "100"),
    ]);
}

/// The other way along the axis is the same coil in a mirror, to the bit.
#[test]
fn traverse_to_either_side() {
    let scene = settings(&[("spindle.speed", "300")]);
    let left = wound(&scene, 1.0);
    let mut mirrored = scene.clone();
    let per_turn = mirrored.traverse.per_turn;
    let other = Value::Real(-per_turn);
    mirrored
        .set("traverse.per_turn", other)
        .expect("a traverse");
    let odd = [
        "layon_position",
        "nozzle_position",
        "nozzle_angle",
        "nozzle_y",
    ];
    for (a, b) in left.iter().zip(wound(&mirrored, 1.0)) {
        let sign = if odd.contains(&a.0) { -1.0 } else { 1.0 };
        assert_eq!((a.0, sign * a.1), b);
    }
}
