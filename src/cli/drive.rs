//! What moves the machine in a run: the scene's own motion, or sampled inputs on a communication grid.

use super::failure::Failure;
use super::shell::quoted;
use super::signals::{Grid, Signals};
use coilwind::scene::Scene;
use coilwind::settings::{NozzleFollows, SceneSettings, Spindle};
use coilwind::signals::Inputs;
use coilwind::simulation::{MotionProfile, OTHER_WAY, SimError, Simulation};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// Most communication steps of a run. Chosen: a computer takes a day for as many at the least, and their table is half a terabyte.
const MOST_STEPS: f64 = 1e9;

/// Where the motion of a run comes from, as it was asked for.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Motion {
    /// file of the sampled inputs, and the communication step, s
    pub(super) inputs: Option<(PathBuf, f64)>,
    /// simulated time at which to stop, s
    pub(super) stop_time: Option<f64>,
}

impl Motion {
    /// What the nozzle follows: in a run of the scene's own motion, its law.
    pub(super) fn nozzle_follows(&self, settings: &SceneSettings) -> NozzleFollows {
        match self.inputs {
            Some(_) => settings.nozzle_follows(),
            None => NozzleFollows::Law,
        }
    }
}

impl Motion {
    /// Whether steps may reach beyond its points or rows.
    pub(super) fn reaches_beyond(&self, scene: &Scene) -> bool {
        let features = scene.solver.features;
        match self.inputs {
            Some(_) => features.steps_beyond,
            None => features.rows_between,
        }
    }

    /// The options that ask for it, a blank before each, as a shell in any folder takes them.
    pub(super) fn options(&self) -> String {
        let mut words = String::new();
        if let Some((file, step)) = &self.inputs {
            let file = std::path::absolute(file).unwrap_or_else(|_| file.clone());
            words += &format!(" --inputs {} --step {step}", quoted(file.display()));
        }
        if let Some(time) = self.stop_time {
            words += &format!(" --stop-time {time}");
        }
        words
    }
}

/// How far a drive is.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(super) enum Place {
    /// rows of the history so far
    MotionProfile { count: u64 },
    /// the grid, and the inputs before the first sample
    Signals { grid: (f64, u64), held: Inputs },
}

/// What moves the machine.
#[derive(Debug)]
pub(super) enum Drive {
    /// the scene's own spindle and traverse, a row per core angle
    MotionProfile {
        /// rad between rows
        interval: f64,
        /// rows so far
        count: u64,
        /// s
        end: f64,
    },
    /// sampled inputs on a communication grid
    Signals {
        signals: Signals,
        /// as it was given
        file: String,
        /// start values; inputs without samples stay there
        held: Inputs,
        grid: Grid,
        /// s
        end: f64,
    },
}

impl Drive {
    /// The drive of a scene; of sampled inputs, the nozzle's is not among them where it follows the scene's law.
    pub(super) fn new(
        motion: &Motion,
        scene: &Scene,
        follows: NozzleFollows,
    ) -> Result<Self, Failure> {
        let Some((path, step)) = &motion.inputs else {
            let end = MotionProfile::new(scene).end();
            let end = motion.stop_time.map_or(end, |stop| stop.min(end));
            return Ok(Self::MotionProfile {
                interval: scene.output.history_interval,
                count: 0,
                end,
            });
        };
        let signals = Signals::read(path)?;
        if follows.is_law() && signals.has("nozzle_position") {
            return Err(twice(path));
        }
        let end = motion.stop_time.unwrap_or(signals.end());
        if end <= 0.0 {
            return Err(no_duration(path));
        }
        // (a step that is as long but for rounding is none longer)
        if *step > end * (1.0 + 1e-9) {
            return Err(too_long(*step, end));
        }
        if end / step > MOST_STEPS {
            return Err(too_short(*step, end));
        }
        let held = signals.before(0.0, scene.start_inputs());
        Ok(Self::Signals {
            held,
            grid: Grid::new(*step, end),
            signals,
            file: path.display().to_string(),
            end,
        })
    }

    /// The axis about which the inputs wind, for `spindle.direction`, where that is `auto` and their speed at the start says another
    /// one: a machine starts at rest.
    pub(super) fn winds_otherwise(&self, spindle: &Spindle) -> Option<&'static str> {
        let Self::Signals { signals, held, .. } = self else {
            return None;
        };
        let sense = signals.winding_sense(OTHER_WAY);
        let otherwise = sense * spindle.sense_from(held.spindle_speed) < 0.0;
        let axis = if sense < 0.0 { "-y" } else { "+y" };
        (spindle.direction == "auto" && otherwise).then_some(axis)
    }

    /// What holds where the run begins before the inputs or goes on beyond them, in words.
    pub(super) fn warnings(&self) -> Vec<String> {
        let Self::Signals {
            signals,
            grid,
            end,
            file,
            ..
        } = self
        else {
            return Vec::new();
        };
        let (first, last) = (signals.begin(), signals.end());
        let mut told = Vec::new();
        if first > 0.0 {
            let held = signals.first();
            told.push(format!(
                "{file}: the first time is {first} s, and the run begins at 0 s; until then its first row holds: {held}; \
                 if the record begins there, take {first} s off all times"
            ));
        } else if first < 0.0 {
            told.push(format!(
                "{file}: the first time is {first} s, and the run begins at 0 s; rows before that are left out; \
                 if the record begins there, add {} s to all times",
                -first
            ));
        }
        let missed = signals.missed(grid.step(), *end);
        told.extend(missed.map(|missed| format!("{file}: {missed}")));
        if *end > last {
            told.push(format!(
                "the inputs end at {last} s; until --stop-time {end} s speed and tension stay as in the last row, and the nozzle stands"
            ));
        }
        told
    }

    /// Simulated time at the end, s.
    pub(super) fn end(&self) -> f64 {
        match self {
            Self::MotionProfile { end, .. } | Self::Signals { end, .. } => *end,
        }
    }

    /// Where it is, for [`Self::go_on`].
    pub(super) fn place(&self) -> Place {
        match self {
            Self::MotionProfile { count, .. } => Place::MotionProfile { count: *count },
            Self::Signals { grid, held, .. } => Place::Signals {
                grid: grid.place(),
                held: *held,
            },
        }
    }

    /// Goes on from a place; false where that is one of the other kind of drive.
    pub(super) fn go_on(&mut self, place: Place) -> bool {
        match (self, place) {
            (Self::MotionProfile { count, .. }, Place::MotionProfile { count: to }) => *count = to,
            (
                Self::Signals { grid, held, .. },
                Place::Signals {
                    grid: to,
                    held: old,
                },
            ) => {
                grid.go_on(to);
                *held = old;
            }
            _ => return false,
        }
        true
    }

    /// Advances to the next point and gives its time, s; `None` at the end.
    pub(super) fn advance(&mut self, simulation: &mut Simulation) -> Option<Result<f64, SimError>> {
        match self {
            Self::MotionProfile {
                interval,
                count,
                end,
            } => {
                let time = simulation.time();
                // Rounding must leave no sliver of a step before the end.
                let sliver = 1e-12 * *end;
                if time >= *end - sliver {
                    return None;
                }
                *count += 1;
                let row = simulation
                    .motion_profile()
                    .time_at(*count as f64 * *interval);
                let next = if row >= *end - sliver { *end } else { row };
                let mut gone = simulation.advance_profile(next - time);
                if next == *end {
                    // the last row is what the results tell of
                    gone = gone.and_then(|()| simulation.catch_up());
                }
                Some(gone.map(|()| next))
            }
            Self::Signals {
                signals,
                held,
                grid,
                ..
            } => {
                let (start, length, end) = grid.next(signals)?;
                let inputs = signals.after(start, *held);
                Some(simulation.advance(inputs, length).map(|()| end))
            }
        }
    }
}

fn twice(path: &Path) -> Failure {
    Failure::Signals {
        file: path.display().to_string(),
        reason: "column nozzle_position, while traverse.mode was set to a law of the core's angle; leave out one of them, \
                 or set traverse.mode = by-input"
            .to_owned(),
    }
}

fn too_long(step: f64, end: f64) -> Failure {
    Failure::Signals {
        file: format!("--step {step}"),
        reason: format!("longer than the run; allowed: up to its length, {end} s"),
    }
}

fn too_short(step: f64, end: f64) -> Failure {
    Failure::Signals {
        file: format!("--step {step}"),
        reason: format!(
            "{:.1e} steps, more than a run can have; allowed: {:.1e} s and more",
            end / step,
            end / MOST_STEPS
        ),
    }
}

fn no_duration(path: &Path) -> Failure {
    Failure::Signals {
        file: path.display().to_string(),
        reason: "the last time is not after 0; allowed: a later time, or --stop-time".to_owned(),
    }
}
