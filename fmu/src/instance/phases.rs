//! From instantiation to the end: the calls that move an instance from state to state.

use super::Instance;
use crate::clock::Clock;
use crate::error::Error;
use crate::lifecycle::State;
use crate::message::Message;
use coilwind::output::Ending;
use coilwind::variables::by_reference;

impl Instance {
    /// `fmi2SetupExperiment`, times in s. The tolerance scales that of the solver.
    ///
    /// # Errors
    ///
    /// [`Error::Time`] if a time is not finite or the stop time is not after the start time, [`Error::Tolerance`] if
    /// that is not one.
    pub(crate) fn setup_experiment(
        &mut self,
        tolerance: Option<f64>,
        start: f64,
        stop: Option<f64>,
    ) -> Result<(), Error> {
        let clock = Clock::new(start, stop)?;
        self.parameters = self
            .parameters
            .for_tolerance(tolerance, self.identity.resources.as_deref())?;
        self.clock = clock;
        self.run = None;
        Ok(())
    }

    /// `fmi2EnterInitializationMode`. Parameters may still change, so that nothing is validated
    /// yet. Never fails.
    pub(crate) fn enter_initialization_mode(&mut self) -> Result<(), Error> {
        self.state = State::Initialization;
        Ok(())
    }

    /// `fmi2ExitInitializationMode`
    ///
    /// # Errors
    ///
    /// If the scene is not valid or has no valid start.
    pub(crate) fn exit_initialization_mode(&mut self) -> Result<(), Error> {
        let started = self.start().map(|_| ());
        let of_scene = match (&started, self.of_scene.take()) {
            (Ok(()), Some(told)) => told,
            (Ok(()), None) => {
                let (_, warnings) = self.parameters.scene()?;
                warnings.iter().map(Message::warning).collect()
            }
            (Err(_), _) => Vec::new(),
        };
        self.messages.extend(of_scene);
        // (a scene that has no valid start may have lost values of its file)
        self.warn_of_contradictions();
        started?;
        self.begin_demonstration();
        self.record();
        self.state = State::StepComplete;
        Ok(())
    }

    /// Tells the importer where what it set is not what the scene says.
    fn warn_of_contradictions(&mut self) {
        let mut texts = self.parameters.contradictions();
        texts.extend(self.parameters.effect_of_tolerance());
        let run = self.run.as_ref();
        let own = run.map_or_else(
            || self.parameters.settings().start_inputs(),
            |run| run.simulation.scene().start_inputs(),
        );
        for (reference, value) in &self.start_inputs {
            let input = by_reference(*reference);
            let text =
                input.and_then(|row| self.parameters.contradiction_of_input(row, *value, &own));
            texts.extend(text);
        }
        self.messages.extend(texts.iter().map(Message::warning));
    }

    /// `fmi2Terminate`. Never fails.
    pub(crate) fn terminate(&mut self) -> Result<(), Error> {
        let ending = if self.clock.is_over() {
            Ending::Done
        } else {
            Ending::Interrupted
        };
        self.finish_recording(&ending);
        self.sum_up();
        self.state = State::Terminated;
        Ok(())
    }

    /// How a run ends that nobody terminates: as it was meant to where it has reached its stop time.
    fn untold_ending(&self) -> Ending {
        match self.clock.has_reached_stop() {
            true => Ending::Done,
            false => Ending::Interrupted,
        }
    }

    /// Tells what the solver did in all, if it did anything.
    fn sum_up(&mut self) {
        let counts = self.run.as_ref().map(|run| run.simulation.statistics());
        if let Some(counts) = counts.filter(|counts| counts.steps > 0) {
            let summary = Message::of_solver(&counts, self.clock.now());
            self.messages.push(summary);
        }
    }

    /// `fmi2Reset`: a fresh instance with the same name, resources and logging. Never fails.
    pub(crate) fn reset(&mut self) -> Result<(), Error> {
        self.finish_recording(&self.untold_ending());
        let messages = std::mem::take(&mut self.messages);
        *self = Self {
            messages,
            ..Self::fresh(self.identity.clone())
        };
        Ok(())
    }

    /// `fmi2FreeInstance`. A run that nobody terminated leaves its results as well.
    pub(crate) fn close(&mut self) {
        if self.state != State::Fatal {
            self.finish_recording(&self.untold_ending());
        }
    }
}
