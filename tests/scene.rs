//! Scene files through the front door: what is read, in which order, and what is refused.

use coilwind::scene::{Core, SceneError};
use coilwind::settings::{Place, SceneSettings, Start};
use coilwind::variables::{Value, by_name, table};
use std::path::Path;

fn parse(text: &str) -> Result<SceneSettings, SceneError> {
    SceneSettings::from_toml_str(text, "test.toml", Path::new(""))
}

fn fig8() -> SceneSettings {
    SceneSettings::packed("fig8")
        .expect("packed")
        .expect("valid")
}

/// The message of a scene that parses but cannot be built.
fn refused(text: &str) -> String {
    parse(text)
        .expect("parses")
        .build()
        .expect_err("must be refused")
        .to_string()
}

/// The message of a scene that does not parse.
fn unread(text: &str) -> String {
    parse(text).expect_err("must not parse").to_string()
}

fn assert_says(message: &str, parts: &[&str]) {
    for part in parts {
        assert!(message.contains(part), "{part:?} is missing in: {message}");
    }
}

/// `x` to six significant digits, as the reference prints its derived numbers.
fn six_digits(x: f64) -> f64 {
    format!("{x:.5e}").parse().unwrap()
}

#[test]
fn packed_fig8_is_the_reference_scene() {
    let text = include_str!("reference/scene_fig8.json");
    let json: serde_json::Value = serde_json::from_str(text).unwrap();
    let number = |path: &str| json.pointer(path).and_then(|v| v.as_f64()).expect(path);
    let mut settings = fig8();
    settings.preset = "paper".to_owned();
    let scene = settings.build().unwrap();

    let w = &scene.wire;
    for (got, path) in [
        (w.diameter, "/wire/diameter_m"),
        (w.density, "/wire/density_kg_per_m3"),
        (w.ea, "/wire/EA_N"),
        (w.ea_p, "/wire/EAp_N"),
        (w.ei, "/wire/EI_Nm2"),
        (w.ei_p, "/wire/EIp_Nm2"),
        (w.gj, "/wire/GJ_Nm2"),
        (w.gj_p, "/wire/GJp_Nm2"),
        (fig8().wire.yield_stress, "/wire/yield_stress_Pa"),
        (six_digits(w.n_y), "/wire/N_y_N"),
        (six_digits(w.m_y), "/wire/M_y_Nm"),
        (six_digits(w.t_y), "/wire/T_y_Nm"),
        (scene.nozzle.distance, "/nozzle/distance_from_axis_m"),
        (scene.nozzle.y_start, "/nozzle/y_start_m"),
        (scene.nozzle.exit_friction, "/nozzle/exit_friction"),
        (scene.traverse.per_turn, "/nozzle/traverse_per_turn_m"),
        (scene.traverse.lead, "/nozzle/traverse_lead_m"),
        (scene.tensioner.tension, "/tension/T0_N"),
        (scene.tensioner.mass, "/tension/baseline/tensioner_mass_kg"),
        (
            scene.tensioner.line_length,
            "/tension/baseline/line_length_m",
        ),
        (
            scene.tensioner.line_damping_ratio,
            "/tension/baseline/line_damping_ratio",
        ),
        (scene.spindle.turns, "/start/turns"),
        (scene.friction.static_, "/friction/static"),
        (scene.friction.kinetic, "/friction/kinetic"),
        (
            scene.contact.stiffness,
            "/contact/normal_stiffness_N_per_m2",
        ),
        (scene.contact.restitution, "/contact/restitution_target"),
        (scene.solver.spacing_near, "/node_spacing_m/paper/near_core"),
        (scene.solver.spacing_free, "/node_spacing_m/paper/free_span"),
    ] {
        assert_eq!(got, number(path), "{path}");
    }
    assert!(w.moment_cap.is_infinite());
    assert_eq!(scene.wire_material, json["wire"]["name"]);
    assert_eq!(
        scene.core,
        Core::RoundedBox {
            width_x: number("/core/width_x_m"),
            height_z: number("/core/height_z_m"),
            length_y: number("/core/length_y_m"),
            corner_radius: number("/core/corner_radius_m"),
        }
    );
    assert_eq!(scene.start.clamp_y, 0.0);
    assert_eq!(scene.spindle.ramp_turns, 0.25);
    let half_width = number("/core/width_x_m") / 2.0;
    let angle = Start::core_angle(half_width, w.radius(), scene.nozzle.distance);
    assert!((angle - number("/start/core_angle0_rad")).abs() < 5e-7);
    let speeds = json["speeds_rad_per_s"].as_array().unwrap();
    assert!(
        speeds
            .iter()
            .any(|s| s.as_f64() == Some(scene.spindle.speed))
    );
    let d = &scene.defects;
    let limits = (
        d.gap,
        d.gap_fraction,
        d.bulge_excess,
        d.overlap_axial,
        d.overlap_height,
    );
    assert_eq!(limits, (0.15, 0.10, 0.5, 0.90, 0.30));
    assert_eq!((d.skip_angle, d.bulge_absolute), (1.2, 0.0));
}

#[test]
fn the_default_is_fig8_in_copper() {
    let mut copper = fig8();
    copper.set_text("wire.material", "copper").unwrap();
    let (copper, default) = (
        copper.build().unwrap(),
        SceneSettings::default().build().unwrap(),
    );
    assert_eq!(default.wire_material, "copper");
    assert_eq!(
        coilwind::scene::Scene {
            name: default.name.clone(),
            ..copper
        },
        default
    );
}

#[test]
fn keys_with_units_are_the_same_doubles() {
    let units = parse(
        "[wire]\ndiameter_mm = 0.7\nyield_stress_MPa = 100\nEA_N = 48900\n\
         [freeze]\ncreep_um_per_rad = 2\nwindow_deg = 90\n\
         [spindle]\nspeed_rpm = 5000\n[tensioner]\nmass_g = 1\n\
         [contact]\nstiffness_N_per_mm2 = 1e4\n[solver]\nstep_us = 0.1\n",
    )
    .unwrap();
    assert_eq!(units.wire.diameter, 0.0007);
    assert_eq!(units.wire.yield_stress, 1e8);
    assert_eq!(units.wire.ea, 48900.0);
    assert_eq!(units.freeze.creep, 2e-6);
    assert!((units.freeze.window - std::f64::consts::FRAC_PI_2).abs() < 1e-15);
    assert!((units.spindle.speed - 523.598_775_598).abs() < 1e-9);
    assert_eq!(units.tensioner.mass, 0.001);
    assert_eq!(units.contact.stiffness, 1e10);
    assert_eq!(units.solver.step, 1e-7);
}

#[test]
fn unknown_names_come_with_a_suggestion() {
    for (text, parts) in [
        (
            "[wire]\n\n diametr_mm = 0.7",
            &[
                "test.toml:3",
                "wire.diametr_mm",
                "value 0.7",
                "wire.diameter_mm?",
            ][..],
        ),
        ("[wire]\ndiametr = 0.7", &["test.toml:2", "wire.diameter?"]),
        (
            "[wire]\ntension = 15",
            &["wire.tension", "tensioner.tension?", "keys of [wire]"],
        ),
        (
            "[spindle]\nspeed_rmp = 15",
            &["spindle.speed_rmp", "spindle.speed?"],
        ),
        (
            "\n[wier]\ndiameter = 1",
            &["test.toml:2", "[wier]", "[wire]?", "tensioner"],
        ),
        ("presett = 'paper'", &["test.toml:1", "presett", "preset?"]),
        ("diameter = 0.7", &["diameter", "wire.diameter?"]),
        ("[scene]\nfile = 'fig8'", &["[scene]"]),
    ] {
        assert_says(&unread(text), parts);
    }
}

#[test]
fn wrong_units_types_and_repeats_are_refused() {
    for (text, parts) in [
        (
            "[wire]\ndiameter_rpm = 3",
            &[
                "test.toml:2",
                "wire.diameter_rpm = 3",
                "wire.diameter_mm, wire.diameter_um",
            ][..],
        ),
        (
            "[wire]\ndiameter = 'thick'",
            &["\"thick\" is a text", "2e-5 to 0.005 m"],
        ),
        (
            "[wire]\nelastic = 1",
            &["wire.elastic = 1 is a number", "true or false"],
        ),
        ("[wire]\ndiameter = [1, 2]", &["a list"]),
        ("[wire.diameter]\nmm = 2", &["a section"]),
        (
            "[wire]\ndiameter = 7e-4\ndiameter_mm = 0.7",
            &[
                "test.toml:3",
                "wire.diameter was already given as wire.diameter",
            ],
        ),
        (
            "[wire]\nmaterial = 'steel'",
            &["\"steel\"", "copper, table1, custom"],
        ),
        ("[wire]\ndiameter = ", &["test.toml:2", "not valid TOML"]),
        ("wire = 3", &["test.toml:1", "wire"]),
    ] {
        assert_says(&unread(text), parts);
    }
}

#[test]
fn numbers_out_of_range_name_their_range() {
    for (text, parts) in [
        (
            "[wire]\ndiameter_mm = -0.7",
            &["test.toml:2", "= -0.7", "2e-5 to 0.005 m"][..],
        ),
        (
            "[wire]\ndiameter = nan",
            &["wire.diameter = nan", "2e-5 to 0.005 m"],
        ),
        (
            "[tensioner]\ntension = inf",
            &["tensioner.tension = inf", "0 to 10000 N"],
        ),
        (
            "[contact]\nrestitution = 1.5",
            &["contact.restitution = 1.5", "0 to 1"],
        ),
        ("[contact]\nrestitution = -0.1", &["allowed: 0 to 1"]),
        (
            "[spindle]\nspeed = 0",
            &["spindle.speed = 0", "0.1 to 2000 rad/s"],
        ),
        ("[spindle]\nramp_turns = 0", &["spindle.ramp_turns = 0"]),
    ] {
        assert_says(&unread(text), parts);
    }
}

#[test]
fn impossible_scenes_say_what_would_do() {
    for (text, parts) in [
        (
            "[nozzle]\ndistance_mm = 15",
            &[
                "test.toml:2",
                "nozzle.distance = 0.015 m",
                "inside the circle",
                "more than 0.016",
            ][..],
        ),
        (
            "[wire]\ndiameter_mm = 2\n[core]\nlength_y_mm = 1",
            &[
                "test.toml:2",
                "wire.diameter = 0.002 m",
                "wider than the core is long",
                "0.001 m",
            ],
        ),
        (
            "[core]\ncorner_radius_mm = 6.5",
            &[
                "test.toml:2",
                "core.corner_radius = 0.0065 m",
                "0 to 0.006 m",
            ],
        ),
        (
            "[friction]\nstatic = 0.1",
            &[
                "test.toml:2",
                "friction.static = 0.1",
                "at least friction.kinetic, 0.17",
            ],
        ),
        (
            "[friction]\nkinetic = 0.3",
            &["friction.kinetic = 0.3", "at most friction.static, 0.23"],
        ),
        (
            "[tensioner]\ntension = 100",
            &[
                "test.toml:2",
                "tensioner.tension = 100 N",
                "breaks at 84.66",
                "less than",
            ],
        ),
        (
            "[solver]\nspacing_near_um = 50",
            &["too fine", "7e-5 to 0.007 m"],
        ),
        (
            "[wire]\ndiameter_um = 30\n[tensioner]\ntension = 0.1\n[solver]\nspacing_near_mm = 0.4",
            &["spacing_near", "solver.spacing_near", "too coarse"],
        ),
        (
            "[solver]\nspacing_near_mm = 0.4\nspacing_free_mm = 0.3",
            &["cannot be finer", "solver.spacing_near, 0.0004 m"],
        ),
        ("[solver]\nspacing_free_mm = 20", &["at least three edges"]),
        (
            "[spindle]\nturns = 0.1",
            &[
                "default scene",
                "spindle.ramp_turns",
                "at most spindle.turns, 0.1",
            ],
        ),
        (
            "[start]\nclamp_y_mm = 15",
            &["start.clamp_y", "-0.01465 to 0.01465 m"],
        ),
        (
            "[nozzle]\ny_start = 0.2",
            &["nozzle.y_start", "-0.075 to 0.075 m"],
        ),
        (
            "[wire]\nmaterial = 'table1'\ndiameter_mm = 0.8",
            &[
                "test.toml:3",
                "wire.diameter = 0.0008 m",
                "table1",
                "0.0007 m",
            ],
        ),
        (
            "[wire]\nmaterial = 'custom'\nEA = 1\nEAp = 0.1\nEI = 1\n",
            &["wire.EIp", "needs every rigidity", "more than 0"],
        ),
        (
            "[wire]\nEIp = 0.5",
            &["test.toml:2", "wire.EIp = 0.5 N.m2", "less than wire.EI"],
        ),
        (
            "[wire]\nyield_stress_MPa = 300",
            &["wire.flow_stress", "moment cap", "at least 3e8 Pa"],
        ),
        (
            "[wire]\nmoment_cap = 1e-3",
            &["wire.moment_cap = 0.001 N.m", "0.00571667"],
        ),
        ("[core]\nshape = 'mesh'", &["core.file", "needs a file"]),
        (
            "[core]\nshape = 'mesh'\nfile = 'none.stl'",
            &["test.toml:3", "none.stl", "cannot be opened"],
        ),
    ] {
        assert_says(&refused(text), parts);
    }
}

#[test]
fn fields_written_directly_are_checked_too() {
    let mut settings = SceneSettings::default();
    settings.freeze.creep = f64::NAN;
    assert_says(
        &settings.build().unwrap_err().to_string(),
        &["freeze.creep = NaN", "0 to 1 m/rad"],
    );
}

#[test]
fn odd_scenes_build_with_a_warning() {
    let warnings = |text: &str| -> Vec<String> {
        let (_, warnings) = parse(text).unwrap().build_with_warnings().unwrap();
        warnings.iter().map(ToString::to_string).collect()
    };
    assert!(warnings("").is_empty());
    assert_eq!(
        SceneSettings::default().build_with_warnings().unwrap().1,
        []
    );
    for (text, part) in [
        ("[nozzle]\ny_start_mm = 20", "starts beside the core"),
        ("[spindle]\nturns = 25", "ends beside the core"),
        ("[tensioner]\ntension = 40", "yields in the free span"),
        (
            "[core]\ncorner_radius = 0\n",
            "coarser than the tightest bend",
        ),
        ("[contact]\nstiffness = 1e8", "1 % of its diameter"),
    ] {
        let found = warnings(text);
        assert_eq!(found.len(), 1, "{found:?}");
        assert_says(&found[0], &[part]);
    }
}

#[test]
fn later_wins_defaults_file_then_single_values() {
    let text = "[tensioner]\ntension = 12\n[wire]\ndiameter_mm = 0.5";
    let mut settings = parse(text).unwrap();
    assert_eq!(settings.tensioner.tension, 12.0);
    assert_eq!(settings.tensioner.mass, 0.001);
    settings.set_text("tensioner.tension", "9.5").unwrap();
    settings.set("wire.diameter_mm", Value::Real(0.4)).unwrap();
    settings.set_text("freeze.enabled", "false").unwrap();
    assert_eq!(settings.tensioner.tension, 9.5);
    assert_eq!(settings.wire.diameter, 0.0004);
    assert!(!settings.freeze.enabled);
    assert_eq!(settings.place("tensioner.tension"), Place::Set);
    assert_eq!(settings.start_inputs().tension_setpoint, 9.5);

    let before = settings.clone();
    for (name, text, parts) in [
        ("tensioner.tensoin", "3", &["tensioner.tension?"][..]),
        ("tensioner.tension", "much", &["= much", "0 to 10000 N"]),
        ("tensioner.tension", "-1", &["set by name", "out of range"]),
        ("freeze.enabled", "yes", &["neither true nor false"]),
        ("wire_tension", "3", &["unknown key wire_tension"]),
        ("scene.file", "fig8", &["loaded before"]),
    ] {
        let error = settings.set_text(name, text).unwrap_err();
        assert_says(&error.to_string(), parts);
    }
    assert_eq!(settings, before);
}

#[test]
fn parameters_come_in_any_order() {
    let row = |name: &str| by_name(name).unwrap();
    let mut parameters = [
        (row("tensioner.tension"), Value::Real(10.0)),
        (row("scene.file"), Value::String("fig8".to_owned())),
        (row("wire.elastic"), Value::Boolean(true)),
    ];
    let one = SceneSettings::from_parameters(parameters.iter().cloned()).unwrap();
    parameters.reverse();
    let other = SceneSettings::from_parameters(parameters.iter().cloned()).unwrap();
    assert_eq!(one, other);
    assert_eq!(
        (one.wire.material.as_str(), one.tensioner.tension),
        ("table1", 10.0)
    );
    assert_eq!(one.file, "fig8");
    let none = SceneSettings::from_parameters(std::iter::empty()).unwrap();
    assert_eq!(none, SceneSettings::default());
}

#[test]
fn a_written_scene_reads_back_the_same() {
    let mut settings = fig8();
    settings
        .set_text("output.directory", "a \"b\" \\ c")
        .unwrap();
    settings.set_text("freeze.creep", "3.3e-6").unwrap();
    let back = parse(&settings.to_toml()).unwrap();
    for variable in table().iter().filter(|v| v.name != "scene.file") {
        assert_eq!(
            variable.start(&back),
            variable.start(&settings),
            "{}",
            variable.name
        );
    }
}

#[test]
fn mesh_files_are_found_beside_the_scene() {
    let folder = tempfile::tempdir().unwrap();
    // A square tube without ends, 10 mm wide and 20 mm long, in millimetres.
    let corner = |i: usize, y: f64| {
        let (x, z) = [(5.0, 5.0), (-5.0, 5.0), (-5.0, -5.0), (5.0, -5.0)][i % 4];
        format!("vertex {x} {y} {z}\n")
    };
    let facet = |v: [String; 3]| {
        format!(
            "facet normal 0 0 0\nouter loop\n{}endloop\nendfacet\n",
            v.concat()
        )
    };
    let mut stl = String::from("solid tube\n");
    for i in 0..4 {
        let (a, b) = (corner(i, -10.0), corner(i + 1, -10.0));
        let (c, d) = (corner(i + 1, 10.0), corner(i, 10.0));
        stl += &facet([a.clone(), b, c.clone()]);
        stl += &facet([a, c, d]);
    }
    stl += "endsolid tube\n";
    std::fs::write(folder.path().join("tube.stl"), stl).unwrap();
    let scene = folder.path().join("tube.toml");
    std::fs::write(&scene, "[core]\nshape = 'mesh'\nfile = 'tube.stl'\n").unwrap();

    let mut settings = SceneSettings::load(scene.to_str().unwrap()).unwrap();
    assert_eq!(settings.name, "tube");
    let built = settings.build().unwrap();
    assert_eq!(
        built.core,
        Core::Mesh {
            path: folder.path().join("tube.stl"),
            unit: 1e-3
        }
    );

    // Its turning circle is 7.07 mm, its end 10 mm from the middle.
    settings.set_text("nozzle.distance_mm", "7.5").unwrap();
    assert_says(
        &settings.build().unwrap_err().to_string(),
        &["0.00707107 m and the wire"],
    );
    settings.set_text("nozzle.distance_mm", "60").unwrap();
    settings.set_text("start.clamp_y_mm", "9.9").unwrap();
    assert_says(
        &settings.build().unwrap_err().to_string(),
        &["-0.00965 to 0.00965 m"],
    );
    std::fs::write(folder.path().join("tube.stl"), "solid\nnonsense").unwrap();
    assert_says(
        &settings.build().unwrap_err().to_string(),
        &["core.file", "cannot be read"],
    );
}

#[test]
fn scenes_that_are_not_there() {
    let message = SceneSettings::load("fig9").unwrap_err().to_string();
    assert_says(
        &message,
        &[
            "fig9",
            "packed scene (fig8, fig8_gap)",
            "did you mean fig8?",
        ],
    );
    let folder = tempfile::tempdir().unwrap();
    let message = SceneSettings::load(folder.path().to_str().unwrap())
        .unwrap_err()
        .to_string();
    assert_says(&message, &["cannot be read"]);
}
