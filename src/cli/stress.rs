//! `coilwind stress`: random scenes, a line each, totals by region, files of what failed.

use super::failure::Failure;
use super::terminal::{StopFlags, print};
use clap::Args;
use coilwind::lab::stress::case_files::{self, Files};
use coilwind::lab::stress::invariants::judge;
use coilwind::lab::stress::refined::{Refined, refine};
use coilwind::lab::stress::region::Totals;
use coilwind::lab::stress::shrink::shrink;
use coilwind::lab::stress::{Case, Outcome, Verdict, draw};
use indicatif::{ProgressBar, ProgressStyle};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc;
use std::{fs, thread};

/// Arguments of `stress`.
#[derive(Args, Debug)]
pub(super) struct StressArgs {
    /// Scenes to draw
    #[arg(long, value_name = "N", default_value_t = 100)]
    count: u64,
    /// Seed of the draw; the same seed draws the same scenes
    #[arg(long, value_name = "S", default_value_t = 1)]
    seed: u64,
    /// Number of the first scene, to look at one alone
    #[arg(long, value_name = "K", default_value_t = 0)]
    first: u64,
    /// Folder for what failed (scene, inputs, mesh) and for the table stability.md
    #[arg(long, value_name = "DIR", default_value = "coilwind-stress")]
    out: PathBuf,
    /// Threads; 0: as many as the machine has. Results do not depend on it
    #[arg(long, value_name = "T", default_value_t = 0)]
    threads: usize,
    /// Keep failures as they were drawn instead of making them small first
    #[arg(long)]
    no_shrink: bool,
    /// Run each scene again at half the tolerance and half the spacing, and compare outcome and verdict
    #[arg(long)]
    refined: bool,
    /// Scenes that are known to break an invariant: they are told, and the exit code is not theirs
    #[arg(long, value_name = "K,...", value_delimiter = ',')]
    known: Vec<u64>,
    /// No progress bar
    #[arg(long)]
    quiet: bool,
}

/// One case that is done.
struct Done {
    case: Case,
    verdict: Verdict,
    /// made finer, or why it could not be
    refined: Option<Result<Refined, String>>,
    /// what was kept of a failure, in words
    kept: String,
}

/// Draws, runs and judges.
pub(super) fn stress(args: &StressArgs) -> Result<(), Failure> {
    fs::create_dir_all(&args.out).map_err(|e| Failure::write(&args.out, e))?;
    // a panic is a finding, told with its case; nothing but that goes to the terminal
    std::panic::set_hook(Box::new(|_| {}));
    let threads = match args.threads {
        0 => thread::available_parallelism().map_or(1, usize::from),
        n => n,
    };
    let bar = bar(args);
    let stop = StopFlags::on_signals().asked;
    let next = AtomicU64::new(0);
    let (send, receive) = mpsc::channel();
    let totals = thread::scope(|scope| {
        for _ in 0..threads {
            let (send, next, stop) = (send.clone(), &next, &*stop);
            scope.spawn(move || work(args, next, stop, &send));
        }
        drop(send);
        collect(args, receive, &bar)
    });
    bar.finish_and_clear();
    let (totals, known) = totals?;
    for (name, text) in [
        ("stability.md", totals.tables()),
        ("worst.md", totals.worst()),
    ] {
        let path = args.out.join(name);
        fs::write(&path, text).map_err(|e| Failure::write(&path, e))?;
    }
    print(&format!("\n{}\n{}\n", totals.tables(), totals.line()))?;
    if stop.load(Ordering::SeqCst) {
        return Err(Failure::StepError {
            directory: args.out.display().to_string(),
        });
    }
    match totals.trouble().0 {
        0 => Ok(()),
        count if count == known => Ok(()),
        count => Err(Failure::Invariant {
            count,
            directory: args.out.display().to_string(),
        }),
    }
}

fn bar(args: &StressArgs) -> ProgressBar {
    let bar = match args.quiet {
        true => ProgressBar::hidden(),
        false => ProgressBar::new(args.count),
    };
    // The template is constant; a mistake in it would show as the default style.
    if let Ok(style) = ProgressStyle::with_template("{bar:30} {pos}/{len}  {eta} left") {
        bar.set_style(style);
    }
    bar
}

/// Takes numbers until there are none or Ctrl-C.
fn work(
    args: &StressArgs,
    next: &AtomicU64,
    stop: &AtomicBool,
    send: &mpsc::Sender<(u64, Result<Done, Failure>)>,
) {
    while !stop.load(Ordering::SeqCst) {
        let index = next.fetch_add(1, Ordering::SeqCst);
        if index >= args.count {
            break;
        }
        let done = one(args, args.first + index);
        // the other end is gone after an error, which ends the run
        if send.send((index, done)).is_err() {
            break;
        }
    }
}

fn one(args: &StressArgs, number: u64) -> Result<Done, Failure> {
    let mut case = draw::case(args.seed, number).map_err(|reason| Failure::Draw { reason })?;
    let name = format!("seed{}-case{number}", args.seed);
    let files = Files::new(&args.out, &name);
    let write = |e| Failure::write(&args.out, e);
    files.write_mesh(&mut case).map_err(write)?;
    let verdict = judge(&case);
    let refined = args.refined.then(|| refine(&case, &verdict));
    let kept = match verdict.outcome.is_trouble() {
        true => keep(args, &files, &case, &verdict).map_err(write)?,
        false => String::new(),
    };
    if kept.is_empty() {
        files.remove_mesh(&case).map_err(write)?;
    }
    Ok(Done {
        case,
        verdict,
        refined,
        kept,
    })
}

/// Writes a failure, made small first.
fn keep(
    args: &StressArgs,
    files: &Files,
    case: &Case,
    verdict: &Verdict,
) -> std::io::Result<String> {
    let (small, found, runs) = match args.no_shrink {
        true => (case.clone(), verdict.clone(), 0),
        false => shrink(case, verdict),
    };
    let words = format!(
        "seed {}, case {}, {}, made smaller in {runs} runs:\n{}",
        case.seed,
        case.number,
        case.kind.as_str(),
        found.outcome
    );
    files.write(&small, &words)?;
    Ok(format!(
        "  kept as {} ({} inputs): {}",
        file_name(&files.scene),
        small.inputs.len(),
        found.outcome
    ))
}

fn file_name(path: &Path) -> String {
    path.file_name()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned()
}

/// Prints what is done, in the order of the numbers; totals, and how many of the known scenes broke an invariant.
fn collect(
    args: &StressArgs,
    receive: mpsc::Receiver<(u64, Result<Done, Failure>)>,
    bar: &ProgressBar,
) -> Result<(Totals, u64), Failure> {
    let mut totals = Totals::new();
    let mut known = 0;
    let mut rows = format!("{}\n", case_files::columns());
    let mut compared = Compared::default();
    let mut early = std::collections::BTreeMap::new();
    let mut due = 0;
    for (index, done) in receive {
        early.insert(index, done);
        while let Some(done) = early.remove(&due) {
            let done = done?;
            totals.add(&done.case, &done.verdict);
            let breaks = matches!(done.verdict.outcome, Outcome::Invariant { .. });
            known += u64::from(breaks && args.known.contains(&done.case.number));
            rows += &case_files::row(&done.case, &done.verdict);
            rows.push('\n');
            let mut text = line(args, &done);
            text += &compared.add(&done);
            if !done.kept.is_empty() {
                text += &done.kept;
                text.push('\n');
            }
            bar.suspend(|| print(&text))?;
            due += 1;
        }
        bar.set_position(due);
    }
    let path = args.out.join("cases.csv");
    fs::write(&path, rows).map_err(|e| Failure::write(&path, e))?;
    if args.refined {
        print(&format!("\n{}\n", compared.line()))?;
    }
    Ok((totals, known))
}

/// How many scenes end as they do when they are made finer.
#[derive(Clone, Copy, Debug, Default)]
struct Compared {
    scenes: u64,
    outcome: u64,
    verdict: u64,
    finer_refused: u64,
}

impl Compared {
    /// Counts a scene in; says what differs.
    fn add(&mut self, done: &Done) -> String {
        let refined = match &done.refined {
            None => return String::new(),
            Some(Err(reason)) => {
                self.finer_refused += 1;
                return format!("  not refined: {reason}\n");
            }
            Some(Ok(refined)) => refined,
        };
        self.scenes += 1;
        self.outcome += u64::from(refined.same_outcome);
        self.verdict += u64::from(refined.same_verdict);
        if refined.same_outcome && refined.same_verdict {
            return String::new();
        }
        format!(
            "  REFINED {}: defects {} instead of {}, {}\n",
            done.case.number,
            refined.finer.measures.defects,
            done.verdict.measures.defects,
            refined.finer.outcome
        )
    }

    fn line(&self) -> String {
        format!(
            "{} scenes refined ({} more cannot be): outcome equal in {}, verdict in {}",
            self.scenes, self.finer_refused, self.outcome, self.verdict
        )
    }
}

fn line(_args: &StressArgs, done: &Done) -> String {
    let (c, m) = (&done.case, &done.verdict.measures);
    let s = &c.settings;
    let outcome = match &done.verdict.outcome {
        Outcome::Completed => "completed".to_owned(),
        other => other.to_string(),
    };
    format!(
        "{:>5} {:<15} {:<11} d {:.3} mm, {:.3} N, {:.0} rad/s: {:.2} turns, {} steps ({} + {} thrown away), {} nodes, depth {:.3} d, energy {:.2} %, {outcome}\n",
        c.number,
        c.kind.as_str(),
        s.core.shape,
        s.wire.diameter * 1e3,
        s.tensioner.tension,
        s.spindle.speed,
        m.turns,
        m.steps,
        m.rejects,
        m.newton_failures,
        m.nodes,
        m.depth,
        100.0 * m.energy,
    )
}
