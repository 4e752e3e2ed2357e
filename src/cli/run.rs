//! `coilwind run`: one scene from start to end, natively or on an FMU's communication grid.

use super::failure::Failure;
use super::frames::Frames;
use super::progress::Progress;
use super::scene::SceneArgs;
use super::signals::{Grid, Signals};
use super::terminal::{print, stop_flag};
use clap::Args;
use coilwind::measure::{Defect, DefectKind, Verdict};
use coilwind::output::{Ending, History, OutputError, Snapshot, write_results};
use coilwind::scene::Scene;
use coilwind::settings::SceneSettings;
use coilwind::signals::Inputs;
use coilwind::simulation::{SimError, Simulation};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// Folder of the results where neither `--out` nor the scene names one.
const DEFAULT_OUT: &str = "coilwind-out";

/// Arguments of `run`.
#[derive(Args, Debug)]
pub(super) struct RunArgs {
    #[command(flatten)]
    scene: SceneArgs,
    /// Folder of the results; default: output.directory of the scene, else coilwind-out
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Write this many snapshots on the way, in DIR/frames: a picture and the wire as VTP each
    #[arg(long, value_name = "N", default_value_t = 0)]
    frames: u32,
    /// Leave coil.vtp, core.vtp and coil.png out: many short runs spend most of their time on them
    #[arg(long, conflicts_with = "frames")]
    no_geometry: bool,
    /// Sampled inputs (CSV with time, spindle_speed, nozzle_position, tension_setpoint) instead of
    /// the scene's spindle and traverse, as the FMU would see them
    #[arg(long, value_name = "FILE", requires = "step")]
    inputs: Option<PathBuf>,
    /// Communication step for --inputs, s
    #[arg(long, value_name = "H", requires = "inputs", value_parser = positive)]
    step: Option<f64>,
    /// Simulated time at which to stop, s; default: end of the programme or of the inputs
    #[arg(long, value_name = "T", value_parser = positive)]
    stop_time: Option<f64>,
    /// Exit with 1 if a defect was found
    #[arg(long)]
    fail_on_defect: bool,
    /// No progress, no events, no verdict; errors only
    #[arg(long)]
    quiet: bool,
}

fn positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(x) if x.is_finite() && x > 0.0 => Ok(x),
        _ => Err("allowed: a number above 0, in seconds".to_owned()),
    }
}

/// Runs a scene.
pub(super) fn run(args: &RunArgs) -> Result<(), Failure> {
    let (settings, scene, warnings) = args.scene.build()?;
    if !args.quiet {
        warnings
            .iter()
            .for_each(|warning| eprintln!("warning: {warning}"));
    }
    let start_failure = |reason| Failure::Start {
        scene: args.scene.scene.clone(),
        reason,
    };
    let mut simulation = Simulation::new(&scene).map_err(start_failure)?;
    let mut drive = Drive::new(args, &scene, &simulation)?;
    if let Drive::Signals { held, .. } = &drive {
        simulation.set_start(*held).map_err(start_failure)?;
    }

    let directory = prepare(args, &settings)?;
    let end = drive.end();
    let clock = Instant::now();
    let mut record = Record {
        history: History::create(&directory.join("history.csv"))?,
        frames: Frames::new(&directory, args.frames, end)?,
        snapshot: Snapshot::new(&simulation).map_err(start_failure)?,
        progress: Progress::new(end, args.quiet),
    };
    let stop = stop_flag();
    simulation.stop_on(Arc::clone(&stop));
    let ended = record.wind(&mut simulation, &mut drive, &stop);
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
    let written = write_results(
        &directory,
        &simulation,
        (!args.no_geometry).then_some(&record.snapshot),
        &ending,
        clock.elapsed().as_secs_f64(),
    );
    let written = flushed.and(written);
    let place = directory.display().to_string();
    match ended {
        Err(Stop::Files(failure)) => return Err(failure),
        Err(Stop::Solver(reason)) => {
            return Err(Failure::Solver {
                reason,
                directory: place,
            });
        }
        Ok(Ending::Interrupted) => {
            written?;
            return Err(Failure::Interrupted {
                time: simulation.time(),
                directory: place,
            });
        }
        Ok(_) => written?,
    }
    report(args, &simulation, &place)
}

/// Makes the folder and leaves the scene in it as it is about to be run.
fn prepare(args: &RunArgs, settings: &SceneSettings) -> Result<PathBuf, Failure> {
    let directory = match (&args.out, settings.output.directory.as_str()) {
        (Some(out), _) => out.clone(),
        (None, "") => PathBuf::from(DEFAULT_OUT),
        (None, directory) => PathBuf::from(directory),
    };
    std::fs::create_dir_all(&directory).map_err(|e| Failure::write(&directory, e))?;
    let path = directory.join("scene.toml");
    std::fs::write(&path, settings.to_toml()).map_err(|e| Failure::write(&path, e))?;
    Ok(directory)
}

/// Defects that the closing words name one by one; the others stand in `defects.csv`.
const NAMED: usize = 5;

/// The verdict, and exit code 1 where defects were asked to fail.
fn report(args: &RunArgs, simulation: &Simulation, directory: &str) -> Result<(), Failure> {
    let outputs = simulation.outputs();
    let (verdict, defects) = (simulation.verdict(), simulation.defects());
    if !args.quiet {
        print(&format!(
            "{:.2} turns wound, {:.2} settled in {:.6} s: {verdict}; results in {directory}\n",
            outputs.turns_wound,
            outputs.turns_settled,
            simulation.time(),
        ))?;
        for defect in defects.iter().take(NAMED) {
            print(&format!("{}\n", in_words(defect)))?;
        }
        if defects.len() > NAMED {
            let more = defects.len() - NAMED;
            print(&format!("and {more} more: see {directory}/defects.csv\n"))?;
        }
        for d in &simulation.scene().skipped {
            print(&format!(
                "{} = {} ({}): {}\n",
                d.name, d.decision, d.setting, d.why
            ))?;
        }
    }
    if args.fail_on_defect && (!defects.is_empty() || verdict.is_defect()) {
        return Err(Failure::Defect {
            what: counted(verdict, &defects),
        });
    }
    Ok(())
}

/// A defect as the closing words have it.
fn in_words(defect: &Defect) -> String {
    let place = format!(
        "in turn {} (layer {}) at {:.0} deg, t = {:.6} s",
        defect.turn, defect.layer, defect.angle_deg, defect.time_s
    );
    match (defect.kind, defect.size_m, defect.size_d) {
        (DefectKind::Break, ..) => format!("the wire broke {place}; nothing was wound after that"),
        (DefectKind::Slack, ..) => format!("the wire went slack {place}"),
        (kind, Some(m), Some(d)) => format!("{kind} of {:.3} mm ({d:.2} d) {place}", 1e3 * m),
        (kind, ..) => format!("{kind} {place}"),
    }
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

/// What moves the machine.
#[derive(Debug)]
enum Drive {
    /// the scene's own spindle and traverse, a row per core angle
    MotionProfile {
        /// rad between rows
        interval: f64,
        /// rows so far
        count: u64,
        /// s
        end: f64,
    },
    /// sampled inputs on a communication grid
    Signals {
        signals: Signals,
        /// start values; inputs without samples stay there
        held: Inputs,
        grid: Grid,
        /// s
        end: f64,
    },
}

impl Drive {
    fn new(args: &RunArgs, scene: &Scene, simulation: &Simulation) -> Result<Self, Failure> {
        let Some((path, step)) = args.inputs.as_deref().zip(args.step) else {
            let end = simulation.motion_profile().end();
            let end = args.stop_time.map_or(end, |stop| stop.min(end));
            return Ok(Self::MotionProfile {
                interval: scene.output.history_interval,
                count: 0,
                end,
            });
        };
        let signals = Signals::read(path)?;
        let end = args.stop_time.unwrap_or(signals.end());
        if end <= 0.0 {
            return Err(no_duration(path));
        }
        let held = signals.before(0.0, simulation.inputs());
        Ok(Self::Signals {
            held,
            grid: Grid::new(step, end),
            signals,
            end,
        })
    }

    /// Simulated time at the end, s.
    fn end(&self) -> f64 {
        match self {
            Self::MotionProfile { end, .. } | Self::Signals { end, .. } => *end,
        }
    }

    /// Advances to the next point and gives its time, s; `None` at the end.
    fn advance(&mut self, simulation: &mut Simulation) -> Option<Result<f64, SimError>> {
        match self {
            Self::MotionProfile {
                interval,
                count,
                end,
            } => {
                let time = simulation.time();
                // Rounding must leave no sliver of a step before the end.
                let sliver = 1e-12 * *end;
                if time >= *end - sliver {
                    return None;
                }
                *count += 1;
                let row = simulation
                    .motion_profile()
                    .time_at(*count as f64 * *interval);
                let next = if row >= *end - sliver { *end } else { row };
                Some(simulation.advance_profile(next - time).map(|()| next))
            }
            Self::Signals {
                signals,
                held,
                grid,
                ..
            } => {
                let (start, length, end) = grid.next(signals)?;
                let inputs = signals.after(start, *held);
                Some(simulation.advance(inputs, length).map(|()| end))
            }
        }
    }
}

fn no_duration(path: &Path) -> Failure {
    Failure::Signals {
        file: path.display().to_string(),
        reason: "the last time is not after 0; allowed: a later time, or --stop-time".to_owned(),
    }
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
}

impl Record {
    /// Advances to the end, the first error, or until the flag is up.
    fn wind(
        &mut self,
        simulation: &mut Simulation,
        drive: &mut Drive,
        stop: &AtomicBool,
    ) -> Result<Ending, Stop> {
        self.history.row(simulation.time(), simulation)?;
        loop {
            if stop.load(Ordering::SeqCst) {
                return Ok(Ending::Interrupted);
            }
            let Some(advanced) = drive.advance(simulation) else {
                return Ok(Ending::Done);
            };
            self.progress.tell(&simulation.drain_events());
            let time = match advanced {
                Err(_) if stop.load(Ordering::SeqCst) => {
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
