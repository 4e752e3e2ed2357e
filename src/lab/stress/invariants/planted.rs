//! A short wind to plant violations in, for the tests of this folder.

use super::broken::Found;
use crate::lab::stress::Invariant;
use crate::settings::SceneSettings;
use crate::signals::Inputs;
use crate::simulation::Simulation;

/// Copper wire that has wound so many turns on a small cylinder, side by side.
pub(super) fn wound(turns: f64) -> Simulation {
    wound_with(turns, |_| {})
}

/// The same with some settings changed.
pub(super) fn wound_with(turns: f64, change: impl FnOnce(&mut SceneSettings)) -> Simulation {
    let mut s = SceneSettings::default();
    s.core.shape = "cylinder".to_owned();
    s.core.radius = 4e-3;
    s.nozzle.distance = 30e-3;
    s.wire.diameter = 0.5e-3;
    s.tensioner.tension = 8.0;
    change(&mut s);
    let mut sim = Simulation::new(&s.build().unwrap()).unwrap();
    let (step, speed) = (2e-4, 100.0);
    let start = sim.inputs().nozzle_position;
    let steps = (turns * std::f64::consts::TAU / (speed * step)).round() as usize;
    for k in 1..=steps {
        let angle = speed * step * k as f64;
        let inputs = Inputs {
            spindle_speed: speed,
            nozzle_position: start + 0.55e-3 * angle / std::f64::consts::TAU,
            tension_setpoint: s.tensioner.tension,
            ..Inputs::HELD
        };
        sim.advance(inputs, step).unwrap();
    }
    sim
}

/// Holds a check to have seen a violation.
#[track_caller]
pub(super) fn sees(found: Found, what: Invariant) {
    match found {
        Ok(()) => panic!("{what}: not seen"),
        Err(broken) => assert_eq!(broken.what, what, "{}", broken.text),
    }
}
