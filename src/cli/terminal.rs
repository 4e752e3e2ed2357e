//! Standard output, and signals.

use super::failure::Failure;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Signals within this time are one. Chosen: `timeout` and service managers signal a program and its group within milliseconds,
/// nobody who presses Ctrl-C once more has waited less.
const AT_ONCE: Duration = Duration::from_secs(1);

/// A flag that Ctrl-C and SIGTERM raise; one that comes later ends the program at once.
pub(super) fn stop_flag() -> Arc<AtomicBool> {
    let flag = Arc::new(AtomicBool::new(false));
    let raised = Arc::clone(&flag);
    let mut first = None;
    let handler = ctrlc::set_handler(move || {
        raised.store(true, Ordering::SeqCst);
        if first.get_or_insert_with(Instant::now).elapsed() > AT_ONCE {
            std::process::exit(130);
        }
    });
    if handler.is_err() {
        eprintln!("warning: Ctrl-C will end the run without results");
    }
    flag
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
