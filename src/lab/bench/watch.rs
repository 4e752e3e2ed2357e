//! CPU and wall time of a stretch of one thread.

use cpu_time::ThreadTime;
use std::time::Instant;

/// Started, and running.
#[derive(Debug)]
pub(super) struct Watch {
    cpu: ThreadTime,
    wall: Instant,
}

/// Seconds that something took.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Spent {
    /// of this thread's CPU, s
    pub cpu: f64,
    /// on the wall, s
    pub wall: f64,
}

impl Watch {
    pub(super) fn start() -> Self {
        Self {
            cpu: ThreadTime::now(),
            wall: Instant::now(),
        }
    }

    /// Since the start.
    pub(super) fn spent(&self) -> Spent {
        Spent {
            cpu: self.cpu.elapsed().as_secs_f64(),
            wall: self.wall.elapsed().as_secs_f64(),
        }
    }
}
