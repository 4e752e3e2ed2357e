//! Contact, friction and feed against the reference cases.

use coilwind::rod::Section;
use coilwind::verify::{self, Answer, Answers, Context, VerifyError};
use serde_json::Value;
use std::path::Path;

/// One case of a reference file.
struct Case {
    id: String,
    inputs: serde_json::Map<String, Value>,
    expected: serde_json::Map<String, Value>,
}

fn folder() -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/reference")
}

fn read(file: &Path) -> (Section, Value, Vec<Case>) {
    let doc: Value = serde_json::from_str(&std::fs::read_to_string(file).unwrap()).unwrap();
    let w = |name: &str| doc["wire"][name].as_f64().unwrap();
    let section = Section {
        diameter: w("d"),
        density: w("rho"),
        ea: w("EA"),
        ea_p: w("EAp"),
        ei: w("EI"),
        ei_p: w("EIp"),
        gj: w("GJ"),
        gj_p: w("GJp"),
        n_y: w("N_y"),
        m_y: w("M_y"),
        t_y: w("T_y"),
        moment_cap: f64::INFINITY,
        strength: f64::INFINITY,
    };
    let cases = doc["cases"].as_array().unwrap().iter().map(|c| Case {
        id: c["id"].as_str().unwrap().to_owned(),
        inputs: c["inputs"].as_object().unwrap().clone(),
        expected: c["expected"].as_object().unwrap().clone(),
    });
    let cases = cases.collect();
    (section, doc["check"].clone(), cases)
}

/// Runs every case of a file and compares what its `check` names; says all that differs at once.
fn check(file: &Path, run: fn(&Context) -> Result<Answers, VerifyError>) {
    let (section, check, cases) = read(file);
    let mut wrong = Vec::new();
    for case in &cases {
        let ctx = Context {
            section: &section,
            inputs: &case.inputs,
            folder: &folder(),
        };
        let start = std::time::Instant::now();
        let answers = run(&ctx);
        let took = start.elapsed().as_secs_f64();
        let Ok(answers) = answers else {
            wrong.push(format!("{}: {answers:?}", case.id));
            continue;
        };
        for (name, rule) in check.as_object().unwrap() {
            let Some(expected) = case.expected.get(name) else {
                continue;
            };
            let got = answers.iter().find(|(n, _)| n == name).map(|(_, a)| a);
            let (ok, line) = match (got, expected) {
                (Some(Answer::Number(got)), Value::Number(e)) => {
                    let e = e.as_f64().unwrap();
                    let error = (got - e).abs();
                    let rel = rule["rel"].as_f64().is_some_and(|t| error <= t * e.abs());
                    let abs = rule["abs"].as_f64().is_some_and(|t| error <= t);
                    let line = format!("{got:.6e} for {e:.6e}, {:+.3} %", (got / e - 1.0) * 100.0);
                    (rel || abs, line)
                }
                (Some(Answer::Flag(got)), Value::Bool(e)) => (got == e, format!("{got} for {e}")),
                (got, e) => (false, format!("{got:?} for {e}")),
            };
            println!("{:5} {} {name}: {line} ({took:.1} s)", ok, case.id);
            if !ok {
                wrong.push(format!("{} {name}: {line}", case.id));
            }
        }
    }
    assert!(!cases.is_empty() && wrong.is_empty(), "{wrong:#?}");
}

macro_rules! kinds {
    ($($kind:ident),*) => {$(
        #[test]
        fn $kind() {
            check(&folder().join(concat!(stringify!($kind), ".json")), verify::$kind::run);
        }
    )*};
}

kinds!(
    capstan,
    groove_seat,
    penalty_impact,
    shoulder_drop,
    shoulder_static,
    spinning_ring,
    twist_buckling,
    winding_feed
);
