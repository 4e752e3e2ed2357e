//! Runs of cases with exact answers: which ones, how, and a record for each number.

use super::file::{CaseFile, Check};
use super::report::{Outcome, Record, judge, unknown};
use super::{Context, KINDS, Kind, VerifyError, WIND};
use crate::scene::{Integrator, Preset};
use crate::settings::SceneSettings;
use std::path::PathBuf;
use std::time::Instant;

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
    /// local error that a step may have, m, for kinds whose set-up is that of a wind
    pub tolerance: f64,
}

impl Manner {
    /// The set-up of a kind's cases: "wind", or in what it differs from a wind's.
    fn setup(&self, kind: &Kind) -> String {
        let mut parts = Vec::new();
        if self.integrator != Integrator::Implicit {
            parts.push("explicit method".to_owned());
        } else if kind.setup != WIND {
            parts.push(kind.setup.to_owned());
        }
        if let Some(spacing) = self.spacing {
            parts.push(format!("spacing {spacing} m"));
        }
        let default = SceneSettings::default().solver.tolerance;
        if kind.setup == WIND && self.tolerance != default {
            parts.push(format!("tolerance {:e} m", self.tolerance));
        }
        if parts.is_empty() {
            WIND.to_owned()
        } else {
            parts.join("; ")
        }
    }
}

impl VerifyOptions {
    /// The manner that preset and settings ask for.
    pub fn manner(&self) -> Result<Manner, VerifyError> {
        let preset = self.preset;
        let mut settings = SceneSettings::default();
        let mut spacing = None;
        for text in &self.set {
            let bad = |problem: String| VerifyError::Setting {
                text: text.clone(),
                problem,
            };
            let (name, value) = text
                .split_once('=')
                .ok_or_else(|| bad("NAME=VALUE is wanted".to_owned()))?;
            settings
                .set_text(name, value)
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
            tolerance: settings.solver.tolerance,
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

/// Runs what `args` ask for, handing each line to `print`; whether every number was right.
///
/// An error is bad input (exit code 2); `Ok(false)` a number out of tolerance, a case without
/// an answer or a kind that is not known (exit code 1).
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
    for file in &files {
        if !args.kinds.is_empty() && !args.kinds.contains(&file.kind) {
            continue;
        }
        run_file(file, &manner, |records, cpu| {
            seconds += cpu;
            records.iter().for_each(&mut count);
        })?;
    }
    if !args.json {
        print(&format!("{right} of {all} right, {seconds:.1} s"));
    }
    Ok(right == all)
}

/// Runs the cases of one file; `each` gets the records of a case and the seconds it took.
pub fn run_file(
    file: &CaseFile,
    manner: &Manner,
    mut each: impl FnMut(&[Record], f64),
) -> Result<(), VerifyError> {
    let solve = KINDS.iter().find(|kind| kind.name == file.kind);
    for case in &file.cases {
        let context = Context {
            section: &file.section,
            inputs: &case.inputs,
            folder: &file.folder,
            integrator: manner.integrator,
            spacing: manner.spacing,
            tolerance: manner.tolerance,
        };
        let start = Instant::now();
        let answers = solve.map(|kind| (kind.run)(&context));
        let cpu = start.elapsed().as_secs_f64();
        let outcome = match answers {
            None => Outcome::Unknown,
            Some(Ok(answers)) => Outcome::Answers(answers, cpu),
            Some(Err(VerifyError::Input { name, problem })) => {
                return Err(VerifyError::File {
                    file: file.name.clone(),
                    key: format!("case {}, inputs.{name}", case.id),
                    problem,
                });
            }
            Some(Err(error)) => Outcome::Failed(error.to_string(), cpu),
        };
        let counts = |c: &&(String, Check)| c.1.counts(manner.preset);
        let mut records = judge(&file.kind, case, file.check.iter().filter(counts), &outcome);
        if solve.is_none() && records.is_empty() {
            records.push(unknown(&file.kind, Some(&case.id)));
        }
        let setup = solve.map(|kind| manner.setup(kind));
        for record in &mut records {
            record.setup.clone_from(&setup);
        }
        each(&records, cpu);
    }
    Ok(())
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
