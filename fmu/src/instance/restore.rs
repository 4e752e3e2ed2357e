//! Saved states: what they take along, and going back to one.

use super::{Instance, Run, not_written};
use crate::ffi::Status;
use crate::logger::Message;
use crate::recording::Recording;
use crate::refusal::Refusal;
use crate::state::{SavedRun, Snapshot};
use coilwind_model_description::{Category, guid};

impl Instance {
    /// `fmi2GetFMUstate`
    pub(crate) fn snapshot(&mut self) -> Snapshot {
        let mut trouble = None;
        let run = self.run.as_mut().map(|run| {
            let recording = run.recording.as_mut();
            let mark = match recording.map(Recording::mark).transpose() {
                Ok(mark) => mark.flatten(),
                Err(reason) => {
                    trouble = Some(not_written(&reason));
                    None
                }
            };
            SavedRun {
                simulation: run.simulation.clone(),
                inputs: run.inputs,
                rates: run.rates,
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
            run,
        }
    }

    /// `fmi2SetFMUstate`: name, resources and logging stay. The history in `output.directory` is cut back to
    /// where it stood; other files are written at the end of the run as ever.
    pub(crate) fn restore(&mut self, saved: &Snapshot) {
        // what is written is on disk before it is read
        if let Some(run) = &mut self.run
            && let Some(mut recording) = run.recording.take()
            && let Err(reason) = recording.mark()
        {
            self.messages.push(not_written(&reason));
        }
        let saved = saved.clone();
        self.state = saved.state;
        self.clock = saved.clock;
        self.parameters = saved.parameters;
        self.start_inputs = saved.start_inputs;
        self.start_rates = saved.start_rates;
        self.run = saved.run.map(|run| {
            let settings = self.parameters.settings();
            let recording = run.mark.and_then(|mark| {
                let resumed = Recording::resume(settings, &run.simulation, &mark);
                match resumed {
                    Ok((recording, false)) => Some(recording),
                    Ok((recording, true)) => {
                        self.messages.push(history_anew(self.clock.now()));
                        Some(recording)
                    }
                    Err(reason) => {
                        self.messages.push(not_written(&reason));
                        None
                    }
                }
            });
            Box::new(Run {
                simulation: run.simulation,
                inputs: run.inputs,
                rates: run.rates,
                recording,
            })
        });
    }

    /// `fmi2SerializeFMUstate`
    pub(crate) fn bytes_of(&self, saved: &Snapshot) -> Result<Vec<u8>, Refusal> {
        saved.to_bytes(guid()?)
    }

    /// `fmi2DeSerializeFMUstate`
    pub(crate) fn snapshot_from(&self, bytes: &[u8]) -> Result<Snapshot, Refusal> {
        Snapshot::from_bytes(bytes, guid()?)
    }
}

/// The rows before a restored state are not there to be gone on with.
fn history_anew(time: f64) -> Message {
    Message {
        status: Status::Warning,
        category: Category::Warning,
        text: format!(
            "output.directory: history.csv is not the one of the restored state and begins anew after {time} s"
        ),
    }
}
