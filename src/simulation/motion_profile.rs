//! The scene's own spindle ramp and traverse, as functions of time.

use crate::scene::Scene;
use crate::system::{Drive, NozzleDrive};
use std::f64::consts::TAU;

/// Share of a time by which sums of pieces of it may miss it.
pub(super) const ROUNDING: f64 = 1e-12;

/// Constant acceleration over the ramp, then constant speed; nozzle travel proportional to angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotionProfile {
    speed: f64,
    ramp_angle: f64,
    end_angle: f64,
    /// nozzle travel per core angle, m/rad
    pub travel_per_angle: f64,
}

impl MotionProfile {
    /// From a scene.
    pub fn new(scene: &Scene) -> Self {
        let s = scene.spindle;
        Self {
            speed: s.speed,
            ramp_angle: s.ramp_turns.min(s.turns) * TAU,
            end_angle: s.turns * TAU,
            travel_per_angle: scene.traverse.per_turn / TAU,
        }
    }

    fn ramp_time(&self) -> f64 {
        2.0 * self.ramp_angle / self.speed.abs()
    }

    /// Angle turned at a time, rad (with the sign of the speed).
    pub fn angle(&self, time: f64) -> f64 {
        let ramp = self.ramp_time();
        let size = if time < ramp {
            self.ramp_angle * (time / ramp).powi(2)
        } else {
            self.ramp_angle + self.speed.abs() * (time - ramp)
        };
        size.copysign(self.speed)
    }

    /// Speed at a time, rad/s.
    pub fn speed(&self, time: f64) -> f64 {
        let ramp = self.ramp_time();
        if time < ramp {
            self.speed * time / ramp
        } else {
            self.speed
        }
    }

    /// Time at which this much angle has been turned, s.
    pub fn time_at(&self, angle: f64) -> f64 {
        let a = angle.abs();
        let ramp = self.ramp_time();
        if a < self.ramp_angle {
            ramp * (a / self.ramp_angle).sqrt()
        } else {
            ramp + (a - self.ramp_angle) / self.speed.abs()
        }
    }

    /// When the last turn is done, s.
    pub fn end(&self) -> f64 {
        self.time_at(self.end_angle)
    }

    /// The motion between two times, s, in intervals of constant acceleration, at set tension `tension`, N.
    pub(crate) fn drives(&self, from: f64, to: f64, tension: f64) -> [Option<Drive>; 2] {
        let mut ramp = self.ramp_time();
        for edge in [from, to] {
            // what is left between is not a time, but the rounding of two
            if (edge - ramp).abs() < ROUNDING * ramp {
                ramp = edge;
            }
        }
        let mut drives = [None; 2];
        let drive = Drive {
            duration: 0.0,
            speed: self.speed,
            acceleration: 0.0,
            nozzle: NozzleDrive::WithSpindle(self.travel_per_angle),
            tension,
            tension_rate: 0.0,
        };
        if from < ramp {
            let end = to.min(ramp);
            if end > from {
                drives[0] = Some(Drive {
                    duration: end - from,
                    speed: self.speed(from),
                    acceleration: self.speed / self.ramp_time(),
                    ..drive
                });
            }
        }
        let start = from.max(ramp);
        if to > start {
            drives[1] = Some(Drive {
                duration: to - start,
                ..drive
            });
        }
        drives
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::SceneSettings;

    /// However time is cut, no piece is the rounding of a sum.
    #[test]
    fn pieces_are_no_rounding() {
        for speed in [30.0, 300.0, 500.0] {
            for ramp in ["0.25", "0.5", "0.3"] {
                let mut settings = SceneSettings::load("fig8").expect("packed");
                for (name, value) in [("spindle.turns", "1"), ("spindle.ramp_turns", ramp)] {
                    settings.set_text(name, value).expect("a setting");
                }
                let speed_text = format!("{speed}");
                settings
                    .set_text("spindle.speed", &speed_text)
                    .expect("a setting");
                let motion_profile = MotionProfile::new(&settings.build().expect("valid"));
                for count in 1..400 {
                    let dt = motion_profile.end() / f64::from(count);
                    let (mut time, mut whole) = (0.0, 0.0);
                    for _ in 0..count {
                        let drives = motion_profile.drives(time, time + dt, 15.0);
                        for piece in drives.into_iter().flatten() {
                            assert!(piece.duration > 1e-9 * dt, "{speed} {count} {piece:?}");
                            whole += piece.duration;
                        }
                        time += dt;
                    }
                    assert!((whole - motion_profile.end()).abs() < 1e-12);
                }
            }
        }
    }
}
