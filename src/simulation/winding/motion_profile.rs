//! The scene's own spindle ramp and traverse, as functions of time.

use super::run_state::WORTH_A_STEP;
use crate::scene::{NozzleLaw, Scene, SpeedLaw};
use crate::system::{Drive, NozzleDrive};

/// Share of a time by which sums of pieces of it may miss it.
pub(in crate::simulation) const ROUNDING: f64 = 1e-12;

/// The spindle by its law of speed; the nozzle goes with the angle.
#[derive(Clone, Debug, PartialEq)]
pub struct MotionProfile {
    /// 1 where the spindle turns about +y, -1 where it turns about -y
    sense: f64,
    spindle: SpeedLaw,
    nozzle: NozzleLaw,
}

impl MotionProfile {
    /// From a scene.
    pub fn new(scene: &Scene) -> Self {
        Self {
            sense: scene.spindle.speed.signum(),
            spindle: scene.speed_law.clone(),
            nozzle: scene.nozzle_law.clone(),
        }
    }

    /// Tells profiles apart whose scene is the same: the file of a table may have changed.
    pub(in crate::simulation) fn checksum(&self) -> u32 {
        let pieces = self.nozzle.pieces().iter();
        let pieces = pieces.flat_map(|piece| [piece.from, piece.y, piece.travel]);
        let stretches = self.spindle.stretches().iter();
        let stretches = stretches.flat_map(|one| [one.start, one.speed, one.gain, one.duration]);
        let mut sum = crc32fast::Hasher::new();
        for x in pieces.chain(stretches) {
            sum.update(&x.to_bits().to_le_bytes());
        }
        sum.finalize()
    }

    /// Angle turned at a time, rad (with the sign of the speed).
    pub fn angle(&self, time: f64) -> f64 {
        self.spindle.angle(time) * self.sense
    }

    /// Speed at a time, rad/s.
    pub fn speed(&self, time: f64) -> f64 {
        self.spindle.speed(time) * self.sense
    }

    /// Time at which this much angle has been turned, s.
    pub fn time_at(&self, angle: f64) -> f64 {
        self.spindle.time_at(angle.abs())
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
        // What is left between is the rounding of two times, or too short to be solved for.
        let snapped = |mut time: f64, edges: &[f64]| {
            for edge in edges {
                if (edge - time).abs() < WORTH_A_STEP.max(ROUNDING * time) {
                    time = *edge;
                }
            }
            time
        };
        let stretches = self.spindle.stretches();
        let stretches = around(stretches, |one| one.start <= from, |one| one.start < to);
        let pieces = self.nozzle.pieces();
        let [begun, done] = [from, to].map(|time| self.spindle.angle(time));
        let pieces = around(pieces, |one| one.from <= begun, |one| one.from < done);
        let stretch_starts = stretches
            .iter()
            .map(move |stretch| snapped(stretch.start, &[from, to]));
        let piece_starts = pieces.iter().map(move |piece| match piece.from {
            0.0 => f64::NEG_INFINITY,
            angle => {
                let starts = stretches.iter().map(|stretch| stretch.start);
                let time = starts.fold(self.time_at(angle), |time, edge| snapped(time, &[edge]));
                snapped(time, &[from, to])
            }
        });
        let within = move |(start, end): &(f64, f64)| *start < to && *end > from;
        // the pieces of the nozzle's way, each in the stretches of the spindle's
        std::iter::zip(pieces, spans(piece_starts))
            .filter(move |(_, span)| within(span))
            .flat_map(move |(piece, (start, end))| {
                let (from, to) = (from.max(start), to.min(end));
                std::iter::zip(stretches, spans(stretch_starts.clone())).filter_map(
                    move |(stretch, (start, end))| {
                        let (from, to) = (from.max(start), to.min(end));
                        let is_even = stretch.gain == 0.0;
                        (to > from).then(|| Drive {
                            duration: to - from,
                            speed: match is_even {
                                true => stretch.speed * self.sense,
                                false => self.speed(from),
                            },
                            acceleration: match is_even {
                                true => 0.0,
                                false => stretch.gain * self.sense / stretch.duration,
                            },
                            nozzle: NozzleDrive::WithSpindle(piece.travel * self.sense),
                            aside: [0.0; 2],
                            tension,
                            tension_rate: 0.0,
                        })
                    },
                )
            })
    }
}

/// Of things that follow each other those from the last that `has_begun` up to the last that `begins`, and one more on either side
/// for what rounding moves.
fn around<T>(all: &[T], has_begun: impl Fn(&T) -> bool, begins: impl Fn(&T) -> bool) -> &[T] {
    let first = all.partition_point(has_begun).saturating_sub(2);
    let end = all.partition_point(begins) + 1;
    &all[first..end.min(all.len())]
}

/// Start and end of things that follow each other; the last goes on without end.
fn spans(starts: impl Iterator<Item = f64> + Clone) -> impl Iterator<Item = (f64, f64)> {
    std::iter::zip(starts.clone(), starts.skip(1).chain([f64::INFINITY]))
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
