//! How a command fails, and the exit code that says so.

use coilwind::output::OutputError;
use coilwind::scene::SceneError;
use coilwind::simulation::SimError;
use std::path::Path;
use std::process::ExitCode;
use thiserror::Error;

/// Everything a command can fail with.
#[derive(Debug, Error)]
pub(super) enum Failure {
    /// The scene is wrong.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The scene is valid but a run of it cannot start.
    #[error("{scene}: cannot start: {reason}")]
    Start {
        /// packed name or path
        scene: String,
        /// why
        reason: SimError,
    },
    /// A cell of an input file is wrong.
    #[error("{file}:{line}: {column} = {value}: {reason}; allowed: {allowed}")]
    Cell {
        /// as given
        file: String,
        /// from 1
        line: u64,
        /// name in the header
        column: String,
        /// as given
        value: String,
        /// what is wrong
        reason: &'static str,
        /// what would do
        allowed: String,
    },
    /// An input file as a whole is wrong.
    #[error("{file}: {reason}")]
    Signals {
        /// as given
        file: String,
        /// what is wrong, and what would do
        reason: String,
    },
    /// A file or folder cannot be written.
    #[error("cannot write {path}: {source}")]
    Write {
        /// file or folder
        path: String,
        /// of the operating system
        source: std::io::Error,
    },
    /// A result file cannot be written.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// The folder of the results holds a run.
    #[error("{directory} holds another run; add --force to overwrite it, or --out for another folder{}", if *can_go_on { format!(", or go on with: coilwind run --resume {directory}") } else { String::new() })]
    Occupied {
        /// the folder
        directory: String,
        /// the run was stopped before its end
        can_go_on: bool,
    },
    /// A run cannot go on.
    #[error("{directory}: {reason}")]
    Resume {
        /// the folder
        directory: String,
        /// why, and what to do
        reason: String,
    },
    /// No report can be made.
    #[error(transparent)]
    Report(#[from] coilwind::output::ReportError),
    /// The solver gave up on the way.
    #[error("the solver gave up {reason}; what was computed so far is in {directory}")]
    Solver {
        /// time, place and reason
        reason: SimError,
        /// where the results are
        directory: String,
    },
    /// Ctrl-C.
    #[error(
        "interrupted at t = {time} s; what was computed so far is in {directory}; go on with: coilwind run --resume {directory}"
    )]
    Interrupted {
        /// simulated time, s
        time: f64,
        /// where the results are
        directory: String,
    },
    /// The ranges or the folder of `sweep` are wrong.
    #[error("sweep: {reason}")]
    Sweep {
        /// what is wrong, and what would do
        reason: String,
    },
    /// Ctrl-C during `sweep`.
    #[error("interrupted; {done} runs are kept; go on with: {command}")]
    SweepInterrupted {
        /// runs that ended
        done: usize,
        /// what goes on
        command: String,
    },
    /// Ctrl-C during a run of an ensemble.
    #[error(
        "interrupted; {done} of {all} members are done{}{}",
        commands.iter().map(|command| format!("; go on with: {command}")).collect::<String>(),
        if missing.is_empty() { String::new() } else { format!("; not begun: {}", missing.join(", ")) }
    )]
    EnsembleInterrupted {
        /// members that ended
        done: usize,
        /// members
        all: usize,
        /// what goes on with those on their way
        commands: Vec<String>,
        /// folders of members that have not begun
        missing: Vec<String>,
    },
    /// Case files or settings of `verify` are wrong.
    #[error(transparent)]
    Cases(#[from] coilwind::lab::verify::VerifyError),
    /// Options or files of `bench` are wrong.
    #[error(transparent)]
    Bench(#[from] coilwind::lab::bench::BenchError),
    /// A benchmark stopped on the way; its line is printed.
    #[error("bench: no complete answer: {reason}")]
    BenchStopped {
        /// why
        reason: String,
    },
    /// No scene could be drawn.
    #[error("stress: {reason}")]
    Draw {
        /// which, and why
        reason: String,
    },
    /// Ctrl-C during `stress`.
    #[error("interrupted; what failed so far is in {directory}")]
    StepError {
        /// where the files are
        directory: String,
    },
    /// `stress` found what must not be.
    #[error("{count} of the scenes broke an invariant; their files are in {directory}")]
    Invariant {
        /// how many
        count: u64,
        /// where the files are
        directory: String,
    },
    /// A number is out of tolerance.
    #[error("not every number is right")]
    Verify,
    /// `--fail-on-defect` and there was one.
    #[error("defects: {what}")]
    Defect {
        /// which flags, how many
        what: String,
    },
}

impl Failure {
    /// A write that failed.
    pub(super) fn write(path: impl AsRef<Path>, source: std::io::Error) -> Self {
        Self::Write {
            path: path.as_ref().display().to_string(),
            source,
        }
    }

    /// Ranges or a folder of `sweep` that will not do.
    pub(super) fn sweep(reason: String) -> Self {
        Self::Sweep { reason }
    }

    /// 1 defect or wrong number, 2 bad input, 3 solver, 130 interrupted (128 + SIGINT, as shells have it).
    fn code(&self) -> u8 {
        match self {
            Self::Defect { .. } | Self::Verify | Self::Invariant { .. } => 1,
            Self::Scene(_)
            | Self::Start { .. }
            | Self::Cell { .. }
            | Self::Signals { .. }
            | Self::Write { .. }
            | Self::Output(_)
            | Self::Report(_)
            | Self::Occupied { .. }
            | Self::Resume { .. }
            | Self::Cases(_)
            | Self::Bench(_)
            | Self::Sweep { .. }
            | Self::Draw { .. } => 2,
            Self::Solver { .. } | Self::BenchStopped { .. } => 3,
            Self::Interrupted { .. }
            | Self::SweepInterrupted { .. }
            | Self::EnsembleInterrupted { .. }
            | Self::StepError { .. } => 130,
        }
    }

    /// The same for the operating system.
    pub(super) fn exit_code(&self) -> ExitCode {
        ExitCode::from(self.code())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_solver_that_gives_up_says_when_where_why_and_exits_with_three() {
        let reason = SimError {
            time: 0.25,
            node: Some(17),
            reason: "not finite".to_owned(),
        };
        let failure = Failure::Solver {
            reason,
            directory: "out".to_owned(),
        };
        assert_eq!(failure.code(), 3);
        let text = failure.to_string();
        for part in ["0.25", "node 17", "not finite", "so far is in out"] {
            assert!(text.contains(part), "{text}");
        }
    }
}
