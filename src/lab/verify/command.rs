//! Runs of cases with exact answers: which ones, how, and a record for each number.

use super::file::{Case, CaseFile, Check};
use super::report::{Outcome, Record, judge, unknown};
use super::side_by_side::side_by_side;
use super::{Context, KINDS, Kind, Setup, VerifyError, WIND, Wind, inputs};
use crate::scene::{Integrator, Preset, refuse_repeated};
use crate::settings::SceneSettings;
use cpu_time::ThreadTime;
use std::path::PathBuf;

/// Which cases to run, and how.
#[derive(Clone, Debug)]
pub struct VerifyOptions {
    /// kinds to run; all if empty
    pub kinds: Vec<String>,
    /// case files to run; the packed reference cases if empty
    pub files: Vec<PathBuf>,
    /// method: the implicit one that winding uses, or the paper's explicit one (RK4)
    pub preset: Preset,
    /// solver settings as `NAME=VALUE`: `solver.spacing_near` (finest node spacing, m), `solver.tolerance` (m, of kinds
    /// whose set-up is that of a wind) or `solver.integrator`
    pub set: Vec<String>,
    /// a line of JSON per number instead of a table
    pub json: bool,
}

impl Default for VerifyOptions {
    fn default() -> Self {
        Self {
            kinds: Vec::new(),
            files: Vec::new(),
            preset: Preset::Default,
            set: Vec::new(),
            json: false,
        }
    }
}

/// How the cases are computed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Manner {
    /// whose checks count
    pub preset: Preset,
    /// the method: implicit for statics as well, or explicit forces with steps of this kind
    pub integrator: Integrator,
    /// node spacing where it is finest, m; `None`: each kind's own
    pub spacing: Option<f64>,
    /// local error that a step may have, m, where the set-up is that of a wind
    pub tolerance: Option<f64>,
    /// node spacing of a wind at this tolerance over the wire's diameter
    pub wind_spacing: f64,
}

impl Manner {
    /// The set-ups that a kind's cases take, each with its name: "wind", or in what it differs from a wind's.
    fn setups(&self, kind: &Kind) -> Vec<(Setup, String)> {
        if self.integrator != Integrator::Implicit {
            return vec![(Setup::Own, self.named(Some("explicit method"), false))];
        }
        let own = kind
            .own
            .map(|how| (Setup::Own, self.named(Some(how), false)));
        let wind = (kind.wind != Wind::Nothing).then(|| (Setup::Wind, self.named(None, true)));
        own.into_iter().chain(wind).collect()
    }

    fn named(&self, how: Option<&str>, winds: bool) -> String {
        let mut parts: Vec<String> = how.map(str::to_owned).into_iter().collect();
        if let Some(spacing) = self.spacing {
            parts.push(format!("spacing {spacing} m"));
        }
        if let Some(tolerance) = self.tolerance.filter(|_| winds) {
            parts.push(format!("tolerance {tolerance:e} m"));
        }
        if parts.is_empty() {
            return WIND.to_owned();
        }
        parts.join("; ")
    }
}

impl VerifyOptions {
    /// The manner that preset and settings ask for.
    pub fn manner(&self) -> Result<Manner, VerifyError> {
        let preset = self.preset;
        let mut settings = SceneSettings::default();
        let mut spacing = None;
        let mut named = Vec::new();
        for text in &self.set {
            let bad = |problem: String| VerifyError::Setting {
                text: text.clone(),
                problem,
            };
            let (name, value) = text
                .split_once('=')
                .ok_or_else(|| bad("NAME=VALUE is wanted".to_owned()))?;
            named.push((name.to_owned(), value.to_owned()));
            refuse_repeated(&named)
                .and_then(|()| settings.set_text(name, value))
                .map_err(|e| bad(e.to_string()))?;
            if name.starts_with("solver.spacing_near") {
                let near = settings.solver.spacing_near;
                if !(near.is_finite() && near > 0.0) {
                    return Err(bad("a spacing above 0 is wanted".to_owned()));
                }
                spacing = Some(near);
            } else if name == "solver.tolerance" {
                let tolerance = settings.solver.tolerance;
                if !(tolerance.is_finite() && tolerance > 0.0) {
                    return Err(bad("a tolerance above 0 is wanted".to_owned()));
                }
            } else if name != "solver.integrator" {
                return Err(bad(
                    "verify takes solver.spacing_near, solver.tolerance and solver.integrator"
                        .to_owned(),
                ));
            }
        }
        let integrator = match (settings.solver.integrator.as_str(), preset) {
            ("rk4", _) | ("auto", Preset::Paper) => Integrator::Rk4,
            ("verlet", _) => Integrator::Verlet,
            ("implicit" | "auto", _) => Integrator::Implicit,
            (other, _) => {
                return Err(VerifyError::Setting {
                    text: format!("solver.integrator={other}"),
                    problem: "auto, implicit, verlet or rk4 is wanted".to_owned(),
                });
            }
        };
        Ok(Manner {
            preset,
            integrator,
            spacing,
            tolerance: Some(settings.solver.tolerance).filter(|tolerance| *tolerance > 0.0),
            wind_spacing: wind_spacing(settings.solver.tolerance)?,
        })
    }

    /// The case files to run.
    pub fn case_files(&self) -> Result<Vec<CaseFile>, VerifyError> {
        if self.files.is_empty() {
            CaseFile::packed()
        } else {
            self.files.iter().map(|p| CaseFile::load(p)).collect()
        }
    }
}

/// Node spacing near the core that the default scene has at this tolerance, over the wire's diameter.
fn wind_spacing(tolerance: f64) -> Result<f64, VerifyError> {
    let mut settings = SceneSettings::default();
    settings.solver.tolerance = tolerance;
    let scene = settings.build().map_err(|e| VerifyError::Setting {
        text: format!("solver.tolerance={tolerance}"),
        problem: e.to_string(),
    })?;
    Ok(scene.solver.spacing_near / scene.wire.diameter)
}

/// Runs what `args` ask for on all cores, handing each line to `print` in the order of the files; whether every number was right.
///
/// An error is bad input (exit code 2); `Ok(false)` a number out of tolerance, a case without
/// an answer, or a kind that is not known (exit code 1).
pub fn run(args: &VerifyOptions, mut print: impl FnMut(&str)) -> Result<bool, VerifyError> {
    let manner = args.manner()?;
    let files = args.case_files()?;
    if !args.json {
        print(&Record::heading());
    }
    let (mut right, mut all) = (0, 0);
    let mut seconds = 0.0;
    let mut count = |record: &Record| {
        all += 1;
        right += usize::from(record.ok == Some(true));
        print(&if args.json {
            record.json()
        } else {
            record.line()
        });
    };
    for kind in &args.kinds {
        if !files.iter().any(|f| f.kind == *kind) {
            if KINDS.iter().any(|known| known.name == *kind) {
                return Err(VerifyError::NoCases { kind: kind.clone() });
            }
            count(&unknown(kind, None));
        }
    }
    let asked = |file: &&CaseFile| args.kinds.is_empty() || args.kinds.contains(&file.kind);
    let by_name = |file: &&CaseFile| !args.files.is_empty() || args.kinds.contains(&file.kind);
    let mut unjudged = Vec::new();
    for file in files.iter().filter(asked).filter(by_name) {
        if !judged(file, manner.preset) {
            unjudged.push(file.kind.as_str());
        }
    }
    let tasks: Vec<Task> = files
        .iter()
        .filter(asked)
        .map(|file| tasks(file, &manner))
        .collect::<Result<Vec<_>, _>>()?
        .into_iter()
        .flatten()
        .collect();
    side_by_side(
        &tasks,
        |task| task.run(&manner),
        |(records, cpu)| {
            seconds += cpu;
            records.iter().for_each(&mut count);
        },
    )?;
    if !args.json {
        print(&format!("{right} of {all} right, {seconds:.1} s"));
        if !unjudged.is_empty() {
            print(&format!(
                "not judged, since no number counts for this preset: {}; --preset names the other",
                unjudged.join(", ")
            ));
        }
    }
    Ok(right == all)
}

/// Runs the cases of one file; `each` gets the records of a case and the seconds of processor time it took.
pub fn run_file(
    file: &CaseFile,
    manner: &Manner,
    mut each: impl FnMut(&[Record], f64),
) -> Result<(), VerifyError> {
    for task in tasks(file, manner)? {
        let (records, cpu) = task.run(manner)?;
        each(&records, cpu);
    }
    Ok(())
}

/// A case to run.
struct Task<'a> {
    file: &'a CaseFile,
    case: &'a Case,
    /// its kind, the set-up and the name of that; none for a kind that is not known
    how: Option<(&'static Kind, Setup, String)>,
}

/// What there is to run of a file, once every input is in its range.
fn tasks<'a>(file: &'a CaseFile, manner: &Manner) -> Result<Vec<Task<'a>>, VerifyError> {
    inputs::check(file)?;
    let Some(kind) = KINDS.iter().find(|kind| kind.name == file.kind) else {
        let of = |case| Task {
            file,
            case,
            how: None,
        };
        return Ok(file.cases.iter().map(of).collect());
    };
    if !judged(file, manner.preset) {
        // nobody asks for what the other preset is judged by
        return Ok(Vec::new());
    }
    let setups = manner.setups(kind);
    let of = |case| {
        setups.iter().map(move |(setup, name)| Task {
            file,
            case,
            how: Some((kind, *setup, name.clone())),
        })
    };
    Ok(file.cases.iter().flat_map(of).collect())
}

/// Whether any number of the file counts for the preset.
fn judged(file: &CaseFile, preset: Preset) -> bool {
    file.check.iter().any(|(_, c)| c.counts(preset))
}

impl Task<'_> {
    /// The records of the case, and the seconds of processor time it took.
    fn run(&self, manner: &Manner) -> Result<(Vec<Record>, f64), VerifyError> {
        let Self { file, case, how } = self;
        if let Some((kind, setup, name)) = how {
            return run_case(file, case, manner, kind, (*setup, name));
        }
        let counts = |c: &&(String, Check)| c.1.counts(manner.preset);
        let mut records = judge(
            &file.kind,
            case,
            file.check.iter().filter(counts),
            &Outcome::Unknown,
        );
        if records.is_empty() {
            records.push(unknown(&file.kind, Some(&case.id)));
        }
        Ok((records, 0.0))
    }
}

/// The records of a case in one set-up, and the seconds of processor time it took.
fn run_case(
    file: &CaseFile,
    case: &Case,
    manner: &Manner,
    kind: &Kind,
    (setup, name): (Setup, &str),
) -> Result<(Vec<Record>, f64), VerifyError> {
    let winds = setup == Setup::Wind;
    let diameter = file.section.diameter;
    let near = manner.wind_spacing * diameter;
    let usual = SceneSettings::default().solver.tolerance_for(diameter);
    let context = Context {
        section: &file.section,
        inputs: &case.inputs,
        folder: &file.folder,
        integrator: manner.integrator,
        spacing: manner.spacing.or(winds.then_some(near)),
        spacing_given: manner.spacing.is_some(),
        tolerance: manner.tolerance.unwrap_or(usual),
        setup,
    };
    let start = ThreadTime::now();
    let answers = (kind.run)(&context);
    let cpu = start.elapsed().as_secs_f64();
    let outcome = match answers {
        Ok(answers) => Outcome::Answers(answers, cpu),
        Err(VerifyError::Input { name, problem }) => {
            return Err(VerifyError::File {
                file: file.name.clone(),
                key: format!("case {}, inputs.{name}", case.id),
                problem,
            });
        }
        Err(error) => Outcome::Failed(error.to_string(), cpu),
    };
    let counts = |(quantity, check): &&(String, Check)| {
        check.counts(manner.preset) && (!winds || kind.wind.answers(quantity))
    };
    let mut records = judge(&file.kind, case, file.check.iter().filter(counts), &outcome);
    for record in &mut records {
        record.setup = Some(name.to_owned());
    }
    Ok((records, cpu))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn set(text: &str) -> VerifyOptions {
        VerifyOptions {
            set: vec![text.to_owned()],
            ..VerifyOptions::default()
        }
    }

    #[test]
    fn settings_reach_the_manner() {
        let paper = VerifyOptions {
            preset: Preset::Paper,
            ..set("solver.spacing_near=0.0002")
        };
        let manner = paper.manner().expect("known settings");
        assert_eq!(manner.integrator, Integrator::Rk4);
        assert_eq!(manner.spacing, Some(0.0002));
        let manner = set("solver.integrator=rk4")
            .manner()
            .expect("known settings");
        assert_eq!(
            (manner.preset, manner.integrator),
            (Preset::Default, Integrator::Rk4)
        );
        for bad in [
            "solver.spacing_near",
            "solver.spacing_near=wide",
            "solver.spacing_near=-1",
            "solver.spacing_naer=1",
            "solver.integrator=euler",
            "wire.diameter=0.001",
        ] {
            assert!(set(bad).manner().is_err(), "{bad}");
        }
    }

    #[test]
    fn a_kind_that_nobody_knows_is_neither_right_nor_wrong() {
        let mut lines = Vec::new();
        let options = VerifyOptions {
            kinds: vec!["perpetual_motion".to_owned()],
            json: true,
            ..VerifyOptions::default()
        };
        let all_right = run(&options, |line| lines.push(line.to_owned()));
        assert_eq!(all_right, Ok(false));
        assert_eq!(lines.len(), 1);
        assert!(lines[0].contains(r#""ok":null"#), "{}", lines[0]);
    }
}
