//! What the importer reads in its log, collected during a call and delivered at its end.

use crate::ffi::Status;
use coilwind::signals::{Event, EventKind};
use coilwind::simulation::SolverStatistics;
use coilwind_model_description::Category;
use std::fmt::Display;

/// One message to the importer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Message {
    pub(crate) status: Status,
    pub(crate) category: Category,
    pub(crate) text: String,
}

impl Message {
    /// Returns the message about an event of a simulation that began at `start`, s of the experiment.
    fn of_event(event: &Event, start: f64) -> Self {
        let (status, category) = match event.kind {
            EventKind::Turn | EventKind::Defect | EventKind::Note => (Status::Ok, Category::Events),
            EventKind::Solver => (Status::Ok, Category::Solver),
            // The wire is still computed, but a machine would have stopped.
            EventKind::Slack
            | EventKind::Break
            | EventKind::Collision
            | EventKind::Runaway
            | EventKind::Judgement => (Status::Warning, Category::Warning),
        };
        Self {
            status,
            category,
            text: Event {
                time: start + event.time,
                ..event.clone()
            }
            .to_string(),
        }
    }

    /// Returns the messages about the events of one communication step. What the solver had to do in it is one message, however often
    /// it had to.
    pub(crate) fn of_events(events: &[Event], start: f64) -> Vec<Self> {
        let of_solver = |event: &&Event| event.kind == EventKind::Solver;
        let (count, last) = (
            events.iter().filter(of_solver).count(),
            events.iter().rfind(of_solver),
        );
        let mut told = false;
        let mut messages = Vec::new();
        for event in events {
            let again = of_solver(&event) && std::mem::replace(&mut told, true);
            if again {
                continue;
            }
            let mut message = Self::of_event(event, start);
            if let Some(last) = last.filter(|_| of_solver(&event) && count > 1) {
                let (more, time) = (count - 1, start + last.time);
                message.text += &format!(
                    "; {more} more such in this communication step, up to t = {time:.6} s"
                );
            }
            messages.push(message);
        }
        messages
    }

    /// Returns what the solver did up to `time`, s of the experiment, in all.
    pub(crate) fn of_solver(counts: &SolverStatistics, time: f64) -> Self {
        let SolverStatistics {
            steps,
            rejects,
            newton_failures,
            forced,
            ..
        } = counts;
        let mut text = format!(
            "t = {time:.6} s: the solver took {steps} steps, and gave up {rejects} for their error and {newton_failures} after a search in vain"
        );
        if *forced > 0 {
            text += &format!("; {forced} of those taken have an error above solver.tolerance");
        }
        Self {
            status: Status::Ok,
            category: Category::Solver,
            text,
        }
    }

    /// Returns a warning: the call is served, and there is something to look at.
    pub(crate) fn warning(text: impl Display) -> Self {
        Self {
            status: Status::Warning,
            category: Category::Warning,
            text: text.to_string(),
        }
    }

    /// Returns a message about a directional derivative. The call is served without a warning, which importers take for a failure.
    pub(crate) fn about_derivative(text: String) -> Self {
        Self {
            status: Status::Ok,
            category: Category::Derivatives,
            text,
        }
    }

    /// Returns the warning that files in `output.directory` are missing. The run does not need them.
    pub(crate) fn not_written(reason: impl Display) -> Self {
        Self::warning(format_args!("output.directory: {reason}"))
    }

    /// Returns the warning that `directory` holds a run that has ended, which this one overwrites.
    pub(crate) fn overwritten(directory: &str) -> Self {
        Self::warning(format_args!(
            "output.directory: {directory} holds the results of a run before, which this run overwrites; \
             name another folder to keep them"
        ))
    }
}
