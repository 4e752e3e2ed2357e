//! The progress bar: turns, speed, time left. Hidden where nobody looks.

use coilwind::signals::Event;
use coilwind::simulation::Simulation;
use indicatif::{ProgressBar, ProgressStyle};

/// Ticks of the whole bar.
const TICKS: u64 = 10_000;

/// A bar on standard error.
pub(super) struct Progress {
    bar: ProgressBar,
    end: f64,
    quiet: bool,
}

impl Progress {
    /// A bar for a run of `end` seconds of simulated time.
    pub(super) fn new(end: f64, quiet: bool) -> Self {
        let bar = if quiet {
            ProgressBar::hidden()
        } else {
            ProgressBar::new(TICKS)
        };
        // The template is constant; a mistake in it would show as the default style.
        if let Ok(style) =
            ProgressStyle::with_template("{bar:30} {percent:>3} %  {msg}  {eta} left")
        {
            bar.set_style(style);
        }
        Self { bar, end, quiet }
    }

    /// Shows where the run is.
    pub(super) fn update(&self, simulation: &Simulation) {
        let share = (simulation.time() / self.end).clamp(0.0, 1.0);
        self.bar.set_position((share * TICKS as f64) as u64);
        let speed = simulation.inputs().spindle_speed;
        let rpm = speed * 30.0 / std::f64::consts::PI;
        let turns = simulation.outputs().spindle_angle / std::f64::consts::TAU;
        self.bar
            .set_message(format!("{turns:.2} turns  {speed:.0} rad/s ({rpm:.0} rpm)"));
    }

    /// Prints what happened above the bar.
    pub(super) fn tell(&self, events: &[Event]) {
        if !self.quiet && !events.is_empty() {
            self.bar
                .suspend(|| events.iter().for_each(|event| eprintln!("{event}")));
        }
    }

    /// Removes the bar.
    pub(super) fn finish(&self) {
        self.bar.finish_and_clear();
    }
}
