//! `coilwind run --ensemble K`: K members side by side, a folder each, and how often each verdict was given.

use super::failure::Failure;
use super::folder;
use super::members;
use super::run::{Judged, RunArgs, wind_one};
use super::terminal::{print, stop_flag};
use coilwind::settings::SceneSettings;
use indicatif::{ProgressBar, ProgressStyle};
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::sync::atomic::Ordering;

/// Winds every member on all cores.
///
/// # Errors
/// What is wrong with the scene or a folder, before anything is wound; then that of the first member with an error, after all
/// have ended.
pub(super) fn run(args: &RunArgs, count: u32) -> Result<(), Failure> {
    let name = args.scene.as_deref().unwrap_or_default();
    let (settings, _, warnings) = SceneSettings::load_and_build(name, &args.set)?;
    if !args.quiet {
        warnings.iter().for_each(|w| eprintln!("warning: {w}"));
    }
    let directory = args.directory(&settings);
    let mut all = Vec::new();
    for member in 1..=count {
        let mut one = args.clone();
        one.set.extend(members::setting(&settings, member, count));
        SceneSettings::load_and_build(name, &one.set)?;
        let out = directory.join(member.to_string());
        folder::refuse_occupied(&out, args.force)?;
        one.out = Some(out);
        // What a member has to say stands in its folder.
        (one.quiet, one.verbose, one.fail_on_defect) = (true, false, false);
        all.push(one);
    }
    let bar = bar(args.quiet, count);
    let stop = stop_flag();
    let wind = |one: &RunArgs| {
        // Members that have not begun when Ctrl-C comes leave no folder.
        let ended = (!stop.load(Ordering::SeqCst)).then(|| wind_one(one, &stop));
        bar.inc(1);
        ended
    };
    let ended: Vec<Option<Result<Judged, Failure>>> = all.par_iter().map(wind).collect();
    bar.finish_and_clear();
    if stop.load(Ordering::SeqCst) {
        return Err(interrupted(&all, &ended));
    }
    let ended: Vec<Result<Judged, Failure>> = ended.into_iter().flatten().collect();
    let words = words(&ended);
    let defective = ended.iter().flatten().any(|judged| judged.defect);
    if !args.quiet {
        let place = directory.display();
        print(&format!(
            "verdicts: {words}\nresults: {place}/1 to {place}/{count}\n"
        ))?;
    }
    ended.into_iter().collect::<Result<Vec<_>, _>>()?;
    match args.fail_on_defect && defective {
        true => Err(Failure::Defect { what: words }),
        false => Ok(()),
    }
}

/// The share of each verdict, the gravest last: `aligned 6 of 8 (75 %), gap 2 of 8 (25 %)`.
fn words(ended: &[Result<Judged, Failure>]) -> String {
    let mut counts = BTreeMap::new();
    for one in ended {
        let key = one.as_ref().ok().map(|judged| judged.verdict);
        // Runs without a verdict come after those with one.
        *counts.entry((key.is_none(), key)).or_insert(0) += 1;
    }
    let all = ended.len();
    let share = |((_, verdict), count): (_, usize)| {
        let word = Option::map_or(verdict, "failed", coilwind::measure::Verdict::as_str);
        let percent = 100.0 * count as f64 / all as f64;
        format!("{word} {count} of {all} ({percent:.0} %)")
    };
    counts.into_iter().map(share).collect::<Vec<_>>().join(", ")
}

/// What Ctrl-C left, and the commands that go on.
fn interrupted(all: &[RunArgs], ended: &[Option<Result<Judged, Failure>>]) -> Failure {
    let folder = |one: &RunArgs| one.out.clone().unwrap_or_default();
    let mut done = 0;
    let mut commands = Vec::new();
    let mut missing = Vec::new();
    for (one, ended) in all.iter().zip(ended) {
        let place = folder(one).display().to_string();
        match ended {
            Some(Ok(_)) => done += 1,
            Some(Err(Failure::Interrupted { .. })) => {
                commands.push(format!("coilwind run --resume {place}"));
            }
            Some(Err(_)) => {}
            None => missing.push(place),
        }
    }
    Failure::EnsembleInterrupted {
        done,
        all: all.len(),
        commands,
        missing,
    }
}

fn bar(quiet: bool, count: u32) -> ProgressBar {
    let bar = match quiet {
        true => ProgressBar::hidden(),
        false => ProgressBar::new(u64::from(count)),
    };
    // The template is constant; a mistake in it would show as the default style.
    if let Ok(style) = ProgressStyle::with_template("{bar:30} {pos}/{len} runs  {eta} left") {
        bar.set_style(style);
    }
    bar
}
