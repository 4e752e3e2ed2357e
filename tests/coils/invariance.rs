//! The same scene in other placement: results go with the scene.
//!
//! All lengths, times and masses of a scene are multiplied such that density and elastic moduli stay: lengths and times by a
//! power of four, masses by its cube. A power of four rounds nothing, not even where a square root is drawn, so that
//! the scaled wire is the same to the bit. A length or a time that is not the scene's shows at once.
//!
//! A scene that is turned about the axis of the core, or a mirror image, rounds otherwise, and its coil is the same but for that.

use coilwind::settings::SceneSettings;
use coilwind::signals::{Inputs, Outputs};
use coilwind::simulation::Simulation;
use coilwind::variables::{Access, Causality, Unit, Value, table, units};

/// A scene like another one: its lengths, times and masses are these powers of one factor times the other's.
#[derive(Clone, Copy)]
struct Like {
    lengths: i32,
    times: i32,
    masses: i32,
}

/// Of another size, with the same metal.
const LARGER: Like = Like {
    lengths: 1,
    times: 1,
    masses: 3,
};

/// Of the same size and with the same forces, of heavier metal.
const HEAVIER: Like = Like {
    lengths: 0,
    times: 1,
    masses: 2,
};

/// Of the same size and as fast, of heavier metal with stronger forces.
const STRONGER: Like = Like {
    lengths: 0,
    times: 0,
    masses: 1,
};

impl Like {
    /// Power of the factor with which values of a unit grow.
    fn exponent(self, unit: &str) -> i32 {
        let known = |u: &&Unit| u.name == unit;
        let base = units().iter().find(known).map_or(&[][..], |u| u.base);
        let powers = base.iter().map(|(name, power)| match *name {
            "kg" => self.masses * power,
            "m" => self.lengths * power,
            "s" => self.times * power,
            _ => 0,
        });
        powers.sum()
    }
}

/// `fig8` with these changes. Spacing and tolerance that nobody gives go with the wire.
fn settings(changes: &[(&str, &str)]) -> SceneSettings {
    let mut settings = SceneSettings::load("fig8").expect("packed");
    let explicit = [
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

/// Winds a scene like that of `settings`, the factor being `scale`; its outputs in units of the original, by name.
fn wound(settings: &SceneSettings, like: Like, scale: f64) -> Vec<(&'static str, f64)> {
    let mut scaled = settings.clone();
    for row in table() {
        if let (Causality::Parameter, Access::Parameter { get, .. }) = (row.causality, &row.access)
            && let Value::Real(value) = get(settings)
            && value != 0.0
        {
            let value = value * scale.powi(like.exponent(row.unit));
            scaled.set(row.name, Value::Real(value)).expect(row.name);
        }
    }
    let mut sim = Simulation::new(&scaled.build().expect("a scene")).expect("starts");
    let end = sim.motion_profile().end();
    while sim.time() < end {
        let left = end - sim.time();
        sim.advance_profile(left.min(1e-3 * scale.powi(like.times)))
            .expect("goes on");
    }
    outputs(sim.outputs(), like, scale)
}

fn outputs(of: &Outputs, like: Like, scale: f64) -> Vec<(&'static str, f64)> {
    let rows = table().iter().filter_map(|row| match row.access {
        Access::Output(get) => match get(of) {
            Value::Real(x) => Some((row.name, x / scale.powi(like.exponent(row.unit)))),
            Value::Integer(n) => Some((row.name, f64::from(n))),
            Value::Boolean(b) => Some((row.name, f64::from(u8::from(b)))),
            Value::String(_) => None,
        },
        _ => None,
    });
    rows.collect()
}

fn is_the_same_in_all(like: Like, changes: &[(&str, &str)]) {
    let settings = settings(changes);
    let original = wound(&settings, like, 1.0);
    for scale in [0.25, 4.0] {
        for (a, b) in original.iter().zip(wound(&settings, like, scale)) {
            assert_eq!(*a, b, "with a factor of {scale}");
        }
    }
}

fn is_the_same_at_every_scale(changes: &[(&str, &str)]) {
    is_the_same_in_all(LARGER, changes);
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

/// Spacings of half a millimetre and facets of the core of half a micrometre moved fed wire by a tenth of a diameter.
#[test]
fn the_explicit_methods_too() {
    for shape in ["rounded-box", "cylinder"] {
        is_the_same_at_every_scale(&[
            ("core.shape", shape),
            ("solver.integrator", "verlet"),
            ("spindle.ramp_turns", "0.1"),
            ("spindle.turns", "0.13"),
            ("spindle.speed", "400"),
        ]);
    }
}

/// Densities that 16 times as much, and a sixteenth, are allowed of.
const LIGHT: [(&str, &str); 2] = [("wire.density", "1600"), ("wire.enamel_density", "600")];

/// The first step went with the diameter alone, and moved the tension by up to 0.4 % before the wire landed.
#[test]
fn heavier_wire_with_slower_spindle() {
    for speed in ["100", "400"] {
        let changes = [&LIGHT[..], &[("spindle.speed", speed)]].concat();
        is_the_same_in_all(HEAVIER, &changes);
    }
}

#[test]
fn heavier_wire_on_a_line_with_mass() {
    let line = [
        ("tensioner.line_inertia", "true"),
        ("tensioner.pulley_mass", "2e-3"),
        ("core.shape", "cylinder"),
        ("core.radius", "8e-3"),
        ("spindle.speed", "100"),
    ];
    is_the_same_in_all(HEAVIER, &[&LIGHT[..], &line].concat());
}

/// A force that is not the scene's shows here.
#[test]
fn stronger_wire_under_more_tension() {
    let wire = [
        ("wire.material", "custom"),
        ("wire.EA", "4.9e4"),
        ("wire.EAp", "1.1e3"),
        ("wire.EI", "1.5e-3"),
        ("wire.EIp", "1.1e-4"),
        ("wire.GJ", "1.1e-3"),
        ("wire.GJp", "9e-5"),
        ("wire.N_y", "60"),
        ("wire.M_y", "8e-3"),
        ("wire.T_y", "7e-3"),
        ("wire.moment_cap", "12e-3"),
        ("wire.strength", "90"),
        ("spindle.speed", "200"),
    ];
    is_the_same_in_all(STRONGER, &[&LIGHT[..], &wire].concat());
}

/// The other way along the axis is the same coil in a mirror, to the bit.
#[test]
fn traverse_to_either_side() {
    let scene = settings(&[("spindle.speed", "300")]);
    let left = wound(&scene, LARGER, 1.0);
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
    for (a, b) in left.iter().zip(wound(&mirrored, LARGER, 1.0)) {
        let sign = if odd.contains(&a.0) { -1.0 } else { 1.0 };
        assert_eq!((a.0, sign * a.1), b);
    }
}

/// A wind that a machine drives, turned about the axis of the core by `turned` (rad), in a mirror along y and in one along z.
#[derive(Clone, Copy)]
struct Placement {
    turned: f64,
    other_side: bool,
    other_way: bool,
}

const PLAIN: Placement = Placement {
    turned: 0.0,
    other_side: false,
    other_way: false,
};

/// Wire fed, free length, lay-on place, bulge and gap after each millisecond of 1.6 turns, as those of the plain scene, and
/// turns laid.
fn driven(settings: &SceneSettings, placement: Placement) -> Vec<([f64; 5], f64)> {
    let scene = settings.build().expect("a scene");
    let sign = |other: bool| if other { -1.0 } else { 1.0 };
    let (side, way) = (sign(placement.other_side), sign(placement.other_way));
    let (sin, cos) = placement.turned.sin_cos();
    let distance = scene.nozzle.distance;
    let inputs = |angle: f64, speed: f64| Inputs {
        spindle_speed: way * speed,
        nozzle_position: side * scene.traverse.per_turn * angle / std::f64::consts::TAU,
        tension_setpoint: scene.tensioner.tension,
        nozzle_offset_x: distance * cos - distance,
        nozzle_offset_z: distance * sin,
        ..Inputs::HELD
    };
    let (most, step) = (scene.spindle.speed, 1e-3);
    let mut sim = Simulation::starting_with(&scene, inputs(0.0, 0.01)).expect("starts");
    let (mut angle, mut speed, mut seen) = (0.0, 0.0, Vec::new());
    while angle < 1.6 * std::f64::consts::TAU {
        speed = f64::min(speed + 0.02 * most, most);
        angle += speed * step;
        sim.advance(inputs(angle, speed), step).expect("goes on");
        let o = sim.outputs();
        seen.push((
            [
                o.fed_length,
                o.free_length,
                side * o.layon_position,
                o.bulge_height,
                o.gap_width,
            ],
            way * o.turns_wound,
        ));
    }
    seen
}

/// What rounding makes of a coil, diameters.
const ROUNDED: f64 = 1e-9;
/// The same where a solve of one of the two takes an iterate more, since its update was next to what counts as close. They part by
/// 2e-6 diameters there, and by a thousand times as much in the second turn.
const ONE_ITERATE_MORE: f64 = 0.01;

/// Winds the scene in both placements: the same coil, and to rounding until wire is bent round the first corner.
fn winds_the_same_coil(changes: &[(&str, &str)], placement: Placement, most: f64) {
    let mut scene = settings(changes);
    // no millisecond of the start is like another
    scene
        .set_text("traverse.per_turn_mm", "0.8")
        .expect("a traverse");
    let (plain, other) = (driven(&scene, PLAIN), driven(&scene, placement));
    for ((a, turns), (b, _)) in plain.iter().zip(&other) {
        let bent = turns - plain[0].1 >= 1e-3;
        let most = if bent { most } else { ROUNDED };
        for (k, (x, y)) in a.iter().zip(b).enumerate() {
            let apart = (x - y).abs() / scene.wire.diameter;
            assert!(
                apart < most,
                "quantity {k} is {apart} d off at turn {turns}"
            );
        }
    }
}

const CHANGES: [(&str, &str); 1] = [("spindle.speed", "100")];

#[test]
fn a_box_turned_about_its_axis() {
    for turned in [0.7, std::f64::consts::PI] {
        winds_the_same_coil(&CHANGES, Placement { turned, ..PLAIN }, ROUNDED);
    }
}

#[test]
fn a_sharp_box_turned_about_its_axis() {
    let changes = [CHANGES[0], ("core.corner_radius", "0")];
    let turned = -1.3;
    winds_the_same_coil(&changes, Placement { turned, ..PLAIN }, ROUNDED);
}

/// Wire lay along the wrong half of the face where the spindle turns backwards, 47 diameters of wire too long.
#[test]
fn a_spindle_that_turns_the_other_way() {
    let (other_way, other_side) = (true, true);
    winds_the_same_coil(&CHANGES, Placement { other_way, ..PLAIN }, ROUNDED);
    winds_the_same_coil(
        &CHANGES,
        Placement {
            other_way,
            other_side,
            turned: 2.1,
        },
        ONE_ITERATE_MORE,
    );
}

/// Wire that was wound backwards counted for nothing until the core had gone round by 18 degrees.
#[test]
fn a_run_that_starts_backwards_starts_as_its_mirror_image() {
    for name in ["fig8", "bobbin", "tooth"] {
        let scene = SceneSettings::load(name).unwrap().build().unwrap();
        let [there, back] = [60.0, -60.0].map(|spindle_speed| {
            let inputs = Inputs {
                spindle_speed,
                ..Simulation::new(&scene).unwrap().inputs()
            };
            let mut sim = Simulation::starting_with(&scene, inputs).unwrap();
            let start = *sim.outputs();
            sim.advance(inputs, 2e-3).unwrap();
            (start, *sim.outputs())
        });
        assert!(there.0.turns_wound > 0.0, "{name}");
        for (there, back) in [(there.0, back.0), (there.1, back.1)] {
            let both = [there.turns_wound, back.turns_wound];
            assert!((both[0] - both[1]).abs() < 1e-6, "{name}: {both:?}");
            let both = [there.layon_angle, back.layon_angle];
            assert!((both[0] - both[1]).abs() < 1e-6, "{name}: {both:?}");
        }
    }
}
