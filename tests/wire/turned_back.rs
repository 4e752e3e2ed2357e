//! Wire on a round core that is turned back beyond its start.

use coilwind::settings::SceneSettings;
use coilwind::signals::Inputs;
use coilwind::simulation::Simulation;
use std::f64::consts::TAU;

const PITCH: f64 = 0.5e-3;

/// Wire on a cylinder: diameter and radius, m.
fn cylinder(diameter: &str, radius: &str) -> Simulation {
    let mut settings = SceneSettings::default();
    for (name, value) in [
        ("wire.diameter", diameter),
        ("core.shape", "cylinder"),
        ("core.radius", radius),
        ("core.length_y", "40e-3"),
        ("nozzle.distance", "50e-3"),
    ] {
        settings.set_text(name, value).expect("a valid setting");
    }
    Simulation::new(&settings.build().expect("a valid scene")).expect("wire at rest")
}

/// Wire folded over its clamp by half a turn had no direction there, and no step went on.
#[test]
fn wire_is_drawn_back_over_its_clamp() {
    let (step, top) = (1e-3, 30.0);
    for (diameter, radius) in [("0.3e-3", "5e-3"), ("0.7e-3", "5e-3"), ("0.5e-3", "10e-3")] {
        let mut sim = cylinder(diameter, radius);
        let (mut speed, mut forward): (f64, bool) = (0.0, true);
        let angle = |sim: &Simulation| sim.outputs().spindle_angle;
        while angle(&sim) > -1.2 * TAU {
            forward &= angle(&sim) < 0.3 * TAU;
            let rise = if forward { 0.05 * top } else { -0.05 * top };
            speed = (speed + rise).clamp(-top, top);
            let inputs = Inputs {
                spindle_speed: speed,
                nozzle_position: PITCH * (angle(&sim) + speed * step) / TAU,
                tension_setpoint: 15.0,
                ..Inputs::HELD
            };
            let went = sim.advance(inputs, step);
            assert_eq!(went, Ok(()), "{diameter} m on {radius} m");
        }
        let out = sim.outputs();
        assert!(!out.defect_break && out.wire_tension > 5.0, "{diameter} m");
        // it lies the other way round
        assert!(out.turns_wound > 0.7, "{}", out.turns_wound);
        let energy = sim.energy();
        println!("{energy:?}");
        assert!(energy.residual_over_dissipated.abs() < 0.01, "{energy:?}");
    }
}
