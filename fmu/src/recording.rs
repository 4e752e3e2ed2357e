//! The files of a run in `output.directory`: a row per communication point, results at the end.

use crate::error::RecordError;
use coilwind::output::{Ending, History, Mark, RESULTS, Snapshot, write_results};
use coilwind::settings::SceneSettings;
use coilwind::simulation::Simulation;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// The open files of a run, and the time that the solver took so far.
#[derive(Debug)]
pub(crate) struct Recording {
    directory: PathBuf,
    /// `None` after a row could not be written, since a table with holes would mislead.
    history: Option<History>,
    snapshot: Snapshot,
    computed: Duration,
}

/// Tells whether `output.directory` holds the results of a run that has ended.
pub(crate) fn holds_results(settings: &SceneSettings) -> bool {
    let summary = Path::new(&settings.output.directory).join("summary.json");
    summary.is_file()
}

impl Recording {
    /// Makes the folder, writes the scene to it and opens the history.
    ///
    /// # Errors
    ///
    /// If a file cannot be written or the core's surface cannot be made.
    pub(crate) fn start(
        settings: &SceneSettings,
        simulation: &Simulation,
    ) -> Result<Self, RecordError> {
        let snapshot = Snapshot::new(simulation)?;
        let directory = PathBuf::from(&settings.output.directory);
        let scene = directory.join("scene.toml");
        let folder = |path: &PathBuf| {
            let path = path.clone();
            move |source| RecordError::Folder { path, source }
        };
        std::fs::create_dir_all(&directory).map_err(folder(&directory))?;
        // First what another run may hold, so that nothing of its is overwritten.
        let history = History::create(&directory.join("history.csv"))?;
        let earlier = RESULTS.iter().map(|name| directory.join(name));
        for file in earlier.filter(|file| file.is_file()) {
            std::fs::remove_file(&file).map_err(folder(&file))?;
        }
        std::fs::write(&scene, settings.to_toml_for_elsewhere()).map_err(folder(&scene))?;
        Ok(Self {
            history: Some(history),
            directory,
            snapshot,
            computed: Duration::ZERO,
        })
    }

    /// Puts all rows on disk and returns where the history stands, or `None` if it broke off.
    ///
    /// # Errors
    ///
    /// If the rows cannot be written.
    pub(crate) fn mark(&mut self) -> Result<Option<Mark>, RecordError> {
        Ok(self.history.as_mut().map(History::mark).transpose()?)
    }

    /// Opens the files of a restored state and cuts the history back to the mark. Where the file is
    /// not the one that the mark was made in, a new one begins, and the flag is true.
    ///
    /// # Errors
    ///
    /// As for [`Self::start`].
    pub(crate) fn resume(
        settings: &SceneSettings,
        simulation: &Simulation,
        mark: &Mark,
    ) -> Result<(Self, bool), RecordError> {
        let directory = PathBuf::from(&settings.output.directory);
        let history = History::resume(&directory.join("history.csv"), mark)?;
        let Some(history) = history else {
            return Ok((Self::start(settings, simulation)?, true));
        };
        let recording = Self {
            snapshot: Snapshot::new(simulation)?,
            history: Some(history),
            directory,
            computed: Duration::ZERO,
        };
        Ok((recording, false))
    }

    /// Time that the solver took so far.
    pub(crate) fn time_taken(&self) -> Duration {
        self.computed
    }

    /// Adds time that the solver took.
    pub(crate) fn computed(&mut self, duration: Duration) {
        self.computed += duration;
    }

    /// Adds a communication point at `time`, s of the experiment.
    ///
    /// # Errors
    ///
    /// If the row cannot be written. The history ends there, and later rows are left out without
    /// an error.
    pub(crate) fn row(&mut self, time: f64, simulation: &Simulation) -> Result<(), RecordError> {
        let Some(history) = &mut self.history else {
            return Ok(());
        };
        let written = history.row(time, simulation);
        if written.is_err() {
            self.history = None;
        }
        Ok(written?)
    }

    /// Writes the results of the run and closes the files.
    ///
    /// # Errors
    ///
    /// If a file cannot be written.
    pub(crate) fn finish(
        mut self,
        simulation: &Simulation,
        ending: &Ending,
    ) -> Result<(), RecordError> {
        let flushed = self.history.as_mut().map_or(Ok(()), History::flush);
        let wall_s = self.computed.as_secs_f64();
        let written = write_results(
            &self.directory,
            simulation,
            Some(&self.snapshot),
            ending,
            wall_s,
        );
        Ok(flushed.and(written)?)
    }
}
