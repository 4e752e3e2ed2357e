//! A controller in the loop: the pull of the tensioner follows the tension that the wire really has.
//!
//! `cargo run --example controller` winds the core of Fig. 8 twice at 30 rad/s. The tensioner drifts and its
//! brake runs out of round. Without control that reaches the wire; with control a PI controller reads the
//! tension at the nozzle every half millisecond and corrects the set value. Printed are the
//! root mean squares of what the tension is off by.

use coilwind::scene::Scene;
use coilwind::settings::SceneSettings;
use coilwind::signals::Inputs;
use coilwind::simulation::{SimError, Simulation};
use std::error::Error;
use std::f64::consts::TAU;

/// Tension wanted, N.
const WANTED: f64 = 15.0;
/// Communication step and sampling time of the controller, s.
const STEP: f64 = 5e-4;
/// Run, s, and the part of it at the beginning that does not count.
const END: f64 = 0.3;
const BEGIN: f64 = 0.05;
/// Speed of the spindle, rad/s, and its rise, rad/s^2.
const SPEED: f64 = 30.0;
const RISE: f64 = 1000.0;
/// Travel of the nozzle per turn, m.
const PITCH: f64 = 0.7e-3;

/// What the tensioner adds to its set value by itself, N: it pulls too hard, and unevenly.
fn disturbance(time: f64) -> f64 {
    1.5 + 2.0 * (TAU * 12.0 * time).sin()
}

/// Proportional and integral control with a limit on its output.
struct Controller {
    /// N per N
    proportional: f64,
    /// N per N and s
    integral: f64,
    /// what the integral part has come to, N
    sum: f64,
}

impl Controller {
    /// The set value for the next step, N, from the tension measured now.
    fn set_value(&mut self, tension: f64) -> f64 {
        let error = WANTED - tension;
        self.sum = (self.sum + self.integral * error * STEP).clamp(-10.0, 10.0);
        (WANTED + self.proportional * error + self.sum).clamp(0.0, 30.0)
    }
}

/// Winds once and returns the root mean square of the tension's error, N.
fn wind(scene: &Scene, mut controller: Option<Controller>) -> Result<f64, SimError> {
    let mut sim = Simulation::new(scene)?;
    let (mut sum, mut count) = (0.0, 0);
    while sim.time() < END {
        let tension = sim.outputs().wire_tension;
        let set_value = controller.as_mut().map_or(WANTED, |c| c.set_value(tension));
        let speed = (sim.inputs().spindle_speed + RISE * STEP).min(SPEED);
        let angle = sim.outputs().spindle_angle + speed * STEP;
        let inputs = Inputs {
            spindle_speed: speed,
            nozzle_position: PITCH * angle / TAU,
            tension_setpoint: set_value + disturbance(sim.time()),
            ..Inputs::HELD
        };
        sim.advance(inputs, STEP)?;
        if sim.time() > BEGIN {
            sum += (sim.outputs().wire_tension - WANTED).powi(2);
            count += 1;
        }
    }
    Ok((sum / f64::from(count)).sqrt())
}

fn main() -> Result<(), Box<dyn Error>> {
    let scene = SceneSettings::load("fig8")?.build()?;
    let controller = Controller {
        proportional: 0.3,
        integral: 300.0,
        sum: 0.0,
    };
    println!("tension off by, root mean square");
    println!("without control  {:6.3} N", wind(&scene, None)?);
    println!("with PI control  {:6.3} N", wind(&scene, Some(controller))?);
    Ok(())
}
