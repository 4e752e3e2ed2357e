//! Files of a run in `output.directory`. One that cannot be written is a warning, not an error.

use super::Instance;
use crate::message::Message;
use crate::recording::{self, Recording};
use coilwind::output::Ending;

impl Instance {
    /// Opens the files and writes the first row, if `output.directory` names a folder.
    pub(super) fn record(&mut self) {
        let Some(run) = &mut self.run else { return };
        let settings = self.parameters.settings();
        if settings.output.directory.is_empty() {
            return;
        }
        let before = recording::holds_results(settings);
        match Recording::start(settings, &run.simulation) {
            Ok(recording) => {
                run.recording = Some(recording);
                if before {
                    let directory = &settings.output.directory;
                    self.messages.push(Message::overwritten(directory));
                }
            }
            Err(reason) => self.messages.push(Message::not_written(reason)),
        }
        self.record_row();
    }

    /// Adds the present communication point to the files, if there are any.
    pub(super) fn record_row(&mut self) {
        if let Some(run) = &mut self.run
            && let Some(recording) = &mut run.recording
            && let Err(reason) = recording.row(self.clock.now(), &run.simulation)
        {
            self.messages.push(Message::not_written(reason));
        }
    }

    /// Writes the results and closes the files, if any are open.
    pub(super) fn finish_recording(&mut self, ending: &Ending) {
        let Some(run) = &mut self.run else { return };
        let Some(recording) = run.recording.take() else {
            return;
        };
        // The files are those of the communication point. Where no step leads there, of the last one before it.
        let _ = run.simulation.catch_up();
        if let Err(reason) = recording.finish(&run.simulation, ending) {
            self.messages.push(Message::not_written(reason));
        }
    }
}
