//! A word on work that takes long before it has anything to show, as on a core of many triangles.

use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::thread;
use std::time::Duration;

/// How long one waits without a word.
const PATIENCE: Duration = Duration::from_secs(2);

/// Work under way, until this is dropped.
pub(super) struct Waiting {
    _done: Sender<()>,
}

impl Waiting {
    /// For all that comes before the first step: says so on standard error where that takes long.
    pub(super) fn for_start() -> Self {
        Self::tell(PATIENCE, || {
            eprintln!(
                "still reading the scene and its core, which takes long where that is a fine mesh ..."
            );
        })
    }

    /// Calls `tell` once after that time, unless the work is done by then.
    fn tell(after: Duration, tell: impl FnOnce() + Send + 'static) -> Self {
        let (done, is_done) = channel();
        let listen = move || {
            if is_done.recv_timeout(after) == Err(RecvTimeoutError::Timeout) {
                tell();
            }
        };
        // (without a thread there is no word)
        drop(thread::Builder::new().spawn(listen));
        Self { _done: done }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A check of a core of 360,000 long triangles took 20 s without a word.
    #[test]
    fn only_what_takes_long_is_told() {
        let told = |work: Duration| {
            let (tell, said) = channel();
            let waiting = Waiting::tell(Duration::from_millis(50), move || {
                tell.send(()).expect("someone listens");
            });
            thread::sleep(work);
            drop(waiting);
            said.recv().is_ok()
        };
        assert!(!told(Duration::ZERO));
        assert!(told(Duration::from_secs(1)));
    }
}
