//! Standard output, and signals.

use super::failure::Failure;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Signals within this time are one. Chosen: `timeout` and service managers signal a program and its group within milliseconds,
/// nobody who presses Ctrl-C once more has waited less.
const AT_ONCE: Duration = Duration::from_secs(1);

/// How long a communication step may take to its end once a stop is asked for: a run goes on from there, and loses nothing.
const TO_ITS_END: Duration = Duration::from_millis(300);

/// What Ctrl-C and SIGTERM raise; one that comes later ends the program at once.
#[derive(Clone, Default)]
pub(super) struct StopFlags {
    /// no further step is to begin
    pub(super) asked: Arc<AtomicBool>,
    /// the step that goes on is to end too
    pub(super) overdue: Arc<AtomicBool>,
}

impl StopFlags {
    /// Flags that signals raise from now on.
    pub(super) fn on_signals() -> Self {
        let flags = Self::default();
        let raised = flags.clone();
        let mut first = None;
        // (a thread of its own, which may sleep)
        let handler = ctrlc::set_handler(move || {
            raised.asked.store(true, Ordering::SeqCst);
            if first.get_or_insert_with(Instant::now).elapsed() > AT_ONCE {
                std::process::exit(130);
            }
            std::thread::sleep(TO_ITS_END);
            raised.overdue.store(true, Ordering::SeqCst);
        });
        if handler.is_err() {
            eprintln!("warning: Ctrl-C will end the run without results");
        }
        flags
    }
}

/// Lets a write fail that a limit on the size of files (`ulimit -f`) forbids, as it does on a full disk. The signal that comes
/// with it would end the program without a word.
pub(super) fn outlive_file_limit() {
    #[cfg(unix)]
    {
        let seen = Arc::new(AtomicBool::new(false));
        // without the handler all else works
        let _ = signal_hook::flag::register(signal_hook::consts::SIGXFSZ, seen);
    }
}

/// Writes to standard output; a reader that has seen enough (`| head`) is no failure.
pub(super) fn print(text: &str) -> Result<(), Failure> {
    use std::io::{ErrorKind, Write};
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(Failure::write("standard output", error))
        }
        _ => Ok(()),
    }
}
