//! The progress line: turns, simulated time, its ratio to the clock, time left, defects. Hidden where nobody looks.

use coilwind::signals::{Event, EventKind};
use coilwind::simulation::Simulation;
use indicatif::{HumanDuration, ProgressBar, ProgressStyle};
use std::time::{Duration, Instant};

/// Ticks of the whole bar.
const TICKS: u64 = 10_000;

/// A line on standard error.
pub(super) struct Progress {
    bar: ProgressBar,
    /// simulated time at the end and where this process began, s
    end: f64,
    from: f64,
    began: Instant,
    quiet: bool,
    verbose: bool,
}

impl Progress {
    /// A line for a run from `from` to `end`, s of simulated time.
    pub(super) fn new(end: f64, from: f64, quiet: bool, verbose: bool) -> Self {
        let bar = if quiet {
            ProgressBar::hidden()
        } else {
            ProgressBar::new(TICKS)
        };
        // The template is constant; a mistake in it would show as the default style.
        if let Ok(style) = ProgressStyle::with_template("{bar:24} {percent:>3} %  {msg}") {
            bar.set_style(style);
        }
        Self {
            bar,
            end,
            from,
            began: Instant::now(),
            quiet,
            verbose,
        }
    }

    /// Shows where the run is.
    pub(super) fn update(&self, simulation: &Simulation) {
        let time = simulation.time();
        let share = (time / self.end).clamp(0.0, 1.0);
        self.bar.set_position((share * TICKS as f64) as u64);
        if self.bar.is_hidden() {
            return;
        }
        let wall = self.began.elapsed().as_secs_f64();
        let factor = (time - self.from) / wall.max(1e-9);
        let outputs = simulation.outputs();
        let turns = outputs.spindle_angle.abs() / std::f64::consts::TAU;
        let left = match factor > 0.0 && wall > 0.5 {
            true => HumanDuration(Duration::from_secs_f64((self.end - time).max(0.0) / factor))
                .to_string(),
            false => "?".to_owned(),
        };
        let defects = outputs.defect_count;
        let s = if defects == 1 { "" } else { "s" };
        self.bar.set_message(format!(
            "{turns:.2} turns  {time:.4} s  x{factor:.3}  {left} left  {defects} defect{s}"
        ));
    }

    /// Prints what happened above the line; what the solver had to do only where it was asked for.
    pub(super) fn tell(&self, events: &[Event]) {
        let told = |event: &&Event| self.verbose || event.kind != EventKind::Solver;
        if !self.quiet && events.iter().any(|event| told(&event)) {
            let print = || {
                events
                    .iter()
                    .filter(told)
                    .for_each(|event| eprintln!("{event}"));
            };
            self.bar.suspend(print);
        }
    }

    /// Removes the line.
    pub(super) fn finish(&self) {
        self.bar.finish_and_clear();
    }
}
