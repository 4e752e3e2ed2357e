//! The bar that counts runs.

use indicatif::{HumanDuration, ProgressBar, ProgressState, ProgressStyle};
use std::fmt::Write;
use std::time::Duration;

/// A bar of so many runs, or one that is not shown.
///
/// The time left is told once a run has ended: before that nothing is known of it.
pub(super) fn runs_bar(quiet: bool, count: u64) -> ProgressBar {
    if quiet {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(count);
    let left = |state: &ProgressState, out: &mut dyn Write| {
        // (a bar that cannot be drawn is no reason to stop)
        let _ = match state.pos() {
            0 => write!(out, "no run has ended yet"),
            _ => write!(out, "{:#} left", HumanDuration(state.eta())),
        };
    };
    // The template is constant; a mistake in it would show as the default style.
    if let Ok(style) = ProgressStyle::with_template("{bar:30} {pos}/{len} runs  {elapsed}, {left}")
    {
        bar.set_style(style.with_key("left", left));
    }
    bar.enable_steady_tick(Duration::from_secs(1));
    bar
}
