//! A nozzle that follows the scene's law of core angle while speed and tension are inputs.
//!
//! The law is a polyline over the angle that the core has turned, whichever way round. A communication step is divided
//! where the core passes a corner of the law or turns back, so that the nozzle goes with the core within each part. So is what a step
//! beyond the communication point follows.

use super::course::Course;
use crate::scene::{NozzleLaw, Scene};
use crate::signals::Inputs;
use crate::simulation::winding::WORTH_A_STEP;
use crate::simulation::{SimError, Winding};
use crate::system::{Drive, NozzleDrive};

/// Distance from its law up to which the nozzle is left where it is, wire diameters. Chosen: more than rounding adds up
/// to in a run, and too little to be seen. Within it the motion is that of the scene's own motion profile, to the bit.
const AS_GOOD_AS_THERE: f64 = 1e-9;

impl Winding {
    /// See [`crate::simulation::Simulation::starting_by_law`].
    pub(in crate::simulation) fn starting_by_law(
        scene: &Scene,
        inputs: Inputs,
    ) -> Result<Self, SimError> {
        let nozzle_position = scene.nozzle_law.start();
        let mut winding = Self::starting_with(
            scene,
            Inputs {
                nozzle_position,
                ..inputs
            },
        )?;
        winding.run.nozzle_by_law = true;
        Ok(winding)
    }

    /// Whether the nozzle follows the scene's law and not its input.
    pub fn nozzle_follows_law(&self) -> bool {
        self.run.nozzle_by_law
    }

    /// Goes through the motion `whole` with the nozzle on its law.
    pub(in crate::simulation) fn follow_by_law(&mut self, whole: &Drive) -> Result<(), SimError> {
        let angle = self.sys.state.spindle.angle - self.run.angle0;
        let law = self.scene.nozzle_law.clone();
        parts(*whole, &law, angle).try_for_each(|part| self.go_through(&part))
    }

    /// The course from the winding's time to the next corner of the nozzle's law.
    pub(in crate::simulation) fn along_law(&self, course: Course) -> Course {
        let angle = self.sys.state.spindle.angle - self.run.angle0;
        let time = self.run.time;
        let endless = course.drive(time, f64::INFINITY);
        let part = parts(endless, &self.scene.nozzle_law, angle).next();
        course.along(&part.unwrap_or(endless), time, self.nozzle_by_law())
    }

    /// Where the law has the nozzle along the core axis now, m; where it is, as long as that is as good.
    pub(super) fn nozzle_by_law(&self) -> f64 {
        let angle = self.sys.state.spindle.angle - self.run.angle0;
        let law = self.scene.nozzle_law.position(angle.abs());
        let is = self.sys.state.support[1].point.y;
        let near = AS_GOOD_AS_THERE * self.scene.wire.diameter;
        if (law - is).abs() <= near { is } else { law }
    }
}

/// The parts of a motion in which the nozzle travels evenly with the core, which stands at `angle`, rad, at its start.
///
/// What would be shorter than the solver can take a step for is left out.
fn parts(whole: Drive, law: &NozzleLaw, mut angle: f64) -> impl Iterator<Item = Drive> {
    let mut gone = 0.0;
    std::iter::from_fn(move || {
        while gone < whole.duration {
            let left = whole.duration - gone;
            let speed = whole.speed + whole.acceleration * gone;
            // which way the core turns once it moves, and whether that is away from its start
            let sense = (speed + whole.acceleration * WORTH_A_STEP.min(left)).signum();
            let side = if angle == 0.0 { sense } else { angle.signum() };
            let (travel, edge) = law.towards(angle.abs(), sense * side);
            let forward = (speed * sense).max(0.0);
            let gain = whole.acceleration * sense;
            let to_edge = time_for((edge - angle.abs()).abs(), forward, gain);
            let to_turning = if gain < 0.0 {
                forward / -gain
            } else {
                f64::INFINITY
            };
            let mut duration = to_edge.min(to_turning).min(left);
            if left - duration < WORTH_A_STEP {
                duration = left;
            }
            angle = match to_edge <= to_turning {
                true => side * edge,
                false => angle + (speed + 0.5 * whole.acceleration * duration) * duration,
            };
            if duration >= WORTH_A_STEP || duration == left {
                let part = Drive {
                    duration,
                    speed,
                    nozzle: NozzleDrive::WithSpindle(travel * side),
                    tension: whole.tension + whole.tension_rate * gone,
                    ..whole
                };
                gone += duration;
                return Some(part);
            }
        }
        None
    })
}

/// Time to go `distance`, m or rad, from a speed of 0 or more at a constant rate of change; infinite if that never leads there.
fn time_for(distance: f64, speed: f64, rate: f64) -> f64 {
    let square = speed * speed + 2.0 * rate * distance;
    if square < 0.0 {
        return f64::INFINITY;
    }
    let time = 2.0 * distance / (speed + square.sqrt());
    if time.is_nan() { f64::INFINITY } else { time }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::SceneSettings;
    use std::f64::consts::TAU;

    fn law() -> NozzleLaw {
        let mut settings = SceneSettings::load("bobbin").expect("packed");
        settings
            .set_text("traverse.mode", "orthocyclic")
            .expect("a mode");
        settings.build().expect("valid").nozzle_law
    }

    fn drive(speed: f64, acceleration: f64, duration: f64) -> Drive {
        Drive {
            duration,
            speed,
            acceleration,
            nozzle: NozzleDrive::Even(0.0),
            aside: [0.0; 2],
            tension: 15.0,
            tension_rate: 100.0,
        }
    }

    /// Follows the parts and compares the nozzle with the law at the end of each.
    fn check(whole: &Drive, law: &NozzleLaw, start: f64) -> usize {
        let parts: Vec<Drive> = parts(*whole, law, start).collect();
        let (mut angle, mut y, mut time) = (start, law.position(start.abs()), 0.0);
        for part in &parts {
            assert_eq!(part.speed, whole.speed + whole.acceleration * time);
            let turned = (part.speed + 0.5 * part.acceleration * part.duration) * part.duration;
            let NozzleDrive::WithSpindle(travel) = part.nozzle else {
                panic!("the nozzle is not with the core");
            };
            angle += turned;
            y += travel * turned;
            time += part.duration;
            let off = y - law.position(angle.abs());
            assert!(off.abs() < 1e-12, "{off:e} m off at {angle} rad, {part:?}");
        }
        assert!((time - whole.duration).abs() <= 1e-15);
        parts.len()
    }

    #[test]
    fn the_nozzle_is_on_its_law_at_every_corner() {
        let law = law();
        for start in [0.0, 0.3, 5.9, TAU, -4.0, 40.0] {
            for (speed, acceleration) in [
                (300.0, 0.0),
                (-300.0, 0.0),
                (0.0, 4e4),
                (200.0, -2e4),
                (-150.0, 3e4),
                (10.0, -5e4),
            ] {
                assert!(check(&drive(speed, acceleration, 0.05), &law, start) > 1);
            }
        }
        assert_eq!(check(&drive(0.0, 0.0, 0.05), &law, 1.0), 1);
        assert_eq!(check(&drive(100.0, 0.0, 1e-3), &law, 1.0), 1);
    }
}
