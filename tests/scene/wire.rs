//! Wire of a scene: enamel, metals of the library, points of a stress-strain curve, insulation under it.

use crate::common::{assert_says, parse, refused, unread};
use coilwind::scene::{Core, Scene};
use coilwind::settings::SceneSettings;
use std::f64::consts::PI;
use std::path::Path;

fn scene(text: &str) -> Scene {
    parse(text).expect("reads").build().expect("a scene")
}

const CURVE: &str = "stress_strain = [[0.0008, 92e6], [0.05, 150e6], [0.2, 2.2e8]]";

#[test]
fn enamel_has_a_range() {
    for (outer, part) in [
        ("0.69", "thinner than the bare wire"),
        ("1.41", "thicker than the bare wire's radius"),
    ] {
        let message = refused(&format!(
            "[wire]\ndiameter_mm = 0.7\nenamelled_diameter_mm = {outer}"
        ));
        let named = "test.toml:3: wire.enamelled_diameter";
        assert_says(&message, &[named, part, "0.0007 to 0.0014 m"]);
    }
    for outer in ["0", "0.7", "0.78", "1.4"] {
        let scene = scene(&format!(
            "[wire]\ndiameter_mm = 0.7\nenamelled_diameter_mm = {outer}"
        ));
        assert_eq!(scene.wire.bare_diameter, 0.7e-3);
        assert!(scene.wire.diameter >= 0.7e-3);
    }
}

#[test]
fn pitch_and_turns_of_a_window_go_with_the_enamel() {
    let coil = "[core]\nshape = 'cylinder'\nradius_mm = 8\n[core.flange]\ninner_distance_mm = 14.5\nheight_mm = 4\n\
                [start]\nclamp_y_mm = -6.85\n[nozzle]\ny_start_mm = -6.85\n[traverse]\nmode = 'orthocyclic'\n[wire]\n";
    let bare = scene(&format!("{coil}diameter_mm = 0.8"));
    let enamelled = scene(&format!(
        "{coil}diameter_mm = 0.7\nenamelled_diameter_mm = 0.8"
    ));
    assert_eq!(bare.nozzle_law, enamelled.nozzle_law);
    let thin = refused(&format!(
        "{coil}diameter_mm = 0.7\nenamelled_diameter_mm = 1.0"
    ));
    assert_says(&thin, &["start.clamp_y", "nozzle.y_start", "past a flange"]);
    // without flanges turns touch
    let open =
        "[traverse]\nmode = 'helical'\ndwell_turns = 0\n[winding]\nturns_per_layer = 3\n[wire]\n";
    let law = scene(&format!(
        "{open}diameter_mm = 0.7\nenamelled_diameter_mm = 0.8"
    ))
    .nozzle_law;
    let (low, high) = (law.start(), law.position(law.end()));
    assert!((high - low - 2.0 * 0.8e-3).abs() < 1e-12, "{low} {high}");
}

#[test]
fn metals_of_the_library_have_their_own_numbers() {
    let density = |text: &str| scene(text).wire.density;
    assert_eq!(density(""), 8960.0);
    assert_eq!(density("[wire]\nmaterial = 'aluminium'"), 2705.0);
    assert_eq!(
        density("[wire]\nmaterial = 'aluminium'\ndensity = 2700"),
        2700.0
    );
    let metal = |name: &str| {
        scene(&format!(
            "[wire]\nmaterial = '{name}'\n[tensioner]\ntension = 5"
        ))
    };
    let (soft, half, hard) = (
        metal("copper-soft"),
        metal("copper-half-hard"),
        metal("copper-hard"),
    );
    let aluminium = metal("aluminium");
    for pair in [(&aluminium, &soft), (&soft, &half), (&half, &hard)] {
        assert!(pair.0.wire.n_y < pair.1.wire.n_y && pair.0.wire.strength < pair.1.wire.strength);
        assert!(pair.0.wire.m_y < pair.1.wire.m_y && pair.0.wire.t_y < pair.1.wire.t_y);
    }
    assert!(soft.resistivity < half.resistivity && hard.resistivity < aluminium.resistivity);
    let area = PI * 0.7e-3 * 0.7e-3 / 4.0;
    assert!((aluminium.wire.ea / (69e9 * area) - 1.0).abs() < 1e-12);
    assert!((aluminium.wire.n_y / (28e6 * area) - 1.0).abs() < 1e-12);
    assert!((aluminium.wire.strength / (83e6 * area) - 1.0).abs() < 1e-12);
    // integrated with the section, where the limit of a section that yields whole is s d^3/6
    let whole = 310e6 * 0.7e-3_f64.powi(3) / 6.0;
    assert!(
        (hard.wire.m_y / whole - 1.0).abs() < 0.02,
        "{}",
        hard.wire.m_y
    );
    assert_eq!(
        scene("[wire]\nresistivity_Ohm_mm2_per_m = 0.02").resistivity,
        2e-8
    );
    let weak = refused("[wire]\nmaterial = 'aluminium'\nyield_stress_MPa = 90");
    assert_says(
        &weak,
        &["test.toml:3: wire.yield_stress", "harden", "8.3e7 Pa"],
    );
    let light = refused("[wire]\ndensity = 50");
    assert_says(
        &light,
        &["test.toml:2: wire.density", "at least 100", "or 0"],
    );
    unread("[wire]\nmaterial = 'tin'");
}

#[test]
fn points_of_a_curve_make_the_section() {
    let text = format!("[wire]\n{CURVE}\nresistivity = 1.8e-8");
    let scene = scene(&text);
    let wire = &scene.wire;
    let area = PI * 0.7e-3 * 0.7e-3 / 4.0;
    let close = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-9, "{a} {b}");
    close(wire.ea, 92e6 / 0.0008 * area);
    close(wire.n_y, 92e6 * area);
    close(wire.strength, 220e6 * area);
    close(wire.moment_cap, 220e6 * 0.7e-3_f64.powi(3) / 6.0);
    close(wire.gj / wire.ei, 1.0 / 1.326);
    assert!(wire.ea_p > 0.0 && wire.ea_p < 0.05 * wire.ea);
    // bending and torsion follow the curve from where the rim yields
    let rim = PI * 0.7e-3_f64.powi(3) / 32.0;
    close(wire.m_y, 92e6 * rim);
    close(wire.t_y, 92e6 / 3.0_f64.sqrt() * 2.0 * rim);
    assert!(wire.hardening.bend.is_some() && wire.hardening.twist.is_some());
    let laws = scene.wire_laws.expect("laws of a curve");
    assert!(
        laws.bend.error < 0.012 && laws.twist.error < 0.012,
        "{laws:?}"
    );
    // a curve that bends much over a long way is told to be followed badly in stretch
    let told = |points: &str| {
        let settings = parse(&format!("[wire]\nstress_strain = {points}")).unwrap();
        let (_, warnings) = settings.build_with_warnings().unwrap();
        warnings.iter().any(|w| w.key == "wire.stress_strain")
    };
    assert!(told("[[0.0008, 92e6], [0.02, 140e6], [0.4, 225e6]]"));
    assert!(!told("[[0.0008, 92e6], [0.02, 115e6], [0.08, 160e6]]"));
    // written out and read again it is the same scene
    let settings = parse(&text).unwrap();
    let again = SceneSettings::from_toml_str(&settings.to_toml(), "again", Path::new("")).unwrap();
    assert_eq!(again.build().unwrap().wire, scene.wire);
    let mut set = SceneSettings::default();
    let list = "[[0.0008, 92e6], [0.05, 150e6], [0.2, 2.2e8]]";
    set.set_text("wire.stress_strain", list).unwrap();
    assert_eq!(set.build().unwrap().wire, scene.wire);
    // a limit of one's own still counts
    let own = parse(&format!("{text}\nM_y = 8e-3"))
        .unwrap()
        .build()
        .unwrap();
    assert_eq!(own.wire.m_y, 8e-3);
    assert_eq!(own.wire.hardening.bend, None, "its law is bilinear");
    assert_eq!(own.wire.hardening.twist, scene.wire.hardening.twist);
    let custom = parse(&format!("[wire]\nmaterial = 'custom'\nGJ = 1e-3\n{CURVE}"));
    close(custom.unwrap().build().unwrap().wire.gj, 1e-3);
}

#[test]
fn points_that_are_no_curve_are_told_with_what_is_allowed() {
    let cases = [
        ("[[0.0008, 92e6]]", "two points or more"),
        (
            "[[0.0008, 92e6], [0.0005, 150e6]]",
            "point 2, [0.0005, 1.5e8], is out of order",
        ),
        (
            "[[0.0008, 92e6], [0.05, 90e6]]",
            "stresses that rise, here above 9.2e7 Pa",
        ),
        (
            "[[0.0008, -92e6], [0.05, 90e6]]",
            "point 1, [0.0008, -9.2e7], is not above 0",
        ),
        (
            "[[0.0008, 92e6], [0.05, 150e6], [0.1, 230e6]]",
            "no steeper than the one before",
        ),
        ("[[0.0008, 92e6], [2, 150e6]]", "strains up to 1"),
        ("[[0.0008, 92e6, 1], [0.1, 150e6]]", "cannot be read"),
        ("[0.0008, 92e6]", "cannot be read"),
        ("'nonsense'", "cannot be read"),
    ];
    for (points, part) in cases {
        let message = refused(&format!("[wire]\nstress_strain = {points}"));
        assert_says(&message, &["test.toml:2: wire.stress_strain", part]);
    }
    for (more, key) in [
        ("yield_stress_MPa = 100", "wire.yield_stress"),
        ("flow_stress_MPa = 200", "wire.flow_stress"),
        ("material = 'table1'", "wire.stress_strain"),
        ("material = 'custom'", "wire.GJ"),
    ] {
        assert_says(&refused(&format!("[wire]\n{CURVE}\n{more}")), &[key]);
    }
    assert_says(
        &unread("[wire]\nstress_strain = [[1, 'x']]"),
        &["wire.stress_strain", "a list"],
    );
    assert_says(
        &unread("[wire]\nmaterial = [1, 2]"),
        &["wire.material", "a list"],
    );
}

/// An even layer round the core and on the flanges is a core that much larger; rim and outer faces stay.
#[test]
fn insulation_is_an_offset_of_the_core() {
    let coil = "[core]\nwidth_x_mm = 12\nheight_z_mm = 30\ncorner_radius_mm = 1\ninsulation_mm = 0.5\n[core.flange]\n\
                inner_distance_mm = 15\nheight_mm = 4\nthickness_mm = 1\ninsulation_mm = 0.25\n";
    let insulated = scene(coil);
    let bare = "[core]\nwidth_x_mm = 13\nheight_z_mm = 31\ncorner_radius_mm = 1.5\n[core.flange]\n\
                inner_distance_mm = 14.5\nheight_mm = 3.5\nthickness_mm = 1.25\n";
    let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-15, "{a} {b}");
    match (insulated.core, scene(bare).core) {
        (
            Core::RoundedBox {
                width_x,
                height_z,
                corner_radius,
                flange: Some(flange),
                ..
            },
            Core::RoundedBox {
                width_x: x,
                height_z: z,
                corner_radius: r,
                flange: Some(of),
                ..
            },
        ) => {
            for (a, b) in [
                (width_x, x),
                (height_z, z),
                (corner_radius, r),
                (flange.inner_distance, of.inner_distance),
                (flange.height, of.height),
                (flange.thickness, of.thickness),
            ] {
                close(a, b);
            }
        }
        other => panic!("{other:?}"),
    }
    let round = "[core]\nshape = 'cylinder'\nradius_mm = 8\ninsulation_mm = 0.3";
    assert!(
        matches!(scene(round).core, Core::Cylinder { radius, .. } if (radius - 8.3e-3).abs() < 1e-15)
    );
    let thick = refused(&coil.replace("insulation_mm = 0.5", "insulation_mm = 4"));
    assert_says(&thick, &["core.insulation", "less than 0.004 m"]);
    let narrow = refused(&coil.replace("insulation_mm = 0.25", "insulation_mm = 7.2"));
    assert_says(
        &narrow,
        &[
            "core.flange.inner_distance",
            "insulated",
            "at least 0.0151 m",
        ],
    );
}

#[test]
fn the_window_ends_at_its_limit_line() {
    let coil = "[core]\nwindow_height_mm = 5\nwindow_taper_deg = 10\n";
    let open = scene(coil).window.unwrap();
    assert_eq!((open.size(), open.height), (None, 5e-3));
    let flanges = "[core.flange]\ninner_distance_mm = 15\nheight_mm = 4\n";
    let closed = scene(&format!("{coil}{flanges}")).window.unwrap();
    assert_eq!(closed.faces, Some([-7.5e-3, 7.5e-3]));
    assert_eq!(closed.size(), Some([15e-3, 5e-3]));
    assert_eq!(scene(flanges).window.unwrap().height, 4e-3);
    assert_eq!(scene("").window, None);
    let steep = refused(&format!(
        "[core]\nwindow_height_mm = 1\nwindow_taper_deg = 10\n{flanges}"
    ));
    assert_says(&steep, &["core.window_height", "meets the core"]);
}

/// A curve with strains in percent is that of wire a hundred times as soft, and passed without a word.
#[test]
fn a_curve_in_other_units_is_warned_of() {
    let told = |points: &str| {
        let settings = parse(&format!("[wire]\nstress_strain = {points}")).unwrap();
        let (_, warnings) = settings.build_with_warnings().unwrap();
        let mut texts = warnings.into_iter().map(|warning| warning.message);
        texts.any(|text| text.contains("makes a modulus of 1.1") && text.contains("ratios"))
    };
    assert!(told("[[0.1, 110e6], [0.5, 140e6], [0.9, 160e6]]"));
    assert!(!told("[[0.001, 110e6], [0.05, 140e6], [0.2, 160e6]]"));
}

/// The explicit methods had 0.5 mm between nodes whatever the wire was: 10 diameters of wire of 0.05 mm.
#[test]
fn the_spacing_of_the_explicit_methods_goes_with_the_wire() {
    let spacing = |diameter: &str| {
        let mut settings = SceneSettings::packed("fig8")
            .expect("packed")
            .expect("valid");
        for (name, value) in [
            ("wire.material", "copper"),
            ("wire.diameter", diameter),
            ("solver.integrator", "verlet"),
        ] {
            settings.set_text(name, value).expect("a setting");
        }
        let solver = settings.build().expect("valid").solver;
        [
            solver.spacing_near,
            solver.spacing_free,
            solver.refine_distance,
        ]
    };
    let (thin, thick) = (spacing("0.35e-3"), spacing("0.7e-3"));
    assert_eq!(thick, [0.5e-3, 1e-3, 6e-3]);
    assert_eq!(thin.map(|x| 2.0 * x), thick);
}
