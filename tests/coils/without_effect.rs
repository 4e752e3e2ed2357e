//! Keys that nothing reads are told, and those that are told change nothing.

use coilwind::settings::SceneSettings;
use coilwind::simulation::Simulation;

/// What a scene lacks, and keys with other values than the default's that nothing reads then.
type Case = (
    &'static [(&'static str, &'static str)],
    &'static [(&'static str, &'static str)],
);

const CASES: &[Case] = &[
    (
        &[("core.flange.inner_distance", "0")],
        &[
            ("core.flange.height", "0.003"),
            ("core.flange.thickness", "0.002"),
            ("core.flange.edge_radius", "0.0001"),
            ("core.flange.insulation", "0.0001"),
            ("core.window_taper", "0.1"),
        ],
    ),
    (
        &[("tensioner.mass", "0")],
        &[("tensioner.line_damping_ratio", "0.4")],
    ),
    (
        &[("tensioner.line_length", "0")],
        &[
            ("tensioner.line_damping_ratio", "0.4"),
            ("tensioner.pulley_place", "0.3"),
        ],
    ),
    (
        &[("wire.elastic", "true")],
        &[
            ("wire.yield_stress", "1.5e8"),
            ("wire.flow_stress", "3e8"),
            ("wire.N_y", "30"),
            ("wire.M_y", "0.005"),
            ("wire.T_y", "0.005"),
            ("wire.moment_cap", "0.02"),
            ("wire.EAp", "2000"),
            ("wire.EIp", "5e-5"),
            ("wire.GJp", "5e-5"),
        ],
    ),
    (
        &[("solver.friction", "off")],
        &[
            ("friction.static", "0.3"),
            ("friction.kinetic", "0.02"),
            ("friction.slip_speed", "0.05"),
        ],
    ),
    (
        &[("solver.integrator", "implicit")],
        &[("solver.step_share", "0.5")],
    ),
    (
        &[("solver.integrator", "verlet"), ("solver.step", "1e-7")],
        &[("solver.step_share", "0.5"), ("solver.tolerance", "1e-5")],
    ),
];

fn settings(changes: &[(&str, &str)]) -> SceneSettings {
    let mut settings = SceneSettings::default();
    for (name, value) in changes {
        settings.set_text(name, value).expect("a setting");
    }
    settings
}

/// Keys that are told to have no effect.
fn told(settings: &SceneSettings) -> Vec<&'static str> {
    let (_, warnings) = settings.build_with_warnings().expect("a scene");
    let without = warnings
        .into_iter()
        .filter(|w| w.message.starts_with("has no effect: "));
    without.map(|w| w.key).collect()
}

/// They were taken without a word.
#[test]
fn keys_of_what_a_scene_lacks_are_told() {
    for (lacks, keys) in CASES {
        let nothing = told(&settings(lacks));
        assert!(nothing.is_empty(), "{lacks:?}: {nothing:?}");
        for key in *keys {
            let told = told(&settings(&[lacks, &[*key][..]].concat()));
            assert_eq!(told, [key.0], "{lacks:?}");
        }
    }
}

/// The other way round: each of these is read.
#[test]
fn keys_of_what_a_scene_has_are_not_told() {
    for changes in [
        &[
            ("core.flange.inner_distance", "0.01"),
            ("core.flange.height", "0.003"),
            ("core.window_taper", "0.01"),
        ][..],
        &[
            ("core.window_height", "0.01"),
            ("core.window_taper", "0.01"),
        ],
        &[
            ("tensioner.mass", "0.001"),
            ("tensioner.pulley_mass", "0.001"),
            ("tensioner.pulley_place", "0.3"),
            ("tensioner.line_damping_ratio", "0.4"),
        ],
        &[
            ("wire.yield_stress", "1e8"),
            ("friction.slip_speed", "0.05"),
        ],
        &[("solver.integrator", "rk4"), ("solver.step_share", "0.5")],
    ] {
        let told = told(&settings(changes));
        assert!(told.is_empty(), "{changes:?}: {told:?}");
    }
}

/// A scene file of that text, with further keys set by name.
fn from_file(text: &str, changes: &[(&str, &str)]) -> SceneSettings {
    let none = std::path::Path::new("");
    let mut settings = SceneSettings::from_toml_str(text, "kept", none).expect("a scene");
    for (name, value) in changes {
        settings.set_text(name, value).expect("a setting");
    }
    settings
}

/// A run keeps a scene with every key of its version, and later versions read it: it was told of about 25 defaults there.
#[test]
fn a_scene_that_was_kept_is_told_nothing_of_its_defaults() {
    let kept = settings(&[("wire.elastic", "true")]).to_toml();
    assert_eq!(told(&from_file(&kept, &[])), [""; 0]);
    let newer = ["insulation", "crossover_delay", "pulley_place", "trail"];
    let is_old = |line: &&str| !newer.iter().any(|key| line.starts_with(key));
    let older: Vec<&str> = kept.lines().filter(is_old).collect();
    assert!(older.len() < kept.lines().count());
    let older = older.join("\n");
    assert_eq!(told(&from_file(&older, &[])), [""; 0]);

    // what is set on purpose is told, also to the default
    for value in ["0.01", "0.02"] {
        let told = told(&from_file(&older, &[("core.radius", value)]));
        assert_eq!(told, ["core.radius"], "{value}");
    }
    let changed = older.replace("dwell_turns = 0.5", "dwell_turns = 0.25");
    assert_ne!(changed, older);
    assert_eq!(told(&from_file(&changed, &[])), ["traverse.dwell_turns"]);
}

/// Importers write every start value.
#[test]
fn defaults_that_an_importer_writes_are_not_told() {
    let usual = SceneSettings::default();
    let mut settings = usual.clone();
    for variable in coilwind::variables::table() {
        if let coilwind::variables::Access::Parameter { get, .. } = variable.access
            && variable.name != "scene.file"
        {
            let value = get(&usual).to_string();
            settings
                .set_text(variable.name, &value)
                .expect(variable.name);
        }
    }
    assert_eq!(told(&settings), [""; 0]);
}

/// A scene that a person wrote names what it is about.
#[test]
fn a_default_in_a_short_scene_is_told() {
    let scene = "[core]\nradius = 0.01\n[wire]\nelastic = true\nN_y = 0\n";
    assert_eq!(told(&from_file(scene, &[])), ["core.radius", "wire.N_y"]);
}

/// What a run of some steps says, to the bit.
fn outputs(changes: &[(&str, &str)]) -> String {
    let scene = settings(changes).build().expect("a scene");
    let mut run = Simulation::new(&scene).expect("a start");
    for _ in 0..20 {
        run.advance_profile(2e-4).expect("steps");
    }
    format!("{:?}", run.outputs())
}

#[test]
fn keys_that_are_told_change_nothing() {
    for (lacks, keys) in CASES {
        // a spindle that is fast at once, so that the wire bends, rubs and swings
        let fast = &[("spindle.speed", "100"), ("spindle.ramp_turns", "0.02")];
        let lacks = [&fast[..], lacks].concat();
        let without = outputs(&lacks);
        for key in *keys {
            let with = outputs(&[&lacks[..], &[*key]].concat());
            assert_eq!(with, without, "{key:?} with {lacks:?}");
        }
    }
}
