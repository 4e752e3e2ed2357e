//! Snapshots on the way, for films.

use super::failure::Failure;
use coilwind::output::Snapshot;
use coilwind::simulation::Simulation;
use std::path::{Path, PathBuf};

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

    /// Frames written, for [`Self::go_on`].
    pub(super) fn written(&self) -> u32 {
        self.written
    }

    /// Goes on after so many frames.
    pub(super) fn go_on(&mut self, written: u32) {
        self.written = written;
    }

    /// Writes the frame that is due, if one is; the last one at the end of the run.
    pub(super) fn update(
        &mut self,
        simulation: &Simulation,
        snapshot: &Snapshot,
    ) -> Result<(), Failure> {
        // A share of the end, with room for the rounding of times.
        let share = simulation.time() / self.end * (1.0 + 1e-9);
        let due = (share * f64::from(self.count))
            .floor()
            .min(f64::from(self.count)) as u32;
        if due > self.written {
            self.written = due;
            let stem = self.directory.join(format!("frame_{due:04}"));
            snapshot.write(&stem, simulation)?;
        }
        Ok(())
    }
}
