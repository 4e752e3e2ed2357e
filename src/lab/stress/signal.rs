//! Input signals: what a machine does, and what goes wrong with it.

use super::case_random::CaseRandom;
use super::{Kind, Layers};
use crate::scene::{Core, Scene};
use crate::signals::Inputs;
use std::f64::consts::TAU;

/// Samples of a case, at most.
const MOST: usize = 6000;
/// Samples of a standstill, at most.
const MOST_STILL: f64 = 1200.0;

/// Communication step, s, and the inputs of each, the last of which only ends the run. The nozzle goes `by_law` of the
/// scene, or to and fro in `layers`.
pub(super) fn draw(
    case_random: &mut CaseRandom,
    kind: Kind,
    scene: &Scene,
    layers: Layers,
    by_law: bool,
) -> (f64, Vec<Inputs>) {
    let top = scene.spindle.speed;
    // a controller looks every 0.3 to 6 degrees of its core
    let step = case_random.log(0.005, 0.1) / top;
    let plan = Plan::new(case_random, kind, scene, step);
    let reach = scene.nozzle.distance;
    let half = match scene.core {
        Core::RoundedBox { length_y, .. } | Core::Cylinder { length_y, .. } => 0.5 * length_y,
        Core::Mesh { .. } => 0.0,
    };
    let mut inputs = Vec::new();
    let (mut angle, mut turned, mut jumped) = (0.0_f64, 0.0_f64, 0.0);
    let mut wait = 0.0;
    while turned < scene.spindle.turns * TAU && inputs.len() < MOST && !plan.is_over(wait) {
        let time = inputs.len() as f64 * step;
        let mut speed = top * plan.speed(turned, time, &mut wait);
        let mut tension = scene.tensioner.tension * plan.tension(turned, wait);
        if plan.jumps.first().is_some_and(|first| turned > first.0) || jumped != 0.0 {
            let passed = plan.jumps.iter().filter(|j| turned > j.0);
            jumped = passed.map(|j| j.1).sum();
        }
        let mut nozzle = jumped
            + match by_law {
                true => scene.nozzle_law.position(angle),
                false => scene.nozzle.y_start + scene.traverse.per_turn * layers.way(angle / TAU),
            };
        if angle + speed * step < 0.0 {
            // unwound: farther back the wire would fold at its clamp, which looks the other way
            break;
        }
        if kind == Kind::Noise {
            speed *= 1.0 + plan.noise * case_random.even(-1.0, 1.0);
            tension *= 1.0 + plan.noise * case_random.even(-1.0, 1.0);
            nozzle += 0.1 * plan.noise * scene.wire.diameter * case_random.even(-1.0, 1.0);
        }
        // as far beside the core as scenes let a nozzle start
        nozzle = nozzle.clamp(-half - reach, half + reach);
        inputs.push(Inputs {
            spindle_speed: speed.clamp(-2000.0, 2000.0),
            nozzle_position: nozzle,
            tension_setpoint: tension.max(0.0),
            ..Inputs::HELD
        });
        angle += speed * step;
        turned += (speed * step).abs();
    }
    inputs.extend(inputs.last().copied());
    (step, inputs)
}

/// When what happens, in rad turned so far.
struct Plan {
    kind: Kind,
    /// rad over which the speed rises at first; 0: at once
    ramp: f64,
    /// s of that
    ramp_time: f64,
    /// when it begins and ends, rad
    event: [f64; 2],
    /// what speed becomes of it, as a share
    share: f64,
    /// how long the core stands or takes to stop, samples
    still: f64,
    /// whether it goes on after a stop; whether it goes back gently
    resumes: bool,
    /// what tension becomes of it, as a share
    pull: f64,
    /// rad and m
    jumps: Vec<(f64, f64)>,
    /// share
    noise: f64,
}

impl Plan {
    fn new(case_random: &mut CaseRandom, kind: Kind, scene: &Scene, step: f64) -> Self {
        let whole = scene.spindle.turns * TAU;
        let at = whole * case_random.even(0.2, 0.8);
        let length = whole * case_random.even(0.02, 0.2);
        let ramp = match kind {
            Kind::Step => 0.0,
            _ => scene.spindle.ramp_turns * TAU,
        };
        let jumps = match kind {
            Kind::Jump => (0..case_random.pick(&[1, 2, 4]))
                .map(|_| {
                    let way = scene.wire.diameter * case_random.log(0.5, 10.0);
                    (
                        whole * case_random.even(0.05, 0.95),
                        way * case_random.sign(),
                    )
                })
                .collect(),
            _ => Vec::new(),
        };
        let still = case_random.log(1e-3, 0.1) / step;
        Self {
            kind,
            ramp,
            ramp_time: 2.0 * ramp / scene.spindle.speed,
            event: [at, (at + length).min(whole)],
            share: match kind {
                Kind::Step => case_random.even(0.1, 1.0),
                _ => -case_random.even(0.1, 1.0),
            },
            still: still.clamp(3.0, MOST_STILL / 4.0),
            resumes: case_random.chance(0.5),
            pull: match kind {
                Kind::Emergency => case_random.even(1.2, 3.0),
                Kind::Slack => 0.0,
                _ => 1.0,
            },
            jumps,
            noise: case_random.log(0.01, 0.5),
        }
    }

    /// Speed over top speed at `turned` rad; `wait` counts samples since a stop began.
    fn speed(&self, turned: f64, time: f64, wait: &mut f64) -> f64 {
        if self.ramp > 0.0 && time < self.ramp_time {
            // (never quite nothing, or the first sample would turn nothing and the next neither)
            return (time / self.ramp_time).max(1e-3);
        }
        let inside = turned >= self.event[0];
        match self.kind {
            Kind::Step if inside && turned < self.event[1] => self.share,
            Kind::Reverse if inside && !self.resumes && turned < self.event[1] => self.share,
            Kind::Reverse if inside && self.resumes && *wait < 3.0 * self.still => {
                // gently: back, and on again
                *wait += 1.0;
                let w = *wait / self.still;
                1.0 + (self.share - 1.0) * w.min(1.0).min(3.0 - w).max(0.0)
            }
            Kind::Stop if inside && *wait < 2.0 * self.still => {
                *wait += 1.0;
                (*wait / self.still - 1.0).max(0.0)
            }
            Kind::Emergency if inside => {
                *wait += 1.0;
                (1.0 - *wait / self.still).max(0.0)
            }
            _ => 1.0,
        }
    }

    /// Whether the core stands and will not go on.
    fn is_over(&self, wait: f64) -> bool {
        match self.kind {
            Kind::Stop => !self.resumes && wait > self.still,
            Kind::Emergency => wait > 2.0 * self.still,
            _ => false,
        }
    }

    fn tension(&self, turned: f64, wait: f64) -> f64 {
        match self.kind {
            Kind::Emergency if wait > 0.0 => self.pull,
            Kind::Slack if turned >= self.event[0] && turned < self.event[1] => self.pull,
            _ => 1.0,
        }
    }
}
