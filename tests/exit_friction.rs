//! Wire that yields by the friction at the nozzle's exit.

use coilwind::settings::SceneSettings;
use coilwind::signals::Inputs;
use coilwind::simulation::Simulation;

/// The tension behind the exit was that of wire which had yielded to the line only: 40 % too low in the outputs and in the
/// energy balance, which booked the rest as numerical.
#[test]
fn wire_that_yields_at_the_exit_pulls_as_hard_as_the_spindle_says() {
    let mut s = SceneSettings::default();
    s.core.shape = "cylinder".to_owned();
    s.core.radius = 18e-3;
    s.wire.diameter = 0.1e-3;
    s.nozzle.distance = 25e-3;
    s.nozzle.exit_friction = 0.4;
    s.tensioner.tension = 0.9;
    let scene = s.build().unwrap();
    assert!(s.tensioner.tension > scene.wire.n_y);
    let mut sim = Simulation::new(&scene).unwrap();
    let (step, speed) = (1e-3, 10.0);
    for _ in 0..300 {
        let inputs = Inputs {
            spindle_speed: speed,
            ..sim.inputs()
        };
        sim.advance(inputs, step).unwrap();
    }
    let o = sim.outputs();
    let arm = s.core.radius + 0.5 * s.wire.diameter;
    let pull = o.spindle_torque.abs() / arm;
    assert!(pull > 1.2 * s.tensioner.tension, "{pull}");
    assert!(
        (o.wire_tension / pull - 1.0).abs() < 0.01,
        "{} N in the wire, {pull} N at the spindle",
        o.wire_tension
    );
    let b = sim.system().state.balance;
    let dissipated = b.plastic.iter().sum::<f64>() + b.friction + b.damping;
    assert!(
        b.numerical.abs() < 0.05 * dissipated,
        "{} of {dissipated} J",
        b.numerical
    );
}
