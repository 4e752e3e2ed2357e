//! The files a run leaves beside `history.csv`.

use super::failure::Failure;
use coilwind::output::{write_summary, write_turns, write_vtp};
use coilwind::simulation::{Simulation, Summary};
use serde::Serialize;
use std::path::{Path, PathBuf};

/// How a run ended.
#[derive(Clone, Debug, Serialize)]
#[serde(tag = "status", rename_all = "snake_case")]
pub(super) enum Ending {
    /// as planned
    Done,
    /// by Ctrl-C
    Interrupted,
    /// the solver gave up
    Failed {
        /// time, place and reason
        reason: String,
    },
}

/// What `summary.json` holds: how the run ended, how long it took, and the run itself.
#[derive(Serialize)]
struct Report {
    #[serde(flatten)]
    ending: Ending,
    wall_s: f64,
    real_time_factor: f64,
    #[serde(flatten)]
    summary: Summary,
}

/// Writes everything that describes the state reached; also after a failure.
pub(super) fn write_results(
    directory: &Path,
    simulation: &Simulation,
    ending: &Ending,
    wall_s: f64,
) -> Result<(), Failure> {
    let summary = simulation.summary();
    write_turns(&directory.join("turns.csv"), &summary.turns)?;
    let real_time_factor = if wall_s > 0.0 {
        simulation.time() / wall_s
    } else {
        0.0
    };
    let report = Report {
        ending: ending.clone(),
        wall_s,
        real_time_factor,
        summary,
    };
    write_summary(&directory.join("summary.json"), &report)?;
    write_geometry(&directory.join("coil"), simulation)
}

/// Writes the wire as it is now, as `stem.vtp`.
fn write_geometry(stem: &Path, simulation: &Simulation) -> Result<(), Failure> {
    let radius = simulation.scene().wire.radius();
    write_vtp(
        &stem.with_extension("vtp"),
        &simulation.centreline(),
        radius,
        None,
    )?;
    Ok(())
}

/// Snapshots evenly spread over a run, in `frames/`.
pub(super) struct Frames {
    directory: PathBuf,
    count: u32,
    end: f64,
    written: u32,
}

impl Frames {
    /// `count` frames over `end` seconds; none makes no folder.
    pub(super) fn new(directory: &Path, count: u32, end: f64) -> Result<Self, Failure> {
        let directory = directory.join("frames");
        if count > 0 {
            std::fs::create_dir_all(&directory).map_err(|e| Failure::write(&directory, e))?;
        }
        Ok(Self {
            directory,
            count,
            end,
            written: 0,
        })
    }

    /// Writes the frame that is due, if one is; the last one at the end of the run.
    pub(super) fn update(&mut self, simulation: &Simulation) -> Result<(), Failure> {
        // A share of the end, with room for the rounding of times.
        let share = simulation.time() / self.end * (1.0 + 1e-9);
        let due = (share * f64::from(self.count))
            .floor()
            .min(f64::from(self.count)) as u32;
        if due > self.written {
            self.written = due;
            let stem = self.directory.join(format!("frame_{due:04}"));
            write_geometry(&stem, simulation)?;
        }
        Ok(())
    }
}
