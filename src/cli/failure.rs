//! How a command fails, and the exit code that says so.

use super::shell::{begin_again, resume_command};
use coilwind::output::{OutputError, ReportError};
use coilwind::scene::SceneError;
use coilwind::simulation::SimError;
use std::io::ErrorKind;
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
    /// Cells of an input file are wrong.
    #[error("{}", cells.join("\n"))]
    Cells {
        /// a line for each: file, line, column, value, what is wrong and what would do
        cells: Vec<String>,
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
    #[error("{directory} holds {holds}; add --force to overwrite it, or --out for another folder{}", if *can_go_on { format!(", or go on with: {}", resume_command(directory)) } else { String::new() })]
    Occupied {
        /// the folder
        directory: String,
        /// another run, or a sweep
        holds: &'static str,
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
    Report(#[from] ReportError),
    /// The solver gave up on the way.
    #[error("the solver gave up {reason}; what was computed so far is in {directory}")]
    Solver {
        /// time, place and reason
        reason: SimError,
        /// where the results are
        directory: String,
    },
    /// The run's own numbers contradict each other.
    #[error("not judged: {reason}; what was computed is in {directory}")]
    Doubt {
        /// how, since when, and what to do
        reason: String,
        /// where the results are
        directory: String,
    },
    /// Ctrl-C.
    #[error(
        "interrupted at t = {} s; what was computed so far is in {directory}; {}",
        seconds(*time),
        goes_on(*time, *kept, directory, told)
    )]
    Interrupted {
        /// simulated time, s
        time: f64,
        /// simulated time of the last checkpoint, s, if there is one
        kept: Option<f64>,
        /// where the results are
        directory: String,
        /// options that the command which goes on takes too
        told: String,
    },
    /// A file could not be written while a run was going on: the disk is full.
    #[error("{failure}; {next}")]
    Stuck {
        /// which file, and what the system said
        failure: Box<Failure>,
        /// what to do
        next: String,
    },
    /// The ranges or the folder of `sweep` are wrong.
    #[error("sweep: {reason}")]
    Sweep {
        /// what is wrong, and what would do
        reason: String,
    },
    /// `--find-max` has no answer.
    #[error("sweep: {reason}")]
    NoMaximum {
        /// why, and what would do
        reason: String,
        /// the solver gave up on the way
        failed: bool,
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
        "interrupted; {done} of {all} members are done; go on with: {}{told}",
        resume_command(directory)
    )]
    EnsembleInterrupted {
        /// members that ended
        done: usize,
        /// members
        all: usize,
        /// where their folders are
        directory: String,
        /// options that the command which goes on takes too
        told: String,
    },
    /// A member of an ensemble that goes on has failed before.
    #[error("{reason}; what was computed so far is in {directory}")]
    MemberFailed {
        /// why, as its summary says
        reason: String,
        /// its folder
        directory: String,
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

    /// A write that failed for want of room, on the disk or under a limit.
    pub(super) fn is_without_room(&self) -> bool {
        let output = match self {
            Self::Output(output) | Self::Report(ReportError::Output(output)) => Some(output),
            _ => None,
        };
        let kind = match (self, output) {
            (Self::Write { source, .. }, _) | (_, Some(OutputError::Io { source, .. })) => {
                source.kind()
            }
            (_, Some(OutputError::Json { source, .. })) => {
                source.io_error_kind().unwrap_or(ErrorKind::Other)
            }
            _ => return false,
        };
        use ErrorKind::{FileTooLarge, QuotaExceeded, StorageFull, WriteZero};
        matches!(kind, FileTooLarge | QuotaExceeded | StorageFull | WriteZero)
    }

    /// Ranges or a folder of `sweep` that will not do.
    pub(super) fn sweep(reason: String) -> Self {
        Self::Sweep { reason }
    }

    /// 1 defect or wrong number, 2 bad input, 3 solver or a full disk on the way, or a run in doubt, 4 no answer, 130 interrupted (128 + SIGINT, as shells have it).
    fn code(&self) -> u8 {
        match self {
            Self::Report(_) if self.is_without_room() => 3,
            Self::Defect { .. } | Self::Verify | Self::Invariant { .. } => 1,
            Self::Scene(_)
            | Self::Start { .. }
            | Self::Cells { .. }
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
            Self::Solver { .. }
            | Self::Doubt { .. }
            | Self::Stuck { .. }
            | Self::MemberFailed { .. }
            | Self::BenchStopped { .. }
            | Self::NoMaximum { failed: true, .. } => 3,
            Self::NoMaximum { failed: false, .. } => 4,
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

/// A time to the microsecond, without zeros at its end.
fn seconds(time: f64) -> String {
    let text = format!("{time:.6}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// Where a run that was stopped at `time` goes on, and how.
fn goes_on(time: f64, kept: Option<f64>, directory: &str, told: &str) -> String {
    let next = || format!("go on with: {}{told}", resume_command(directory));
    match kept.map(seconds) {
        None => begin_again(Path::new(directory)) + told,
        Some(kept) if kept == seconds(time) => next(),
        Some(kept) => format!(
            "its last checkpoint is of t = {kept} s, and what came after it is computed again; {}",
            next()
        ),
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

    /// The message told the time that was reached, and the run went on from another one; a folder of two words was two.
    #[test]
    fn an_interrupted_run_says_from_when_it_goes_on_and_how() {
        let told = |kept| {
            let failure = Failure::Interrupted {
                time: 0.183_000_000_1,
                kept,
                directory: "my runs/a".to_owned(),
                told: " --quiet".to_owned(),
            };
            assert_eq!(failure.code(), 130);
            failure.to_string()
        };
        let command = "; go on with: coilwind run --resume 'my runs/a' --quiet";
        let begins = "interrupted at t = 0.183 s; what was computed so far is in my runs/a; ";
        let again = told(Some(0.0));
        assert!(
            again.starts_with(begins) && again.ends_with(command),
            "{again}"
        );
        assert!(
            again.contains("its last checkpoint is of t = 0 s"),
            "{again}"
        );
        let same = told(Some(0.183));
        assert!(
            !same.contains("checkpoint") && same.ends_with(command),
            "{same}"
        );
        let none = told(None);
        assert!(
            none.ends_with("; begin again with: coilwind run 'my runs/a/scene.toml' --out 'my runs/a' --force --quiet"),
            "{none}"
        );
    }
}
