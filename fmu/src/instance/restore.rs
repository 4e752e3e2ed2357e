//! Saved states: taking one of an instance, going back to one, and the bytes of one.

use super::Instance;
use super::run::Run;
use crate::error::Error;
use crate::message::Message;
use crate::recording::Recording;
use crate::state::{SavedRun, Snapshot};
use coilwind_model_description::guid;
use std::time::Duration;

impl Instance {
    /// `fmi2GetFMUstate`. What stands in the files of the run is on disk afterwards. Where that
    /// fails, the importer gets a warning and the state has no place in the history.
    pub(crate) fn snapshot(&mut self) -> Snapshot {
        let mut trouble = None;
        let run = self.run.as_mut().map(|run| {
            let recording = run.recording.as_mut();
            let mark = match recording.map(Recording::mark).transpose() {
                Ok(mark) => mark.flatten(),
                Err(reason) => {
                    trouble = Some(Message::not_written(reason));
                    None
                }
            };
            SavedRun {
                simulation: run.simulation.clone(),
                inputs: run.inputs,
                rates: run.rates,
                last: run.last.clone(),
                mark,
            }
        });
        self.messages.extend(trouble);
        Snapshot {
            state: self.state,
            clock: self.clock,
            parameters: self.parameters.clone(),
            start_inputs: self.start_inputs.clone(),
            start_rates: self.start_rates.clone(),
            demonstrates: self.demonstrates,
            run,
        }
    }

    /// `fmi2SetFMUstate`. Name, resources and logging stay. The history in `output.directory` is
    /// cut back to where it stood; the end of the run writes the other files.
    pub(crate) fn restore(&mut self, saved: &Snapshot) {
        // Buffered rows must be on disk before the file is read again.
        let mut taken = Duration::ZERO;
        if let Some(run) = &mut self.run
            && let Some(mut recording) = run.recording.take()
        {
            taken = recording.time_taken();
            if let Err(reason) = recording.mark() {
                self.messages.push(Message::not_written(reason));
            }
        }
        let saved = saved.clone();
        self.state = saved.state;
        self.clock = saved.clock;
        self.parameters = saved.parameters;
        self.start_inputs = saved.start_inputs;
        self.start_rates = saved.start_rates;
        self.demonstrates = saved.demonstrates;
        self.of_scene = None;
        self.run = saved.run.map(|run| {
            let settings = self.parameters.settings();
            let mut recording = run.mark.and_then(|mark| {
                let resumed = Recording::resume(settings, &run.simulation, &mark);
                match resumed {
                    Ok((recording, false)) => Some(recording),
                    Ok((recording, true)) => {
                        self.messages.push(history_anew(self.clock.now()));
                        Some(recording)
                    }
                    Err(reason) => {
                        self.messages.push(Message::not_written(reason));
                        None
                    }
                }
            });
            // What was computed in vain is part of what the results have cost.
            if let Some(recording) = &mut recording {
                recording.computed(taken);
            }
            Box::new(Run {
                simulation: run.simulation,
                inputs: run.inputs,
                rates: run.rates,
                last: run.last,
                recording,
            })
        });
    }

    /// `fmi2SerializeFMUstate`: the bytes of a saved state.
    ///
    /// # Errors
    ///
    /// If the state cannot be encoded, or parameters that were set contradict each other.
    pub(crate) fn bytes_of(&self, saved: &Snapshot) -> Result<Vec<u8>, Error> {
        saved.parameters.scene()?;
        saved.to_bytes(guid()?)
    }

    /// `fmi2DeSerializeFMUstate`: the saved state of bytes. The instance does not change.
    ///
    /// # Errors
    ///
    /// [`Error::Bytes`] or [`Error::State`] if the bytes are not a state of this FMU.
    pub(crate) fn snapshot_from(&self, bytes: &[u8]) -> Result<Snapshot, Error> {
        Snapshot::from_bytes(bytes, guid()?, self.identity.resources.as_deref())
    }
}

/// Warns that the history lacks the rows before `time`, s.
fn history_anew(time: f64) -> Message {
    Message::warning(format_args!(
        "output.directory: history.csv is not the one of the restored state and begins anew after \
         {time} s; leave the file in place until the state is restored to keep earlier rows"
    ))
}
