//! The scene's own spindle ramp and traverse, as functions of time.

use super::WORTH_A_STEP;
use crate::scene::{NozzleLaw, Scene};
use crate::system::{Drive, NozzleDrive};
use std::f64::consts::TAU;

/// Share of a time by which sums of pieces of it may miss it.
pub(super) const ROUNDING: f64 = 1e-12;

/// Constant acceleration over the ramp, then constant speed; the nozzle goes with the angle.
#[derive(Clone, Debug, PartialEq)]
pub struct MotionProfile {
    speed: f64,
    ramp_angle: f64,
    nozzle: NozzleLaw,
}

impl MotionProfile {
    /// From a scene.
    pub fn new(scene: &Scene) -> Self {
        let s = scene.spindle;
        Self {
            speed: s.speed,
            ramp_angle: s.ramp_turns.min(s.turns) * TAU,
            nozzle: scene.nozzle_law.clone(),
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
        self.time_at(self.nozzle.end())
    }

    /// Nozzle position at a time, s, in m.
    pub fn nozzle(&self, time: f64) -> f64 {
        self.nozzle.position(self.angle(time).abs())
    }

    /// The motion between two times, s, in intervals of constant acceleration and even travel, at set tension `tension`, N.
    pub(crate) fn drives(
        &self,
        from: f64,
        to: f64,
        tension: f64,
    ) -> impl Iterator<Item = Drive> + use<'_> {
        // what is left between is the rounding of two times, or too short to be solved for
        let snapped = move |mut time: f64| {
            for edge in [from, to] {
                if (edge - time).abs() < WORTH_A_STEP.max(ROUNDING * time) {
                    time = edge;
                }
            }
            time
        };
        let ramp = snapped(self.ramp_time());
        // before the ramp ends and after, in the pieces of the nozzle's way
        let pieces = self.nozzle.pieces();
        let starts = pieces.iter().map(move |p| match p.from {
            0.0 => f64::NEG_INFINITY,
            angle => snapped(self.time_at(angle)),
        });
        let ends = starts.clone().skip(1).chain([f64::INFINITY]);
        let spans = pieces.iter().zip(starts.zip(ends));
        spans
            .filter(move |(_, (start, end))| *start < to && *end > from)
            .flat_map(move |(piece, (start, end))| {
                let (from, to) = (from.max(start), to.min(end));
                let drive = Drive {
                    duration: 0.0,
                    speed: self.speed,
                    acceleration: 0.0,
                    nozzle: NozzleDrive::WithSpindle(piece.travel * self.speed.signum()),
                    aside: [0.0; 2],
                    tension,
                    tension_rate: 0.0,
                };
                let rises = (from < ramp && to.min(ramp) > from).then(|| Drive {
                    duration: to.min(ramp) - from,
                    speed: self.speed(from),
                    acceleration: self.speed / self.ramp_time(),
                    ..drive
                });
                let begin = from.max(ramp);
                let goes_on = (to > begin).then_some(Drive {
                    duration: to - begin,
                    ..drive
                });
                [rises, goes_on].into_iter().flatten()
            })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::SceneSettings;

    /// A run that ended at a row of its history went on from there for the 0.3 ns to a corner of the nozzle's way, and gave up.
    #[test]
    fn no_piece_is_left_between_a_row_and_a_corner() {
        let settings = SceneSettings::load("tooth").expect("packed");
        let motion_profile = MotionProfile::new(&settings.build().expect("valid"));
        let corners: Vec<f64> = motion_profile
            .nozzle
            .pieces()
            .iter()
            .map(|p| p.from)
            .collect();
        assert!(corners.len() > 20);
        for corner in &corners[1..20] {
            let corner = motion_profile.time_at(*corner);
            for off in [-3e-10, -1e-12, 1e-11, 6e-10] {
                for (from, to) in [(corner - 1e-4, corner + off), (corner + off, corner + 1e-4)] {
                    let pieces: Vec<Drive> = motion_profile.drives(from, to, 15.0).collect();
                    assert!(
                        pieces.iter().all(|p| p.duration > 1e-9),
                        "{off}: {pieces:?}"
                    );
                    let whole: f64 = pieces.iter().map(|p| p.duration).sum();
                    assert!((whole - (to - from)).abs() < 1e-15);
                }
            }
        }
    }

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
                        for piece in drives {
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
