//! Nodes are as near each other as the corners of the core ask.

use coilwind::settings::SceneSettings;
use coilwind::simulation::Simulation;

/// Copper of 0.1 mm on a box with corners of 0.2 mm.
fn fine_wire(changes: &[(&str, &str)]) -> SceneSettings {
    let mut settings = SceneSettings::load("fig8").expect("packed");
    let fine = [
        ("wire.material", "copper"),
        ("wire.diameter_mm", "0.1"),
        ("traverse.per_turn_mm", "0.1"),
        ("tensioner.tension", "0.7"),
        ("core.corner_radius_mm", "0.2"),
        ("spindle.speed", "100"),
        ("spindle.turns", "2.4"),
    ];
    for (name, value) in fine.iter().chain(changes) {
        settings.set_text(name, value).expect("a valid setting");
    }
    settings
}

/// Largest height over the core of the last settled turn, diameters.
fn height(settings: &SceneSettings) -> f64 {
    let mut sim = Simulation::new(&settings.build().expect("a scene")).expect("starts");
    let end = sim.motion_profile().end();
    while sim.time() < end {
        let left = end - sim.time();
        sim.advance_profile(left.min(1e-3)).expect("goes on");
    }
    assert!(sim.outputs().turns_settled > 1.0);
    sim.outputs().bulge_height / settings.wire.diameter
}

/// Nodes three diameters apart had fine wire stand off the faces twice as far as it does, every turn a bulge.
#[test]
fn fine_wire_on_tight_corners_is_no_bulge() {
    let height = height(&fine_wire(&[]));
    // 0.358 and 0.360 at half and at three fifths of the spacing; 0.95 at 0.3 mm
    assert!((height - 0.36).abs() < 0.05, "{height} d");
}

#[test]
fn stiff_wire_and_round_corners_keep_their_spacing() {
    let near = |settings: &SceneSettings| {
        let solver = settings.build().expect("a scene").solver;
        (solver.spacing_near, solver.spacing_free)
    };
    let mut fig8 = SceneSettings::load("fig8").expect("packed");
    let usual = near(&fig8);
    fig8.set_text("core.corner_radius", "0")
        .expect("a sharp core");
    assert_eq!(near(&fig8), usual, "the wire is bent more widely than that");
    let coarse = [("solver.tolerance_um", "10"), ("tensioner.tension", "1.2")];
    let wide = [coarse[0], coarse[1], ("core.corner_radius_mm", "1")];
    let (tight, wide) = (near(&fine_wire(&coarse)), near(&fine_wire(&wide)));
    assert_eq!(tight.0, 0.5 * wide.0);
    assert_eq!(tight.1, wide.1, "the free span has no corners");
    // spacing goes with the wire, and on a cylinder that is wide for it it is at most twice as much
    let cylinder = |diameter: &str| {
        near(&fine_wire(&[
            ("core.shape", "cylinder"),
            ("core.radius_mm", "2"),
            ("wire.diameter_mm", diameter),
            ("tensioner.tension", "0.1"),
        ]))
        .0
    };
    let over_usual = |d: f64, near: f64| near / (usual.0 * d / 0.7);
    assert!((over_usual(0.3, cylinder("0.3")) - 1.0).abs() < 1e-12);
    assert!((over_usual(0.1, cylinder("0.1")) - 2.0_f64.sqrt()).abs() < 1e-12);
    assert!((over_usual(0.04, cylinder("0.04")) - 2.0).abs() < 1e-12);
    let given = fine_wire(&[("solver.spacing_near_mm", "0.2")]);
    assert_eq!(given.build().expect("a scene").solver.spacing_near, 0.2e-3);
}

/// Edges were as long on a sharp corner as on a round one: longer than half of what tension straightens hard wire in.
#[test]
fn wire_pulled_hard_over_a_sharp_corner_has_its_nodes_nearer() {
    let near = |tension: &str, corner: &str| {
        let mut settings = SceneSettings::load("fig8").expect("packed");
        for (name, value) in [
            ("wire.material", "custom"),
            ("wire.diameter_mm", "1.5"),
            ("wire.density", "7850"),
            ("wire.EA", "371100"),
            ("wire.EAp", "3534"),
            ("wire.EI", "0.05219"),
            ("wire.EIp", "0.000497"),
            ("wire.GJ", "0.04045"),
            ("wire.GJp", "0.000331"),
            ("wire.N_y", "441.8"),
            ("wire.M_y", "0.1406"),
            ("wire.T_y", "0.1275"),
            ("traverse.per_turn_mm", "1.5"),
            ("tensioner.tension", tension),
            ("core.corner_radius_mm", corner),
        ] {
            settings.set_text(name, value).expect("a valid setting");
        }
        settings.build().expect("a scene").solver.spacing_near
    };
    let usual = near("40", "5");
    assert_eq!(
        near("40", "0.01"),
        usual,
        "pulled so little it bends widely"
    );
    assert_eq!(near("360", "5"), usual, "it lies on the corner");
    // sqrt(EIp/T) is 1.2 mm
    assert_eq!(near("360", "0.01"), 0.5 * usual);
}
