//! Case files: one `kind`, the wire, what is checked how closely, and the cases.

use super::VerifyError;
use crate::rod::{ENAMEL_DENSITY, Hardening, Section};
use crate::scene::Preset;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use std::path::{Path, PathBuf};

/// How an expected number counts.
///
/// `rel`: within this share of the expected value; `abs`: within this distance; both: either
/// suffices; `abs_of` and `tol`: within `tol` times that input; `equal`: exactly equal.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Check {
    /// share of the expected value
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rel: Option<f64>,
    /// distance in the quantity's unit
    #[serde(skip_serializing_if = "Option::is_none")]
    pub abs: Option<f64>,
    /// name of an input that `tol` multiplies
    #[serde(skip_serializing_if = "Option::is_none")]
    pub abs_of: Option<String>,
    /// factor of that input
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tol: Option<f64>,
    /// exactly equal
    #[serde(skip_serializing_if = "Option::is_none")]
    pub equal: Option<bool>,
    /// counts under this preset only: `paper` or `default`
    #[serde(skip_serializing_if = "Option::is_none")]
    pub preset: Option<String>,
}

impl Check {
    /// Whether it counts under `preset`.
    pub fn counts(&self, preset: Preset) -> bool {
        self.preset.as_deref().is_none_or(|name| {
            name == match preset {
                Preset::Paper => "paper",
                Preset::Default => "default",
            }
        })
    }
}

/// One case.
#[derive(Clone, Debug, PartialEq)]
pub struct Case {
    /// its name
    pub id: String,
    /// what the solver is given
    pub inputs: Map<String, Value>,
    /// what it should find
    pub expected: Map<String, Value>,
}

/// A file of cases of one kind.
#[derive(Clone, Debug, PartialEq)]
pub struct CaseFile {
    /// path or packed name, for messages
    pub name: String,
    /// folder that paths in the cases are relative to
    pub folder: PathBuf,
    /// which solver
    pub kind: String,
    /// quantities that count
    pub check: Vec<(String, Check)>,
    /// the wire
    pub section: Section,
    /// the cases, in file order
    pub cases: Vec<Case>,
}

/// The reference files that come with the program.
macro_rules! packed {
    ($($kind:literal),* $(,)?) => {
        &[$(($kind, include_str!(concat!("../../../tests/reference/", $kind, ".json")))),*]
    };
}

/// Kind and text of each packed file.
const PACKED: &[(&str, &str)] = packed![
    "elastica_cantilever",
    "end_couple",
    "bending_modes",
    "axial_wave",
    "torsion",
    "hanging_wire",
    "helix",
    "mandrel_springback",
    "cyclic_bending",
    "bulge_linear",
    "corner_edge",
    "square_loop",
    "capstan",
    "grooved_capstan",
    "twist_buckling",
    "shoulder_static",
    "groove_seat",
    "shoulder_drop",
    "spinning_ring",
    "penalty_impact",
    "winding_feed",
    "feed_tension",
    "wave_damping",
    "rolling_path",
    "helix_gap",
    "frozen_helix",
    "live_pair",
];

impl CaseFile {
    /// Reads a file.
    pub fn load(path: &Path) -> Result<Self, VerifyError> {
        let name = path.display().to_string();
        let text = std::fs::read_to_string(path).map_err(|e| VerifyError::Unreadable {
            file: name.clone(),
            reason: e.to_string(),
        })?;
        let folder = path.parent().unwrap_or(Path::new("")).to_path_buf();
        Self::parse(&name, folder, &text)
    }

    /// The files that come with the program.
    pub fn packed() -> Result<Vec<Self>, VerifyError> {
        let read = |(kind, text): &(&str, &str)| {
            Self::parse(&format!("{kind}.json (packed)"), PathBuf::new(), text)
        };
        PACKED.iter().map(read).collect()
    }

    /// Reads the text of a file.
    pub fn parse(name: &str, folder: PathBuf, text: &str) -> Result<Self, VerifyError> {
        let bad = |key: &str, problem: String| VerifyError::File {
            file: name.to_owned(),
            key: key.to_owned(),
            problem,
        };
        let root: Value = serde_json::from_str(text).map_err(|e| bad("", e.to_string()))?;
        let root = object(&root).ok_or_else(|| bad("", "a JSON object is wanted".to_owned()))?;
        let field = |key: &str| root.get(key).ok_or_else(|| bad(key, "missing".to_owned()));
        let kind = field("kind")?
            .as_str()
            .ok_or_else(|| bad("kind", "a text is wanted".to_owned()))?;
        let checks = object(field("check")?)
            .ok_or_else(|| bad("check", "an object is wanted".to_owned()))?;
        let check = checks
            .iter()
            .map(|(quantity, value)| {
                parse_check(value)
                    .map(|c| (quantity.clone(), c))
                    .map_err(|problem| bad(&format!("check.{quantity}"), problem))
            })
            .collect::<Result<_, _>>()?;
        let wire =
            object(field("wire")?).ok_or_else(|| bad("wire", "an object is wanted".to_owned()))?;
        let section =
            section(wire).map_err(|(key, problem)| bad(&format!("wire.{key}"), problem))?;
        let list = field("cases")?
            .as_array()
            .filter(|list| !list.is_empty())
            .ok_or_else(|| bad("cases", "a list of at least one case is wanted".to_owned()))?;
        let cases = list
            .iter()
            .enumerate()
            .map(|(i, value)| {
                case(value).map_err(|(key, problem)| bad(&format!("cases[{i}]{key}"), problem))
            })
            .collect::<Result<_, _>>()?;
        Ok(Self {
            name: name.to_owned(),
            folder,
            kind: kind.to_owned(),
            check,
            section,
            cases,
        })
    }
}

fn object(value: &Value) -> Option<&Map<String, Value>> {
    value.as_object()
}

fn parse_check(value: &Value) -> Result<Check, String> {
    let check = Check::deserialize(value).map_err(|e| e.to_string())?;
    let bound = |t: Option<f64>| t.is_none_or(|t| t >= 0.0 && t.is_finite());
    if !(bound(check.rel) && bound(check.abs) && bound(check.tol)) {
        return Err("a tolerance is a finite number, 0 or more".to_owned());
    }
    if check.abs_of.is_some() != check.tol.is_some() {
        return Err("abs_of and tol go together".to_owned());
    }
    let says_how = check.rel.is_some()
        || check.abs.is_some()
        || check.abs_of.is_some()
        || check.equal == Some(true);
    if !says_how {
        return Err("one of rel, abs, abs_of with tol, equal: true is wanted".to_owned());
    }
    match check.preset.as_deref() {
        None | Some("paper" | "default") => Ok(check),
        Some(other) => Err(format!("preset {other} is neither paper nor default")),
    }
}

/// Section of a wire record, or the key at fault.
fn section(wire: &Map<String, Value>) -> Result<Section, (&'static str, String)> {
    let number = |key: &'static str, above_zero: bool| {
        let value = wire
            .get(key)
            .ok_or((key, "missing".to_owned()))?
            .as_f64()
            .ok_or((key, "a number is wanted".to_owned()))?;
        let good = value.is_finite() && (value > 0.0 || (!above_zero && value == 0.0));
        let range = if above_zero { "above 0" } else { "0 or more" };
        good.then_some(value)
            .ok_or((key, format!("{value}: a finite number {range} is wanted")))
    };
    let diameter = number("d", true)?;
    Ok(Section {
        diameter,
        bare_diameter: diameter,
        enamel_density: ENAMEL_DENSITY,
        density: number("rho", true)?,
        ea: number("EA", true)?,
        ea_p: number("EAp", false)?,
        ei: number("EI", true)?,
        ei_p: number("EIp", false)?,
        gj: number("GJ", true)?,
        gj_p: number("GJp", false)?,
        n_y: number("N_y", true)?,
        m_y: number("M_y", true)?,
        t_y: number("T_y", true)?,
        moment_cap: f64::INFINITY,
        hardening: Hardening::default(),
        strength: f64::INFINITY,
    })
}

fn case(value: &Value) -> Result<Case, (String, String)> {
    let wanted = |key: &str, what: &str| (key.to_owned(), format!("{what} is wanted"));
    let case = object(value).ok_or_else(|| wanted("", "an object"))?;
    let part = |key: &str| {
        case.get(key)
            .and_then(object)
            .cloned()
            .ok_or_else(|| wanted(&format!(".{key}"), "an object"))
    };
    let id = match case.get("id") {
        Some(Value::String(id)) => id.clone(),
        Some(Value::Number(id)) => id.to_string(),
        _ => return Err(wanted(".id", "a text")),
    };
    Ok(Case {
        id,
        inputs: part("inputs")?,
        expected: part("expected")?,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const GOOD: &str = r#"{"kind":"k","check":{"a":{"rel":0.1}},
        "wire":{"d":7e-4,"rho":8960,"EA":4.9e4,"EAp":1e3,"EI":3e-3,"EIp":1e-4,"GJ":4e-3,"GJp":9e-5,"N_y":38,"M_y":5e-3,"T_y":5e-3},
        "cases":[{"id":"one","inputs":{},"expected":{"a":1}}]}"#;

    fn error(from: &str, to: &str) -> String {
        assert!(GOOD.contains(from));
        let text = GOOD.replace(from, to);
        match CaseFile::parse("f.json", PathBuf::new(), &text) {
            Err(e) => e.to_string(),
            Ok(_) => String::new(),
        }
    }

    #[test]
    fn faults_are_named_by_file_and_key() {
        assert!(CaseFile::parse("f.json", PathBuf::new(), GOOD).is_ok());
        for (from, to, key) in [
            (r#""kind":"k","#, "", "kind"),
            (r#""EI":3e-3"#, r#""EI":-3e-3"#, "wire.EI"),
            (r#""EI":3e-3"#, r#""EI":"stiff""#, "wire.EI"),
            (r#""T_y":5e-3"#, r#""T":5e-3"#, "wire.T_y"),
            (r#"{"rel":0.1}"#, r#"{"relative":0.1}"#, "check.a"),
            (r#"{"rel":0.1}"#, r#"{"rel":-1}"#, "check.a"),
            (r#"{"rel":0.1}"#, r#"{"abs_of":"L"}"#, "check.a"),
            (r#"{"rel":0.1}"#, r#"{"rel":1,"preset":"best"}"#, "check.a"),
            (r#"{"rel":0.1}"#, r#"{"equal":false}"#, "check.a"),
            (r#""inputs":{},"#, "", "cases[0].inputs"),
            (r#""id":"one""#, r#""id":[]"#, "cases[0].id"),
        ] {
            let message = error(from, to);
            assert!(message.starts_with("f.json"), "{message}");
            assert!(message.contains(key), "{message} should name {key}");
        }
        assert!(error("}]}", "}]").contains("line 3"));
    }

    #[test]
    fn packed_files_are_whole() {
        let files = CaseFile::packed().expect("packed files are well formed");
        assert_eq!(files.len(), PACKED.len());
        for (file, (kind, _)) in files.iter().zip(PACKED) {
            assert_eq!(file.kind, *kind);
            assert!(!file.check.is_empty() && !file.cases.is_empty());
        }
    }
}
