//! `coilwind sweep`: many runs of one scene on all cores, one table.

use super::failure::Failure;
use super::folder;
use super::runs_bar::runs_bar;
use super::scene::SceneArgs;
use super::shell::quoted;
use super::sweep_answer::{Answer, Seen};
use super::sweep_files as files;
use super::sweep_find_max::Look;
use super::sweep_grid::Grid;
use super::sweep_ledger::Ledger;
use super::sweep_range::{Range, variable_of};
use super::sweep_row::Row;
use super::terminal::{StopFlags, print};
use super::{
    sweep_find_max as find_max, sweep_map as map, sweep_statistics as statistics,
    sweep_wind as wind,
};
use clap::Args;
use clap::builder::RangedI64ValueParser;
use indicatif::ProgressBar;
use rayon::prelude::*;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// Points of a grid that are told in words; the table has all.
const TOLD: usize = 40;

/// Arguments of `sweep`.
#[derive(Args, Debug)]
pub(super) struct SweepArgs {
    #[command(flatten)]
    scene: SceneArgs,
    /// Vary a variable: N values evenly from A to B. Given again, every combination is wound
    #[arg(long, value_name = "NAME=A:B:N", value_parser = Range::parse, required = true)]
    over: Vec<Range>,
    /// Wind so many runs at each point, with the nozzle up to half a wire nearer and farther
    #[arg(long, value_name = "K", default_value_t = 1, value_parser = RangedI64ValueParser::<u32>::new().range(1..=1000))]
    ensemble: u32,
    /// Folder of the tables; a sweep that was stopped goes on there
    #[arg(long, value_name = "DIR", default_value = "coilwind-sweep")]
    out: PathBuf,
    /// Find the highest value of this variable at which no run has a defect, by bisection among the N values of its range;
    /// for the spindle's speed also among values between them, at most 5 rad/s apart
    #[arg(long, value_name = "NAME")]
    find_max: Option<String>,
    /// Overwrite the sweep that the folder holds
    #[arg(long)]
    force: bool,
    /// Runs at a time; 0: one a core. Results do not depend on it
    #[arg(long, value_name = "N", default_value_t = 0)]
    threads: usize,
    /// No progress, no closing words; errors and the answer of --find-max only
    #[arg(long)]
    quiet: bool,
}

/// Winds what is not wound yet, and tells what came of it.
pub(super) fn sweep(args: &SweepArgs) -> Result<(), Failure> {
    let (base, _, warnings) = args.scene.build()?;
    if !args.quiet {
        warnings.iter().for_each(|w| eprintln!("warning: {w}"));
    }
    let ranges = match &args.find_max {
        Some(name) => vec![find_max::candidates(name, &args.over)?],
        None => args.over.clone(),
    };
    refuse_set_and_swept(&args.scene.set, &ranges)?;
    let grid = Grid::new(base, ranges, args.ensemble)?;
    if !args.quiet {
        // Runs over a key without effect would all be the same.
        let more = grid.warnings(&warnings)?;
        more.iter().for_each(|w| eprintln!("warning: {w}"));
    }
    folder::refuse_own_scene(&args.out, &args.scene.scene)?;
    let ledger = Ledger::open(&args.out, &grid, args.find_max.is_some(), args.force);
    let ledger = ledger.map_err(|failure| stuck_at_start(failure, args.force))?;
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(args.threads)
        .build()
        .map_err(|e| Failure::sweep(format!("--threads {}: {e}", args.threads)))?;
    let mut work = Work {
        before: ledger.count(),
        answer: None,
        ledger,
        bar: runs_bar(args.quiet, 0),
        stop: StopFlags::on_signals().asked,
        pool,
        grid,
    };
    let told = match args.find_max {
        Some(_) => work.find_max(),
        None => work.all(),
    };
    work.bar.finish_and_clear();
    work.ledger.write(&work.grid).map_err(stuck)?;
    let told = told.map_err(stuck)?;
    let mapped = map::write(&args.out, &work.grid, work.ledger.rows()).map_err(stuck)?;
    if work.stop.load(Ordering::SeqCst) {
        return Err(Failure::SweepInterrupted {
            done: work.ledger.count(),
            command: again(),
        });
    }
    let answer = work.answer.take();
    if let Some(answer) = &answer {
        answer.write(&args.out).map_err(stuck)?;
    }
    let assumes = answer.as_ref().and_then(|answer| answer.assumes.as_deref());
    let answer = answer.as_ref().map(Answer::words).transpose();
    if args.quiet {
        // A result is no progress.
        return answer?.map_or(Ok(()), |words| print(&format!("{words}\n")));
    }
    let total = work.ledger.count();
    let failed = work
        .ledger
        .rows()
        .values()
        .filter(|row| row.failed())
        .count();
    let defects = work.ledger.rows().values().filter(|row| row.defect).count();
    let unjudged = work
        .ledger
        .rows()
        .values()
        .filter(|row| row.is_unjudged())
        .count();
    if unjudged > 0 {
        eprintln!(
            "warning: in {unjudged} of {total} runs no turn came to rest beside another, so nothing could be compared; {}",
            work.grid.remedy()
        );
    }
    if let Some(row) = work.ledger.rows().values().find(|row| row.failed()) {
        eprintln!(
            "warning: the solver gave up {failed} of {total} runs, one with this reason: {}; column reason of {} has all",
            row.reason,
            files::ROWS
        );
    }
    let found = match &answer {
        Ok(Some(words)) => format!("{words}\n{}\n", assumes.unwrap_or_default()),
        _ => String::new(),
    };
    let map = match mapped {
        true => format!(
            "map: {}, {}\n",
            args.out.join(files::PAGE).display(),
            args.out.join(files::MAP).display()
        ),
        false => String::new(),
    };
    print(&format!(
        "{told}{found}{total} runs, {} of them new; {defects} with a defect, {failed} that the solver gave up\ntables: {} (a row a run), {} (a row a point)\n{map}",
        total - work.before,
        args.out.join(files::ROWS).display(),
        args.out.join(files::STATISTICS).display(),
    ))?;
    answer.map(drop)
}

/// A failure on the way, with what to do where a file could not be written.
fn stuck(failure: Failure) -> Failure {
    match failure {
        Failure::Write { .. } | Failure::Output(_) => Failure::Stuck {
            failure: Box::new(failure),
            next: format!("make room, then go on with: {}", again()),
        },
        other => other,
    }
}

/// A failure before anything was wound, with what to do where it is room that was missing.
fn stuck_at_start(failure: Failure, force: bool) -> Failure {
    // What was to be overwritten may be half overwritten.
    let forced = if force { " --force" } else { "" };
    match failure.is_without_room() {
        true => Failure::Stuck {
            failure: Box::new(failure),
            next: format!("make room, then go on with: {}{forced}", again()),
        },
        false => failure,
    }
}

/// An error where `--set` gives a value to what `--over` varies: it would not count.
fn refuse_set_and_swept(set: &[(String, String)], ranges: &[Range]) -> Result<(), Failure> {
    for (name, value) in set {
        let variable = variable_of(name);
        if let Some(range) = ranges.iter().find(|range| range.variable() == variable) {
            return Err(Failure::sweep(format!(
                "--set {name}={value}: --over {range} gives {variable} its values; leave out one of them"
            )));
        }
    }
    Ok(())
}

/// A sweep that is going on.
struct Work {
    grid: Grid,
    ledger: Ledger,
    pool: rayon::ThreadPool,
    bar: ProgressBar,
    stop: Arc<AtomicBool>,
    /// runs that were there
    before: usize,
    /// of `--find-max`, at its end
    answer: Option<Answer>,
}

impl Work {
    /// Winds the whole grid; tells it point by point.
    fn all(&mut self) -> Result<String, Failure> {
        self.bar.set_length(self.grid.runs() as u64);
        self.wind(0..self.grid.runs())?;
        let points = self.grid.points();
        let lines = (0..points.min(TOLD)).filter_map(|point| self.line(point));
        let mut told: String = lines.collect();
        if points > TOLD {
            told += &format!("... and {} more points\n", points - TOLD);
        }
        Ok(told)
    }

    /// Looks for the highest value without a defect; tells what was looked at.
    fn find_max(&mut self) -> Result<String, Failure> {
        let points = self.grid.points();
        // those of the bisection, and one at the lowest value
        let looks = (points + 1).next_power_of_two().ilog2() + 1;
        self.bar
            .set_length(u64::from(looks) * u64::from(self.grid.members));
        let (mut told, mut seen) = (String::new(), Vec::new());
        let limit = find_max::bisect(points, |point| self.look(point, &mut told, &mut seen))?;
        let lowest = match (limit.free, limit.unknown) {
            (2.., None) => self.look(0, &mut told, &mut seen)?,
            _ => Look::Free,
        };
        let range = &self.grid.ranges[0];
        self.answer = Some(Answer::new(
            (range, self.grid.remedy()),
            &limit,
            lowest,
            seen,
        ));
        Ok(told)
    }

    /// Winds the runs of a point, adds its line to what is `told` and its look to what is `seen`, and says what they show.
    fn look(
        &mut self,
        point: usize,
        told: &mut String,
        seen: &mut Vec<Seen>,
    ) -> Result<Look, Failure> {
        let runs = self.grid.runs_at(point);
        self.wind(runs.clone())?;
        *told += &self.line(point).unwrap_or_default();
        let rows: Vec<&Row> = runs
            .clone()
            .filter_map(|run| self.ledger.row(run))
            .collect();
        // An interrupted look says nothing, and the sweep tells of its stop.
        let look = match rows.len() < runs.len() {
            true => Look::Unknown {
                unjudged: 0,
                failed: 0,
                of: runs.len(),
            },
            false => Look::at(&rows),
        };
        let value = self.grid.ranges[0].value(point as u32);
        seen.push(Seen::new(value, runs.len(), look));
        Ok(look)
    }

    /// Winds those of these runs that are not there, as many at a time as there are threads.
    fn wind(&mut self, runs: std::ops::Range<usize>) -> Result<(), Failure> {
        let Self {
            grid,
            ledger,
            pool,
            bar,
            stop,
            ..
        } = self;
        let missing: Vec<usize> = runs.filter(|&run| ledger.row(run).is_none()).collect();
        bar.set_position(ledger.count() as u64);
        bar.reset_eta();
        let ledger = Mutex::new(ledger);
        // One after the other from the front, so that what a stopped sweep has is one piece.
        let each = |run: usize| -> Result<(), Failure> {
            let settings = grid.settings(run)?;
            if let Some(row) = wind::wind(&settings, grid.member(run), stop)? {
                let mut ledger = ledger.lock().unwrap_or_else(PoisonError::into_inner);
                ledger.add(grid, run, row)?;
                bar.inc(1);
            }
            Ok(())
        };
        // (a run that is begun after that builds its scene before it looks)
        let goes_on = |_: &usize| !stop.load(Ordering::SeqCst);
        let wanted = missing.into_iter().take_while(goes_on);
        pool.install(|| wanted.par_bridge().try_for_each(each))
    }

    /// What a point came to, in a line.
    fn line(&self, point: usize) -> Option<String> {
        let ensemble = statistics::at(&self.grid, self.ledger.rows(), point)?;
        Some(format!("{}: {}\n", self.grid.name(point), ensemble.line()))
    }
}

/// The command that goes on, as a shell takes it.
fn again() -> String {
    // (what is no text is told as well as it can be)
    let words = std::env::args_os().skip(1);
    let words = words.map(|word| word.to_string_lossy().into_owned());
    let words = words.filter(|word| word != "--force").map(quoted);
    let words: Vec<String> = words.collect();
    format!("coilwind {}", words.join(" "))
}
