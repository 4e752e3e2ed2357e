//! Tensioners at the nozzle, or next to it, and tensioners without mass.

use coilwind::settings::SceneSettings;
use coilwind::signals::Inputs;
use coilwind::simulation::Simulation;

fn start(scene: &str, changes: &[(&str, &str)]) -> Simulation {
    let mut settings = SceneSettings::load(scene).expect("packed");
    for (name, value) in changes {
        settings.set_text(name, value).expect("a valid setting");
    }
    Simulation::new(&settings.build().expect("a valid scene")).expect("wire at rest")
}

/// Wire was let in as long as the last tension would have made it, which overshot from step to step until the wire "broke".
#[test]
fn a_line_shorter_than_an_edge_lets_yielding_wire_in_evenly() {
    for (pull, length) in [(30.0, "0"), (34.0, "0"), (30.0, "1e-5"), (30.0, "0.5")] {
        let mut sim = start(
            "bobbin",
            &[
                ("wire.material", "copper-soft"),
                ("tensioner.tension", &pull.to_string()),
                ("tensioner.line_length", length),
            ],
        );
        for k in 0..300 {
            let inputs = Inputs {
                spindle_speed: 0.3
                    * f64::from(u8::try_from((k - 100).clamp(0, 100)).expect("small")),
                ..sim.inputs()
            };
            sim.advance(inputs, 1e-5).expect("the run goes on");
            let out = sim.outputs();
            let said = format!(
                "{pull} N, line of {length} m, step {k}: {} to {} N",
                out.wire_tension_min, out.wire_tension_max
            );
            assert!(!out.defect_break, "{said}");
            assert!(
                out.wire_tension_max < 1.05 * pull && out.wire_tension_min > 0.95 * pull,
                "{said}"
            );
        }
    }
}

/// The line's stretch was taken off once, where no spring was there to have it.
#[test]
fn a_tensioner_without_mass_stays_where_it_is() {
    let mut sim = start("fig8", &[("tensioner.mass", "0")]);
    for _ in 0..3 {
        sim.advance(sim.inputs(), 1e-3).expect("the run goes on");
        let out = sim.outputs();
        assert!(
            (out.tensioner_position - out.fed_length).abs() < 1e-12,
            "{} m",
            out.tensioner_position
        );
    }
}
