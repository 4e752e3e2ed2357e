//! What scenes say, in which order values count, and that written scenes read back.

use crate::common::{assert_says, fig8, parse};
use coilwind::scene::Core;
use coilwind::settings::{Origin, SceneSettings, Start};
use coilwind::variables::{Value, by_name, table};
use std::path::Path;

/// `x` to six significant digits, as the reference prints its derived numbers.
fn six_digits(x: f64) -> f64 {
    format!("{x:.5e}").parse().unwrap()
}

#[test]
fn packed_fig8_is_the_reference_scene() {
    let text = include_str!("../reference/scene_fig8.json");
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
            flange: None,
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
            // (the packed scene says so, the default does not)
            tension_given: false,
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
    assert_eq!(settings.origin("tensioner.tension"), Origin::Set);
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
    // A square bar, 10 mm wide and 20 mm long, in millimetres.
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
        stl += &facet([a.clone(), c.clone(), b]);
        stl += &facet([a, d, c]);
    }
    for (y, order) in [(-10.0, [0, 3, 2, 1]), (10.0, [0, 1, 2, 3])] {
        let [a, b, c, d] = order.map(|i| corner(i, y));
        stl += &facet([a.clone(), c.clone(), b]);
        stl += &facet([a, d, c]);
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
            unit: 1e-3,
            flange: None,
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

/// `scene.toml` in a folder of results named a mesh from where the run had begun, and no command found it.
#[test]
fn a_scene_written_elsewhere_finds_its_files() {
    let text = "core.shape = 'mesh'\ncore.file = 'parts/core.stl'\ntraverse.file = 'way.csv'";
    let read = |text: &str, folder: &str| {
        SceneSettings::from_toml_str(text, "own.toml", Path::new(folder)).expect("reads")
    };
    let own = read(text, "scenes");
    let there = read(&own.to_toml_for_elsewhere(), "results/7");
    assert_eq!(there.core.file, own.core.file);
    assert!(Path::new(&own.core.file).ends_with("scenes/parts/core.stl"));
    // one that `--set` gave, which counts from here
    let mut set = read("core.shape = 'mesh'", "scenes");
    set.set_text("core.file", "core.stl").expect("a name");
    let there = read(&set.to_toml_for_elsewhere(), "results/7").core.file;
    assert_eq!(
        Path::new(&there),
        std::path::absolute("core.stl").expect("a path")
    );
}
