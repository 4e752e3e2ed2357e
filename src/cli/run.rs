//! `coilwind run`: one scene from start to end, natively or on an FMU's communication grid.

use super::checkpoint::{self, Checkpoint, Plan};
use super::drive::{Drive, Motion};
use super::ends::Ends;
use super::failure::Failure;
use super::folder;
use super::frames::Frames;
use super::progress::Progress;
use super::read_files;
use super::shell::{begin_again, note, resume_command};
use super::terminal::{StopFlags, print};
use clap::Args;
use clap::builder::NonEmptyStringValueParser;
use coilwind::measure::{Defect, DefectKind, Verdict};
use coilwind::output::{Ending, History, Mark, OutputError, Snapshot, write_report, write_results};
use coilwind::scene::{Scene, assignment};
use coilwind::settings::{NozzleFollows, SceneSettings};
use coilwind::simulation::{SimError, Simulation};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

/// Folder of the results where neither `--out` nor the scene names one.
const DEFAULT_OUT: &str = "coilwind-out";
/// Wall time between two checkpoints where none is given, s.
const CHECKPOINT_EVERY: f64 = 5.0;
/// Checkpoints take at most one in so many parts of the time.
const CHECKPOINT_SHARE: u32 = 20;

/// Arguments of `run`.
#[derive(Args, Clone, Debug)]
pub(super) struct RunArgs {
    /// Scene file (TOML), or the name of a packed scene such as fig8
    #[arg(required_unless_present = "resume", value_parser = NonEmptyStringValueParser::new())]
    pub(super) scene: Option<String>,
    /// Set a parameter, with or without its unit: wire.diameter=7e-4, wire.diameter_mm=0.7
    #[arg(long, value_name = "NAME=VALUE", value_parser = assignment)]
    pub(super) set: Vec<(String, String)>,
    /// Folder of the results; default: output.directory of the scene, else coilwind-out
    #[arg(long, value_name = "DIR")]
    pub(super) out: Option<PathBuf>,
    /// Wind so many runs side by side with the nozzle up to half a wire nearer and farther, in DIR/1 to DIR/K, and tell how often
    /// each verdict was given
    #[arg(long, value_name = "K", value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub(super) ensemble: Option<u32>,
    /// Overwrite the run that the folder of the results holds
    #[arg(long)]
    pub(super) force: bool,
    /// Go on with the run or the ensemble in this folder, which was stopped before its end
    #[arg(
        long,
        value_name = "DIR",
        conflicts_with_all = ["scene", "set", "out", "force", "ensemble", "frames", "no_geometry", "inputs", "step", "stop_time"]
    )]
    pub(super) resume: Option<PathBuf>,
    /// Wall time between two checkpoints from which a stopped run could go on, s
    #[arg(long, value_name = "S", default_value_t = CHECKPOINT_EVERY, value_parser = positive)]
    checkpoint_every: f64,
    /// Keep this many frames of the wire on the way, in DIR/frames; ParaView opens them as DIR/frames.pvd
    #[arg(
        long,
        value_name = "N",
        default_value_t = 0,
        allow_negative_numbers = true
    )]
    pub(super) frames: u32,
    /// Leave coil.vtp, core.vtp, coil.png and report.html out: many short runs spend most of their time on them
    #[arg(long, conflicts_with = "frames")]
    pub(super) no_geometry: bool,
    #[command(flatten)]
    pub(super) ends: Ends,
    /// Sampled inputs (CSV with time, spindle_speed, nozzle_position, tension_setpoint) instead of
    /// the scene's spindle and traverse, as the FMU would see them
    #[arg(long, value_name = "FILE", requires = "step")]
    pub(super) inputs: Option<PathBuf>,
    /// Communication step for --inputs, s
    #[arg(long, value_name = "H", requires = "inputs", value_parser = positive, allow_negative_numbers = true)]
    pub(super) step: Option<f64>,
    /// Simulated time at which to stop, s; default: end of the motion profile or of the inputs
    #[arg(long, value_name = "T", value_parser = positive, allow_negative_numbers = true)]
    pub(super) stop_time: Option<f64>,
    /// No progress, no events, no verdict; errors only
    #[arg(long)]
    pub(super) quiet: bool,
    /// Tell also what the solver does and what the program has decided for this scene
    #[arg(long, conflicts_with = "quiet")]
    pub(super) verbose: bool,
    /// The scene itself, in place of one to load
    #[arg(skip)]
    pub(super) settings: Option<Box<SceneSettings>>,
}

impl RunArgs {
    /// The motion that was asked for.
    pub(super) fn motion(&self) -> Motion {
        Motion {
            inputs: self.inputs.clone().zip(self.step),
            stop_time: self.stop_time,
        }
    }

    /// The options that shape the files of the run and are no part of its scene, a blank before each.
    fn wound_with(&self) -> String {
        let mut words = self.motion().options();
        if self.frames > 0 {
            words += &format!(" --frames {}", self.frames);
        }
        if self.no_geometry {
            words += " --no-geometry";
        }
        words
    }

    /// The options that change none of its numbers, which `--resume` takes too.
    pub(super) fn told_with(&self) -> String {
        let mut words = String::new();
        if self.checkpoint_every != CHECKPOINT_EVERY {
            words += &format!(" --checkpoint-every {}", self.checkpoint_every);
        }
        for (given, word) in [
            (self.ends.no_report, " --no-report"),
            (self.ends.fail_on_defect, " --fail-on-defect"),
            (self.quiet, " --quiet"),
            (self.verbose, " --verbose"),
        ] {
            words += if given { word } else { "" };
        }
        words
    }

    /// Folder of the results of a new run of these settings.
    pub(super) fn directory(&self, settings: &SceneSettings) -> PathBuf {
        match (&self.out, settings.output.directory.as_str()) {
            (Some(out), _) => out.clone(),
            (None, "") => PathBuf::from(DEFAULT_OUT),
            (None, directory) => PathBuf::from(directory),
        }
    }
}

/// What a run that ended came to.
pub(super) struct Judged {
    pub(super) verdict: Verdict,
    /// there is a defect, or the verdict names one
    pub(super) defect: bool,
}

fn positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(x) if x.is_finite() && x > 0.0 => Ok(x),
        _ => Err("allowed: a number above 0, in seconds".to_owned()),
    }
}

/// A run that is about to wind: new, or where it was stopped.
struct Start {
    directory: PathBuf,
    plan: Plan,
    simulation: Simulation,
    drive: Drive,
    history: History,
    frames: Frames,
    /// of the run so far, s
    wall_s: f64,
}

/// Runs a scene, or goes on with a run.
pub(super) fn run(args: &RunArgs) -> Result<(), Failure> {
    wind_one(args, &StopFlags::on_signals()).map(drop)
}

/// The same, until the flag is up.
pub(super) fn wind_one(args: &RunArgs, stop: &StopFlags) -> Result<Judged, Failure> {
    let start = match &args.resume {
        Some(directory) => resume(directory, args)?,
        None => begin(args)?,
    };
    let Start {
        directory,
        plan,
        mut simulation,
        mut drive,
        history,
        frames,
        wall_s,
    } = start;
    let mut args = args.clone();
    args.ends = args.ends.or(plan.ends);
    let args = &args;
    let snapshot = Snapshot::new(&simulation).map_err(|reason| Failure::Start {
        scene: plan.settings.name.clone(),
        reason,
    })?;
    let clock = Instant::now();
    let mut record = Record {
        history,
        frames,
        snapshot,
        progress: Progress::new(drive.end(), simulation.time(), args.quiet, args.verbose),
        checkpoints: Checkpoints {
            directory: directory.clone(),
            plan,
            every: Duration::from_secs_f64(args.checkpoint_every.min(1e6)),
            due: clock,
            clock,
            wall_s,
            kept: args.resume.is_some().then(|| simulation.time()),
            failed: false,
        },
    };
    simulation.stop_on(Arc::clone(&stop.overdue));
    let mut ended = record.wind(&mut simulation, &mut drive, stop, args.resume.is_none());
    // The coil of the last row. The checkpoint is of before, so that a run which goes on knows nothing of it.
    match simulation.caught_up() {
        Ok(there) => simulation = there,
        Err(reason) => ended = ended.and(Err(Stop::Solver(reason))),
    }
    record.progress.tell(&simulation.drain_events());
    record.progress.finish();

    // Results first: whatever ended the run, what it computed stays usable.
    let flushed = record.history.flush();
    let ending = match &ended {
        Ok(ending) => ending.clone(),
        Err(Stop::Solver(reason)) => Ending::Failed {
            reason: reason.to_string(),
        },
        Err(Stop::Files(_)) => Ending::Failed {
            reason: "a file could not be written".to_owned(),
        },
    };
    let geometry = record.checkpoints.plan.geometry;
    let written = write_results(
        &directory,
        &simulation,
        geometry.then_some(&record.snapshot),
        &ending,
        wall_s + clock.elapsed().as_secs_f64(),
    );
    let written = flushed.and(written).map_err(Failure::from);
    let page = (geometry && !args.ends.no_report).then(|| directory.join("report.html"));
    let written = written.and_then(|()| match &page {
        Some(page) => Ok(write_report(&[&directory], page)?),
        None => Ok(()),
    });
    let place = directory.display().to_string();
    // The checkpoint stays where a file could not be written: with room on the disk the run goes on.
    let stuck = |failure| stuck(failure, &directory, &args.told_with());
    match ended {
        Err(Stop::Files(failure)) => return Err(stuck(failure)),
        Err(Stop::Solver(reason)) => {
            Checkpoint::remove(&directory)?;
            // Lines that say where to look, only where there is something to look at.
            if written.is_ok() {
                tell(args, &simulation, &ending, page.as_deref(), &directory)?;
            }
            return Err(Failure::Solver {
                reason,
                directory: place,
            });
        }
        Ok(Ending::Interrupted) => {
            written.map_err(stuck)?;
            return Err(Failure::Interrupted {
                time: simulation.time(),
                kept: record.checkpoints.kept,
                directory: place,
                told: args.told_with(),
            });
        }
        Ok(_) => written.map_err(stuck)?,
    }
    Checkpoint::remove(&directory)?;
    if let Some(text) = record.frames.fewer().filter(|_| !args.quiet) {
        eprintln!("warning: {text}");
    }
    conclude(args, &simulation, page.as_deref(), &directory)
}

/// The failure of a run that could not write a file, with what to do then.
fn stuck(failure: Failure, directory: &Path, told: &str) -> Failure {
    let next = match directory.join(checkpoint::FILE).is_file() {
        true => format!(
            "make room, then go on with: {}{told}",
            resume_command(directory.display())
        ),
        false => format!("make room, then {}{told}", begin_again(directory)),
    };
    Failure::Stuck {
        failure: Box::new(failure),
        next,
    }
}

/// A new run.
fn begin(args: &RunArgs) -> Result<Start, Failure> {
    let name = args.scene.as_deref().unwrap_or_default();
    let motion = args.motion();
    let _waiting = (!args.quiet).then(super::waiting::Waiting::for_start);
    let (mut settings, mut scene, warnings) = match args.settings.as_deref().cloned() {
        Some(settings) => {
            let (scene, warnings) = settings.build_for(motion.nozzle_follows(&settings))?;
            (settings, scene, warnings)
        }
        None => SceneSettings::load_and_build(name, &args.set, |settings| {
            motion.nozzle_follows(settings)
        })?,
    };
    if !args.quiet {
        warnings
            .iter()
            .for_each(|warning| eprintln!("warning: {warning}"));
    }
    let follows = motion.nozzle_follows(&settings);
    let drive = Drive::new(&motion, &scene, follows)?;
    if let Some(axis) = drive.winds_otherwise(&settings.spindle) {
        settings.set_text("spindle.direction", axis)?;
        (scene, _) = settings.build_for(follows)?;
    }
    if !args.quiet {
        drive
            .warnings()
            .iter()
            .for_each(|w| eprintln!("warning: {w}"));
    }
    let simulation = match (&drive, follows) {
        (Drive::MotionProfile { .. }, _) => Simulation::new(&scene),
        (Drive::Signals { held, .. }, NozzleFollows::LawByInputs | NozzleFollows::Law) => {
            Simulation::starting_by_law(&scene, *held)
        }
        (Drive::Signals { held, .. }, NozzleFollows::Input) => {
            Simulation::starting_with(&scene, *held)
        }
    };
    let mut simulation = simulation.map_err(|reason| Failure::Start {
        scene: args.scene.as_ref().unwrap_or(&settings.name).clone(),
        reason,
    })?;
    simulation.step_beyond(motion.reaches_beyond(&scene));
    let directory = args.directory(&settings);
    let plan = Plan::new(
        &settings,
        &motion,
        (args.frames, !args.no_geometry),
        args.ends,
    )?;
    folder::prepare(&directory, args.force, args.scene.as_deref())?;
    let history = History::create(&directory.join("history.csv"))?;
    let read = read_files::note(&settings, args.inputs.as_deref());
    folder::begin(&directory, &settings, &(note(&args.wound_with()) + &read))?;
    Ok(Start {
        frames: Frames::new(&directory, args.frames, drive.end())?,
        directory,
        plan,
        simulation,
        drive,
        history,
        wall_s: 0.0,
    })
}

/// The run of a folder, where its last checkpoint was written.
fn resume(directory: &Path, args: &RunArgs) -> Result<Start, Failure> {
    let begin_again = |why: &str| Failure::Resume {
        directory: directory.display().to_string(),
        reason: format!("{why}; {}", begin_again(directory)),
    };
    let hold = folder::hold(directory)?;
    folder::clear_partial(directory);
    let checkpoint = Checkpoint::read(directory)?;
    let plan = checkpoint.plan;
    plan.check_inputs()?;
    plan.check_scene(directory)?;
    let follows = plan.motion.nozzle_follows(&plan.settings);
    let (scene, _): (Scene, _) = plan.settings.build_for(follows)?;
    let mut simulation = Simulation::from_bytes(&scene, &checkpoint.state)
        .map_err(|error| begin_again(&error.to_string()))?;
    simulation.step_beyond(plan.motion.reaches_beyond(&scene));
    let mut drive = Drive::new(&plan.motion, &scene, follows)?;
    if !drive.go_on(checkpoint.place) {
        return Err(begin_again("the checkpoint contradicts itself"));
    }
    // (from here on the history holds it)
    drop(hold);
    let history = History::resume(&directory.join("history.csv"), &checkpoint.history)?;
    let history =
        history.ok_or_else(|| begin_again("history.csv is not the one that the run wrote"))?;
    let mut frames = Frames::new(directory, plan.frames, drive.end())?;
    frames.go_on(checkpoint.frames);
    if !args.quiet {
        let time = simulation.time();
        eprintln!("going on at t = {time:.6} s of {:.6} s", drive.end());
    }
    Ok(Start {
        directory: directory.to_owned(),
        plan,
        simulation,
        drive,
        history,
        frames,
        wall_s: checkpoint.wall_s,
    })
}

/// Tells the end of a run that was wound as planned. It fails where the run's own numbers are in doubt, and where defects were
/// asked to fail.
fn conclude(
    args: &RunArgs,
    simulation: &Simulation,
    page: Option<&Path>,
    directory: &Path,
) -> Result<Judged, Failure> {
    let (verdict, defects) = (simulation.verdict(), simulation.defects());
    if args.verbose {
        for d in &simulation.scene().skipped {
            print(&format!(
                "{} = {} ({}): {}\n",
                d.name, d.decision, d.setting, d.why
            ))?;
        }
    }
    tell(args, simulation, &Ending::Done, page, directory)?;
    if let Some(reason) = simulation.doubt() {
        return Err(Failure::Doubt {
            reason,
            directory: directory.display().to_string(),
        });
    }
    let defect = !defects.is_empty() || verdict.is_defect();
    if args.ends.fail_on_defect && defect {
        return Err(Failure::Defect {
            what: counted(verdict, &defects),
        });
    }
    Ok(Judged { verdict, defect })
}

/// Three lines: the verdict, why, and where to look. They say what `summary.json` says.
fn tell(
    args: &RunArgs,
    simulation: &Simulation,
    ending: &Ending,
    page: Option<&Path>,
    directory: &Path,
) -> Result<(), Failure> {
    if args.quiet {
        return Ok(());
    }
    let outputs = simulation.outputs();
    let (verdict, reasons) = ending.judgement(simulation);
    let place = match page {
        Some(page) => format!("report: {}", page.display()),
        None => format!("results: {}", directory.display()),
    };
    print(&format!(
        "verdict: {verdict}; {:.2} turns wound, {:.2} settled in {:.6} s\nwhy: {}\n{place}\n",
        outputs.turns_wound,
        outputs.turns_settled,
        simulation.time(),
        reasons.join("; "),
    ))
}

/// How many defects of each kind there are, in words.
fn counted(verdict: Verdict, defects: &[Defect]) -> String {
    let kinds = DefectKind::ALL.into_iter().filter_map(|kind| {
        let count = defects.iter().filter(|d| d.kind == kind).count();
        (count > 0).then(|| format!("{kind} {count}"))
    });
    let kinds: Vec<String> = kinds.collect();
    let found = if kinds.is_empty() {
        "none over a whole run of stations".to_owned()
    } else {
        kinds.join(", ")
    };
    format!("{found}; verdict: {verdict}")
}

/// Why winding stopped early.
enum Stop {
    Solver(SimError),
    Files(Failure),
}

impl From<Failure> for Stop {
    fn from(failure: Failure) -> Self {
        Self::Files(failure)
    }
}

impl From<OutputError> for Stop {
    fn from(failure: OutputError) -> Self {
        Self::Files(failure.into())
    }
}

/// Everything that watches a run.
struct Record {
    history: History,
    frames: Frames,
    snapshot: Snapshot,
    progress: Progress,
    checkpoints: Checkpoints,
}

impl Record {
    /// Advances to the end, the first error, or until the flag is up. The history of a run that is new has a row for its start.
    fn wind(
        &mut self,
        simulation: &mut Simulation,
        drive: &mut Drive,
        stop: &StopFlags,
        new: bool,
    ) -> Result<Ending, Stop> {
        if new {
            self.history.row(simulation.time(), simulation)?;
        }
        loop {
            let stopped = stop.asked.load(Ordering::SeqCst);
            if stopped || Instant::now() >= self.checkpoints.due {
                let mark = self.history.mark()?;
                self.checkpoints
                    .write(simulation, drive, mark, &self.frames);
            }
            if stopped {
                return Ok(Ending::Interrupted);
            }
            let Some(advanced) = drive.advance(simulation) else {
                return Ok(Ending::Done);
            };
            self.progress.tell(&simulation.drain_events());
            let time = match advanced {
                // In the middle of a communication step: the run goes on from the checkpoint before it.
                Err(_) if stop.asked.load(Ordering::SeqCst) => {
                    self.history.row(simulation.time(), simulation)?;
                    return Ok(Ending::Interrupted);
                }
                advanced => advanced.map_err(Stop::Solver)?,
            };
            self.history.row(time, simulation)?;
            self.frames.update(simulation, &self.snapshot)?;
            self.progress.update(simulation);
        }
    }
}

/// Writes where the run could go on, now and then.
struct Checkpoints {
    directory: PathBuf,
    plan: Plan,
    every: Duration,
    /// when the next one is written
    due: Instant,
    clock: Instant,
    /// of the run before it was stopped, s
    wall_s: f64,
    /// simulated time of the last one, s
    kept: Option<f64>,
    /// one could not be written, which has been told
    failed: bool,
}

impl Checkpoints {
    fn write(&mut self, simulation: &Simulation, drive: &Drive, history: Mark, frames: &Frames) {
        let began = Instant::now();
        let wall_s = self.wall_s + self.clock.elapsed().as_secs_f64();
        let written = simulation
            .to_bytes()
            .map_err(|error| error.to_string())
            .and_then(|state| {
                let checkpoint = Checkpoint {
                    plan: self.plan.clone(),
                    place: drive.place(),
                    history,
                    frames: frames.written().to_vec(),
                    wall_s,
                    state,
                };
                checkpoint.write(&self.directory).map_err(|e| e.to_string())
            });
        match written {
            Ok(()) => self.kept = Some(simulation.time()),
            Err(error) if !self.failed => {
                // The results matter more; a full disk will end the run by itself.
                self.failed = true;
                let after = match self.kept {
                    Some(_) => "after a stop the run would go on from the checkpoint before",
                    None => "the run could not go on after a stop",
                };
                eprintln!("warning: {error}; {after}");
            }
            Err(_) => {}
        }
        let now = Instant::now();
        self.due = now + self.every.max(CHECKPOINT_SHARE * (now - began));
    }
}
