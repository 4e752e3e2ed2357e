//! Frames of a film on the way: the wire at evenly spread times, and the file that lists them.

use super::failure::Failure;
use coilwind::output::{Snapshot, write_series};
use coilwind::simulation::Simulation;
use std::path::{Path, PathBuf};

/// Name of the list in the folder of a run; ParaView opens it as a film.
pub(super) const SERIES: &str = "frames.pvd";

/// Frames evenly spread over a run, in `frames/`, listed in [`SERIES`].
pub(super) struct Frames {
    directory: PathBuf,
    count: u32,
    end: f64,
    /// number, from 1, and time in s of the frames written
    written: Vec<(u32, f64)>,
    /// frames that were written, and gone when the run went on
    lost: usize,
}

impl Frames {
    /// `count` frames over `end` seconds; none makes no folder.
    pub(super) fn new(directory: &Path, count: u32, end: f64) -> Result<Self, Failure> {
        let folder = directory.join("frames");
        if count > 0 {
            std::fs::create_dir_all(&folder).map_err(|e| Failure::write(&folder, e))?;
        }
        Ok(Self {
            directory: directory.to_owned(),
            count,
            end,
            written: Vec::new(),
            lost: 0,
        })
    }

    /// Numbers and times of the frames written, for [`Self::go_on`].
    pub(super) fn written(&self) -> &[(u32, f64)] {
        &self.written
    }

    /// Goes on after these frames, as far as they are still there.
    pub(super) fn go_on(&mut self, mut written: Vec<(u32, f64)>) {
        let before = written.len();
        written.retain(|&(number, _)| self.directory.join(name(number)).is_file());
        self.lost = before - written.len();
        self.written = written;
    }

    /// What to say where there are fewer frames than were asked for.
    pub(super) fn fewer(&self) -> Option<String> {
        let (kept, asked) = (self.written.len(), self.count);
        if self.lost > 0 {
            let lost = self.lost;
            return Some(format!(
                "{kept} of {asked} frames are kept: {lost} were gone when the run went on; for all, wind the scene again"
            ));
        }
        (kept < asked as usize).then(|| {
            format!(
                "{kept} of {asked} frames are kept, one at each row of history.csv; for more, lower output.history_interval, or --step with --inputs"
            )
        })
    }

    /// Writes the frame that is due, if one is; the last one at the end of the run.
    pub(super) fn update(
        &mut self,
        simulation: &Simulation,
        snapshot: &Snapshot,
    ) -> Result<(), Failure> {
        // A share of the end, with room for the rounding of times.
        let share = simulation.time() / self.end * (1.0 + 1e-9);
        let count = f64::from(self.count);
        let due = (share * count).floor().min(count) as u32;
        if due > self.written.last().map_or(0, |&(number, _)| number) {
            // (the wire may be a step of the method behind; where none leads on, it is drawn where it is)
            let there = simulation.caught_up();
            let shown = there.as_ref().unwrap_or(simulation);
            snapshot.write_frame(&self.directory.join(name(due)), shown)?;
            self.written.push((due, simulation.time()));
            let listed: Vec<(f64, String)> = self
                .written
                .iter()
                .map(|&(number, time)| (time, name(number)))
                .collect();
            write_series(&self.directory.join(SERIES), &listed)?;
        }
        Ok(())
    }
}

/// A frame's file, from the folder of the run.
fn name(number: u32) -> String {
    format!("frames/frame_{number:04}.vtp")
}
