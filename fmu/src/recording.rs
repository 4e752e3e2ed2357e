//! Files of a run: a row per communication point, results at the end, in `output.directory`.

use coilwind::output::{Ending, History, Mark, OutputError, Snapshot, write_results};
use coilwind::settings::SceneSettings;
use coilwind::simulation::{SimError, Simulation};
use std::path::PathBuf;
use std::time::Duration;

/// What kept files from being written.
#[derive(Debug, thiserror::Error)]
pub(crate) enum RecordError {
    /// the folder or the scene in it
    #[error("cannot write {}: {source}", path.display())]
    Folder {
        /// folder or file
        path: PathBuf,
        /// what the system said
        source: std::io::Error,
    },
    /// a result file
    #[error(transparent)]
    Output(#[from] OutputError),
    /// the core's surface, wanted for the picture
    #[error(transparent)]
    Core(#[from] SimError),
}

/// The open files of a run.
#[derive(Debug)]
pub(crate) struct Recording {
    directory: PathBuf,
    /// `None` once a row could not be written: a table with holes would mislead
    history: Option<History>,
    snapshot: Snapshot,
    computed: Duration,
}

impl Recording {
    /// Makes the folder, leaves the scene in it and opens the history.
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
        std::fs::write(&scene, settings.to_toml()).map_err(folder(&scene))?;
        Ok(Self {
            history: Some(History::create(&directory.join("history.csv"))?),
            directory,
            snapshot,
            computed: Duration::ZERO,
        })
    }

    /// Where the history stands; `None` if it broke off.
    pub(crate) fn mark(&mut self) -> Result<Option<Mark>, RecordError> {
        Ok(self.history.as_mut().map(History::mark).transpose()?)
    }

    /// Takes the files of a restored state up again: the history is cut back to the mark. Where the file is not
    /// the one that the mark was made in, a new one begins; the flag says so.
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

    /// Counts time spent in the solver.
    pub(crate) fn computed(&mut self, duration: Duration) {
        self.computed += duration;
    }

    /// Adds a communication point, `time` in s of the experiment. After a failure, told once, the
    /// history ends there.
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

    /// Writes what describes the run and closes the files.
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
