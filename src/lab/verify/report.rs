//! Expected against computed: one record per number, as a line of JSON or of a table.

use super::file::{Case, Check};
use super::{Answer, Answers};
use serde::Serialize;
use serde_json::Value;

/// One expected number and what became of it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Record {
    /// kind of the case
    pub kind: String,
    /// its id; none where no case of the kind is known
    pub id: Option<String>,
    /// quantity, `name[3]` for an element of a list
    pub quantity: Option<String>,
    /// the reference
    pub expected: Value,
    /// what came out; null if nothing did
    pub got: Value,
    /// distance over the expected value; none for booleans and for an expected 0
    pub rel_error: Option<f64>,
    /// the file's check object for this quantity
    pub tolerance: Option<Check>,
    /// within tolerance; none for a kind that is not known
    pub ok: Option<bool>,
    /// computing time of the whole case, s (one thread)
    pub cpu_s: Option<f64>,
    /// "wind" where contact law, stiffness, spacing, tolerance, twist and formula of time are those of a wind of elastic wire, else
    /// what differs; none for a kind that is not known
    pub setup: Option<String>,
    /// why there is no number
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error: Option<String>,
}

/// What a case gave.
pub(super) enum Outcome {
    /// the kind is not known
    Unknown,
    /// answers and the seconds they took
    Answers(Answers, f64),
    /// what went wrong and after how many seconds
    Failed(String, f64),
}

/// The records of one case for the quantities that `checks` names.
pub(super) fn judge<'a>(
    kind: &str,
    case: &Case,
    checks: impl Iterator<Item = &'a (String, Check)>,
    outcome: &Outcome,
) -> Vec<Record> {
    let mut records = Vec::new();
    for (quantity, check) in checks {
        let expected = match case.expected.get(quantity) {
            None | Some(Value::Null) => continue,
            Some(expected) => expected,
        };
        let got = match outcome {
            Outcome::Answers(answers, _) => answers.iter().find(|(name, _)| name == quantity),
            _ => None,
        };
        let mut push = |quantity: String, expected: &Value, got: Value| {
            records.push(compare(kind, case, quantity, expected, got, check, outcome));
        };
        match expected {
            Value::Array(list) => {
                for (i, e) in list.iter().enumerate() {
                    let got = match got {
                        Some((_, Answer::List(values))) => values.get(i).map(|v| Value::from(*v)),
                        _ => None,
                    };
                    push(format!("{quantity}[{i}]"), e, got.unwrap_or(Value::Null));
                }
            }
            _ => {
                let got = match got {
                    Some((_, Answer::Number(v))) => Value::from(*v),
                    Some((_, Answer::Flag(b))) => Value::from(*b),
                    _ => Value::Null,
                };
                push(quantity.clone(), expected, got);
            }
        }
    }
    records
}

fn compare(
    kind: &str,
    case: &Case,
    quantity: String,
    expected: &Value,
    got: Value,
    check: &Check,
    outcome: &Outcome,
) -> Record {
    let numbers = expected.as_f64().zip(got.as_f64());
    let within = match numbers {
        Some((e, g)) => close(check, case, e, g),
        None => check.equal == Some(true) && *expected == got,
    };
    let (ok, cpu_s, error) = match outcome {
        Outcome::Unknown => (None, None, Some(format!("kind {kind} is not known"))),
        Outcome::Failed(why, seconds) => (Some(false), Some(*seconds), Some(why.clone())),
        Outcome::Answers(_, seconds) => (Some(within), Some(*seconds), None),
    };
    Record {
        kind: kind.to_owned(),
        id: Some(case.id.clone()),
        quantity: Some(quantity),
        expected: expected.clone(),
        rel_error: numbers
            .filter(|(e, _)| *e != 0.0)
            .map(|(e, g)| (g - e).abs() / e.abs()),
        got,
        tolerance: Some(check.clone()),
        ok,
        cpu_s,
        setup: None,
        error,
    }
}

/// Whether any of the check's bounds holds.
fn close(check: &Check, case: &Case, expected: f64, got: f64) -> bool {
    let off = (got - expected).abs();
    let of_input = check.abs_of.as_ref().zip(check.tol).and_then(|(name, t)| {
        let scale = case.inputs.get(name)?.as_f64()?;
        Some(t * scale.abs())
    });
    check.rel.is_some_and(|t| off <= t * expected.abs())
        || check.abs.is_some_and(|t| off <= t)
        || of_input.is_some_and(|t| off <= t)
        || (check.equal == Some(true) && got == expected)
}

/// The record of a kind that nobody knows and no file shows.
pub(super) fn unknown(kind: &str, id: Option<&str>) -> Record {
    Record {
        kind: kind.to_owned(),
        id: id.map(str::to_owned),
        quantity: None,
        expected: Value::Null,
        got: Value::Null,
        rel_error: None,
        tolerance: None,
        ok: None,
        cpu_s: None,
        setup: None,
        error: Some(format!("kind {kind} is not known")),
    }
}

impl Record {
    /// One line of JSON.
    pub fn json(&self) -> String {
        serde_json::to_string(self).unwrap_or_else(|e| format!("{{\"error\":\"{e}\"}}"))
    }

    /// One line of the table.
    pub fn line(&self) -> String {
        let verdict = match self.ok {
            Some(true) => "ok",
            Some(false) => "FAIL",
            None => "?",
        };
        let name = format!(
            "{} {} {}",
            self.kind,
            self.id.as_deref().unwrap_or("-"),
            self.quantity.as_deref().unwrap_or("-")
        );
        let number = |v: &Value| {
            v.as_f64()
                .map_or_else(|| v.to_string(), |x| format!("{x:.6e}"))
        };
        let error = self
            .rel_error
            .map_or_else(String::new, |e| format!("off by {e:.1e}"));
        let bound = self.tolerance.as_ref().map_or_else(String::new, bound);
        let setup = self.setup.as_deref().unwrap_or("-");
        let mut line = format!(
            "{verdict:<4}  {name:<72}  {:>14}  {:>14}  {error:<15} {bound:<30}  [{setup}]",
            number(&self.expected),
            number(&self.got),
        );
        if let Some(why) = &self.error {
            line.push_str("  ");
            line.push_str(why);
        }
        line.trim_end().to_owned()
    }

    /// Heading of the table.
    pub fn heading() -> String {
        format!(
            "{:<4}  {:<72}  {:>14}  {:>14}",
            "", "kind, case, quantity", "expected", "got"
        )
    }
}

/// A check in words.
fn bound(check: &Check) -> String {
    let mut parts = Vec::new();
    if let Some(t) = check.rel {
        parts.push(format!("{t:e} of it"));
    }
    if let Some(t) = check.abs {
        parts.push(format!("{t:e}"));
    }
    if let (Some(name), Some(t)) = (&check.abs_of, check.tol) {
        parts.push(format!("{t:e} of {name}"));
    }
    if check.equal == Some(true) {
        parts.push("equal".to_owned());
    }
    format!("(may: {})", parts.join(" or "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn case(expected: Value) -> Case {
        Case {
            id: "c".to_owned(),
            inputs: json!({"L_m": 0.5}).as_object().cloned().unwrap_or_default(),
            expected: expected.as_object().cloned().unwrap_or_default(),
        }
    }

    fn verdicts(check: Check, expected: Value, got: Answer) -> Vec<Option<bool>> {
        let checks = [("a".to_owned(), check)];
        judge(
            "k",
            &case(json!({ "a": expected })),
            checks.iter(),
            &Outcome::Answers(vec![("a", got)], 0.1),
        )
        .iter()
        .map(|r| r.ok)
        .collect()
    }

    #[test]
    fn either_bound_suffices() {
        let rel = Check {
            rel: Some(0.01),
            ..Check::default()
        };
        let both = Check {
            abs: Some(0.1),
            ..rel.clone()
        };
        let of = Check {
            abs_of: Some("L_m".to_owned()),
            tol: Some(0.2),
            ..Check::default()
        };
        let n = Answer::Number;
        assert_eq!(verdicts(rel.clone(), json!(-1.0), n(-1.009)), [Some(true)]);
        assert_eq!(verdicts(rel.clone(), json!(-1.0), n(-1.011)), [Some(false)]);
        assert_eq!(verdicts(both.clone(), json!(1.0), n(1.09)), [Some(true)]);
        assert_eq!(verdicts(both, json!(1.0), n(1.11)), [Some(false)]);
        assert_eq!(verdicts(of.clone(), json!(0), n(0.09)), [Some(true)]);
        assert_eq!(verdicts(of, json!(0), n(0.11)), [Some(false)]);
        assert_eq!(
            verdicts(rel.clone(), json!(1.0), n(f64::NAN)),
            [Some(false)]
        );
        let list = Answer::List(vec![1.0]);
        assert_eq!(
            verdicts(rel, json!([1.0, 2.0]), list),
            [Some(true), Some(false)]
        );
    }

    #[test]
    fn flags_are_equal_or_not_and_have_no_error() {
        let equal = Check {
            equal: Some(true),
            ..Check::default()
        };
        assert_eq!(
            verdicts(equal.clone(), json!(true), Answer::Flag(true)),
            [Some(true)]
        );
        assert_eq!(
            verdicts(equal.clone(), json!(true), Answer::Flag(false)),
            [Some(false)]
        );
        let checks = [("a".to_owned(), equal)];
        let outcome = Outcome::Answers(vec![("a", Answer::Flag(true))], 0.1);
        let records = judge(
            "k",
            &case(json!({"a": true, "b": 1})),
            checks.iter(),
            &outcome,
        );
        assert_eq!(records.len(), 1);
        assert!(records[0].json().contains(r#""rel_error":null"#));
    }

    #[test]
    fn without_an_answer_there_is_no_number() {
        let check = [(
            "a".to_owned(),
            Check {
                rel: Some(0.1),
                ..Check::default()
            },
        )];
        let unknown = judge("k", &case(json!({"a": 1})), check.iter(), &Outcome::Unknown);
        assert!(unknown[0].json().contains(r#""ok":null"#));
        let failed = Outcome::Failed("stuck".to_owned(), 0.2);
        let failed = judge("k", &case(json!({"a": 1})), check.iter(), &failed);
        assert_eq!((failed[0].ok, &failed[0].got), (Some(false), &Value::Null));
        assert!(failed[0].line().contains("stuck"));
    }
}
