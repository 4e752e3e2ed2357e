//! `coilwind run --ensemble K`: K members side by side, a folder each, and how often each verdict was given.

use super::checkpoint::{self, Plan};
use super::drive::Drive;
use super::ensemble_files::{self, PLAN, Summary};
use super::failure::Failure;
use super::folder;
use super::lock::Locked;
use super::members;
use super::run::{Judged, RunArgs, wind_one};
use super::runs_bar::runs_bar;
use super::shell::{begin_again, resume_command};
use super::terminal::{StopFlags, print};
use coilwind::measure::{DefectKind, UNJUDGED, Verdict};
use coilwind::settings::SceneSettings;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::cmp::Reverse;
use std::collections::BTreeMap;
use std::io::ErrorKind;
use std::path::Path;
use std::sync::atomic::Ordering;

/// Changes whenever the layout does.
const MAGIC: &[u8; 8] = b"coilwen2";

/// What the members of an ensemble have in common.
#[derive(Serialize, Deserialize)]
struct Ensemble {
    /// scene of the middle, motion and options
    plan: Plan,
    members: u32,
}

/// A member as it stands.
enum Member {
    /// to be wound, or to go on
    Open(Box<RunArgs>),
    /// it has ended before
    Ended(Result<Judged, Failure>),
}

/// Winds every member on all cores.
///
/// # Errors
/// What is wrong with the scene or a folder, before anything is wound; then that of the first member with an error, after all
/// have ended.
pub(super) fn run(args: &RunArgs, count: u32) -> Result<(), Failure> {
    let name = args.scene.as_deref().unwrap_or_default();
    let motion = args.motion();
    let follows = |settings: &SceneSettings| motion.nozzle_follows(settings);
    let (settings, scene, warnings) = SceneSettings::load_and_build(name, &args.set, follows)?;
    let drive = Drive::new(&motion, &scene, follows(&settings))?;
    if !args.quiet {
        warnings.iter().for_each(|w| eprintln!("warning: {w}"));
        drive
            .warnings()
            .iter()
            .for_each(|w| eprintln!("warning: {w}"));
    }
    let directory = args.directory(&settings);
    folder::refuse_occupied(&directory, args.force)?;
    folder::refuse_own_scene(&directory, name)?;
    let mut all = Vec::new();
    for member in 1..=count {
        let mut one = quiet(args);
        one.set.extend(members::setting(&settings, member, count));
        SceneSettings::load_and_build(name, &one.set, follows)?;
        let out = directory.join(member.to_string());
        folder::refuse_occupied(&out, args.force)?;
        one.out = Some(out);
        all.push(Member::Open(Box::new(one)));
    }
    let geometry = !args.no_geometry;
    let ensemble = Ensemble {
        plan: Plan::new(&settings, &motion, (args.frames, geometry), args.ends)?,
        members: count,
    };
    folder::prepare(&directory, args.force, None)?;
    folder::clear_all(&directory)?;
    let mut held = ensemble_files::begin(&directory)?;
    let path = directory.join(PLAN);
    let plan = checkpoint::checked(&path, MAGIC, &ensemble)?;
    if let Err(error) = held.write(&plan) {
        // Half a plan is none.
        let _ = held.remove();
        return Err(Failure::write(path, error));
    }
    let verdicts = BTreeMap::new();
    let members = count;
    Summary { members, verdicts }.write(&directory)?;
    wind(args, &directory, held, all)
}

/// Goes on with the members of a folder that were stopped, and winds those that have not begun.
///
/// # Errors
/// Those of [`run`], and a plan that cannot be read.
pub(super) fn resume(args: &RunArgs, directory: &Path) -> Result<(), Failure> {
    let path = directory.join(PLAN);
    let missing = || Failure::write(&path, ErrorKind::NotFound.into());
    let held = ensemble_files::hold(directory)?.ok_or_else(missing)?;
    let bytes = std::fs::read(&path).map_err(|e| Failure::write(&path, e))?;
    let ensemble: Ensemble =
        checkpoint::read_checked(&bytes, MAGIC).map_err(|what| Failure::Resume {
            directory: directory.display().to_string(),
            reason: format!("{PLAN} {what}; go on with each member, or begin again with --force"),
        })?;
    ensemble.plan.check_inputs()?;
    let all: Result<Vec<Member>, Failure> = (1..=ensemble.members)
        .map(|member| ensemble.member(args, directory, member))
        .collect();
    let mut args = args.clone();
    args.ends = args.ends.or(ensemble.plan.ends);
    wind(&args, directory, held, all?)
}

impl Ensemble {
    /// A member as its folder has it.
    fn member(&self, args: &RunArgs, directory: &Path, member: u32) -> Result<Member, Failure> {
        let out = directory.join(member.to_string());
        let mut one = quiet(args);
        one.ends.no_report |= self.plan.ends.no_report;
        one.resume = None;
        if out.join(checkpoint::FILE).is_file() {
            one.resume = Some(out);
        } else if out.join("summary.json").is_file() {
            return Ok(Member::Ended(judged(&out)));
        } else {
            let mut settings = self.plan.settings.clone();
            members::vary(&mut settings, member, self.members)?;
            one.settings = Some(Box::new(settings));
            (one.inputs, one.step) = self.plan.motion.inputs.clone().unzip();
            one.stop_time = self.plan.motion.stop_time;
            one.frames = self.plan.frames;
            one.no_geometry = !self.plan.geometry;
            // A kill may have left it without a checkpoint.
            one.force = true;
            one.out = Some(out);
        }
        Ok(Member::Open(Box::new(one)))
    }
}

/// The same run without words: what a member has to say stands in its folder.
fn quiet(args: &RunArgs) -> RunArgs {
    let mut one = args.clone();
    (one.quiet, one.verbose, one.ends.fail_on_defect) = (true, false, false);
    one
}

/// What a member that has ended came to, from its folder.
fn judged(directory: &Path) -> Result<Judged, Failure> {
    let summary = summary(directory);
    let word = |key: &str| summary[key].as_str().unwrap_or_default();
    let mild = [
        Verdict::Unsettled,
        Verdict::Single,
        Verdict::Aligned,
        Verdict::Marginal,
    ];
    let mut verdicts = mild.into_iter().chain(DefectKind::ALL.map(Verdict::from));
    let verdict = verdicts.find(|verdict| verdict.as_str() == word("verdict"));
    let place = directory.display().to_string();
    match (word("status"), verdict) {
        ("done", Some(verdict)) => {
            let defects = summary["defects"].as_array();
            let any = defects.is_some_and(|defects| !defects.is_empty());
            let defect = any || verdict.is_defect();
            Ok(Judged { verdict, defect })
        }
        ("done", None) if word("verdict") == UNJUDGED => Err(Failure::MemberFailed {
            reason: summary["reasons"][0]
                .as_str()
                .unwrap_or_default()
                .to_owned(),
            directory: place,
        }),
        ("failed", _) => Err(Failure::MemberFailed {
            reason: word("reason").to_owned(),
            directory: place,
        }),
        _ => Err(Failure::Resume {
            directory: place,
            reason: format!("summary.json is not whole; {}", begin_again(directory)),
        }),
    }
}

/// Winds the members that are open, and tells what came of all. The plan is held until they have ended.
fn wind(args: &RunArgs, directory: &Path, held: Locked, all: Vec<Member>) -> Result<(), Failure> {
    let count = all.len();
    let bar = runs_bar(args.quiet, count as u64);
    let stop = StopFlags::on_signals();
    let wind = |member: Member| {
        let ended = match member {
            Member::Ended(judged) => Some(judged),
            // Members that have not begun when Ctrl-C comes leave no folder.
            Member::Open(one) => {
                (!stop.asked.load(Ordering::SeqCst)).then(|| wind_one(&one, &stop))
            }
        };
        bar.inc(1);
        ended
    };
    let ended: Vec<Option<Result<Judged, Failure>>> = all.into_par_iter().map(wind).collect();
    bar.finish_and_clear();
    let goes_on = |one: &Option<Result<Judged, Failure>>| {
        matches!(one, None | Some(Err(Failure::Interrupted { .. })))
    };
    if ended.iter().any(goes_on) {
        return Err(Failure::EnsembleInterrupted {
            done: ended.iter().filter(|one| !goes_on(one)).count(),
            all: count,
            directory: directory.display().to_string(),
            told: args.told_with(),
        });
    }
    let ended: Vec<Result<Judged, Failure>> = ended.into_iter().flatten().collect();
    let stuck = |one: &Result<Judged, Failure>| matches!(one, Err(Failure::Stuck { .. }));
    if !ended.iter().any(stuck) {
        let path = directory.join(PLAN);
        held.remove().map_err(|e| Failure::write(&path, e))?;
    }
    let counts = counts(&ended);
    let verdicts = counts.iter().map(|(key, count)| (word(key), *count));
    Summary {
        members: ended.len() as u32,
        verdicts: verdicts.collect(),
    }
    .write(directory)?;
    let words = words(&counts);
    let defective = ended.iter().flatten().any(|judged| judged.defect);
    let place = directory.display();
    if !args.quiet {
        let why = why(directory, &ended);
        print(&format!(
            "verdicts: {words}\n{why}results: {place}/1 to {place}/{count}\n"
        ))?;
    }
    let first = ended.into_iter().collect::<Result<Vec<_>, _>>();
    first.map_err(|failure| match failure {
        // All members go on together, and not the one that met the full disk.
        Failure::Stuck { failure, .. } => Failure::Stuck {
            failure,
            next: format!(
                "make room, then go on with: {}{}",
                resume_command(place),
                args.told_with()
            ),
        },
        other => other,
    })?;
    match args.ends.fail_on_defect && defective {
        true => Err(Failure::Defect { what: words }),
        false => Ok(()),
    }
}

/// A line with the first reason of the gravest verdict, and the member that has it; none where no member has a verdict.
fn why(directory: &Path, ended: &[Result<Judged, Failure>]) -> String {
    let judged = (1..).zip(ended);
    let verdicts = judged.filter_map(|(member, one)| Some((one.as_ref().ok()?.verdict, member)));
    let gravest = verdicts.min_by_key(|(verdict, member)| (Reverse(*verdict), *member));
    let told = gravest.and_then(|(_, member)| {
        let place = directory.join(member.to_string());
        let summary = summary(&place);
        let reason = summary["reasons"][0].as_str()?;
        Some(format!("why: {reason} ({})\n", place.display()))
    });
    told.unwrap_or_default()
}

/// What the folder of a member tells of it; nothing where it has no whole summary.
fn summary(directory: &Path) -> Value {
    let text = std::fs::read_to_string(directory.join("summary.json")).unwrap_or_default();
    serde_json::from_str(&text).unwrap_or_default()
}

/// Runs by verdict, the gravest last; those without one come after those with one.
type Counts = BTreeMap<(bool, Option<Verdict>), u32>;

fn counts(ended: &[Result<Judged, Failure>]) -> Counts {
    let mut counts = Counts::new();
    for one in ended {
        let verdict = one.as_ref().ok().map(|judged| judged.verdict);
        *counts.entry((verdict.is_none(), verdict)).or_insert(0) += 1;
    }
    counts
}

/// The verdict of a count.
fn word((_, verdict): &(bool, Option<Verdict>)) -> String {
    verdict.map_or("failed", Verdict::as_str).to_owned()
}

/// The share of each verdict: `aligned 6 of 8 (75 %), gap 2 of 8 (25 %)`.
fn words(counts: &Counts) -> String {
    let all: u32 = counts.values().sum();
    let share = |(key, count): (_, &u32)| {
        let percent = 100.0 * f64::from(*count) / f64::from(all);
        format!("{} {count} of {all} ({percent:.0} %)", word(key))
    };
    counts.iter().map(share).collect::<Vec<_>>().join(", ")
}
